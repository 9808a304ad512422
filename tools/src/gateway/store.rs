//! What must not be lost, on disk: messages until the broker has them, and the numbers of
//! telegrams.
//!
//! One transaction holds all that waits: the messages that came, the numbers of their lines, and
//! those that the broker has acknowledged since. A commit returns when the disk has it; what a
//! power cut leaves is the state after one of the commits.

mod letters;
mod message;
mod steady;
mod writer;

use core::{
    fmt,
    hash::{BuildHasher as _, Hasher as _},
};
use std::{
    collections::hash_map::RandomState,
    fs::{self, OpenOptions},
    path::Path,
};

use alloc::collections::BTreeMap;
use redb::{
    Database, ReadableDatabase as _, ReadableTable as _, StorageBackend, TableDefinition,
    WriteTransaction, backends::FileBackend,
};
use thiserror::Error;

use self::steady::Steady;
pub(crate) use self::{
    letters::DeadLetters,
    message::Message,
    writer::{Append, Shared, WINDOW, Writer},
};
use super::config::Overflow;

/// Messages by their identifiers, in the order of their arrival.
const MESSAGES: TableDefinition<'_, u64, &[u8]> = TableDefinition::new("messages");
/// By line: the number of its last telegram, and the telegram.
const LINES: TableDefinition<'_, &str, (u64, &[u8])> = TableDefinition::new("lines");
/// By line and area that is served: what it holds.
const AREAS: TableDefinition<'_, (&str, &str), &[u8]> = TableDefinition::new("areas");
/// What is known of the whole: below.
const ABOUT: TableDefinition<'_, &str, u64> = TableDefinition::new("about");

const RUN: &str = "run";
const COUNT: &str = "messages";
const BYTES: &str = "bytes";
/// The identifier of the next message.
const NEXT: &str = "next";

/// Memory for pages of the file.
const CACHE: usize = 4 << 20;

/// Why a message was not stored.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub(crate) enum StoreError {
    #[error("the store is full: {bytes} bytes of {max} are taken")]
    Full { bytes: u64, max: u64 },
    #[error("the store: {0}")]
    Disk(String),
    #[error("the store: the disk is stalled")]
    Stalled,
}

impl StoreError {
    fn disk(error: impl fmt::Display) -> Self {
        Self::Disk(error.to_string())
    }
}

/// A message to store.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) message: Message,
    /// Of a telegram.
    pub(crate) number: Option<Number>,
}

/// The highest number of a line, and the telegram that came last, by which its repeat is known.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Number {
    pub(crate) line: String,
    pub(crate) seq: u64,
    pub(crate) telegram: Vec<u8>,
    /// An area that the gateway serves, and what it holds now.
    pub(crate) area: Option<Box<(String, Vec<u8>)>>,
}

/// The last telegram of a line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Last {
    pub(crate) seq: u64,
    pub(crate) telegram: Vec<u8>,
    /// What the areas hold that the gateway serves, by their names.
    pub(crate) areas: BTreeMap<String, Vec<u8>>,
}

/// What a store holds when it is opened.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    /// Of this store, for good: what tells its numbers from those of another.
    pub(crate) run: String,
    pub(crate) lines: BTreeMap<String, Last>,
    pub(crate) messages: u64,
}

impl Known {
    /// Of a gateway that keeps nothing on disk.
    pub(crate) fn nothing() -> Self {
        Self {
            run: format!("{:016x}", random()),
            ..Self::default()
        }
    }
}

/// Whatever seeds the maps of the standard library: the operating system's random numbers.
fn random() -> u64 {
    RandomState::new().build_hasher().finish()
}

/// How a database is opened: again, after an error of the disk.
type Open = Box<dyn Fn() -> Result<Database, StoreError> + Send>;

/// The store, for the one thread that writes.
pub(crate) struct Store {
    open: Open,
    /// `None` after an error of the disk.
    database: Option<Database>,
    next_id: u64,
    count: u64,
    bytes: u64,
    max_bytes: u64,
    overflow: Overflow,
}

/// What a commit has done.
#[derive(Debug, Default)]
pub(crate) struct Committed {
    /// By entry, in their order: its identifier, unless the store was full.
    pub(crate) stored: Vec<Result<u64, StoreError>>,
    /// Messages given up for them.
    pub(crate) dropped: u64,
    /// The last of those.
    pub(crate) dropped_to: Option<u64>,
}

impl Store {
    /// Opens the store in a folder, which is made if it is not there.
    ///
    /// # Errors
    /// Those of the folder and the file; one that another gateway has open.
    pub(crate) fn open(
        folder: &Path,
        max_bytes: u64,
        overflow: Overflow,
    ) -> Result<(Self, Known), StoreError> {
        fs::create_dir_all(folder).map_err(StoreError::disk)?;
        let path = folder.join("messages.redb");
        let open = move || {
            let mut options = OpenOptions::new();
            let options = options.read(true).write(true).create(true).truncate(false);
            let file = options.open(&path).map_err(StoreError::disk)?;
            database(FileBackend::new(file).map_err(StoreError::disk)?)
        };
        Self::with(Box::new(open), max_bytes, overflow)
    }

    /// A store on any storage, which `backend` opens.
    #[cfg(test)]
    pub(crate) fn on<B: StorageBackend>(
        backend: impl Fn() -> B + Send + 'static,
        max_bytes: u64,
        overflow: Overflow,
    ) -> Result<(Self, Known), StoreError> {
        let open = move || database(backend());
        Self::with(Box::new(open), max_bytes, overflow)
    }

    fn with(open: Open, max_bytes: u64, overflow: Overflow) -> Result<(Self, Known), StoreError> {
        let mut store = Self {
            open,
            database: None,
            next_id: 1,
            count: 0,
            bytes: 0,
            max_bytes,
            overflow,
        };
        let known = store.reopen()?;
        Ok((store, known))
    }

    pub(crate) const fn count(&self) -> u64 {
        self.count
    }

    pub(crate) const fn bytes(&self) -> u64 {
        self.bytes
    }

    pub(crate) const fn max_bytes(&self) -> u64 {
        self.max_bytes
    }

    /// Opens the file, and reads what it holds. A new one gets its tables and its name.
    fn reopen(&mut self) -> Result<Known, StoreError> {
        let database = (self.open)()?;
        let known = self.read(&database).map_err(StoreError::disk)?;
        self.database = Some(database);
        Ok(known)
    }

    fn read(&mut self, database: &Database) -> Result<Known, redb::Error> {
        let write = database.begin_write()?;
        let known = {
            write.open_table(MESSAGES)?;
            let (lines, mut about) = (write.open_table(LINES)?, write.open_table(ABOUT)?);
            let value = |about: &redb::Table<'_, &str, u64>, name| {
                about
                    .get(name)
                    .map(|value| value.map(|value| value.value()))
            };
            let run = match value(&about, RUN)? {
                Some(run) => run,
                None => {
                    let run = random();
                    about.insert(RUN, run)?;
                    run
                }
            };
            self.count = value(&about, COUNT)?.unwrap_or_default();
            self.bytes = value(&about, BYTES)?.unwrap_or_default();
            self.next_id = value(&about, NEXT)?.unwrap_or(1).max(self.next_id);
            let mut known = Known {
                run: format!("{run:016x}"),
                lines: BTreeMap::new(),
                messages: self.count,
            };
            for line in lines.iter()? {
                let (name, last) = line?;
                let (seq, telegram) = last.value();
                let telegram = telegram.to_vec();
                let areas = BTreeMap::new();
                let last = Last {
                    seq,
                    telegram,
                    areas,
                };
                known.lines.insert(name.value().to_owned(), last);
            }
            for area in write.open_table(AREAS)?.iter()? {
                let (name, bytes) = area?;
                let (line, name) = name.value();
                let last = known.lines.entry(line.to_owned()).or_default();
                last.areas.insert(name.to_owned(), bytes.value().to_vec());
            }
            known
        };
        write.commit()?;
        Ok(known)
    }

    /// Stores entries and forgets messages, in one transaction; returns when the disk has it.
    ///
    /// # Errors
    /// Those of the disk: none of the entries may be acknowledged, though some may be stored.
    pub(crate) fn commit(
        &mut self,
        entries: &[Entry],
        forget: &[u64],
    ) -> Result<Committed, StoreError> {
        let before = (self.next_id, self.count, self.bytes);
        let database = match self.database.take() {
            Some(database) => database,
            None => {
                self.reopen()?;
                self.database
                    .take()
                    .ok_or_else(|| StoreError::disk("not open"))?
            }
        };
        let committed = database
            .begin_write()
            .map_err(redb::Error::from)
            .and_then(|write| {
                let committed = self.write(&write, entries, forget)?;
                write.commit()?;
                Ok(committed)
            });
        match committed {
            Ok(committed) => {
                self.database = Some(database);
                Ok(committed)
            }
            Err(error) => {
                // Closed: what it has in memory may not be what is on disk. No identifier is used
                // twice.
                (_, self.count, self.bytes) = before;
                Err(StoreError::disk(error))
            }
        }
    }

    fn write(
        &mut self,
        write: &WriteTransaction,
        entries: &[Entry],
        forget: &[u64],
    ) -> Result<Committed, redb::Error> {
        let mut messages = write.open_table(MESSAGES)?;
        let mut lines = write.open_table(LINES)?;
        let mut areas = write.open_table(AREAS)?;
        let mut committed = Committed::default();
        for id in forget {
            if let Some(gone) = messages.remove(id)? {
                self.forgotten(gone.value());
            }
        }
        for entry in entries {
            let bytes = entry.message.to_bytes();
            let len = len(&bytes);
            while self.bytes.saturating_add(len) > self.max_bytes
                && self.overflow == Overflow::DropOldest
                && let Some((id, gone)) = messages.pop_first()?
            {
                self.forgotten(gone.value());
                committed.dropped += 1;
                committed.dropped_to = Some(id.value());
            }
            if self.bytes.saturating_add(len) > self.max_bytes {
                let (bytes, max) = (self.bytes, self.max_bytes);
                committed.stored.push(Err(StoreError::Full { bytes, max }));
                continue;
            }
            let id = self.next_id;
            self.next_id += 1;
            messages.insert(id, &*bytes)?;
            self.count += 1;
            self.bytes += len;
            committed.stored.push(Ok(id));
            if let Some(Number {
                line,
                seq,
                telegram,
                area,
            }) = &entry.number
            {
                lines.insert(line.as_str(), (*seq, telegram.as_slice()))?;
                if let Some((name, bytes)) = area.as_deref() {
                    areas.insert((line.as_str(), name.as_str()), bytes.as_slice())?;
                }
            }
        }
        let mut about = write.open_table(ABOUT)?;
        about.insert(COUNT, self.count)?;
        about.insert(BYTES, self.bytes)?;
        about.insert(NEXT, self.next_id)?;
        Ok(committed)
    }

    fn forgotten(&mut self, message: &[u8]) {
        self.count = self.count.saturating_sub(1);
        self.bytes = self.bytes.saturating_sub(len(message));
    }

    /// The first messages after this one, so many at most.
    ///
    /// # Errors
    /// Those of the disk.
    pub(crate) fn read_after(&mut self, id: u64, most: usize) -> Result<Vec<Message>, StoreError> {
        if self.database.is_none() {
            self.reopen()?;
        }
        let Some(database) = &self.database else {
            return Ok(Vec::new());
        };
        let read = || -> Result<Vec<Message>, redb::Error> {
            let messages = database.begin_read()?.open_table(MESSAGES)?;
            let mut found = Vec::new();
            for message in messages.range(id.saturating_add(1)..)?.take(most) {
                let (id, bytes) = message?;
                found.extend(Message::from_bytes(id.value(), bytes.value()));
            }
            Ok(found)
        };
        let found = read();
        if found.is_err() {
            self.database = None;
        }
        found.map_err(StoreError::disk)
    }
}

/// The database on a storage, which has room made durable before it is used.
fn database(storage: impl StorageBackend) -> Result<Database, StoreError> {
    let mut builder = Database::builder();
    builder.set_cache_size(CACHE);
    let opened = builder.create_with_backend(Steady(storage));
    opened.map_err(StoreError::disk)
}

fn len(bytes: &[u8]) -> u64 {
    u64::try_from(bytes.len()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests;
