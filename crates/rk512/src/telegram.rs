//! One telegram as the transport carries it.

use core::fmt;
use core::ops::Deref;

use thiserror::Error;

use crate::command::{Command, CommandError, Continuation};
use crate::reaction::{Reaction, ReactionFault};

/// User data in one telegram, at most; more goes into continuations.
pub const MAX_DATA: usize = 128;
/// Bytes in front of the data of a command.
pub const COMMAND_HEADER: usize = 10;
/// Bytes in front of the data of a continuation or a reaction.
pub const SHORT_HEADER: usize = 4;
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
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::First => 0x00,
            Self::Continuation => 0xFF,
        }
    }

    /// The part that byte 1 stands for, if any.
    #[must_use]
    pub const fn from_code(code: u8) -> Option<Self> {
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
    len: u8,
}

impl Telegram {
    /// A telegram with `header` and room for `data_len` bytes of data (at most 128), all 0.
    pub(crate) fn with_room<const H: usize>(header: [u8; H], data_len: usize) -> Self {
        let mut bytes = [0; MAX_TELEGRAM];
        for (to, from) in bytes.iter_mut().zip(header) {
            *to = from;
        }
        let len = H + data_len.min(MAX_DATA);
        let len = u8::try_from(len).unwrap_or(u8::MAX);
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

    /// What stands behind the first `header` bytes.
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

/// Why a block is no telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DecodeError {
    /// It is a command, or too short to tell, and wrong.
    #[error("command: {0}")]
    Command(#[from] CommandError),
    /// It is a reaction, and wrong.
    #[error("reaction: {0}")]
    Reaction(#[from] ReactionFault),
}

/// Any telegram, decoded without knowledge of what went before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Message<'a> {
    /// First telegram of a SEND or FETCH.
    Command(Command, &'a [u8]),
    /// Continuation of a SEND or FETCH.
    Continuation(Continuation, &'a [u8]),
    /// Answer to either.
    Reaction(Reaction, &'a [u8]),
}

impl<'a> Message<'a> {
    /// Decodes one block; byte 3 is 0 in reactions and a letter in commands.
    ///
    /// # Errors
    /// [`DecodeError`] names the byte and its value.
    pub fn decode(block: &'a [u8]) -> Result<Self, DecodeError> {
        if is_reaction(block) {
            let (reaction, data) = Reaction::decode(block)?;
            return Ok(Self::Reaction(reaction, data));
        }
        if is_continuation(block) {
            let (continuation, data) = Continuation::decode(block)?;
            return Ok(Self::Continuation(continuation, data));
        }
        let (command, data) = Command::decode(block)?;
        Ok(Self::Command(command, data))
    }

    /// The telegram again; the inverse of [`decode`](Self::decode).
    ///
    /// # Errors
    /// [`EncodeError`] if the data do not belong to the header.
    pub fn encode(&self) -> Result<Telegram, EncodeError> {
        match self {
            Self::Command(command, data) => command.telegram(data),
            Self::Continuation(continuation, data) => continuation.telegram(data),
            Self::Reaction(reaction, data) => reaction.telegram(data),
        }
    }
}

/// Whether a block is meant for the client: byte 3 is 0.
pub(crate) fn is_reaction(block: &[u8]) -> bool {
    matches!(block, [_, _, 0, ..])
}

pub(crate) fn is_continuation(block: &[u8]) -> bool {
    block.first() == Some(&Part::Continuation.code())
}
