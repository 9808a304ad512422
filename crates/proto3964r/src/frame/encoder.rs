//! From a payload to the characters after the STX.

use core::mem;

use thiserror::Error;

use super::Check;
use crate::ascii::{DLE, ETX};

/// Why a block was not encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum EncodeError {
    /// The output is too short for this payload.
    #[error("the encoded block takes {needed} bytes, the output has {available}")]
    BufferTooSmall {
        /// Bytes that the encoded block takes.
        needed: usize,
        /// Bytes that the output has.
        available: usize,
    },
    /// The payload is longer than any block.
    #[error("the payload has {len} bytes, a block holds at most 65535")]
    PayloadTooLong {
        /// Bytes of the payload.
        len: usize,
    },
}

/// The longest body of a payload of `payload_len` bytes: each byte a DLE, then DLE ETX BCC.
///
/// ```text
/// 2 payload_len + 3
/// ```
/// Stays at `usize::MAX` past the end of the type.
#[must_use]
pub const fn max_encoded_len(payload_len: usize) -> usize {
    payload_len.saturating_mul(2).saturating_add(3)
}

/// Writes the body of `payload` to the front of `out` and returns its length.
///
/// [`max_encoded_len`] bytes are always enough.
///
/// # Errors
/// [`EncodeError::BufferTooSmall`] when `out` is shorter than the body; the contents of `out`
/// are then unspecified. [`EncodeError::PayloadTooLong`] above 65535 bytes.
///
/// # Examples
/// ```
/// use proto3964r::frame::{Check, encode, max_encoded_len};
///
/// let mut body = [0; max_encoded_len(3)];
/// let len = encode(&[0x01, 0x10, 0x02], Check::Bcc, &mut body)?;
/// assert_eq!(body[..len], [0x01, 0x10, 0x10, 0x02, 0x10, 0x03, 0x10]);
/// # Ok::<(), proto3964r::frame::EncodeError>(())
/// ```
pub fn encode(payload: &[u8], check: Check, out: &mut [u8]) -> Result<usize, EncodeError> {
    if u16::try_from(payload.len()).is_err() {
        return Err(EncodeError::PayloadTooLong { len: payload.len() });
    }
    let mut encoder = Encoder::START;
    let len = encoder.fill(check, payload, out);
    if encoder.is_done() {
        Ok(len)
    } else {
        Err(EncodeError::BufferTooSmall {
            needed: encoded_len(payload, check),
            available: out.len(),
        })
    }
}

/// Bytes that the body of this payload takes: each byte, each DLE once more, DLE ETX, and the BCC.
pub(crate) fn encoded_len(payload: &[u8], check: Check) -> usize {
    let doubled = payload.iter().filter(|&&byte| byte == DLE).count();
    payload.len() + doubled + 2 + usize::from(check == Check::Bcc)
}

/// What the encoder writes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Next {
    Payload,
    /// The second half of a doubled DLE.
    Twin,
    Etx,
    Bcc,
    Done,
}

/// Writes a body piece by piece; the payload stays with the caller.
///
/// Check and payload are the same in every call; the payload has up to 65535 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Encoder {
    position: usize,
    bcc: u8,
    next: Next,
}

impl Encoder {
    /// Before the first character.
    pub(crate) const START: Self = Self {
        position: 0,
        bcc: 0,
        next: Next::Payload,
    };

    pub(crate) fn is_done(&self) -> bool {
        self.next == Next::Done
    }

    /// The next character of the body, `None` after the last one.
    #[inline]
    pub(crate) fn next_byte(&mut self, check: Check, payload: &[u8]) -> Option<u8> {
        self.next_data(payload).or_else(|| self.next_control(check))
    }

    /// The next byte of the payload, or the second half of a doubled DLE; `None` after them.
    #[inline]
    pub(crate) fn next_data(&mut self, payload: &[u8]) -> Option<u8> {
        let byte = match self.next {
            Next::Payload => {
                let byte = *payload.get(self.position)?;
                self.position += 1;
                if byte == DLE {
                    self.next = Next::Twin;
                }
                byte
            }
            Next::Twin => {
                self.next = Next::Payload;
                DLE
            }
            _ => return None,
        };
        self.bcc ^= byte;
        Some(byte)
    }

    /// The next character of what ends the block.
    fn next_control(&mut self, check: Check) -> Option<u8> {
        let (byte, next) = match self.next {
            Next::Payload | Next::Twin => (DLE, Next::Etx),
            Next::Etx if check == Check::Bcc => (ETX, Next::Bcc),
            Next::Etx => (ETX, Next::Done),
            Next::Bcc => (self.bcc, Next::Done),
            Next::Done => return None,
        };
        self.bcc ^= byte;
        self.next = next;
        Some(byte)
    }

    /// Writes as much of the body as `out` takes and returns how much.
    pub(crate) fn fill(&mut self, check: Check, payload: &[u8], out: &mut [u8]) -> usize {
        let mut written = self.fill_payload(payload, out);
        while let Some(slot) = out.get_mut(written)
            && let Some(byte) = self.next_byte(check, payload)
        {
            *slot = byte;
            written += 1;
            written += self.fill_payload(payload, out.get_mut(written..).unwrap_or_default());
        }
        written
    }

    /// [`next_data`](Self::next_data) for many, as far as no DLE is parted from its twin; returns
    /// how many characters.
    #[inline]
    fn fill_payload(&mut self, payload: &[u8], out: &mut [u8]) -> usize {
        if self.next != Next::Payload {
            return 0;
        }
        let mut rest = payload.get(self.position..).unwrap_or_default();
        let room = out.len();
        let (mut free, mut bcc) = (out, self.bcc);
        loop {
            let mut plain = 0;
            for (slot, &byte) in free.iter_mut().zip(rest) {
                if byte == DLE {
                    break;
                }
                *slot = byte;
                bcc ^= byte;
                plain += 1;
            }
            // Two at a time: data full of DLE would cost more than three times the usual.
            match (rest.get(plain..), mem::take(&mut free).get_mut(plain..)) {
                (Some([DLE, DLE, after @ ..]), Some([a, b, c, d, space @ ..])) => {
                    (*a, *b, *c, *d) = (DLE, DLE, DLE, DLE);
                    (rest, free) = (after, space);
                }
                (Some([DLE, after @ ..]), Some([a, b, space @ ..])) => {
                    (*a, *b) = (DLE, DLE);
                    (rest, free) = (after, space);
                }
                (Some(after), Some(space)) => {
                    self.position = payload.len() - after.len();
                    self.bcc = bcc;
                    return room - space.len();
                }
                _ => return 0, // a run is no longer than what it was made from
            }
        }
    }
}
