//! The closed loop on a scale.

use crate::Direction;
use core::num::NonZeroU16;
use thiserror::Error;

/// Why settings of a closed loop are refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LoopError {
    /// A ratio with a 0.
    #[error("{counts} counts per {steps} steps: neither may be 0")]
    Ratio {
        /// Counts given.
        counts: u16,
        /// Steps given.
        steps: u16,
    },
    /// A dead band that is not below the alarm.
    #[error("a dead band of {dead_band_counts} counts is not below the alarm at {alarm_counts}")]
    DeadBand {
        /// The dead band given, in counts.
        dead_band_counts: u32,
        /// The alarm given, in counts.
        alarm_counts: u32,
    },
}

/// How many counts of a scale a number of steps is, as a fraction.
///
/// # Examples
/// ```
/// use pulse_interp::ScaleRatio;
/// // 500 counts/mm and 100 steps/mm.
/// let ratio = ScaleRatio::new(5, 1)?;
/// # assert_eq!((ratio.counts(), ratio.steps()), (5, 1));
/// # Ok::<(), pulse_interp::LoopError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "(u16, u16)", into = "(u16, u16)")
)]
pub struct ScaleRatio {
    counts: NonZeroU16,
    steps: NonZeroU16,
}

impl ScaleRatio {
    /// `counts` counts per `steps` steps.
    ///
    /// # Errors
    /// [`LoopError::Ratio`] where either is 0.
    pub const fn new(counts: u16, steps: u16) -> Result<Self, LoopError> {
        match (NonZeroU16::new(counts), NonZeroU16::new(steps)) {
            (Some(counts), Some(steps)) => Ok(Self { counts, steps }),
            _ => Err(LoopError::Ratio { counts, steps }),
        }
    }

    /// Counts per [`steps`](Self::steps).
    #[must_use]
    pub const fn counts(self) -> u16 {
        self.counts.get()
    }

    /// Steps per [`counts`](Self::counts).
    #[must_use]
    pub const fn steps(self) -> u16 {
        self.steps.get()
    }
}

impl TryFrom<(u16, u16)> for ScaleRatio {
    type Error = LoopError;

    fn try_from((counts, steps): (u16, u16)) -> Result<Self, LoopError> {
        Self::new(counts, steps)
    }
}

impl From<ScaleRatio> for (u16, u16) {
    fn from(ratio: ScaleRatio) -> Self {
        (ratio.counts(), ratio.steps())
    }
}

/// Settings of an axis' closed loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_structs, reason = "every setting is needed")]
pub struct LoopSettings {
    /// Counts of the scale per step.
    pub ratio: ScaleRatio,
    /// An error of up to this many counts is left alone.
    pub dead_band_counts: u32,
    /// An error of more than this many counts is not corrected: the axis is lost.
    pub alarm_counts: u32,
}

/// The axis is further off than its alarm allows, or than an `i32` of steps corrects. It stays
/// refused until [`AxisLoop::reset`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error(
    "{error_counts} counts off at {counts} counts, {commanded_steps} steps: above the alarm at \
     {alarm_counts}"
)]
#[non_exhaustive]
pub struct LostSteps {
    /// Counts read less counts commanded, rounded towards 0.
    pub error_counts: i64,
    /// The counts read.
    pub counts: i32,
    /// The steps commanded.
    pub commanded_steps: i64,
    /// The alarm, in counts.
    pub alarm_counts: u32,
}

/// The closed loop of one axis: steps commanded against counts read.
///
/// ```text
/// error = counts - commanded * ratio
/// |error| <= dead band   nothing
/// |error| <= alarm       -error / ratio steps, to the nearest
/// else                   an alarm
/// ```
/// A state machine without a clock. Its corrections are steps of the motor, not of the path: they
/// are not commanded. After one, let the scale settle before the next check.
/// Source: \[Stage\], with a dead band of 3 counts at 5 counts per step.
///
/// # Examples
/// ```
/// use pulse_interp::{AxisLoop, Direction, LoopSettings, ScaleRatio};
/// let mut axis = AxisLoop::new(LoopSettings {
///     ratio: ScaleRatio::new(5, 1)?,
///     dead_band_counts: 3,
///     alarm_counts: 100,
/// })?;
/// for _ in 0..20 {
///     axis.command(Direction::Positive);
/// }
/// assert_eq!(axis.correction(98), Ok(0)); // 2 counts short
/// assert_eq!(axis.correction(90), Ok(2)); // two steps lost
/// assert!(axis.correction(-5).is_err());
/// # Ok::<(), pulse_interp::LoopError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AxisLoop {
    settings: LoopSettings,
    // One step at a time: no run is long enough to overflow it.
    commanded: i64,
    lost: bool,
}

impl AxisLoop {
    /// A loop of an axis at 0 steps and 0 counts.
    ///
    /// # Errors
    /// [`LoopError::DeadBand`] where the dead band is not below the alarm.
    pub const fn new(settings: LoopSettings) -> Result<Self, LoopError> {
        let LoopSettings {
            dead_band_counts,
            alarm_counts,
            ..
        } = settings;
        if dead_band_counts >= alarm_counts {
            return Err(LoopError::DeadBand {
                dead_band_counts,
                alarm_counts,
            });
        }
        Ok(Self {
            settings,
            commanded: 0,
            lost: false,
        })
    }

    /// Counts one step of the path.
    #[inline]
    pub fn command(&mut self, direction: Direction) {
        self.commanded = self.commanded.wrapping_add(i64::from(direction.sign()));
    }

    /// Sets the steps commanded so far, up less down, where they are counted elsewhere.
    pub const fn set_commanded(&mut self, steps: i64) {
        self.commanded = steps;
    }

    /// Steps commanded so far, up less down.
    #[must_use]
    pub const fn commanded_steps(&self) -> i64 {
        self.commanded
    }

    /// The steps that bring the axis back to where it was commanded, 0 within the dead band, where
    /// the scale reads `counts`.
    ///
    /// # Errors
    /// [`LostSteps`], and again at every further call.
    pub fn correction(&mut self, counts: i32) -> Result<i32, LostSteps> {
        let LoopSettings {
            ratio,
            dead_band_counts,
            alarm_counts,
        } = self.settings;
        let per = i128::from(ratio.counts());
        let scale = i128::from(ratio.steps());
        // In counts / scale, so that nothing is rounded: below 2^80.
        let error = i128::from(counts)
            .wrapping_mul(scale)
            .wrapping_sub(i128::from(self.commanded).wrapping_mul(per));
        let within = |limit: u32| error.abs() <= i128::from(limit).wrapping_mul(scale);
        let steps = if within(dead_band_counts) {
            Some(0)
        } else {
            i32::try_from(nearest(error.wrapping_neg(), per)).ok()
        };
        self.lost |= steps.is_none() || !within(alarm_counts);
        match steps {
            Some(steps) if !self.lost => Ok(steps),
            _ => Err(LostSteps {
                error_counts: whole_counts(error, scale),
                counts,
                commanded_steps: self.commanded,
                alarm_counts,
            }),
        }
    }

    /// Starts again at 0 steps and 0 counts, as after homing; ends an alarm.
    pub fn reset(&mut self) {
        (self.commanded, self.lost) = (0, false);
    }
}

/// The nearest whole quotient, halves away from 0.
fn nearest(numerator: i128, divisor: i128) -> i128 {
    let half = (divisor >> 1).wrapping_mul(numerator.signum());
    // The divisor is a ratio's counts, never 0.
    let rounded = numerator.wrapping_add(half).checked_div(divisor);
    rounded.unwrap_or(0)
}

fn whole_counts(error: i128, scale: i128) -> i64 {
    let counts = error.checked_div(scale).unwrap_or(0);
    // 2^63 steps of up to 2^16 counts do not fit; no axis has them.
    i64::try_from(counts).unwrap_or(if error < 0 { i64::MIN } else { i64::MAX })
}
