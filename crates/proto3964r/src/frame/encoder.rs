//! From a payload to the characters behind the STX.

use thiserror::Error;

use super::{Check, scan::plain_run};
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

/// The length of the body of this payload.
///
/// ```text
/// len(payload) + number of 10h + 2 + (1 with BCC)
/// ```
#[must_use]
pub fn encoded_len(payload: &[u8], check: Check) -> usize {
    let doubled = payload.iter().filter(|&&byte| byte == DLE).count();
    payload.len() + doubled + 2 + check.len()
}

/// The block check character: XOR of `characters` as they stand on the line.
///
/// Over a whole body with its BCC the result is 0.
#[must_use]
pub fn bcc(characters: &[u8]) -> u8 {
    characters.iter().fold(0, |xor, byte| xor ^ byte)
}

/// Writes the body of `payload` to the front of `out` and returns its length.
///
/// [`max_encoded_len`] bytes are always enough.
///
/// # Errors
/// [`EncodeError::BufferTooSmall`] when `out` is shorter than [`encoded_len`]; the contents of
/// `out` are then unspecified. [`EncodeError::PayloadTooLong`] above 65535 bytes.
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

/// What the encoder writes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Next {
    Payload,
    /// The second half of a doubled DLE.
    Twin,
    Dle,
    Etx,
    Bcc,
    Done,
}

/// Writes a body piece by piece; the payload stays with the caller.
///
/// Check and payload are the same in every call; the payload has up to 65535 bytes, so that `position` never wraps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Encoder {
    position: u16,
    bcc: u8,
    next: Next,
}

impl Encoder {
    /// In front of the first character.
    pub(crate) const START: Self = Self {
        position: 0,
        bcc: 0,
        next: Next::Payload,
    };

    pub(crate) fn is_done(&self) -> bool {
        self.next == Next::Done
    }

    /// Whether payload is next, or the end behind it.
    pub(crate) fn is_in_payload(&self) -> bool {
        self.next == Next::Payload
    }

    /// The next byte of the payload if it is no DLE; `None`, and nothing taken, else. Only while
    /// [`is_in_payload`](Self::is_in_payload), and with a DLE behind a payload that is shorter
    /// than `buffer`: one comparison then finds the end too.
    #[inline]
    pub(crate) fn next_plain(&mut self, buffer: &[u8]) -> Option<u8> {
        let byte = *buffer.get(usize::from(self.position))?;
        if byte == DLE {
            return None;
        }
        self.position = self.position.wrapping_add(1);
        self.bcc ^= byte;
        Some(byte)
    }

    /// The next character of the body, `None` behind the last one.
    #[inline]
    pub(crate) fn next_byte(&mut self, check: Check, payload: &[u8]) -> Option<u8> {
        if self.next == Next::Payload {
            if let Some(&byte) = payload.get(usize::from(self.position)) {
                self.position = self.position.wrapping_add(1);
                self.bcc ^= byte;
                if byte == DLE {
                    self.next = Next::Twin;
                }
                return Some(byte);
            }
            self.next = Next::Dle;
        }
        self.next_control(check)
    }

    fn next_control(&mut self, check: Check) -> Option<u8> {
        let (byte, next) = match self.next {
            Next::Twin => (DLE, Next::Payload),
            Next::Dle => (DLE, Next::Etx),
            Next::Etx => match check {
                Check::Bcc => (ETX, Next::Bcc),
                Check::None => (ETX, Next::Done),
            },
            Next::Bcc => (self.bcc, Next::Done),
            Next::Payload | Next::Done => return None,
        };
        self.bcc ^= byte;
        self.next = next;
        Some(byte)
    }

    /// Writes as much of the body as `out` takes and returns how much.
    pub(crate) fn fill(&mut self, check: Check, payload: &[u8], out: &mut [u8]) -> usize {
        let mut written = 0;
        while let Some(free) = out.get_mut(written..).filter(|free| !free.is_empty()) {
            written += match self.fill_run(payload, free) {
                0 => match (self.next_byte(check, payload), free.first_mut()) {
                    (Some(byte), Some(slot)) => {
                        *slot = byte;
                        1
                    }
                    _ => break,
                },
                run => run,
            };
        }
        written
    }

    /// Copies the run up to the next DLE.
    fn fill_run(&mut self, payload: &[u8], out: &mut [u8]) -> usize {
        if self.next != Next::Payload {
            return 0;
        }
        let rest = payload
            .get(usize::from(self.position)..)
            .unwrap_or_default();
        let reach = rest.get(..out.len()).unwrap_or(rest);
        let (len, xor) = plain_run(reach);
        let (Some(run), Some(out), Ok(step)) =
            (reach.get(..len), out.get_mut(..len), u16::try_from(len))
        else {
            return 0;
        };
        out.copy_from_slice(run);
        self.bcc ^= xor;
        self.position = self.position.wrapping_add(step);
        len
    }
}
