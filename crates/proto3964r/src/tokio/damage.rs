//! Characters that came in damaged, over streams that carry bytes alone.

use std::io;

use thiserror::Error;

use super::{Clock, Reader, Writer};
use crate::{embedded_io_async::Driver, event::CharacterError};

/// What a receiver circuit reports in place of a character.
///
/// A stream hands it out as an [`io::Error`] made of it, once, in its place among the characters;
/// a [`Link`](super::Link) reports it to its station and goes on.
///
/// # Examples
/// ```
/// use std::io;
/// use proto3964r::{CharacterError, tokio::Damage};
///
/// let error = io::Error::from(Damage::Character { byte: 0x41, error: CharacterError::Parity });
/// assert_eq!(error.to_string(), "parity error in 41");
/// assert!(Damage::of(&error).is_some());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Damage {
    /// A character that came in damaged.
    #[error("{error} error in {byte:02X}")]
    Character {
        /// What was read.
        byte: u8,
        /// What is wrong with it.
        error: CharacterError,
    },
    /// BREAK.
    #[error("BREAK")]
    Break,
}

impl Damage {
    /// The damage that an error reports; `None` for every other error.
    #[must_use]
    pub fn of(error: &io::Error) -> Option<Self> {
        error.get_ref()?.downcast_ref().copied()
    }
}

impl From<Damage> for io::Error {
    fn from(damage: Damage) -> Self {
        Self::new(io::ErrorKind::InvalidData, damage)
    }
}

impl<const N: usize> Driver<Reader, Writer, Clock, N> {
    /// Tells the station of the [`Damage`] that [`wait`](Self::wait) has returned as an error;
    /// call `wait` again.
    ///
    /// # Errors
    /// Any other error, as it is.
    pub fn take_damage(&mut self, error: io::Error) -> io::Result<()> {
        let now = self.now();
        match Damage::of(&error) {
            Some(Damage::Character { byte, error }) => {
                self.station_mut().handle_damaged(now, byte, error);
            }
            Some(Damage::Break) => self.station_mut().handle_break(now),
            None => return Err(error),
        }
        Ok(())
    }
}
