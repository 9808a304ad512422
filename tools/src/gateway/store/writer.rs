//! The thread that writes: one commit for all that waits.

use alloc::{
    collections::{BTreeMap, BTreeSet, VecDeque},
    sync::Arc,
};
use core::{
    mem,
    sync::atomic::{AtomicU64, Ordering},
    time::Duration,
};
use std::{
    io,
    sync::{
        Mutex, MutexGuard, PoisonError,
        mpsc::{self, Receiver, RecvTimeoutError, SyncSender, TrySendError},
    },
    thread::{self, JoinHandle},
};

use bytes::Bytes;
use log::error;
use tokio::sync::{Notify, oneshot};

use super::{DeadLetters, Entry, Message, Store, StoreError};
use crate::gateway::config::Sync;

/// Messages that wait in memory for the broker; what is beyond is read from the store in its turn.
pub(crate) const WINDOW: usize = 1024;

/// Entries that wait for the disk.
const WAITING: usize = 4096;

/// Entries of one commit.
const TOGETHER: usize = 512;

/// How late the store forgets what the broker has, unless a commit is due anyway.
const FORGET_PAUSE: Duration = Duration::from_millis(250);

/// From one error of the disk to the next attempt.
const ERROR_PAUSE: Duration = Duration::from_millis(250);

/// What sessions, lines and the thread share.
#[derive(Default)]
pub(crate) struct Shared {
    state: Mutex<State>,
    /// A message has come.
    pub(crate) filled: Notify,
    /// Messages that the broker has not acknowledged, and their bytes.
    pub(crate) count: AtomicU64,
    pub(crate) bytes: AtomicU64,
    /// Messages given up because there was no room.
    pub(crate) dropped: AtomicU64,
    /// Messages in the file of dead letters, of this run.
    pub(crate) dead: AtomicU64,
}

#[derive(Default)]
pub(crate) struct State {
    pub(crate) queue: VecDeque<Message>,
    /// By topic.
    pub(crate) retained: BTreeMap<String, Bytes>,
    /// Topics of those that have yet to be sent.
    pub(crate) unsent: BTreeSet<String>,
    /// What the broker has, and the store not yet forgotten.
    pub(crate) done: Vec<u64>,
    /// What the broker has refused, and why.
    pub(crate) dead: Vec<(Message, String)>,
    /// The last that was in the queue.
    loaded_to: u64,
    /// The store holds messages after that.
    pub(crate) has_more: bool,
}

impl Shared {
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Something for the thread.
pub(crate) enum Append {
    /// To be stored; who waits for that is told.
    Entry(Entry, Option<oneshot::Sender<Result<(), StoreError>>>),
    /// There is something in the shared state.
    Look,
    /// The last: all of it, and the end.
    End,
}

/// The thread, from outside.
pub(crate) struct Writer {
    requests: SyncSender<Append>,
    thread: Mutex<Option<JoinHandle<()>>>,
}

impl Writer {
    /// Starts the thread. Without a store it writes dead letters alone.
    ///
    /// # Errors
    /// A thread that cannot be had.
    pub(crate) fn start(
        store: Option<(Store, Sync)>,
        letters: DeadLetters,
        shared: Arc<Shared>,
    ) -> io::Result<Self> {
        let (requests, received) = mpsc::sync_channel(WAITING);
        if let Some((store, _)) = &store {
            shared.count.store(store.count(), Ordering::Relaxed);
            shared.bytes.store(store.bytes(), Ordering::Relaxed);
            shared.state().has_more = store.count() > 0;
        }
        let (store, together) = match store {
            Some((store, Sync::Each)) => (Some(store), 1),
            Some((store, _)) => (Some(store), TOGETHER),
            None => (None, 1),
        };
        let work = Work {
            store,
            letters,
            shared,
            together,
            could_not: None,
        };
        let thread = thread::Builder::new().name("store".to_owned());
        let thread = Mutex::new(Some(thread.spawn(move || work.run(&received))?));
        Ok(Self { requests, thread })
    }

    /// # Errors
    /// The disk is so far behind that no more can wait for it.
    pub(crate) fn append(&self, request: Append) -> Result<(), StoreError> {
        self.requests
            .try_send(request)
            .map_err(|error| match error {
                TrySendError::Full(_) => StoreError::Stalled,
                TrySendError::Disconnected(_) => StoreError::disk("its thread has ended"),
            })
    }

    /// There is something in the shared state. A thread that has much to do looks anyway.
    pub(crate) fn look(&self) {
        self.append(Append::Look).ok();
    }

    /// Waits until all that was handed over is done, and ends the thread.
    pub(crate) fn end(&self) {
        drop(self.requests.send(Append::End));
        let thread = self
            .thread
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .take();
        if let Some(thread) = thread {
            drop(thread.join());
        }
    }
}

/// The thread, from inside.
struct Work {
    store: Option<Store>,
    letters: DeadLetters,
    shared: Arc<Shared>,
    /// Entries of one commit, at most.
    together: usize,
    /// The last error that was logged.
    could_not: Option<String>,
}

impl Work {
    fn run(mut self, requests: &Receiver<Append>) {
        let mut is_ending = false;
        while !is_ending {
            let has_leftovers = {
                let state = self.shared.state();
                !state.done.is_empty() || !state.dead.is_empty()
            };
            let first = if has_leftovers {
                requests.recv_timeout(FORGET_PAUSE)
            } else {
                requests.recv().map_err(RecvTimeoutError::from)
            };
            let (mut entries, mut waiting) = (Vec::new(), Vec::new());
            match first {
                Ok(first) => {
                    let others = requests.try_iter().take(self.together.saturating_sub(1));
                    for request in core::iter::once(first).chain(others) {
                        match request {
                            Append::Entry(entry, done) => {
                                entries.push(entry);
                                waiting.push(done);
                            }
                            Append::Look => {}
                            Append::End => is_ending = true,
                        }
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => is_ending = true,
            }
            self.bury();
            let is_time_to_forget = entries.is_empty() && has_leftovers;
            if !entries.is_empty() || is_time_to_forget || is_ending {
                self.commit(entries, waiting);
            }
            self.load();
        }
    }

    /// Writes dead letters, and has the store forget them.
    fn bury(&mut self) {
        let letters = mem::take(&mut self.shared.state().dead);
        if letters.is_empty() {
            return;
        }
        let written = self.letters.write(letters.iter());
        let count = u64::try_from(letters.len()).unwrap_or(u64::MAX);
        match written {
            Ok(()) => {
                self.shared.dead.fetch_add(count, Ordering::Relaxed);
                let done = letters.into_iter().map(|(message, _)| message.id);
                self.shared.state().done.extend(done);
                self.shared.filled.notify_one();
            }
            Err(error) => {
                // They wait, and are in the store meanwhile.
                self.log(format!("dead letters: {error}; {count} messages wait"));
                let mut state = self.shared.state();
                let newer = mem::replace(&mut state.dead, letters);
                state.dead.extend(newer);
                drop(state);
                thread::sleep(ERROR_PAUSE);
            }
        }
    }

    fn commit(
        &mut self,
        entries: Vec<Entry>,
        waiting: Vec<Option<oneshot::Sender<Result<(), StoreError>>>>,
    ) {
        let forget = mem::take(&mut self.shared.state().done);
        let Some(store) = &mut self.store else {
            return;
        };
        let tell = |done: Option<oneshot::Sender<_>>, result| {
            // Who has left does not want to know.
            drop(done.map(|done| done.send(result)));
        };
        match store.commit(&entries, &forget) {
            Ok(committed) => {
                let (count, bytes) = (store.count(), store.bytes());
                self.shared.count.store(count, Ordering::Relaxed);
                self.shared.bytes.store(bytes, Ordering::Relaxed);
                self.shared
                    .dropped
                    .fetch_add(committed.dropped, Ordering::Relaxed);
                self.could_not = None;
                let mut state = self.shared.state();
                if let Some(dropped_to) = committed.dropped_to {
                    state.queue.retain(|message| message.id > dropped_to);
                }
                for ((entry, done), stored) in
                    entries.into_iter().zip(waiting).zip(committed.stored)
                {
                    match stored {
                        Ok(id) => {
                            state.stored(Message {
                                id,
                                ..entry.message
                            });
                            tell(done, Ok(()));
                        }
                        Err(error) => {
                            if done.is_none() {
                                self.shared.dropped.fetch_add(1, Ordering::Relaxed);
                            }
                            tell(done, Err(error));
                        }
                    }
                }
                drop(state);
                self.shared.filled.notify_one();
            }
            Err(error) => {
                let mut state = self.shared.state();
                state.done.extend(forget);
                // Some may be on disk all the same.
                state.has_more = true;
                drop(state);
                for done in waiting {
                    tell(done, Err(error.clone()));
                }
                self.log(error.to_string());
                thread::sleep(ERROR_PAUSE);
            }
        }
    }

    /// Reads what is next, where the broker has taken most of what was in memory.
    fn load(&mut self) {
        let Some(store) = &mut self.store else {
            return;
        };
        let after = {
            let state = self.shared.state();
            if !state.has_more || state.queue.len() > WINDOW / 2 {
                return;
            }
            state.loaded_to
        };
        match store.read_after(after, WINDOW / 2) {
            Ok(found) => {
                let mut state = self.shared.state();
                state.has_more = found.len() >= WINDOW / 2;
                state.loaded_to = found.last().map_or(after, |last| last.id);
                state.queue.extend(found);
                drop(state);
                self.shared.filled.notify_one();
            }
            Err(error) => self.log(error.to_string()),
        }
    }

    /// Once, until something else goes wrong or all goes well.
    fn log(&mut self, message: String) {
        if self.could_not.as_ref() != Some(&message) {
            error!("{message}");
            self.could_not = Some(message);
        }
    }
}

impl State {
    /// A message is on disk.
    fn stored(&mut self, message: Message) {
        if self.has_more || self.queue.len() >= WINDOW {
            self.has_more = true;
        } else {
            self.loaded_to = message.id;
            self.queue.push_back(message);
        }
    }
}
