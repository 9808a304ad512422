//! A storage whose length is durable before anything relies on it.

use std::io;

use redb::StorageBackend;

/// Flushes before and after the length changes. A head of the file that reached the disk before
/// the length that it tells of would make the file unreadable after a power cut; files grow seldom.
#[derive(Debug)]
pub(super) struct Steady<B>(pub(super) B);

impl<B: StorageBackend> StorageBackend for Steady<B> {
    fn len(&self) -> io::Result<u64> {
        self.0.len()
    }

    fn read(&self, offset: u64, out: &mut [u8]) -> io::Result<()> {
        self.0.read(offset, out)
    }

    fn set_len(&self, len: u64) -> io::Result<()> {
        self.0.sync_data()?;
        self.0.set_len(len)?;
        self.0.sync_data()
    }

    fn sync_data(&self) -> io::Result<()> {
        self.0.sync_data()
    }

    fn write(&self, offset: u64, data: &[u8]) -> io::Result<()> {
        self.0.write(offset, data)
    }

    fn close(&self) -> io::Result<()> {
        self.0.close()
    }
}
