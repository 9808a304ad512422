//! From positions and increments to whole steps.

use core::num::NonZeroU32;
use core::ops::RangeInclusive;
use thiserror::Error;
use trig_kernels::SixDigits;

/// Why a position has no number of steps.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ScaleError {
    /// Steps per unit that are zero, not finite or outside 1e-150..=1e150 either way.
    #[error(
        "{} steps per unit, not within 1e-150..=1e150 either way",
        SixDigits(*.steps_per_unit)
    )]
    Scale {
        /// Steps per unit given.
        steps_per_unit: f64,
    },
    /// A ratio with a zero.
    #[error("{steps} steps for {units} units: neither may be 0")]
    Ratio {
        /// Steps given.
        steps: i32,
        /// Units given.
        units: u32,
    },
    /// A position that is not finite.
    #[error("position {position} is not finite")]
    NotFinite {
        /// Position given.
        position: f64,
    },
    /// More steps than 31 bits hold.
    #[error(
        "position {} is {} steps, more than {limit} either way",
        SixDigits(*.position), SixDigits(*.steps)
    )]
    OutOfRange {
        /// Position given.
        position: f64,
        /// Its steps, before rounding.
        steps: f64,
        /// Largest number of steps.
        limit: i32,
    },
    /// An increment of more steps than 31 bits hold.
    #[error("increment of {units} units is {steps} steps, more than {limit} either way")]
    IncrementOutOfRange {
        /// Increment given.
        units: i32,
        /// Its steps.
        steps: i64,
        /// Largest number of steps.
        limit: i32,
    },
}

/// Steps per unit of one axis, for positions in floating point: the last float before the steps.
///
/// Round the absolute position, then take differences of whole steps
/// ([`Position::move_to`](crate::Position::move_to)); rounding each increment would drift.
///
/// # Examples
/// ```
/// use stepper_sync::StepScale;
/// // 0.75 deg a step behind a gear of 13:1, positions in degrees.
/// let scale = StepScale::new(13.0 / 0.75)?;
/// assert_eq!(scale.to_steps(1.0)?, 17);
/// assert_eq!(scale.to_steps(-90.0_f32)?, -1560);
/// # Ok::<(), stepper_sync::ScaleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "f64", into = "f64")
)]
pub struct StepScale {
    // Within `RANGE` either way: the position of every step is a normal number.
    steps_per_unit: f64,
}

/// Steps per unit.
const RANGE: RangeInclusive<f64> = 1e-150..=1e150;

impl StepScale {
    /// A scale from 1e-150 to 1e150 steps per unit; negative when the motor turns against the axis.
    ///
    /// # Errors
    /// [`ScaleError::Scale`] outside that range, for zero and NaN.
    pub fn new(steps_per_unit: f64) -> Result<Self, ScaleError> {
        if RANGE.contains(&steps_per_unit.abs()) {
            Ok(Self { steps_per_unit })
        } else {
            Err(ScaleError::Scale { steps_per_unit })
        }
    }

    /// The scale of a motor with `full_steps` a turn and `microsteps` in each of them, behind a
    /// gear of `gear` turns of the motor to one of its output, which moves the axis by
    /// `units_per_turn`: 2π for radians, 360 for degrees, the lead of a screw or the circumference
    /// of a pulley in mm.
    ///
    /// ```text
    /// full_steps · microsteps · gear / units_per_turn
    /// ```
    ///
    /// ```
    /// use core::f64::consts::TAU;
    /// use stepper_sync::StepScale;
    ///
    /// // 1.8 deg a step, sixteenths, a belt of 5:1, in radians; and a screw of 4 mm, in mm.
    /// let joint = StepScale::of_motor(200, 16, 5.0, TAU)?;
    /// let slide = StepScale::of_motor(200, 8, 1.0, 4.0)?;
    /// assert_eq!((joint.to_steps(TAU)?, slide.to_steps(0.01)?), (16_000, 4));
    /// # Ok::<(), stepper_sync::ScaleError>(())
    /// ```
    ///
    /// # Errors
    /// [`ScaleError::Scale`], as of [`new`](Self::new).
    pub fn of_motor(
        full_steps: u32,
        microsteps: u32,
        gear: f64,
        units_per_turn: f64,
    ) -> Result<Self, ScaleError> {
        Self::new(f64::from(full_steps) * f64::from(microsteps) * gear / units_per_turn)
    }

    /// Steps per unit.
    #[must_use]
    pub const fn steps_per_unit(self) -> f64 {
        self.steps_per_unit
    }

    /// The whole step nearest to an absolute position, halves away from zero.
    ///
    /// # Errors
    /// [`ScaleError::NotFinite`]; [`ScaleError::OutOfRange`] past ±(2^31 - 1) steps.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the whole part is wanted, and the range is checked"
    )]
    pub fn to_steps(self, position: impl Into<f64>) -> Result<i32, ScaleError> {
        let position = position.into();
        if !position.is_finite() {
            return Err(ScaleError::NotFinite { position });
        }
        let steps = position * self.steps_per_unit;
        let limit = i32::MAX;
        if steps.abs() >= f64::from(limit) + 0.5 {
            return Err(ScaleError::OutOfRange {
                position,
                steps,
                limit,
            });
        }
        // `f64::round` is not in `core`. The fraction is exact.
        let whole = steps as i32;
        let fraction = steps - f64::from(whole);
        let away = i32::from(fraction >= 0.5).wrapping_sub(i32::from(fraction <= -0.5));
        Ok(whole.wrapping_add(away))
    }

    /// The position of a whole step, in units.
    #[must_use]
    pub fn to_position(self, steps: i32) -> f64 {
        f64::from(steps) / self.steps_per_unit
    }
}

impl TryFrom<f64> for StepScale {
    type Error = ScaleError;

    fn try_from(steps_per_unit: f64) -> Result<Self, ScaleError> {
        Self::new(steps_per_unit)
    }
}

impl From<StepScale> for f64 {
    fn from(scale: StepScale) -> Self {
        scale.steps_per_unit
    }
}

/// Whole steps from integer increments in another unit, with the remainder carried.
///
/// ```text
/// steps so far = floor(units so far · steps / units + 1/2)
/// ```
/// Exact for any number of increments: an encoder's counts, micrometres, another axis' steps.
///
/// # Examples
/// ```
/// use stepper_sync::StepCarry;
/// // 100 steps/mm, increments of 3 um: 0.3 steps each.
/// let mut carry = StepCarry::new(100, 1000)?;
/// let steps: i32 = (0..1000).map(|_| carry.advance(3).unwrap_or(0)).sum();
/// assert_eq!(steps, 300);
/// # Ok::<(), stepper_sync::ScaleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StepCarry {
    steps: i32,
    units: NonZeroU32,
    // Below `units`.
    remainder: i64,
}

impl StepCarry {
    /// `steps` steps for every `units` units; negative when the motor turns against the axis.
    ///
    /// # Errors
    /// [`ScaleError::Ratio`] when either is 0.
    pub const fn new(steps: i32, units: u32) -> Result<Self, ScaleError> {
        match NonZeroU32::new(units) {
            Some(nonzero) if steps != 0 => Ok(Self {
                steps,
                units: nonzero,
                // A half, so that rounding down rounds to the nearest.
                remainder: (units >> 1) as i64,
            }),
            _ => Err(ScaleError::Ratio { steps, units }),
        }
    }

    /// Whole steps due after an increment of signed units.
    ///
    /// # Errors
    /// [`ScaleError::IncrementOutOfRange`] past ±(2^31 - 1) steps; nothing is carried then.
    pub fn advance(&mut self, units: i32) -> Result<i32, ScaleError> {
        // 2^31 * 2^31 + 2^32 fits 64 bits.
        let sum = i64::from(units)
            .wrapping_mul(i64::from(self.steps))
            .wrapping_add(self.remainder);
        let divisor = i64::from(self.units.get());
        let due = sum.checked_div_euclid(divisor).unwrap_or(0);
        let limit = i32::MAX;
        match i32::try_from(due) {
            Ok(steps) if steps != i32::MIN => {
                self.remainder = sum.checked_rem_euclid(divisor).unwrap_or(0);
                Ok(steps)
            }
            _ => Err(ScaleError::IncrementOutOfRange {
                units,
                steps: due,
                limit,
            }),
        }
    }
}
