//! What a port hears.

use proto3964r::{LineError, tokio::Damage};

/// A character, or what a receiver circuit reports in its place.
pub(crate) type Heard = Result<u8, Damage>;

/// A character with a wrong parity bit, or a wrong stop bit: Linux does not tell which.
pub(crate) const fn damaged(byte: u8) -> Heard {
    Err(Damage::Character {
        byte,
        error: LineError::Parity,
    })
}
