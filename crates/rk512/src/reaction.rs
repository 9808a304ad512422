//! Reactions: the answers to commands.

use core::num::NonZeroU8;

use thiserror::Error;

use crate::telegram::{EncodeError, MAX_DATA, Part, SHORT_HEADER, Telegram};

/// Why a partner refused: byte 4 of a reaction.
///
/// The meanings are those of `WinCC` OA and WAGO; the last column is the event that an S7 logs when
/// it receives the number.
///
/// | code | name | S7 event |
/// |---|---|---|
/// | 0Ah | access denied | 0902h, 0905h |
/// | 0Ch | invalid data type | 0905h |
/// | 10h | wrong byte 1 or 4; continuation not supported (WAGO) | 090Bh |
/// | 12h | request or object type not supported | 0904h |
/// | 14h | DB or DX missing or too short | 0903h |
/// | 16h | wrong byte 3 | 090Ah |
/// | 2Ah | PLC stopped | 090Dh |
/// | 32h | locked by the coordination flag | 0909h |
/// | 34h | wrong length | 090Ch |
/// | 36h | synchronisation error | 0908h |
/// | FEh | FETCH not served | |
/// | FFh | job failed | |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum ReactionError {
    /// 0Ah.
    #[error("access denied (0Ah)")]
    AccessDenied,
    /// 0Ch.
    #[error("invalid data type (0Ch)")]
    DataType,
    /// 10h.
    #[error("wrong header byte 1 or 4, or continuation not supported (10h)")]
    Header,
    /// 12h.
    #[error("request or object type not supported (12h)")]
    RequestType,
    /// 14h.
    #[error("data block missing or too short (14h)")]
    NoSuchBlock,
    /// 16h.
    #[error("unknown command in header byte 3 (16h)")]
    UnknownCommand,
    /// 2Ah.
    #[error("PLC stopped (2Ah)")]
    Stopped,
    /// 32h.
    #[error("locked by the coordination flag (32h)")]
    Locked,
    /// 34h.
    #[error("wrong length (34h)")]
    Length,
    /// 36h.
    #[error("synchronisation error (36h)")]
    Synchronisation,
    /// `FEh`.
    #[error("FETCH is not served (FEh)")]
    FetchNotServed,
    /// `FFh`.
    #[error("job failed (FFh)")]
    JobFailed,
    /// A number that the sources do not name.
    #[error("unknown error number {0:02X}h")]
    Other(NonZeroU8),
}

impl ReactionError {
    const NAMED: [Self; 12] = [
        Self::AccessDenied,
        Self::DataType,
        Self::Header,
        Self::RequestType,
        Self::NoSuchBlock,
        Self::UnknownCommand,
        Self::Stopped,
        Self::Locked,
        Self::Length,
        Self::Synchronisation,
        Self::FetchNotServed,
        Self::JobFailed,
    ];

    /// The number on the line, never 0.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::AccessDenied => 0x0A,
            Self::DataType => 0x0C,
            Self::Header => 0x10,
            Self::RequestType => 0x12,
            Self::NoSuchBlock => 0x14,
            Self::UnknownCommand => 0x16,
            Self::Stopped => 0x2A,
            Self::Locked => 0x32,
            Self::Length => 0x34,
            Self::Synchronisation => 0x36,
            Self::FetchNotServed => 0xFE,
            Self::JobFailed => 0xFF,
            Self::Other(code) => code.get(),
        }
    }

    /// The error that `code` stands for; `None` for 0, which is no error.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        let other = NonZeroU8::new(code).map(Self::Other);
        Self::NAMED
            .into_iter()
            .find(|named| named.code() == code)
            .or(other)
    }
}

/// What is wrong with a received reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ReactionFault {
    /// Shorter than its header.
    #[error("{len} bytes, the header alone has {SHORT_HEADER}")]
    TooShort {
        /// Bytes received.
        len: usize,
    },
    /// Byte 1 is neither 00h nor `FFh`.
    #[error("byte 1: {value:02X}h, neither 00h nor FFh")]
    FirstByte {
        /// The byte.
        value: u8,
    },
    /// Byte 2 or 3 is not 00h.
    #[error("byte {byte}: {value:02X}h instead of 00h")]
    NotZero {
        /// 2 or 3.
        byte: u8,
        /// The byte.
        value: u8,
    },
    /// The reaction to a first telegram where that to a continuation was due, or the reverse.
    #[error("reaction to {got:?}, that to {expected:?} was due")]
    OutOfStep {
        /// What byte 1 says.
        got: Part,
        /// What it should say.
        expected: Part,
    },
    /// A FETCH reaction has too much or too little data, or any has more than 128 bytes.
    #[error("{len} bytes of data, {expected} were due")]
    DataLength {
        /// Bytes received.
        len: usize,
        /// Bytes due.
        expected: usize,
    },
    /// A SEND reaction came with data.
    #[error("SEND reaction with {len} bytes of data")]
    SendWithData {
        /// Bytes after the header.
        len: usize,
    },
}

impl ReactionFault {
    /// The number under which an S7 logs this event (class 0Ah), where the sources give one.
    ///
    /// Siemens names 0A06h for FETCH alone; here a SEND reaction that is too short has it too.
    #[must_use]
    pub const fn event(self) -> Option<u16> {
        match self {
            Self::OutOfStep { .. } => Some(0x0A01),
            Self::FirstByte { .. } => Some(0x0A02),
            Self::DataLength { .. } => Some(0x0A03),
            Self::SendWithData { .. } => Some(0x0A04),
            Self::TooShort { .. } => Some(0x0A06),
            Self::NotZero { .. } => None,
        }
    }
}

/// Header of a reaction: byte 1 as in the command, 00h, 00h, error number or 00h.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "the header has these two, no more"
)]
pub struct Reaction {
    /// Whether it answers a first telegram or a continuation.
    pub part: Part,
    /// Byte 4.
    pub result: Result<(), ReactionError>,
}

impl Reaction {
    /// The header.
    pub(crate) const fn encode(self) -> [u8; SHORT_HEADER] {
        let code = match self.result {
            Ok(()) => 0,
            Err(error) => error.code(),
        };
        [self.part.code(), 0, 0, code]
    }

    /// The telegram: header, then the data that a FETCH asked for.
    ///
    /// # Errors
    /// [`EncodeError::TooMuchData`] above 128 bytes.
    pub fn telegram(self, data: &[u8]) -> Result<Telegram, EncodeError> {
        Telegram::new(self.encode(), data)
    }

    /// Decodes a reaction; returns the data after the header.
    ///
    /// # Errors
    /// [`ReactionFault`] names the byte and its value.
    pub fn decode(block: &[u8]) -> Result<(Self, &[u8]), ReactionFault> {
        let Some((&[first, second, third, code], data)) = block.split_first_chunk() else {
            return Err(ReactionFault::TooShort { len: block.len() });
        };
        let Some(part) = Part::from_code(first) else {
            return Err(ReactionFault::FirstByte { value: first });
        };
        for (byte, value) in [(2, second), (3, third)] {
            if value != 0 {
                return Err(ReactionFault::NotZero { byte, value });
            }
        }
        if data.len() > MAX_DATA {
            let (len, expected) = (data.len(), MAX_DATA);
            return Err(ReactionFault::DataLength { len, expected });
        }
        let result = ReactionError::from_code(code).map_or(Ok(()), Err);
        Ok((Self { part, result }, data))
    }
}
