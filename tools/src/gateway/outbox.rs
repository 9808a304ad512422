//! What waits for the broker.

use alloc::collections::{BTreeMap, BTreeSet, VecDeque};
use core::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use bytes::Bytes;
use tokio::sync::{Notify, Semaphore};

use super::config::Overflow;

/// A message and where it goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Message {
    pub(crate) topic: String,
    pub(crate) payload: Bytes,
    /// Whether the broker keeps it for those who come later.
    pub(crate) is_retained: bool,
}

/// Messages in the order of their arrival, until the broker has acknowledged them; at most
/// `capacity`, those under way included. Of what the broker retains, the latest of each topic.
pub(crate) struct Outbox {
    state: Mutex<State>,
    /// A message has come.
    filled: Notify,
    /// Free places.
    places: Semaphore,
    capacity: usize,
    overflow: Overflow,
    dropped: AtomicU64,
}

#[derive(Default)]
struct State {
    queue: VecDeque<(String, Bytes)>,
    /// By topic.
    retained: BTreeMap<String, Bytes>,
    /// Topics of those that have yet to be sent.
    unsent: BTreeSet<String>,
}

impl Outbox {
    pub(crate) fn new(capacity: usize, overflow: Overflow) -> Self {
        Self {
            state: Mutex::default(),
            filled: Notify::new(),
            places: Semaphore::new(capacity),
            capacity,
            overflow,
            dropped: AtomicU64::new(0),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts a message at the end; waits for a place, or gives up the oldest, as configured.
    pub(crate) async fn push(&self, topic: String, payload: Bytes) {
        if !self.try_push(&topic, &payload) {
            let has_dropped =
                self.overflow == Overflow::DropOldest && self.state().queue.pop_front().is_some();
            if has_dropped {
                // The place of the oldest is taken over.
                self.dropped.fetch_add(1, Ordering::Relaxed);
            } else if let Ok(place) = self.places.acquire().await {
                place.forget();
            }
            self.state().queue.push_back((topic, payload));
            self.filled.notify_one();
        }
    }

    /// Puts a message at the end if the queue is less than half full; otherwise it is dropped and
    /// counted. For what a flood would otherwise fill the queue with.
    pub(crate) fn offer(&self, topic: String, payload: Bytes) {
        let is_half_full = self.places.available_permits() < self.capacity.div_ceil(2);
        if is_half_full || !self.try_push(&topic, &payload) {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn try_push(&self, topic: &str, payload: &Bytes) -> bool {
        let Ok(place) = self.places.try_acquire() else {
            return false;
        };
        place.forget();
        let message = (topic.to_owned(), payload.clone());
        self.state().queue.push_back(message);
        self.filled.notify_one();
        true
    }

    /// Sets what the broker retains under a topic.
    pub(crate) fn retain(&self, topic: String, payload: Bytes) {
        let mut state = self.state();
        if state.retained.get(&topic) != Some(&payload) {
            state.unsent.insert(topic.clone());
            state.retained.insert(topic, payload);
            self.filled.notify_one();
        }
    }

    /// The next message, for the one session there is: what is retained first. May be dropped and
    /// called again.
    pub(crate) async fn next(&self) -> Message {
        loop {
            if let Some(message) = self.try_next() {
                return message;
            }
            self.filled.notified().await;
        }
    }

    fn try_next(&self) -> Option<Message> {
        let mut state = self.state();
        if let Some(topic) = state.unsent.pop_first()
            && let Some(payload) = state.retained.get(&topic).cloned()
        {
            return Some(Message {
                topic,
                payload,
                is_retained: true,
            });
        }
        let (topic, payload) = state.queue.pop_front()?;
        Some(Message {
            topic,
            payload,
            is_retained: false,
        })
    }

    /// The broker has acknowledged a message, or it is given up.
    pub(crate) fn done(&self, message: &Message) {
        if !message.is_retained {
            self.places.add_permits(1);
        }
    }

    /// A session has ended: what it had taken, in order, goes back to the front; what is retained
    /// is sent again.
    pub(crate) fn restore(&self, taken: impl DoubleEndedIterator<Item = Message>) {
        let mut state = self.state();
        for message in taken.rev().filter(|message| !message.is_retained) {
            state.queue.push_front((message.topic, message.payload));
        }
        state.unsent = state.retained.keys().cloned().collect();
        self.filled.notify_one();
    }

    /// Whether nothing waits for a session.
    pub(crate) fn is_empty(&self) -> bool {
        let state = self.state();
        state.queue.is_empty() && state.unsent.is_empty()
    }

    /// Messages that the broker has not acknowledged.
    pub(crate) fn len(&self) -> usize {
        self.capacity
            .saturating_sub(self.places.available_permits())
    }

    /// Messages given up because the queue was full.
    pub(crate) fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests;
