//! A serial line: characters that take their time, some of which arrive damaged.

use alloc::collections::VecDeque;
use core::time::Duration;

use crate::random::Random;

/// Damages one byte of a number of them: it is flipped in one bit, lost or doubled.
///
/// Between two damaged bytes are `spacing` to `2 spacing - 1` sound ones. A spacing of the longest
/// block damages at most one byte of a block, which is what a block check character is sure to see.
///
/// # Examples
/// ```
/// use machine_sim::serial_line::Noise;
/// let mut noise = Noise::new(7, 100);
/// let arrived = noise.pass(&[0x55; 1000]);
/// assert_ne!(arrived, [0x55; 1000]);
/// assert!((5..=9).contains(&noise.damaged()));
/// ```
#[derive(Debug, Clone)]
pub struct Noise {
    random: Random,
    spacing: u64,
    /// Sound bytes to come; `None` on a clean line.
    ahead: Option<u64>,
    bytes: u64,
    damaged: u64,
}

impl Noise {
    /// Noise that damages the same bytes in the same way for the same seed; none for a spacing
    /// of 0.
    #[must_use]
    pub const fn new(seed: u64, spacing: u64) -> Self {
        let mut noise = Self {
            random: Random::new(seed),
            spacing,
            ahead: None,
            bytes: 0,
            damaged: 0,
        };
        noise.ahead = noise.gap();
        noise
    }

    /// What arrives of these bytes.
    pub fn pass(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut arrived = Vec::with_capacity(bytes.len());
        for &byte in bytes {
            self.bytes += 1;
            match &mut self.ahead {
                Some(0) => self.damage(byte, &mut arrived),
                Some(ahead) => {
                    *ahead -= 1;
                    arrived.push(byte);
                }
                None => arrived.push(byte),
            }
        }
        arrived
    }

    /// Bytes that were sent.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// How many of them were damaged.
    #[must_use]
    pub const fn damaged(&self) -> u64 {
        self.damaged
    }

    fn damage(&mut self, byte: u8, arrived: &mut Vec<u8>) {
        self.damaged += 1;
        self.ahead = self.gap();
        match self.random.next_u64() % 4 {
            0 => {}
            1 => arrived.extend([byte, byte]),
            _ => arrived.push(byte ^ (1 << (self.random.next_u64() % 8))),
        }
    }

    const fn gap(&mut self) -> Option<u64> {
        match self.random.next_u64().checked_rem(self.spacing) {
            Some(more) => Some(self.spacing.saturating_add(more)),
            None => None,
        }
    }
}

/// One direction of a line: characters follow each other at its speed, and arrive when their last
/// bit has. Time is a `Duration` since an epoch of the caller.
///
/// # Examples
/// ```
/// use core::time::Duration;
/// use machine_sim::serial_line::{Noise, SerialLine};
///
/// // 8 data bits, even parity, one stop bit.
/// let mut line = SerialLine::new(9600, 11, Noise::new(1, 0));
/// line.send(Duration::ZERO, &[0x10, 0x02]);
/// let first = line.poll_timeout().unwrap();
/// assert_eq!(first.as_micros(), 1145);
/// assert_eq!(line.receive(first), [0x10]);
/// assert_eq!(line.receive(2 * first), [0x02]);
/// ```
#[derive(Debug, Clone)]
pub struct SerialLine {
    character: Duration,
    /// When each is at the other end, and what was sent.
    under_way: VecDeque<(Duration, u8)>,
    noise: Noise,
}

impl SerialLine {
    /// A line of a number of bits per second (0 counts as 1), with the bits of a character on the
    /// line: start, data, parity and stop.
    #[must_use]
    pub fn new(bits_per_second: u32, bits_per_character: u8, noise: Noise) -> Self {
        let second = Duration::from_secs(1);
        Self {
            character: second * u32::from(bits_per_character) / bits_per_second.max(1),
            under_way: VecDeque::new(),
            noise,
        }
    }

    /// Hands bytes to the transmitter, after those that it still has.
    pub fn send(&mut self, now: Duration, bytes: &[u8]) {
        for &byte in bytes {
            let last = self.under_way.back().map_or(now, |&(at, _)| at.max(now));
            self.under_way.push_back((last + self.character, byte));
        }
    }

    /// Drops what the transmitter has not begun to send.
    pub fn discard(&mut self, now: Duration) {
        let begun = now + self.character;
        self.under_way.retain(|&(at, _)| at < begun);
    }

    /// When the next character is at the other end.
    #[must_use]
    pub fn poll_timeout(&self) -> Option<Duration> {
        self.under_way.front().map(|&(at, _)| at)
    }

    /// What has arrived by now and was not received before.
    pub fn receive(&mut self, now: Duration) -> Vec<u8> {
        let mut arrived = Vec::new();
        while let Some(&(at, byte)) = self.under_way.front()
            && at <= now
        {
            self.under_way.pop_front();
            arrived.extend(self.noise.pass(&[byte]));
        }
        arrived
    }

    /// What happens to the bytes.
    #[must_use]
    pub const fn noise(&self) -> &Noise {
        &self.noise
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: u64 = 50;

    #[test]
    fn damage_keeps_its_distance() {
        for seed in 0..20 {
            let mut noise = Noise::new(seed, SPACING);
            let mut last = 0;
            for place in 1..20_000 {
                let before = noise.damaged();
                let arrived = noise.pass(&[0x41]);
                if noise.damaged() == before {
                    assert_eq!(arrived, [0x41]);
                    continue;
                }
                let flipped = |byte: u8| (byte ^ 0x41).is_power_of_two();
                assert!(
                    matches!(arrived[..], [] | [0x41, 0x41])
                        || arrived.len() == 1 && flipped(arrived[0]),
                    "{arrived:02X?}"
                );
                let sound = place - last - 1;
                assert!((SPACING..2 * SPACING).contains(&sound), "{sound}");
                last = place;
            }
            assert_eq!(noise.bytes(), 19_999);
        }
    }

    #[test]
    fn a_clean_line_changes_nothing() {
        let bytes: Vec<u8> = (0..=255).collect();
        let mut noise = Noise::new(1, 0);
        assert_eq!(noise.pass(&bytes), bytes);
        assert_eq!((noise.bytes(), noise.damaged()), (256, 0));
    }

    #[test]
    fn characters_follow_each_other() {
        let at = Duration::from_millis;
        // 10 ms a character.
        let mut line = SerialLine::new(1000, 10, Noise::new(1, 0));
        assert_eq!(line.poll_timeout(), None);
        line.send(at(0), b"ab");
        line.send(at(5), b"c");
        assert_eq!(line.receive(at(9)), []);
        assert_eq!(line.receive(at(25)), b"ab");
        // "c" is on the line, "d" and "e" are not.
        line.send(at(25), b"de");
        line.discard(at(25));
        assert_eq!(line.poll_timeout(), Some(at(30)));
        assert_eq!(line.receive(at(100)), b"c");
        line.send(at(100), b"f");
        assert_eq!(line.poll_timeout(), Some(at(110)));
        assert_eq!(line.noise().bytes(), 3);
    }
}
