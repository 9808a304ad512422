//! What a job can come to.

use core::time::Duration;

use thiserror::Error;

use crate::command::Command;
use crate::reaction::{ReactionError, ReactionFault};

/// Why a job was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SubmitError {
    /// The last job runs, or its outcome has not been polled.
    #[error("the last job runs or its outcome has not been polled")]
    Busy,
    /// The job is longer than the client's buffer.
    #[error("{len} bytes, the client's buffer has {capacity}")]
    TooLong {
        /// Bytes of the job.
        len: usize,
        /// Bytes of the buffer.
        capacity: usize,
    },
    /// The data are not as long as the command says.
    #[error("{len} bytes of data, the command announces {expected}")]
    DataLength {
        /// Bytes given.
        len: usize,
        /// Bytes announced; 0 for a FETCH.
        expected: usize,
    },
}

/// Why a job failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum JobError {
    /// The partner's reaction carries an error number.
    #[error("refused by the partner: {0}")]
    Refused(ReactionError),
    /// The partner's reaction is wrong.
    #[error("wrong reaction: {0}")]
    Reaction(ReactionFault),
    /// No reaction within the monitoring time.
    #[error("no reaction within {0:?}")]
    NoReaction(Duration),
    /// The transport could not deliver a command.
    #[error("command not delivered")]
    Transport,
    /// Given up by the caller.
    #[error("cancelled")]
    Cancelled,
}

impl JobError {
    /// The number under which an S7 logs this event (class 0Ah), where the sources give one.
    #[must_use]
    pub const fn event(self) -> Option<u16> {
        match self {
            Self::Reaction(fault) => fault.event(),
            Self::NoReaction(_) => Some(0x0A05),
            Self::Refused(_) | Self::Transport | Self::Cancelled => None,
        }
    }
}

/// How a job ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Outcome<'a> {
    /// The partner took all data.
    Sent {
        /// The job.
        command: Command,
    },
    /// The partner's data.
    Fetched {
        /// The job.
        command: Command,
        /// All bytes asked for; words high byte first.
        data: &'a [u8],
    },
    /// The job failed.
    Failed {
        /// The job.
        command: Command,
        /// Why.
        error: JobError,
        /// Bytes of data whose reaction had come by then.
        done: usize,
    },
}
