//! Transmitter and receiver circuits on a wire that is simulated in steps.

use core::time::Duration;

use proto3964r::CharacterError;

use crate::steps::{STEPS_PER_SECOND, time};

/// Parity bit of a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::exhaustive_enums, reason = "a frame has these three")]
pub enum Parity {
    /// None: 8N1.
    None,
    /// Even: 8E1.
    Even,
    /// Odd: 8O1.
    Odd,
}

/// Baud rate and parity of a circuit: eight data bits, one stop bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame {
    /// Steps of a bit.
    bit: u32,
    parity: Parity,
}

/// A receiver looks at a bit in its middle, and must hit it with both its ends a quarter off.
const MIN_STEPS_OF_BIT: u32 = 4;

impl Frame {
    /// 9600 bit/s, even parity.
    pub const USUAL: Self = Self {
        bit: 16,
        parity: Parity::Even,
    };

    /// `None` for a rate that is not made of whole steps: 153600 bit/s over a whole number from 4
    /// on, as 1200, 2400, 4800, 9600, 19200 and 38400 bit/s are.
    #[must_use]
    pub fn new(baud: u32, parity: Parity) -> Option<Self> {
        let baud = u64::from(baud);
        let bit = STEPS_PER_SECOND.checked_div(baud)?;
        let bit = u32::try_from(bit).ok()?;
        let is_whole = u64::from(bit) * baud == STEPS_PER_SECOND;
        (is_whole && bit >= MIN_STEPS_OF_BIT).then_some(Self { bit, parity })
    }

    /// Bits of a character, with start and stop bit: 10 or 11.
    #[must_use]
    pub const fn bits(self) -> u8 {
        match self.parity {
            Parity::None => 10,
            Parity::Even | Parity::Odd => 11,
        }
    }

    fn steps(self) -> u32 {
        u32::from(self.bits()) * self.bit
    }

    /// Start, data, parity and stop bits, the first one lowest.
    fn of(self, byte: u8) -> u16 {
        let data = u16::from(byte) << 1;
        let is_odd = byte.count_ones() % 2 == 1;
        match self.parity {
            Parity::None => data | 1 << 9,
            Parity::Even => data | u16::from(is_odd) << 9 | 1 << 10,
            Parity::Odd => data | u16::from(!is_odd) << 9 | 1 << 10,
        }
    }
}

/// Sends one character after the other.
#[derive(Clone, Debug)]
pub(crate) struct Transmitter {
    frame: Frame,
    bits: u16,
    step: u32,
}

impl Transmitter {
    pub(crate) const fn new(frame: Frame) -> Self {
        Self {
            frame,
            bits: 0,
            step: u32::MAX,
        }
    }

    pub(crate) fn is_free(&self) -> bool {
        self.step >= self.frame.steps()
    }

    pub(crate) fn character(&self) -> Duration {
        time(u64::from(self.frame.steps()))
    }

    /// Begins with a character, of whose bits those of `flipped` are wrong, the start bit lowest.
    pub(crate) fn load(&mut self, byte: u8, flipped: u16) {
        self.bits = self.frame.of(byte) ^ flipped;
        self.step = 0;
    }

    /// The level of this step: high in idle.
    pub(crate) fn step(&mut self) -> bool {
        if self.is_free() {
            return true;
        }
        let bit = self.step / self.frame.bit;
        self.step += 1;
        self.bits >> bit & 1 == 1
    }
}

/// Looks for characters in a level.
#[derive(Clone, Debug)]
pub(crate) struct Receiver {
    frame: Frame,
    step: Option<u32>,
    bits: u16,
    /// High since the last character with a wrong stop bit.
    is_ready: bool,
}

/// A character that came in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Read {
    pub(crate) byte: u8,
    pub(crate) error: Option<CharacterError>,
}

impl Receiver {
    pub(crate) const fn new(frame: Frame) -> Self {
        Self {
            frame,
            step: None,
            bits: 0,
            is_ready: true,
        }
    }

    pub(crate) const fn is_idle(&self) -> bool {
        self.step.is_none() && self.is_ready
    }

    /// Takes the level of a step; a character, if it ended.
    pub(crate) fn step(&mut self, level: bool) -> Option<Read> {
        self.is_ready |= level;
        if self.step.is_none() && !level && self.is_ready {
            (self.step, self.bits) = (Some(0), 0);
        }
        let step = self.step?;
        let bit = step / self.frame.bit;
        self.step = Some(step + 1);
        if step % self.frame.bit != self.frame.bit / 2 {
            return None;
        }
        self.bits |= u16::from(level) << bit;
        if bit == 0 && level {
            self.step = None; // a spike
        }
        if bit + 1 < u32::from(self.frame.bits()) {
            return None;
        }
        self.step = None;
        self.is_ready = level;
        let [_, byte] = (self.bits >> 1).to_be_bytes();
        let error = if !level {
            Some(CharacterError::Framing)
        } else if self.bits != self.frame.of(byte) {
            Some(CharacterError::Parity)
        } else {
            None
        };
        Some(Read { byte, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Passed = Vec<(u8, Option<CharacterError>)>;

    fn pass(from: Frame, to: Frame, byte: u8, flipped: u16) -> Passed {
        let mut transmitter = Transmitter::new(from);
        let mut receiver = Receiver::new(to);
        transmitter.load(byte, flipped);
        let steps = 3 * from.steps().max(to.steps());
        (0..steps)
            .filter_map(|_| receiver.step(transmitter.step()))
            .map(|Read { byte, error }| (byte, error))
            .collect()
    }

    #[test]
    fn characters_arrive() {
        for baud in [1200, 2400, 4800, 9600, 19_200, 38_400] {
            for parity in [Parity::None, Parity::Even, Parity::Odd] {
                let frame = Frame::new(baud, parity).unwrap();
                for byte in 0..=255 {
                    assert_eq!(pass(frame, frame, byte, 0), [(byte, None)]);
                }
            }
        }
    }

    #[test]
    fn a_rate_must_fit_the_steps() {
        assert_eq!(Frame::new(9600, Parity::Even), Some(Frame::USUAL));
        for baud in [0, 9601, 57_600, 115_200, u32::MAX] {
            assert_eq!(Frame::new(baud, Parity::Even), None);
        }
    }

    #[test]
    fn parity_and_stop_bit_are_checked() {
        let even = Frame::USUAL;
        let odd = Frame::new(9600, Parity::Odd).unwrap();
        let (parity, framing) = (Some(CharacterError::Parity), Some(CharacterError::Framing));
        assert_eq!(pass(odd, even, 0x41, 0), [(0x41, parity)]);
        assert_eq!(pass(even, even, 0x41, 1 << 3), [(0x45, parity)]);
        assert_eq!(pass(even, even, 0x41, 1 << 10), [(0x41, framing)]);
        assert_eq!(pass(even, even, 0x41, 0b11 << 3), [(0x4D, None)]);
    }
}
