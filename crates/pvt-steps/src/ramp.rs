//! Trapezoidal speed for rapid moves.

mod axis;
mod plan;
mod real;
mod rows;

pub use axis::AxisRamp;
pub use rows::RampRows;

use crate::{Direction, Edges, PvtKnot, Rate};
use plan::Plan;
use rows::AxisRows;
use thiserror::Error;

/// What the leading axis of a rapid move may do. One pulse is one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "written as a literal")]
pub struct RampLimits {
    /// Rate at which the motor starts and stops without a ramp, in mHz; 0 for a start from rest.
    pub start_millihertz: u32,
    /// Highest rate, in mHz.
    pub max_millihertz: u32,
    /// Acceleration and deceleration, in steps/s².
    pub accel_steps_per_s2: u32,
}

/// How fast the leading axis is at both ends of a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "written as a literal")]
pub struct RampEnds {
    /// Rate at the start, in mHz: that of the end of the move before, or what the motor starts
    /// with.
    pub entry_millihertz: u32,
    /// Rate at the end, in mHz.
    pub exit_millihertz: u32,
}

/// Why a ramp cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RampError {
    /// More steps than an edge counter holds.
    #[error("axis {axis}: {steps} steps, more than {limit} either way")]
    TooManySteps {
        /// Index of the axis.
        axis: usize,
        /// Steps asked for.
        steps: i32,
        /// Largest number of steps either way.
        limit: i32,
    },
    /// A highest rate of 0.
    #[error("the highest rate is 0 mHz")]
    ZeroMaxRate,
    /// An acceleration of 0.
    #[error("the acceleration is 0 steps/s²")]
    ZeroAcceleration,
    /// The start rate is above the highest rate.
    #[error("start rate {start_millihertz} mHz, above the highest rate {max_millihertz} mHz")]
    StartAboveMax {
        /// Start rate given, in mHz.
        start_millihertz: u32,
        /// Highest rate given, in mHz.
        max_millihertz: u32,
    },
    /// A rate at one of the ends is above the highest rate.
    #[error("{end_millihertz} mHz at an end, above the highest rate {max_millihertz} mHz")]
    EndAboveMax {
        /// Rate given, in mHz.
        end_millihertz: u32,
        /// Highest rate given, in mHz.
        max_millihertz: u32,
    },
    /// The move is too short for the change of the rate.
    #[error(
        "from {} to {} mHz in {steps} steps, fewer than the {needed} that it takes",
        ends.entry_millihertz,
        ends.exit_millihertz
    )]
    TooShort {
        /// Steps of the leading axis.
        steps: u32,
        /// Rates given.
        ends: RampEnds,
        /// Steps that the change takes.
        needed: u64,
    },
    /// The highest rate has less than two ticks between edges.
    #[error(
        "highest rate {max_millihertz} mHz, above the {limit_millihertz} mHz of 2 ticks an edge"
    )]
    RateTooHigh {
        /// Highest rate given, in mHz.
        max_millihertz: u32,
        /// A quarter of the tick rate, in mHz.
        limit_millihertz: u64,
    },
    /// Reaching the highest rate from rest would take more than 2^31 ticks.
    #[error(
        "acceleration {accel_steps_per_s2} steps/s², below the {limit_steps_per_s2} that reach \
         {max_millihertz} mHz in 2^31 ticks"
    )]
    AccelerationTooLow {
        /// Acceleration given, in steps/s².
        accel_steps_per_s2: u32,
        /// Least acceleration for this rate and timer, in steps/s².
        limit_steps_per_s2: u64,
        /// Highest rate given, in mHz.
        max_millihertz: u32,
    },
    /// A tick rate with too large a denominator.
    #[error("tick rate {}/{} Hz, denominator above {limit}", rate.numerator(), rate.denominator())]
    TickRate {
        /// Tick rate given.
        rate: Rate,
        /// Largest denominator.
        limit: u32,
    },
    /// The move lasts 2^61 ticks or more.
    #[error("{steps} steps last 2^{bits} ticks or more")]
    TooLong {
        /// Steps of the leading axis.
        steps: u32,
        /// log2 of the limit in ticks.
        bits: u32,
    },
}

/// A rapid move of N axes: trapezoidal speed of the leading axis, triangular when the move is too
/// short, the others in exact proportion, all ends on the same tick.
///
/// With n steps of the leading axis, rates v0 and v1 at the start and the end, highest rate v,
/// acceleration a and F ticks a second:
/// ```text
/// n a >= v² - (v0² + v1²)/2:  D = F (n/v + ((v - v0)² + (v - v1)²) / (2 v a))
/// otherwise:                  D = F (2 p - v0 - v1) / a,  p² = n a + (v0² + v1²)/2
/// ```
/// D and the times of speeding up and slowing down, F (v - v0)/a and F (v - v1)/a, are rounded to
/// whole ticks, in a trapezoid one at least for a change; the speed between them follows from the
/// distance, so that speed and acceleration are off by one part in as many as the move and its ramps
/// have ticks. These phases are the
/// [`rows`](Self::rows) of a PVT table, and the steps those of [`PvtSteps`](crate::PvtSteps): step
/// i where the axis passes i - 1/2 steps, less than 2 ticks and 2^-28 steps from its place on the
/// exact trapezoid.
///
/// Each pulse lasts nearly half of the shortest period: the last step of an axis comes half a step
/// before its end, which all axes reach at [`end_ticks`](Self::end_ticks).
///
/// # Examples
/// ```
/// use pvt_steps::{Ramp, RampLimits, Rate};
/// let limits = RampLimits {
///     start_millihertz: 0,
///     max_millihertz: 2_000_000,
///     accel_steps_per_s2: 10_000,
/// };
/// let ramp = Ramp::new([4000, -1500], &limits, Rate::from_hz(1_000_000)?)?;
/// // 4000 / 2000 + 2000 / 10,000 s.
/// assert_eq!(ramp.end_ticks(), 2_200_000);
/// assert_eq!(ramp.axes().map(|axis| axis.count()), [8000, 3000]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ramp<const N: usize> {
    plan: Plan,
    steps: [i32; N],
}

impl<const N: usize> Ramp<N> {
    /// A ramp for `steps` signed steps per axis, in ticks of `tick_rate`
    /// ([`Timer::tick_rate`](stepper_sync::Timer::tick_rate)), that starts and stops at the start
    /// rate.
    ///
    /// # Errors
    /// [`RampError`]: each variant names the value and its limit.
    pub fn new(steps: [i32; N], limits: &RampLimits, tick_rate: Rate) -> Result<Self, RampError> {
        let ends = RampEnds {
            entry_millihertz: limits.start_millihertz,
            exit_millihertz: limits.start_millihertz,
        };
        Self::between(steps, limits, ends, tick_rate)
    }

    /// The same between other rates: moves in one proportion join where one ends as fast as the
    /// next begins.
    ///
    /// # Errors
    /// [`RampError`]: each variant names the value and its limit.
    ///
    /// # Examples
    /// ```
    /// use pvt_steps::{Ramp, RampEnds, RampLimits, Rate};
    /// let limits = RampLimits {
    ///     start_millihertz: 0,
    ///     max_millihertz: 2_000_000,
    ///     accel_steps_per_s2: 10_000,
    /// };
    /// let ends = RampEnds { entry_millihertz: 0, exit_millihertz: 1_000_000 };
    /// // 50 steps in 0.1 s up to 1000 steps/s.
    /// let ramp = Ramp::between([50], &limits, ends, Rate::from_hz(1_000_000)?)?;
    /// assert_eq!(ramp.end_ticks(), 100_000);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn between(
        steps: [i32; N],
        limits: &RampLimits,
        ends: RampEnds,
        tick_rate: Rate,
    ) -> Result<Self, RampError> {
        if let Some(axis) = steps.iter().position(|&n| n == i32::MIN) {
            return Err(RampError::TooManySteps {
                axis,
                steps: i32::MIN,
                limit: i32::MAX,
            });
        }
        let most = steps.map(i32::unsigned_abs).into_iter().max().unwrap_or(0);
        let plan = Plan::new(most, limits, ends, tick_rate)?;
        Ok(Self { plan, steps })
    }

    /// The tick D at which every axis is at its end.
    #[must_use]
    pub const fn end_ticks(&self) -> u64 {
        self.plan.end_ticks()
    }

    /// The signed steps of each axis.
    #[must_use]
    pub const fn steps(&self) -> [i32; N] {
        self.steps
    }

    /// The level of each direction pin, `None` for an axis at rest.
    #[must_use]
    pub fn directions(&self) -> [Option<Direction>; N] {
        self.steps.map(Direction::of)
    }

    /// Where the rows begin: at 0, with the rate of the start.
    #[must_use]
    pub fn start(&self) -> [PvtKnot; N] {
        self.steps
            .map(|steps| AxisRows::new(&self.plan, steps).knot())
    }

    /// The same move as rows of a PVT table.
    pub fn rows(&self) -> RampRows<N> {
        RampRows::new(self.steps.map(|steps| AxisRows::new(&self.plan, steps)))
    }

    /// One iterator of intervals per axis, each for its own timer and interrupt handler.
    pub fn axes(&self) -> [AxisRamp; N] {
        self.steps.map(|steps| {
            let rows = AxisRows::new(&self.plan, steps);
            AxisRamp::new(rows, self.plan.pulse_ticks, steps)
        })
    }

    /// The edges of all axes in time order, for one timer or a simulation.
    pub fn edges(&self) -> Edges<AxisRamp, N> {
        Edges::new(self.axes())
    }
}
