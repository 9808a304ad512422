//! One telegram as the transport carries it, without knowledge of what it says.

use core::fmt;
use core::ops::Deref;

use thiserror::Error;

/// User data in one telegram, at most; more goes into continuations.
pub const MAX_DATA: usize = 128;
/// Bytes before the data of a command.
pub(crate) const COMMAND_HEADER: usize = 10;
/// Bytes before the data of a continuation or a reaction.
pub(crate) const SHORT_HEADER: usize = 4;
/// The longest telegram: a SEND command with 128 bytes of data.
pub const MAX_TELEGRAM: usize = COMMAND_HEADER + MAX_DATA;

/// First telegram of a job or a continuation: byte 1 of commands and reactions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "byte 1 has two values, no more")]
pub enum Part {
    /// 00h.
    First,
    /// `FFh`.
    Continuation,
}

impl Part {
    /// Byte 1 of the telegram.
    pub(crate) const fn code(self) -> u8 {
        match self {
            Self::First => 0x00,
            Self::Continuation => 0xFF,
        }
    }

    /// The part that byte 1 stands for, if any.
    pub(crate) const fn from_code(code: u8) -> Option<Self> {
        match code {
            0x00 => Some(Self::First),
            0xFF => Some(Self::Continuation),
            _ => None,
        }
    }
}

/// Why data cannot go out with a header.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum EncodeError {
    /// More than [`MAX_DATA`] bytes.
    #[error("{len} bytes of data in one telegram, at most {MAX_DATA} fit")]
    TooMuchData {
        /// Bytes given.
        len: usize,
    },
    /// Not the data that the command announces for its first telegram.
    #[error("{len} bytes of data in the first telegram, the command announces {expected}")]
    DataLength {
        /// Bytes given.
        len: usize,
        /// Bytes that belong in the first telegram.
        expected: usize,
    },
}

/// One encoded telegram: the payload of one block of the transport.
#[derive(Clone, Copy)]
pub struct Telegram {
    bytes: [u8; MAX_TELEGRAM],
    /// At most [`MAX_TELEGRAM`].
    len: u8,
}

impl Telegram {
    /// A telegram with `header` and room for `data_len` bytes of data (at most 128), all 0.
    pub(crate) fn with_room<const H: usize>(header: [u8; H], data_len: usize) -> Self {
        let mut bytes = [0; MAX_TELEGRAM];
        for (to, from) in bytes.iter_mut().zip(header) {
            *to = from;
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a telegram has at most 138 bytes"
        )]
        let len = (H + data_len.min(MAX_DATA)) as u8;
        Self { bytes, len }
    }

    pub(crate) fn new<const H: usize>(header: [u8; H], data: &[u8]) -> Result<Self, EncodeError> {
        let len = data.len();
        if len > MAX_DATA {
            return Err(EncodeError::TooMuchData { len });
        }
        let mut telegram = Self::with_room(header, len);
        telegram.after_mut(H).copy_from_slice(data);
        Ok(telegram)
    }

    /// What follows the first `header` bytes.
    pub(crate) fn after_mut(&mut self, header: usize) -> &mut [u8] {
        let end = usize::from(self.len);
        self.bytes.get_mut(header..end).unwrap_or_default()
    }
}

impl Deref for Telegram {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        self.bytes.get(..usize::from(self.len)).unwrap_or_default()
    }
}

impl AsRef<[u8]> for Telegram {
    fn as_ref(&self) -> &[u8] {
        self
    }
}

impl PartialEq for Telegram {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl Eq for Telegram {}

impl fmt::Debug for Telegram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Telegram({:02X?})", &**self)
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Telegram {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "Telegram({=[u8]:02X})", &**self);
    }
}

/// Whether a block is meant for the client: byte 3 is 0.
pub(crate) fn is_reaction(block: &[u8]) -> bool {
    matches!(block, [_, _, 0, ..])
}

pub(crate) fn is_continuation(block: &[u8]) -> bool {
    block.first() == Some(&Part::Continuation.code())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_byte_tells_first_and_continuation() {
        for code in 0..=u8::MAX {
            let part = Part::from_code(code);
            assert_eq!(part.is_some(), code == 0 || code == 0xFF);
            assert!(part.is_none_or(|part| part.code() == code));
        }
    }
}
