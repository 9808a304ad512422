use thiserror::Error;

use super::header::{Checksum, HEADER_LEN, Header, TRAILER_LEN};

/// Keeps the running check value of a container while the caller writes its payload, in pieces of
/// any size.
#[derive(Debug, Clone)]
#[must_use = "a container without its trailer is refused"]
pub struct Writer {
    checksum: Checksum,
    declared: u32,
    written: u64,
}

impl Writer {
    /// The header to write first, and the writer for what follows.
    pub fn new(header: Header) -> ([u8; HEADER_LEN], Self) {
        let (bytes, checksum) = header.encode();
        let writer = Self {
            checksum,
            declared: header.payload_len(),
            written: 0,
        };
        (bytes, writer)
    }

    /// Counts the next piece of the payload, which the caller writes as it is.
    ///
    /// # Errors
    /// [`LengthMismatch`] when the payload is now longer than the header says.
    pub fn update(&mut self, payload: &[u8]) -> Result<(), LengthMismatch> {
        self.checksum.update(payload);
        let more = u64::try_from(payload.len()).unwrap_or(u64::MAX);
        self.written = self.written.saturating_add(more);
        if self.written > u64::from(self.declared) {
            return Err(self.mismatch());
        }
        Ok(())
    }

    /// The trailer to write last.
    ///
    /// # Errors
    /// [`LengthMismatch`] when the payload was not as long as the header says.
    pub fn finish(self) -> Result<[u8; TRAILER_LEN], LengthMismatch> {
        if self.written != u64::from(self.declared) {
            return Err(self.mismatch());
        }
        Ok(self.checksum.value().to_be_bytes())
    }

    const fn mismatch(&self) -> LengthMismatch {
        LengthMismatch {
            declared: self.declared,
            written: self.written,
        }
    }
}

/// The payload has another length than the header says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{written} bytes of payload written, the header says {declared}")]
#[non_exhaustive]
pub struct LengthMismatch {
    /// Bytes by the header.
    pub declared: u32,
    /// Bytes counted.
    pub written: u64,
}
