//! Any telegram, decoded without knowledge of what went before.

use thiserror::Error;

use crate::command::{Command, CommandError, Continuation};
use crate::reaction::{Reaction, ReactionFault};
use crate::telegram::{EncodeError, Telegram, is_continuation, is_reaction};

/// Why a block is no telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DecodeError {
    /// It is a command, or too short to decide, and wrong.
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
