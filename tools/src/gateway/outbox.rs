//! What waits for the broker.

use alloc::sync::Arc;
use core::sync::atomic::Ordering;
use std::io;

use tokio::sync::{Semaphore, oneshot};

use super::{
    config::{Overflow, Sync},
    store::{Append, DeadLetters, Entry, Message, Shared, Store, StoreError, WINDOW, Writer},
};

/// Messages in the order of their arrival, until the broker has acknowledged them: in a store, or
/// in memory. Of what the broker retains, the latest of each topic.
pub(crate) struct Outbox {
    shared: Arc<Shared>,
    writer: Writer,
    keeping: Keeping,
}

enum Keeping {
    Memory {
        /// Free places.
        places: Semaphore,
        capacity: usize,
        overflow: Overflow,
    },
    Disk {
        max_bytes: u64,
    },
}

impl Outbox {
    /// Keeps messages in memory, `capacity` at most, those under way included.
    ///
    /// # Errors
    /// A thread that cannot be had.
    pub(crate) fn in_memory(
        capacity: usize,
        overflow: Overflow,
        letters: DeadLetters,
    ) -> io::Result<Self> {
        let shared = Arc::<Shared>::default();
        Ok(Self {
            writer: Writer::start(None, letters, Arc::clone(&shared))?,
            shared,
            keeping: Keeping::Memory {
                places: Semaphore::new(capacity),
                capacity,
                overflow,
            },
        })
    }

    /// Keeps messages in a store; what that holds already is sent first.
    ///
    /// # Errors
    /// A thread that cannot be had.
    pub(crate) fn on_disk(store: Store, sync: Sync, letters: DeadLetters) -> io::Result<Self> {
        let shared = Arc::<Shared>::default();
        let max_bytes = store.max_bytes();
        Ok(Self {
            writer: Writer::start(Some((store, sync)), letters, Arc::clone(&shared))?,
            shared,
            keeping: Keeping::Disk { max_bytes },
        })
    }

    /// Whether messages outlive this program.
    pub(crate) const fn is_on_disk(&self) -> bool {
        matches!(self.keeping, Keeping::Disk { .. })
    }

    /// Puts a message at the end, and returns when it is safe. In memory it waits for a place, or
    /// gives up the oldest, as configured. A message whose future is dropped may be kept all the
    /// same.
    ///
    /// # Errors
    /// A store that is full or a disk that fails: the message is not safe.
    pub(crate) async fn push(&self, entry: Entry) -> Result<(), StoreError> {
        let Keeping::Memory {
            places, overflow, ..
        } = &self.keeping
        else {
            let (done, is_done) = oneshot::channel();
            self.writer.append(Append::Entry(entry, Some(done)))?;
            let ended = || StoreError::Disk("its thread has ended".to_owned());
            return is_done.await.unwrap_or_else(|_| Err(ended()));
        };
        if !self.try_push(places, &entry.message) {
            let has_dropped = *overflow == Overflow::DropOldest
                && self.shared.state().queue.pop_front().is_some();
            if has_dropped {
                // The place of the oldest is taken over.
                self.count_dropped();
            } else if let Ok(place) = places.acquire().await {
                place.forget();
            }
            self.shared.state().queue.push_back(entry.message);
            self.shared.filled.notify_one();
        }
        Ok(())
    }

    /// Puts a message at the end if there is room for as much again; otherwise it is dropped and
    /// counted. For what a flood would otherwise take all the room with.
    pub(crate) fn offer(&self, message: Message) {
        let is_taken = match &self.keeping {
            Keeping::Memory {
                places, capacity, ..
            } => {
                let is_half_full = places.available_permits() < capacity.div_ceil(2);
                !is_half_full && self.try_push(places, &message)
            }
            Keeping::Disk { max_bytes } => {
                let number = None;
                self.shared.bytes.load(Ordering::Relaxed) < max_bytes / 2
                    && self
                        .writer
                        .append(Append::Entry(Entry { message, number }, None))
                        .is_ok()
            }
        };
        if !is_taken {
            self.count_dropped();
        }
    }

    fn count_dropped(&self) {
        self.shared.dropped.fetch_add(1, Ordering::Relaxed);
    }

    fn try_push(&self, places: &Semaphore, message: &Message) -> bool {
        let Ok(place) = places.try_acquire() else {
            return false;
        };
        place.forget();
        self.shared.state().queue.push_back(message.clone());
        self.shared.filled.notify_one();
        true
    }

    /// Sets what the broker retains under a topic.
    pub(crate) fn retain(&self, topic: String, payload: bytes::Bytes) {
        let mut state = self.shared.state();
        if state.retained.get(&topic) != Some(&payload) {
            state.unsent.insert(topic.clone());
            state.retained.insert(topic, payload);
            self.shared.filled.notify_one();
        }
    }

    /// Has what is retained under a topic sent once more.
    pub(crate) fn retain_again(&self, topic: &str) {
        let mut state = self.shared.state();
        if state.retained.contains_key(topic) {
            state.unsent.insert(topic.to_owned());
            self.shared.filled.notify_one();
        }
    }

    /// The broker does not take what it should retain under a topic.
    pub(crate) fn forget_retained(&self, topic: &str) {
        self.shared.state().retained.remove(topic);
    }

    /// The next message, for the one session there is: what is retained first. May be dropped and
    /// called again.
    pub(crate) async fn next(&self) -> Message {
        loop {
            if let Some(message) = self.try_next() {
                return message;
            }
            self.shared.filled.notified().await;
        }
    }

    fn try_next(&self) -> Option<Message> {
        let mut state = self.shared.state();
        if let Some(topic) = state.unsent.pop_first()
            && let Some(payload) = state.retained.get(&topic).cloned()
        {
            return Some(Message {
                topic,
                payload,
                is_retained: true,
                ..Message::default()
            });
        }
        // What was refused and cannot be written down must not fill the memory.
        if state.dead.len() >= WINDOW {
            return None;
        }
        let next = state.queue.pop_front();
        // Asked for once, half a window before the last is sent.
        if state.has_more && (state.queue.len() == WINDOW / 4 || state.queue.is_empty()) {
            self.writer.look();
        }
        next
    }

    /// The broker has acknowledged a message.
    pub(crate) fn done(&self, message: &Message) {
        match &self.keeping {
            _ if message.is_retained => {}
            Keeping::Memory { places, .. } => places.add_permits(1),
            Keeping::Disk { .. } => {
                let mut state = self.shared.state();
                state.done.push(message.id);
                // The thread sleeps where nothing was to be forgotten.
                if state.done.len() == 1 {
                    self.writer.look();
                }
            }
        }
    }

    /// The broker does not take a message, and never will: it goes to the file of dead letters.
    pub(crate) fn refused(&self, message: Message, reason: String) {
        if let Keeping::Memory { places, .. } = &self.keeping {
            places.add_permits(1);
        }
        self.shared.state().dead.push((message, reason));
        self.writer.look();
    }

    /// A session has ended: what it had taken, in order, goes back to the front; what is retained
    /// is sent again.
    pub(crate) fn restore(&self, taken: impl DoubleEndedIterator<Item = Message>) {
        let mut state = self.shared.state();
        for message in taken.rev().filter(|message| !message.is_retained) {
            state.queue.push_front(message);
        }
        state.unsent = state.retained.keys().cloned().collect();
        self.shared.filled.notify_one();
    }

    /// Whether nothing waits for a session, and nothing that was refused for its file.
    pub(crate) fn is_empty(&self) -> bool {
        let state = self.shared.state();
        state.queue.is_empty()
            && !state.has_more
            && state.unsent.is_empty()
            && state.dead.is_empty()
    }

    /// Messages that the broker has not acknowledged.
    pub(crate) fn len(&self) -> u64 {
        match &self.keeping {
            Keeping::Memory {
                places, capacity, ..
            } => {
                let taken = capacity.saturating_sub(places.available_permits());
                u64::try_from(taken).unwrap_or(u64::MAX)
            }
            Keeping::Disk { .. } => self.shared.count.load(Ordering::Relaxed),
        }
    }

    /// Bytes of the messages in the store.
    pub(crate) fn bytes(&self) -> u64 {
        self.shared.bytes.load(Ordering::Relaxed)
    }

    /// Messages given up because there was no room.
    pub(crate) fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }

    /// Messages that the broker refused, in the file of dead letters since the start.
    pub(crate) fn dead(&self) -> u64 {
        self.shared.dead.load(Ordering::Relaxed)
    }

    /// Brings all that the thread was handed to the disk, and ends it.
    pub(crate) fn end(&self) {
        self.writer.end();
    }
}

#[cfg(test)]
mod disk_tests;
#[cfg(test)]
mod tests;
