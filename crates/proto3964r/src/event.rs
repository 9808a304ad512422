//! What a station reports.

use core::fmt;

use thiserror::Error;

use crate::frame::FrameError;

/// What [`Station::poll_event`](crate::Station::poll_event) hands out.
///
/// [`Received`](Self::Received) and the outcome of a job ([`Sent`](Self::Sent) or
/// [`Failed`](Self::Failed)) are never lost. The others are diagnosis: when they are not fetched,
/// later ones are dropped and counted. Its `Display` is a line for a person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Event<'a> {
    /// A telegram came in and was acknowledged; or, with
    /// [`Config::acknowledge_wait_ms`](crate::Config::acknowledge_wait_ms), waits for
    /// [`Station::accept`](crate::Station::accept).
    Received(&'a [u8]),
    /// The job was acknowledged by the partner.
    Sent {
        /// Bytes of its payload.
        len: usize,
    },
    /// The job was given up.
    Failed(Failure),
    /// Something came in and was answered with NAK.
    Rejected(Rejection),
    /// The partner's telegram was given up after one rejection or more.
    Abandoned(Abandoned),
    /// Initialization conflict (collision): both stations sent STX.
    Conflict {
        /// Conflicts in a row in which the partner neither gave way nor had a telegram to deliver.
        in_a_row: u8,
    },
    /// Both stations seem to have the same priority: two high ones wait for each other's DLE in
    /// vain, conflict after conflict, even if one of them gives way at a retry; or two low ones
    /// both answered DLE.
    SamePriority,
    /// The line was held in BREAK; the station is idle.
    Break,
}

/// Why and when a job was given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("job given up after {attempts} {phase} attempts, first error: {cause}")]
#[non_exhaustive]
pub struct Failure {
    /// The phase whose attempts are used up.
    pub phase: JobPhase,
    /// The first error of this job. Siemens reports the first one too: the later ones are often
    /// its consequence.
    pub cause: Cause,
    /// Attempts in that phase.
    pub attempts: u8,
}

/// The two phases of a job, each with its own attempt counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the procedure has these two")]
pub enum JobPhase {
    /// From STX to DLE.
    Connection,
    /// From DLE to the answer to the block.
    Transmission,
}

impl fmt::Display for JobPhase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Connection => "connection",
            Self::Transmission => "transmission",
        })
    }
}

/// What went wrong with an attempt to send.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Cause {
    /// No answer within the acknowledgement delay time (QVZ).
    #[error("timeout")]
    Timeout,
    /// The partner answered NAK.
    #[error("nak")]
    Nak,
    /// DLE came before what it answers can have left at the rate of [`Config::line`]: the line is
    /// faster than that, or it was noise.
    ///
    /// [`Config::line`]: crate::Config::line
    #[error("answer sooner than the baud rate allows")]
    TooSoon,
    /// A character that is no answer.
    #[error("unexpected {0:02X}")]
    Unexpected(u8),
    /// A damaged character.
    #[error("{0}")]
    Line(CharacterError),
    /// The partner sent STX as well and nothing came of it.
    #[error("initialization conflict")]
    Conflict,
    /// The output did not take the next byte within QVZ.
    #[error("stalled")]
    Stalled,
    /// BREAK on the line.
    #[error("break")]
    Break,
    /// [`Station::cancel`](crate::Station::cancel) was called.
    #[error("cancelled")]
    Cancelled,
}

/// What a receiver circuit reports about one character.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CharacterError {
    /// The parity bit is wrong.
    #[error("parity")]
    Parity,
    /// The stop bit is missing.
    #[error("framing")]
    Framing,
    /// Characters were lost before this one.
    #[error("overrun")]
    Overrun,
    /// On a two-wire line, another character was heard than was sent.
    #[error("collision")]
    Collision,
}

/// Why a reception was answered with NAK.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Rejection {
    /// The block came to its end and is no good.
    #[error(transparent)]
    Frame(FrameError),
    /// A character of the block was damaged.
    #[error("{0} error")]
    Line(CharacterError),
    /// A gap longer than the character delay time (ZVZ) in the block.
    #[error("character delay time exceeded")]
    CharacterDelay,
    /// The block, already known to be bad, did not end.
    #[error("block without an end")]
    Endless,
    /// STX came, and no receive buffer became free in time.
    #[error("no receive buffer")]
    NoBuffer,
    /// The block is good, and [`Station::refuse`](crate::Station::refuse) was called.
    #[error("refused by the user")]
    Refused,
    /// The block is good, and the user neither accepted nor refused it before its time, or before
    /// the partner asked again.
    #[error("not accepted in time")]
    Undecided,
    /// A character other than STX and NAK in idle, followed by silence.
    #[error("noise {first:02X}h while idle")]
    Noise {
        /// The first such character.
        first: u8,
    },
}

/// Why the repeat of a rejected telegram is no longer awaited.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Abandoned {
    /// No STX within the block wait time (BWZ).
    #[error("no repeat within the block wait time")]
    NoRepeat,
    /// As many rejections as transmission attempts are configured.
    #[error("{0} rejected receptions")]
    TooMany(u8),
    /// The partner sent NAK: it gave up.
    #[error("given up by the partner")]
    ByPartner,
}

impl fmt::Display for Event<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Received([]) => f.write_str("received an empty telegram"),
            Self::Received(telegram) => write!(f, "received {}", Hex(telegram)),
            Self::Sent { len } => write!(f, "sent {len} bytes"),
            Self::Failed(failure) => failure.fmt(f),
            Self::Rejected(rejection) => write!(f, "rejected: {rejection}"),
            Self::Abandoned(abandoned) => write!(f, "abandoned: {abandoned}"),
            Self::Conflict { in_a_row } => {
                write!(f, "initialization conflict, {in_a_row} in a row")
            }
            Self::SamePriority => f.write_str("both stations seem to have the same priority"),
            Self::Break => f.write_str("BREAK on the line"),
        }
    }
}

/// Bytes as people write them: `41 42`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::exhaustive_structs, reason = "bytes and nothing else")]
pub struct Hex<'a>(pub &'a [u8]);

impl fmt::Display for Hex<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, byte) in self.0.iter().enumerate() {
            let space = if at == 0 { "" } else { " " };
            write!(f, "{space}{byte:02X}")?;
        }
        Ok(())
    }
}

#[cfg(feature = "log")]
impl Event<'_> {
    /// Writes the event to `log`: what went well at level debug, everything else at level warn.
    pub(crate) fn log(&self) {
        match self {
            Self::Received(telegram) => log::debug!("received {} bytes", telegram.len()),
            Self::Sent { .. } => log::debug!("{self}"),
            _ => log::warn!("{self}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString as _;

    use super::*;

    #[test]
    fn events_are_lines_for_a_person() {
        let failure = Failure {
            phase: JobPhase::Connection,
            cause: Cause::Timeout,
            attempts: 6,
        };
        for (event, line) in [
            (Event::Received(&[0x41, 0x10]), "received 41 10"),
            (Event::Received(&[]), "received an empty telegram"),
            (Event::Sent { len: 3 }, "sent 3 bytes"),
            (
                Event::Failed(failure),
                "job given up after 6 connection attempts, first error: timeout",
            ),
            (
                Event::Rejected(Rejection::Noise { first: 0x41 }),
                "rejected: noise 41h while idle",
            ),
            (
                Event::Abandoned(Abandoned::TooMany(6)),
                "abandoned: 6 rejected receptions",
            ),
            (
                Event::Conflict { in_a_row: 2 },
                "initialization conflict, 2 in a row",
            ),
        ] {
            assert_eq!(event.to_string(), line);
        }
    }
}
