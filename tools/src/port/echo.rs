//! A two-wire line, on which each side hears itself.

use alloc::collections::VecDeque;
use core::time::Duration;
use std::time::Instant;

use proto3964r::{CharacterError, tokio::Damage};

use super::heard::Heard;

/// Removes from what is heard what was sent.
///
/// As many characters as were sent are their echo. One that differs is a collision, and is heard as
/// such. What does not come within its time is no longer awaited.
#[derive(Debug)]
pub(crate) struct Echo {
    /// What was sent and has not been heard.
    awaited: VecDeque<u8>,
    /// When the last of them must have come.
    until: Option<Instant>,
    character: Duration,
}

/// Above what USB adapters and serial servers hold a character back.
const LATENCY: Duration = Duration::from_millis(100);

impl Echo {
    /// For characters of this time on the line.
    pub(crate) const fn new(character: Duration) -> Self {
        Self {
            awaited: VecDeque::new(),
            until: None,
            character,
        }
    }

    /// Characters have been sent.
    pub(crate) fn sent(&mut self, now: Instant, bytes: &[u8]) {
        self.expire(now);
        self.awaited.extend(bytes);
        let count = u32::try_from(self.awaited.len()).map_or(u32::MAX, |count| count);
        self.until = now.checked_add(self.character.saturating_mul(count) + LATENCY);
    }

    /// What is left of something that was heard.
    pub(crate) fn hear(&mut self, now: Instant, heard: Heard) -> Option<Heard> {
        self.expire(now);
        let Some(awaited) = self.awaited.pop_front() else {
            return Some(heard);
        };
        match heard {
            Ok(byte) if byte == awaited => None,
            Ok(byte) => Some(Err(Damage::Character {
                byte,
                error: CharacterError::Collision,
            })),
            Err(damage) => Some(Err(damage)),
        }
    }

    fn expire(&mut self, now: Instant) {
        if self.until.is_some_and(|until| now > until) {
            self.awaited.clear();
            self.until = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const CHARACTER: Duration = Duration::from_millis(1);

    fn left(echo: &mut Echo, now: Instant, heard: &[u8]) -> Vec<Heard> {
        let heard = heard.iter().map(|&byte| Ok(byte));
        heard.filter_map(|heard| echo.hear(now, heard)).collect()
    }

    proptest! {
        /// However the echo and the partner's characters are cut into pieces.
        #[test]
        fn own_characters_are_removed(
            rounds in prop::collection::vec(
                (prop::collection::vec(any::<u8>(), 0..20), prop::collection::vec(any::<u8>(), 0..20)),
                0..10,
            ),
        ) {
            let now = Instant::now();
            let mut echo = Echo::new(CHARACTER);
            for (own, partner) in rounds {
                echo.sent(now, &own);
                let on_the_wire: Vec<_> = own.iter().chain(&partner).copied().collect();
                let wanted: Vec<Heard> = partner.into_iter().map(Ok).collect();
                prop_assert_eq!(left(&mut echo, now, &on_the_wire), wanted);
            }
        }
    }

    #[test]
    fn another_character_is_a_collision() {
        let now = Instant::now();
        let mut echo = Echo::new(CHARACTER);
        echo.sent(now, &[0x02, 0x41]);
        let collision = Err(Damage::Character {
            byte: 0x12,
            error: CharacterError::Collision,
        });
        let heard = left(&mut echo, now, &[0x12, 0x41, 0x10]);
        assert_eq!(heard, [collision, Ok(0x10)]);
    }

    #[test]
    fn an_echo_that_does_not_come_swallows_nothing_later() {
        let now = Instant::now();
        let mut echo = Echo::new(CHARACTER);
        echo.sent(now, &[0x02]);
        let later = now + CHARACTER + LATENCY + CHARACTER;
        assert_eq!(left(&mut echo, later, &[0x02]), [Ok(0x02)]);
    }
}
