use thiserror::Error;

/// The highest speed of a plan. -128 is not used: its negative does not fit into a byte.
const MAX_SPEED: u8 = i8::MAX.unsigned_abs();

/// What the firmware does every tick with the speed v of a motor, its accumulator a and the
/// threshold L, 600 in \[Dancer\].
///
/// ```text
/// Reset            a += |v|   a >= L:   a = 0,    one half step in the direction of v
/// CarryMagnitude   a += |v|   a >= L:   a -= L,   the same
/// CarrySigned      a += v     |a| >= L: a -= ±L,  one half step in the direction of a
/// ```
/// `stepper-sync` has the same laws tick by tick, as `SpeedLaw`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Law {
    /// The law of the source. The overshoot is lost: at a threshold of 600 there are 44 distinct
    /// speeds, and 119 is 16 % slow.
    #[default]
    Reset,
    /// The overshoot is kept, whatever the direction.
    CarryMagnitude,
    /// The overshoot is kept with its sign.
    CarrySigned,
}

/// Where a motor is after frames, by the law of the firmware: for planning.
///
/// ```
/// use pattern_codec::dance::{Law, Motor, Timing};
///
/// let mut wheel = Motor::new(Law::Reset, 600, Timing::DEFAULT)?;
/// for _ in 0..25 {
///     wheel.run(60);
/// }
/// assert_eq!(wheel.position(), 500);
/// # Ok::<(), pattern_codec::dance::ThresholdTooLow>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Motor {
    law: Law,
    /// At least 128.
    threshold: u16,
    /// At least 1.
    frame_ticks: u32,
    /// At most 127.
    max_speed: u8,
    pub(super) position: i64,
    /// Below the threshold; under [`Law::CarrySigned`] above its negative.
    accumulator: i64,
}

/// A threshold at which the highest speed would need more than one half step per tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("a threshold of {threshold}, {} is the least", Motor::MIN_THRESHOLD)]
#[non_exhaustive]
pub struct ThresholdTooLow {
    /// The threshold.
    pub threshold: u16,
}

/// Threshold of the accumulators in \[Dancer\].
pub(super) const THRESHOLD: u16 = 600;

impl Motor {
    /// The least threshold: a speed of -128 then makes one half step in every tick.
    pub const MIN_THRESHOLD: u16 = 128;

    /// At position 0, with an empty accumulator.
    ///
    /// # Errors
    /// [`ThresholdTooLow`] below 128.
    pub const fn new(
        law: Law,
        threshold: u16,
        timing: super::Timing,
    ) -> Result<Self, ThresholdTooLow> {
        if threshold < Self::MIN_THRESHOLD {
            return Err(ThresholdTooLow { threshold });
        }
        Ok(Self {
            law,
            threshold,
            frame_ticks: timing.frame_ticks(),
            max_speed: MAX_SPEED,
            position: 0,
            accumulator: 0,
        })
    }

    /// With a lower highest speed for turns; above 127 it stays 127.
    #[must_use]
    pub const fn with_max_speed(self, max_speed: u8) -> Self {
        let max_speed = if max_speed < MAX_SPEED {
            max_speed
        } else {
            MAX_SPEED
        };
        Self { max_speed, ..self }
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

    pub(super) const fn law(&self) -> Law {
        self.law
    }

    pub(super) fn threshold(&self) -> i64 {
        self.threshold.into()
    }

    pub(super) fn frame_ticks(&self) -> i64 {
        self.frame_ticks.into()
    }

    /// What the accumulator holds already for half steps in a direction, 1 or -1.
    pub(super) const fn gathered(&self, direction: i64) -> i64 {
        match self.law {
            Law::Reset | Law::CarryMagnitude => self.accumulator,
            Law::CarrySigned => self.accumulator.saturating_mul(direction),
        }
    }

    /// One frame at a speed.
    pub fn run(&mut self, speed: i8) {
        let (steps, accumulator) = match self.law {
            Law::Reset => self.reset(speed),
            Law::CarryMagnitude => {
                let (steps, accumulator) = self.carry(i64::from(speed.unsigned_abs()));
                (steps.saturating_mul(speed.signum().into()), accumulator)
            }
            Law::CarrySigned => self.carry(speed.into()),
        };
        self.position = self.position.saturating_add(steps);
        self.accumulator = accumulator;
    }

    /// A frame without loss: half steps and what is left.
    fn carry(&self, speed: i64) -> (i64, i64) {
        // Below 2^7 * 2^32 + 2^16.
        let sum = speed
            .saturating_mul(self.frame_ticks())
            .saturating_add(self.accumulator);
        let steps = sum.checked_div(self.threshold()).unwrap_or(0);
        let left = sum.checked_rem(self.threshold()).unwrap_or(0);
        (steps, left)
    }

    /// A frame in which every half step empties the accumulator.
    fn reset(&self, speed: i8) -> (i64, i64) {
        let magnitude = i64::from(speed.unsigned_abs());
        let lacking = self.threshold().saturating_sub(self.accumulator);
        // Rounded up; at rest no step comes.
        let first = ticks(lacking, magnitude);
        let Some(rest) = first.and_then(|first| self.frame_ticks().checked_sub(first)) else {
            return (0, self.accumulator);
        };
        if rest < 0 {
            let gained = magnitude.saturating_mul(self.frame_ticks());
            return (0, self.accumulator.saturating_add(gained));
        }
        let period = ticks(self.threshold(), magnitude).unwrap_or(1);
        let more = rest.checked_div(period).unwrap_or(0);
        let left = rest.checked_rem(period).unwrap_or(0);
        let steps = more.saturating_add(1).saturating_mul(speed.signum().into());
        (steps, left.saturating_mul(magnitude))
    }
}

/// Ticks until a magnitude has gathered so much; `None` at rest.
pub(super) fn ticks(much: i64, magnitude: i64) -> Option<i64> {
    much.saturating_add(magnitude)
        .saturating_sub(1)
        .checked_div(magnitude)
}
