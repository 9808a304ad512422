//! A listener on both directions of a line.

mod character;
mod conversation;
mod observation;
mod scan;
mod side;
#[cfg(test)]
mod tests;

use core::time::Duration;

use proto3964r::{CharacterError, Config};

pub use character::Character;
pub use observation::{Observation, Observations};
pub use side::Side;

pub(crate) use character::since;
pub(crate) use conversation::Conversation;
pub(crate) use observation::{Mark, Millis};
pub(crate) use scan::BccSeen;
pub(crate) use side::PerSide;

/// Listens to both directions of a line and names each step.
///
/// `N` is the longest payload that is kept. Feed it each character with its time, or the lines of
/// a capture; it sends nothing. Times and check come from a [`Config`]; the other settings do not
/// matter. Why a line fails is what [`diagnose`](crate::diagnose) finds.
///
/// # Examples
/// ```
/// use core::time::Duration;
/// use monitor3964r::{Monitor, Side};
/// use proto3964r::{Config, Line, Priority};
///
/// let mut monitor = Monitor::<64>::new(Config::siemens_3964r(Priority::Low, Line::Instant));
/// let mut steps = monitor.handle_byte(Duration::ZERO, Side::A, 0x02);
/// assert_eq!(steps.next().unwrap().to_string(), "A STX, attempt 1");
/// let mut steps = monitor.handle_byte(Duration::from_millis(3), Side::B, 0x15);
/// assert_eq!(steps.next().unwrap().to_string(), "B NAK to STX, 3.000 ms");
/// ```
#[derive(Clone, Debug)]
pub struct Monitor<const N: usize> {
    conversation: Conversation,
    buffer: [u8; N],
}

impl<const N: usize> Monitor<N> {
    /// A monitor for a line with these times and this check, before the first character.
    #[must_use]
    pub fn new(config: Config) -> Self {
        const {
            assert!(N <= 65535, "a block holds at most 65535 bytes");
        }
        Self {
            conversation: Conversation::new(&config, config.check),
            buffer: [0; N],
        }
    }

    /// Takes a character that `side` sent; returns what it means.
    pub fn handle_byte(&mut self, now: Duration, side: Side, byte: u8) -> Observations<'_> {
        self.handle(Character {
            at: now,
            side,
            byte,
            error: None,
        })
    }

    /// Takes a character of `side` that came in damaged.
    pub fn handle_damaged(
        &mut self,
        now: Duration,
        side: Side,
        byte: u8,
        error: CharacterError,
    ) -> Observations<'_> {
        self.handle(Character {
            at: now,
            side,
            byte,
            error: Some(error),
        })
    }

    fn handle(&mut self, heard: Character) -> Observations<'_> {
        self.conversation.take(heard);
        let scan = self.conversation.scan();
        if let Some(byte) = scan.data() {
            let slot = usize::try_from(scan.len())
                .ok()
                .and_then(|len| len.checked_sub(1));
            if let Some(slot) = slot.and_then(|at| self.buffer.get_mut(at)) {
                *slot = byte;
            }
        }
        Observations::new(self.conversation.marks(), &self.buffer)
    }

    /// Reports a wait that has become too long by `now`.
    ///
    /// Needed on a live line only: the next character does the same.
    pub fn handle_timeout(&mut self, now: Duration) -> Observations<'_> {
        self.conversation.handle_timeout(now);
        Observations::new(self.conversation.marks(), &self.buffer)
    }

    /// When [`handle_timeout`](Self::handle_timeout) has something to report, unless a character
    /// comes first.
    #[must_use]
    pub fn poll_timeout(&self) -> Option<Duration> {
        self.conversation.poll_timeout()
    }
}
