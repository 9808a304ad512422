//! What is wrong with a command: of the own program, or of the partner.

use thiserror::Error;

use crate::area::{AreaError, AreaKind};
use crate::coordination::CoordinationError;
use crate::reaction::ReactionError;

/// Why a command cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RequestError {
    /// SEND goes to DB and DX only.
    #[error("SEND writes to DB or DX, not to {kind}")]
    NotSendable {
        /// The area's kind.
        kind: AreaKind,
    },
    /// Length 0.
    #[error("length 0")]
    Empty,
}

/// What is wrong with a received command; each has its reaction and, where Siemens names one, its
/// event number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CommandError {
    /// Shorter than its header.
    #[error("{len} bytes, the header alone has {least}")]
    TooShort {
        /// Bytes received.
        len: usize,
        /// Bytes of the header.
        least: usize,
    },
    /// Byte 1 is neither 00h nor `FFh`.
    #[error("byte 1: {value:02X}h, neither 00h nor FFh")]
    FirstByte {
        /// The byte.
        value: u8,
    },
    /// Byte 2 is not 00h.
    #[error("byte 2: {value:02X}h instead of 00h")]
    SecondByte {
        /// The byte.
        value: u8,
    },
    /// Byte 3 is neither `A`, `O` nor `E`.
    #[error("byte 3: {value:02X}h, neither 41h, 4Fh nor 45h")]
    Request {
        /// The byte.
        value: u8,
    },
    /// Byte 4 names no area.
    #[error("byte 4: {value:02X}h names no area")]
    AreaKind {
        /// The byte.
        value: u8,
    },
    /// Byte 4 of a SEND is not `D`.
    #[error("byte 4: SEND from {kind}, only 44h (DB) is allowed")]
    SendSource {
        /// The area that byte 4 names.
        kind: AreaKind,
    },
    /// Byte 5 is not 0 in an area without numbers.
    #[error("byte 5: {0}")]
    Number(#[from] AreaError),
    /// Bytes 7 and 8 are 0.
    #[error("bytes 7, 8: length {value}")]
    Length {
        /// The length.
        value: u16,
    },
    /// Byte 6 lies past the end of the area.
    #[error("byte 6: starts at {start}, the area has {size} units")]
    Start {
        /// First unit asked for.
        start: u8,
        /// Units in the area.
        size: usize,
    },
    /// The job runs past the end of the area.
    #[error("bytes 7, 8: ends at {end}, the area has {size} units")]
    End {
        /// First unit after the job.
        end: usize,
        /// Units in the area.
        size: usize,
    },
    /// Bytes 9 and 10 mean nothing.
    #[error(transparent)]
    Coordination(#[from] CoordinationError),
    /// The data of the first telegram are not as long as its header says.
    #[error("{len} bytes of data in the first telegram, its header announces {expected}")]
    FirstDataLength {
        /// Bytes received.
        len: usize,
        /// Bytes announced for this telegram.
        expected: usize,
    },
    /// The data of a continuation are not what is left, or more than 128 bytes.
    #[error("{len} bytes of data in the continuation, {expected} were due")]
    ContinuationDataLength {
        /// Bytes received.
        len: usize,
        /// Bytes due in this telegram.
        expected: usize,
    },
    /// A FETCH came with data.
    #[error("FETCH with {len} bytes of data")]
    FetchWithData {
        /// Bytes after the header.
        len: usize,
    },
    /// Byte 3 of a continuation differs from the first telegram's.
    #[error("byte 3 of the continuation: {value:02X}h, the first telegram had {first:02X}h")]
    OtherRequest {
        /// The byte.
        value: u8,
        /// The byte of the first telegram.
        first: u8,
    },
    /// Byte 4 of a continuation differs from the first telegram's.
    #[error("byte 4 of the continuation: {value:02X}h, the first telegram had {first:02X}h")]
    OtherAreaKind {
        /// The byte.
        value: u8,
        /// The byte of the first telegram.
        first: u8,
    },
    /// A continuation of nothing.
    #[error("continuation without a first telegram")]
    NothingToContinue,
    /// The command came before the reaction to the last one had gone.
    #[error("command before the reaction to the last one")]
    ReactionPending,
    /// The data source refused.
    #[error("refused by the data source: {0}")]
    Refused(ReactionError),
}

impl CommandError {
    /// The reaction that the partner gets.
    ///
    /// The sources name the numbers and what they mean, but not the number for every check.
    /// Where they do not, the choice is this crate's: 0Ah for coordination flag and CPU.
    #[must_use]
    pub const fn reaction(self) -> ReactionError {
        match self {
            Self::Refused(error) => error,
            Self::FirstByte { .. }
            | Self::SecondByte { .. }
            | Self::AreaKind { .. }
            | Self::OtherAreaKind { .. } => ReactionError::Header,
            Self::Request { .. } | Self::OtherRequest { .. } => ReactionError::UnknownCommand,
            Self::SendSource { .. } => ReactionError::DataType,
            Self::Number(_) | Self::Start { .. } | Self::End { .. } => ReactionError::NoSuchBlock,
            Self::Coordination(_) => ReactionError::AccessDenied,
            Self::TooShort { .. }
            | Self::Length { .. }
            | Self::FirstDataLength { .. }
            | Self::ContinuationDataLength { .. }
            | Self::FetchWithData { .. } => ReactionError::Length,
            Self::NothingToContinue | Self::ReactionPending => ReactionError::Synchronisation,
        }
    }

    /// The number under which an S7 logs this event (class 06h), where the sources give one.
    #[must_use]
    pub const fn event(self) -> Option<u16> {
        Some(match self {
            Self::OtherRequest { .. } => 0x0603,
            Self::OtherAreaKind { .. } => 0x0605,
            Self::Number(_) | Self::Refused(ReactionError::NoSuchBlock) => 0x0606,
            Self::Start { .. } => 0x0607,
            Self::Length { .. } | Self::End { .. } => 0x0608,
            Self::Coordination(CoordinationError::Flag { .. }) => 0x0609,
            Self::Coordination(CoordinationError::Cpu { .. }) => 0x060A,
            Self::ContinuationDataLength { .. } => 0x060B,
            Self::FetchWithData { .. } => 0x060C,
            Self::NothingToContinue | Self::ReactionPending => 0x060E,
            Self::Refused(ReactionError::Locked) => 0x060F,
            Self::TooShort { .. } => 0x0610,
            Self::FirstDataLength { .. } => 0x0611,
            Self::FirstByte { .. }
            | Self::SecondByte { .. }
            | Self::Request { .. }
            | Self::AreaKind { .. }
            | Self::SendSource { .. }
            | Self::Refused(_) => return None,
        })
    }
}
