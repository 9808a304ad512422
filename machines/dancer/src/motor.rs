//! Where a motor is after frames, by the law of the firmware: what plans count on.

use pattern_codec::dance::{Threshold, Timing};

use crate::law::Law;

/// The highest speed of a plan. -128 is not used: its negative does not fit into a byte.
const MAX_SPEED: u8 = i8::MAX.unsigned_abs();

/// Where a motor is after frames, by the law of the firmware: for planning.
///
/// ```
/// use dancer::{Law, Motor};
/// use pattern_codec::dance::{Threshold, Timing};
///
/// let mut wheel = Motor::new(Law::Reset, Threshold::DEFAULT, Timing::DEFAULT);
/// for _ in 0..25 {
///     wheel.run(60);
/// }
/// assert_eq!(wheel.position(), 500);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Motor {
    law: Law,
    threshold: Threshold,
    /// At least 1.
    frame_ticks: u32,
    /// At most 127.
    max_speed: u8,
    position: i64,
    /// Below the threshold; under [`Law::CarrySigned`] above its negative.
    accumulator: i64,
}

impl Motor {
    /// At position 0, with an empty accumulator.
    #[must_use]
    pub const fn new(law: Law, threshold: Threshold, timing: Timing) -> Self {
        Self {
            law,
            threshold,
            frame_ticks: timing.frame_ticks(),
            max_speed: MAX_SPEED,
            position: 0,
            accumulator: 0,
        }
    }

    /// With a lower highest speed for turns; above 127 it stays 127.
    #[must_use]
    pub fn with_max_speed(self, max_speed: u8) -> Self {
        Self {
            max_speed: max_speed.min(MAX_SPEED),
            ..self
        }
    }

    /// The highest speed of a turn.
    #[must_use]
    pub const fn max_speed(&self) -> u8 {
        self.max_speed
    }

    /// Half steps from the start.
    #[must_use]
    pub const fn position(&self) -> i64 {
        self.position
    }

    /// Position and accumulator: what frames change.
    pub(crate) const fn state(&self) -> (i64, i64) {
        (self.position, self.accumulator)
    }

    /// The same motor elsewhere.
    pub(crate) const fn with_state(self, (position, accumulator): (i64, i64)) -> Self {
        Self {
            position,
            accumulator,
            ..self
        }
    }

    pub(crate) const fn law(&self) -> Law {
        self.law
    }

    pub(crate) fn threshold(&self) -> i64 {
        self.threshold.get().into()
    }

    pub(crate) fn frame_ticks(&self) -> i64 {
        self.frame_ticks.into()
    }

    /// What the accumulator holds already for half steps in a direction, 1 or -1.
    pub(crate) const fn accumulated(&self, direction: i64) -> i64 {
        match self.law {
            Law::Reset | Law::CarryMagnitude => self.accumulator,
            Law::CarrySigned => self.accumulator * direction,
        }
    }

    /// One frame at a speed.
    pub fn run(&mut self, speed: i8) {
        let sign = i64::from(speed.signum());
        let magnitude = i64::from(speed.unsigned_abs());
        let (steps, accumulator) = match self.law {
            Law::Reset if speed == 0 => return,
            Law::Reset => {
                let (steps, left) = self.reset(magnitude);
                (steps * sign, left)
            }
            Law::CarryMagnitude => {
                let (steps, left) = self.carry(magnitude);
                (steps * sign, left)
            }
            Law::CarrySigned => self.carry(speed.into()),
        };
        self.position += steps;
        self.accumulator = accumulator;
    }

    /// A frame without loss: half steps and what is left.
    fn carry(&self, speed: i64) -> (i64, i64) {
        let sum = speed * self.frame_ticks() + self.accumulator;
        (sum / self.threshold(), sum % self.threshold())
    }

    /// A frame in which every half step empties the accumulator, at a speed above 0.
    fn reset(&self, magnitude: i64) -> (i64, i64) {
        let ticks = self.frame_ticks();
        let first = ticks_to(self.threshold() - self.accumulator, magnitude);
        if first > ticks {
            return (0, self.accumulator + magnitude * ticks);
        }
        let rest = ticks - first;
        let period = ticks_to(self.threshold(), magnitude);
        (rest / period + 1, rest % period * magnitude)
    }
}

/// Ticks until a magnitude above 0 has accumulated so much, rounded up.
pub(crate) const fn ticks_to(much: i64, magnitude: i64) -> i64 {
    (much + magnitude - 1) / magnitude
}
