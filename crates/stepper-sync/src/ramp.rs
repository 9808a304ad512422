//! Trapezoidal speed for rapid moves.

mod axis;
mod fixed;
mod plan;

pub use axis::AxisRamp;

use crate::trains::most_pulses;
use crate::{Direction, Edges, Rate, TrainError};
use plan::Plan;
use thiserror::Error;

/// What the leading axis of a rapid move may do. One pulse is one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RampLimits {
    /// Rate at which the motor starts and stops without a ramp, in mHz; 0 for a start from rest.
    pub start_millihertz: u32,
    /// Highest rate, in mHz.
    pub max_millihertz: u32,
    /// Acceleration and deceleration, in steps/s².
    pub accel_steps_per_s2: u32,
}

/// Why a ramp cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RampError {
    /// A number of steps out of range.
    #[error(transparent)]
    Steps(#[from] TrainError),
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

/// A rapid move of N axes: trapezoidal speed of the leading axis, triangular when the way is too
/// short, the others in exact proportion, all ends on the same tick.
///
/// With n steps of the leading axis, start rate v0, highest rate v, acceleration a and F ticks a
/// second, edge k = 1..2n of the leading axis lies at s = k/2 steps, and
/// ```text
/// s_a = (v² - v0²) / 2a                                          way of one ramp
/// t(s) = F (sqrt(v0² + 2 a s) - v0) / a                          s <= min(s_a, n/2)
/// t(s) = F (s/v + (v - v0)² / (2 v a))                           s_a <= s <= n - s_a
/// t(s) = D - t(n - s)                                            otherwise
/// D = F (n/v + (v - v0)² / (v a))       for n >= 2 s_a           the whole move
/// D = 2 F (sqrt(v0² + a n) - v0) / a    otherwise
/// ```
/// Pulse i rises at s = i - 1/2 and falls at s = i. An axis with m steps makes its edges where the
/// leading axis, moving smoothly, would be at s = k n / 2m: the same formula with v0, v and a
/// scaled by m/n.
///
/// The square roots are exact integer roots, carried from edge to edge with their remainder, so
/// that nothing adds up. They are kept in subticks: 2^p to a tick, with the largest p <= 16 for
/// which F v / a is at most 2^31 subticks and D less than 2^61. Every edge is within half a tick
/// and two subticks of t(s), and the end within half a tick of D.
///
/// # Examples
/// ```
/// use stepper_sync::{Ramp, RampLimits, Rate};
/// let limits = RampLimits {
///     start_millihertz: 0,
///     max_millihertz: 2_000_000,
///     accel_steps_per_s2: 10_000,
/// };
/// let ramp = Ramp::new([4000, -1500], &limits, Rate::from_hz(1_000_000)?)?;
/// // 4000 / 2000 + 2000 / 10,000 s.
/// assert_eq!(ramp.end_ticks(), 2_200_000);
/// assert_eq!(ramp.axes().map(|axis| axis.sum::<u64>()), [2_200_000; 2]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ramp<const N: usize> {
    axes: [AxisRamp; N],
    steps: [i32; N],
    end_ticks: u64,
}

impl<const N: usize> Ramp<N> {
    /// A ramp for `steps` signed steps per axis, in ticks of `tick_rate`
    /// ([`Timer::tick_rate`](crate::Timer::tick_rate)).
    ///
    /// # Errors
    /// [`RampError`]: each variant names the value and its limit.
    pub fn new(steps: [i32; N], limits: &RampLimits, tick_rate: Rate) -> Result<Self, RampError> {
        let most = most_pulses(&steps)?;
        let plan = Plan::new(most, limits, tick_rate)?;
        Ok(Self {
            axes: steps.map(|n| plan.axis(n.unsigned_abs())),
            steps,
            end_ticks: plan.end_ticks(),
        })
    }

    /// The tick D at which every moving axis makes its last edge.
    #[must_use]
    pub const fn end_ticks(&self) -> u64 {
        self.end_ticks
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

    /// One iterator of intervals per axis, each for its own timer and interrupt handler.
    pub fn axes(&self) -> [AxisRamp; N] {
        self.axes.clone()
    }

    /// The edges of all axes in time order, for one timer or a simulation.
    pub fn edges(&self) -> Edges<AxisRamp, N> {
        Edges::new(self.axes())
    }
}
