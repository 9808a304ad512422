//! The laws of accumulators, and the mean speeds that come of them.

use super::{Accumulators, MAX_THRESHOLD, MIN_THRESHOLD};
use crate::Rate;
use thiserror::Error;

/// What becomes of an accumulator that has passed its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SpeedLaw {
    /// It returns to 0, as in \[Dancer\]: the overshoot is lost, and with it up to 16 % of the
    /// speed at a threshold of 600. Only some speeds are distinct.
    Reset,
    /// It keeps what it has beyond the threshold: speeds are exact. It gathers magnitudes, so what
    /// one direction has gathered counts for the other after a reversal.
    CarryMagnitude,
    /// It gathers signed speeds and keeps the rest: speeds are exact, and
    /// `threshold · position + accumulator` is the sum of all speeds, whatever the reversals.
    CarrySigned,
}

/// Why accumulators are refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum AccumulatorError {
    /// The highest speed would need more than one step per tick.
    #[error(
        "a threshold of {threshold} would need more than one step per tick at a speed of -128; \
         the least is {limit}"
    )]
    ThresholdTooLow {
        /// Threshold given.
        threshold: u16,
        /// Lowest threshold.
        limit: u16,
    },
    /// The sum of accumulator and speed would not fit 16 bits.
    #[error(
        "a threshold of {threshold} does not leave a speed room in 16 bits; the most is {limit}"
    )]
    ThresholdTooHigh {
        /// Threshold given.
        threshold: u16,
        /// Highest threshold.
        limit: u16,
    },
}

/// How speeds become steps: law, threshold and tick; what mean speeds come of it, and how far they
/// are off.
///
/// # Examples
/// ```
/// use motor_phases::{Accumulation, Rate, SpeedLaw};
/// let tick = Rate::from_hz(1000)?;
/// let paper = Accumulation::new(SpeedLaw::Reset, 600, tick)?;
/// // 119 should make a step in 5.04 ticks and makes one in 6.
/// assert_eq!(paper.steps_per_tick(119), 1.0 / 6.0);
/// assert_eq!(paper.error(119), -19.0 / 119.0);
/// let exact = Accumulation::new(SpeedLaw::CarrySigned, 600, tick)?;
/// assert_eq!(exact.millihertz(119), 198_333);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Accumulation {
    law: SpeedLaw,
    // Within 128..=32639.
    threshold: u16,
    tick_rate: Rate,
}

impl Accumulation {
    /// A law, the threshold at which a motor steps, and the ticks per second.
    ///
    /// \[Dancer\] has [`SpeedLaw::Reset`], 600 and 1000 Hz.
    ///
    /// # Errors
    /// [`AccumulatorError::ThresholdTooLow`] below 128, where a speed of -128 would need more than
    /// one step per tick; [`AccumulatorError::ThresholdTooHigh`] above 32,639.
    pub const fn new(
        law: SpeedLaw,
        threshold: u16,
        tick_rate: Rate,
    ) -> Result<Self, AccumulatorError> {
        if threshold < MIN_THRESHOLD {
            return Err(AccumulatorError::ThresholdTooLow {
                threshold,
                limit: MIN_THRESHOLD,
            });
        }
        if threshold > MAX_THRESHOLD {
            return Err(AccumulatorError::ThresholdTooHigh {
                threshold,
                limit: MAX_THRESHOLD,
            });
        }
        Ok(Self {
            law,
            threshold,
            tick_rate,
        })
    }

    /// The law.
    #[must_use]
    pub const fn law(&self) -> SpeedLaw {
        self.law
    }

    /// The threshold, in units of the speed.
    #[must_use]
    pub const fn threshold(&self) -> u16 {
        self.threshold
    }

    /// Ticks per second.
    #[must_use]
    pub const fn tick_rate(&self) -> Rate {
        self.tick_rate
    }

    /// Accumulators of N motors, empty and at rest.
    #[must_use]
    pub const fn motors<const N: usize>(&self) -> Accumulators<N> {
        Accumulators::new(self.law, self.threshold.cast_signed())
    }

    /// Mean steps per tick at a constant speed, with its sign.
    ///
    /// ```text
    /// reset         ±1 / ⌈threshold / |speed|⌉
    /// carry         speed / threshold
    /// ```
    /// In \[Dancer\] speeds are multiples of V0, 1/5 step per tick: V0 · speed / 120 is meant.
    #[must_use]
    pub fn steps_per_tick(&self, speed: i8) -> f64 {
        let (steps, ticks) = self.mean(speed);
        f64::from(steps) / f64::from(ticks)
    }

    /// By how much the mean speed is off `speed / threshold`, relative to it.
    ///
    /// ```text
    /// reset         threshold / (|speed| · ⌈threshold / |speed|⌉) - 1, never above 0
    /// carry         0
    /// ```
    /// 0 at rest.
    #[must_use]
    pub fn error(&self, speed: i8) -> f64 {
        match self.law {
            SpeedLaw::Reset if speed != 0 => {
                // At most threshold + |speed|: far below 2^31.
                let gathered =
                    u32::from(speed.unsigned_abs()).wrapping_mul(self.reset_ticks(speed));
                let lost = gathered.wrapping_sub(u32::from(self.threshold));
                0.0 - f64::from(lost) / f64::from(gathered)
            }
            _ => 0.0,
        }
    }

    /// Mean steps per second in millihertz, signed, to the nearest, halves up.
    #[must_use]
    pub fn millihertz(&self, speed: i8) -> i64 {
        let (steps, ticks) = self.mean(speed);
        // 2^7 * 2^32 * 2000 and 2^15 * 2^32 * 2 fit 64 bits.
        let denominator = i64::from(ticks).wrapping_mul(i64::from(self.tick_rate.denominator()));
        i64::from(steps)
            .wrapping_mul(i64::from(self.tick_rate.numerator()))
            .wrapping_mul(2000)
            .wrapping_add(denominator)
            .checked_div_euclid(denominator.wrapping_mul(2))
            .unwrap_or(0)
    }

    /// Steps in ticks, above 0.
    fn mean(&self, speed: i8) -> (i8, u32) {
        match self.law {
            SpeedLaw::Reset if speed != 0 => (speed.signum(), self.reset_ticks(speed)),
            _ => (speed, u32::from(self.threshold)),
        }
    }

    /// Ticks from step to step under [`SpeedLaw::Reset`]; 0 at rest.
    fn reset_ticks(&self, speed: i8) -> u32 {
        // Rounded up: 2^15 + 2^7 fits.
        u32::from(self.threshold)
            .wrapping_add(u32::from(speed.unsigned_abs()).saturating_sub(1))
            .checked_div(u32::from(speed.unsigned_abs()))
            .unwrap_or(0)
    }
}
