//! A two-wire line, on which each side hears itself.

use alloc::collections::VecDeque;
use core::time::Duration;
use std::time::Instant;

use proto3964r::{CharacterError, tokio::Damage};

use super::heard::Heard;

/// Removes from what is heard what was sent.
///
/// A character that differs from the echo that is due is a collision, and is heard as such: it came
/// in the echo's place, or before it where a server puts one after the other. Which of both, only
/// what follows shows; either way no echo is taken for the partner's character. What does not come
/// within its time is no longer awaited.
#[derive(Debug)]
pub(crate) struct Echo {
    /// What was sent and has not been heard.
    awaited: VecDeque<u8>,
    /// Of these, so many may have been replaced: as many other characters have been heard.
    doubtful: usize,
    /// When the last of them must have come.
    until: Option<Instant>,
    character: Duration,
}

/// Above what USB adapters, serial servers and a busy machine hold a character back, and below QVZ:
/// when a station begins anew, nothing old is awaited.
const LATENCY: Duration = Duration::from_millis(500);

impl Echo {
    /// For characters of this time on the line.
    pub(crate) const fn new(character: Duration) -> Self {
        Self {
            awaited: VecDeque::new(),
            doubtful: 0,
            until: None,
            character,
        }
    }

    /// Characters have been sent.
    pub(crate) fn sent(&mut self, now: Instant, bytes: &[u8]) {
        self.awaited.extend(bytes);
        let count = u32::try_from(self.awaited.len()).map_or(u32::MAX, |count| count);
        self.until = now.checked_add(self.character.saturating_mul(count) + LATENCY);
    }

    /// What is left of something that was heard.
    pub(crate) fn hear(&mut self, heard: Heard) -> Option<Heard> {
        if let Ok(byte) = heard
            && let Some(replaced) = self.replaced_before(byte)
        {
            self.awaited.drain(..=replaced);
            self.doubtful = (self.doubtful - replaced).min(self.awaited.len());
            return None;
        }
        // As many as were sent have been heard, or more: it is none of these.
        if self.doubtful == self.awaited.len() {
            return Some(heard);
        }
        self.doubtful += 1;
        Some(heard.and_then(|byte| {
            Err(Damage::Character {
                byte,
                error: CharacterError::Collision,
            })
        }))
    }

    /// Of those that may have been replaced, how many were so if this is an echo; none if it is
    /// not.
    fn replaced_before(&self, byte: u8) -> Option<usize> {
        let mut due = self.awaited.iter().take(self.doubtful + 1);
        due.position(|&awaited| awaited == byte)
    }

    /// When what is awaited is overdue.
    pub(crate) const fn until(&self) -> Option<Instant> {
        self.until
    }

    /// Nothing is left to read: what is overdue does not come any more, however late one looks.
    pub(crate) fn silence(&mut self, now: Instant) {
        if self.until.is_some_and(|until| now >= until) {
            self.forget();
        }
    }

    /// Nothing that was sent is heard any more.
    pub(crate) fn forget(&mut self) {
        self.awaited.clear();
        self.doubtful = 0;
        self.until = None;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const CHARACTER: Duration = Duration::from_millis(1);

    fn left(echo: &mut Echo, heard: &[u8]) -> Vec<Heard> {
        let heard = heard.iter().map(|&byte| Ok(byte));
        heard.filter_map(|heard| echo.hear(heard)).collect()
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
                prop_assert_eq!(left(&mut echo, &on_the_wire), wanted);
            }
        }

        /// Wherever characters of others come between own ones, or in their place, none of the own
        /// is left, and all of the others.
        #[test]
        fn no_own_character_is_left_after_collisions(
            line in prop::collection::vec((0_u8..100, 0..4_u8, 100..200_u8), 1..20),
            partner in prop::collection::vec(100..200_u8, 0..5),
        ) {
            let now = Instant::now();
            let mut echo = Echo::new(CHARACTER);
            let own: Vec<_> = line.iter().map(|&(own, ..)| own).collect();
            echo.sent(now, &own);
            let (mut on_the_wire, mut wanted) = (Vec::new(), Vec::new());
            for (own, what, other) in line {
                // As sent, replaced, or after another one.
                if what == 1 || what == 2 {
                    on_the_wire.push(other);
                    wanted.push(other);
                }
                if what != 1 {
                    on_the_wire.push(own);
                }
            }
            on_the_wire.extend(&partner);
            wanted.extend(partner);
            let bytes = left(&mut echo, &on_the_wire).into_iter().map(|heard| match heard {
                Ok(byte) | Err(Damage::Character { byte, .. }) => byte,
                Err(damage) => unreachable!("{damage:?}"),
            });
            prop_assert_eq!(bytes.collect::<Vec<_>>(), wanted);
        }
    }

    /// What collisions are heard as.
    fn collision(byte: u8) -> Heard {
        let error = CharacterError::Collision;
        Err(Damage::Character { byte, error })
    }

    #[test]
    fn another_character_is_a_collision() {
        for (own, on_the_wire, wanted) in [
            (
                &[0x02, 0x41][..],
                &[0x12, 0x41, 0x10][..],
                &[collision(0x12), Ok(0x10)][..],
            ),
            // The partner's NAK came before the echo of STX.
            (&[0x02], &[0x15, 0x02, 0x10], &[collision(0x15), Ok(0x10)]),
            // Of two equal characters the first was replaced: as many as were sent have been heard,
            // and the second is not awaited in the answer's place.
            (
                &[0x00, 0x00],
                &[0x12, 0x00, 0x10, 0x03],
                &[collision(0x12), Ok(0x10), Ok(0x03)],
            ),
        ] {
            let mut echo = Echo::new(CHARACTER);
            echo.sent(Instant::now(), own);
            assert_eq!(left(&mut echo, on_the_wire), wanted);
        }
    }

    #[test]
    fn an_echo_that_does_not_come_swallows_nothing_later() {
        let now = Instant::now();
        let mut echo = Echo::new(CHARACTER);
        echo.sent(now, &[0x02]);
        echo.silence(now + CHARACTER + LATENCY);
        assert_eq!(left(&mut echo, &[0x02]), [Ok(0x02)]);
    }
}
