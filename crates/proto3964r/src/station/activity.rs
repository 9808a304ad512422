//! What a station does, for a person.

use core::fmt;

use super::{Station, state::State};

/// What a station does, and for what it waits. Its `Display` is a line for a person, with the timer
/// that runs; [`Station::poll_timeout`] says until when.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Activity {
    /// Nothing is under way.
    Idle,
    /// A character that belongs to nothing came; NAK follows when the line is silent.
    AwaitSilence,
    /// STX came while the receive buffer is in use.
    AwaitBuffer,
    /// DLE invites the block, none of it has come.
    AwaitBlock,
    /// A block comes in.
    Receive,
    /// A block comes in that is known to be bad; NAK follows at its end.
    ReceiveBad,
    /// A good block came in, the user has yet to accept or refuse it.
    AwaitUser,
    /// NAK rejects the block, its repeat is awaited.
    AwaitRepeat,
    /// STX is next on the line.
    Request,
    /// STX is sent, DLE is awaited.
    AwaitConnection,
    /// The block goes out.
    Send,
    /// The block was interrupted and is repeated when the line is silent.
    Interrupted,
    /// The block is sent, its answer is awaited.
    AwaitAcknowledgement,
    /// The job was given up while it had the line; a late answer to it is waited out.
    Settle,
}

impl fmt::Display for Activity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Idle => "idle",
            Self::AwaitSilence => "noise: NAK after a silence of ZVZ",
            Self::AwaitBuffer => "STX received, waits for a free receive buffer",
            Self::AwaitBlock => "DLE sent, waits for the block: ZVZ",
            Self::Receive => "receives the block: ZVZ",
            Self::ReceiveBad => "receives a bad block, NAK at its end: ZVZ",
            Self::AwaitUser => "block received, waits for its user to accept it",
            Self::AwaitRepeat => "NAK sent, waits for the repeat: BWZ",
            Self::Request => "STX is next",
            Self::AwaitConnection => "STX sent, waits for DLE: QVZ",
            Self::Send => "sends the block",
            Self::Interrupted => "block interrupted, repeats it after a silence of ZVZ",
            Self::AwaitAcknowledgement => "block sent, waits for DLE: QVZ",
            Self::Settle => "job given up, waits for a silence of ZVZ",
        })
    }
}

impl<const N: usize, const T: usize> Station<N, T> {
    /// What the station does, to show it; the procedure itself needs nobody to ask.
    #[must_use]
    pub const fn activity(&self) -> Activity {
        match self.state {
            State::Idle => Activity::Idle,
            State::Noise { .. } => Activity::AwaitSilence,
            State::AwaitBuffer { .. } => Activity::AwaitBuffer,
            State::Invited { .. } => Activity::AwaitBlock,
            State::Receiving { .. } => Activity::Receive,
            State::Spoiled { .. } => Activity::ReceiveBad,
            State::Held { .. } => Activity::AwaitUser,
            State::AwaitRepeat { .. } => Activity::AwaitRepeat,
            State::Request { .. } => Activity::Request,
            State::AwaitDle { .. } => Activity::AwaitConnection,
            State::Sending { .. } => Activity::Send,
            State::Interrupted { .. } => Activity::Interrupted,
            State::AwaitAck { .. } => Activity::AwaitAcknowledgement,
            State::Settling { .. } => Activity::Settle,
        }
    }
}
