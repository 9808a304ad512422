//! A disk whose power can be cut.

use alloc::sync::Arc;
use std::{
    io,
    sync::{Mutex, MutexGuard},
};

use redb::StorageBackend;

/// What a disk writes whole or not at all.
const SECTOR: usize = 512;

/// An xorshift generator.
pub(super) struct Random(pub(super) u32);

impl Random {
    pub(super) fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 % end
    }
}

/// A disk in memory, shared with the store that is on it.
#[derive(Clone, Debug, Default)]
pub(super) struct Disk(Arc<Mutex<Platter>>);

#[derive(Debug, Default)]
struct Platter {
    /// What programs read.
    current: Vec<u8>,
    /// What a power cut leaves at least.
    flushed: Vec<u8>,
    /// What was done since the last flush.
    unflushed: Vec<Change>,
    /// Changes and flushes until all fail.
    fuse: Option<u32>,
}

#[derive(Clone, Debug)]
enum Change {
    Length(usize),
    Write { at: usize, bytes: Vec<u8> },
}

impl Change {
    fn apply(&self, to: &mut Vec<u8>) {
        match self {
            Self::Length(len) => to.resize(*len, 0),
            Self::Write { at, bytes } => {
                let end = at + bytes.len();
                if to.len() < end {
                    to.resize(end, 0);
                }
                to[*at..end].copy_from_slice(bytes);
            }
        }
    }
}

impl Disk {
    fn platter(&self) -> MutexGuard<'_, Platter> {
        self.0.lock().unwrap()
    }

    /// Puts the same disk in again.
    pub(super) fn opener(&self) -> impl Fn() -> Self + Send + 'static {
        let disk = self.clone();
        move || disk.clone()
    }

    /// After so many changes and flushes all of them fail.
    pub(super) fn fail_after(&self, count: u32) {
        self.platter().fuse = Some(count);
    }

    pub(super) fn repair(&self) {
        self.platter().fuse = None;
    }

    pub(super) fn has_unflushed(&self) -> bool {
        !self.platter().unflushed.is_empty()
    }

    /// What is on the disk after the power has failed: of each change since the last flush any
    /// sectors.
    pub(super) fn cut(&self, random: &mut Random) -> Self {
        let platter = self.platter();
        let mut left = platter.flushed.clone();
        for change in &platter.unflushed {
            match change {
                Change::Length(_) if random.below(2) == 0 => {}
                Change::Length(_) => change.apply(&mut left),
                Change::Write { at, bytes } => {
                    let how = random.below(3);
                    let mut begin = 0;
                    while begin < bytes.len() {
                        // To the end of the sector.
                        let end = (begin + SECTOR - (at + begin) % SECTOR).min(bytes.len());
                        if how == 0 || how == 1 && random.below(2) == 0 {
                            let bytes = bytes[begin..end].to_vec();
                            let at = at + begin;
                            Change::Write { at, bytes }.apply(&mut left);
                        }
                        begin = end;
                    }
                }
            }
        }
        Self(Arc::new(Mutex::new(Platter {
            current: left.clone(),
            flushed: left,
            unflushed: Vec::new(),
            fuse: None,
        })))
    }
}

impl Platter {
    /// # Errors
    /// The power is gone.
    fn burn(&mut self) -> io::Result<()> {
        match &mut self.fuse {
            Some(0) => Err(io::Error::other("no power")),
            Some(left) => {
                *left -= 1;
                Ok(())
            }
            None => Ok(()),
        }
    }

    fn change(&mut self, change: Change) -> io::Result<()> {
        self.burn()?;
        change.apply(&mut self.current);
        self.unflushed.push(change);
        Ok(())
    }
}

fn place(offset: u64) -> io::Result<usize> {
    usize::try_from(offset).map_err(io::Error::other)
}

impl StorageBackend for Disk {
    fn len(&self) -> io::Result<u64> {
        u64::try_from(self.platter().current.len()).map_err(io::Error::other)
    }

    fn read(&self, offset: u64, out: &mut [u8]) -> io::Result<()> {
        let platter = self.platter();
        let begin = place(offset)?;
        let bytes = platter.current.get(begin..begin + out.len());
        out.copy_from_slice(bytes.ok_or(io::ErrorKind::UnexpectedEof)?);
        Ok(())
    }

    fn set_len(&self, len: u64) -> io::Result<()> {
        let len = place(len)?;
        self.platter().change(Change::Length(len))
    }

    fn sync_data(&self) -> io::Result<()> {
        let mut platter = self.platter();
        platter.burn()?;
        let Platter {
            flushed, unflushed, ..
        } = &mut *platter;
        unflushed.drain(..).for_each(|change| change.apply(flushed));
        Ok(())
    }

    fn write(&self, offset: u64, data: &[u8]) -> io::Result<()> {
        let (at, bytes) = (place(offset)?, data.to_vec());
        self.platter().change(Change::Write { at, bytes })
    }
}
