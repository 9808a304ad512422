//! What a tap hears: one character, with its time.

use core::time::Duration;

use proto3964r::CharacterError;

use super::side::Side;

/// One character on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "what a tap can know of a character"
)]
pub struct Character {
    /// When it was heard, since an epoch of the caller.
    pub at: Duration,
    /// Who sent it.
    pub side: Side,
    /// What was read.
    pub byte: u8,
    /// What the receiver circuit says.
    pub error: Option<CharacterError>,
}

impl Character {
    /// The character, unless it is damaged: then it answers nothing.
    pub(crate) fn intact(self) -> Option<u8> {
        self.error.is_none().then_some(self.byte)
    }
}

/// Time from one to the other, zero if it runs backwards. `Duration`'s own subtraction has a way
/// to a panic.
pub(crate) fn since(earlier: Duration, later: Duration) -> Duration {
    let nanos = later.as_nanos().saturating_sub(earlier.as_nanos());
    match u64::try_from(nanos) {
        Ok(nanos) => Duration::from_nanos(nanos),
        Err(_) => Duration::MAX,
    }
}
