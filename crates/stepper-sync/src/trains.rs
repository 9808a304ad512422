//! Pulse trains with different counts that end on the same tick.

use crate::{AxisTrain, Edges, Rounding, SingleReload};
use thiserror::Error;

/// Sense of rotation of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_enums,
    reason = "an axis turns one way or the other"
)]
pub enum Direction {
    /// Steps count up.
    Positive,
    /// Steps count down.
    Negative,
}

impl Direction {
    /// Direction of a signed number of steps; `None` for zero: the direction pin keeps its level.
    #[must_use]
    pub const fn of(steps: i32) -> Option<Self> {
        match steps {
            0 => None,
            1.. => Some(Self::Positive),
            _ => Some(Self::Negative),
        }
    }

    /// The other direction.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Positive => Self::Negative,
            Self::Negative => Self::Positive,
        }
    }
}

/// Why no trains can be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TrainError {
    /// A half period of no ticks.
    #[error("the half period is 0 ticks; at least 1 is needed")]
    ZeroHalfPeriod,
    /// More pulses than an edge counter holds.
    #[error("axis {axis}: {steps} steps, more than {limit} either way")]
    TooManySteps {
        /// Index of the axis.
        axis: usize,
        /// Steps asked for.
        steps: i32,
        /// Largest number of steps either way.
        limit: i32,
    },
    /// The move lasts longer than 64 bits of ticks hold.
    #[error(
        "{pulses} pulses with a half period of {half_period_ticks} ticks last 2^64 ticks or more"
    )]
    TooLong {
        /// Pulses of the leading axis.
        pulses: u32,
        /// Half period asked for, in ticks.
        half_period_ticks: u64,
    },
}

/// Pulse trains of N axes with different counts that all end on the same tick.
///
/// The axis with the most pulses, `n_max`, runs at the fixed half period T; the others are spread
/// over the same time:
/// ```text
/// D = 2 n_max T            n pulses are 2 n edges
/// edge k = floor(k D / 2n) k = 1..2n
/// ```
/// Integers only: the last edge of every moving axis is at D, and no edge is a whole tick away from
/// its ideal place. The first edge comes an interval after tick 0, at which the direction pins are
/// set. An axis with 0 steps does not start; when all are 0, nothing happens in no time. Steps go
/// up to ±(2^31 - 1), and D below 2^64 ticks, which half periods below 2^32 always keep.
/// Source: [Engraver 2000], with the rounding error distributed.
///
/// # Examples
/// ```
/// use stepper_sync::Trains;
/// // 30 and -7 pulses with a half period of 4096 ticks.
/// let trains = Trains::new([30, -7], 4096)?;
/// assert_eq!(trains.end_ticks(), 2 * 30 * 4096);
/// assert_eq!(trains.axes().map(|axis| axis.sum::<u64>()), [245_760, 245_760]);
/// # Ok::<(), stepper_sync::TrainError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trains<const N: usize> {
    axes: [AxisTrain; N],
    steps: [i32; N],
    end_ticks: u64,
}

impl<const N: usize> Trains<N> {
    /// Trains for `steps` signed steps per axis; the leading axis has `half_period_ticks` between
    /// its edges.
    ///
    /// # Errors
    /// [`TrainError::ZeroHalfPeriod`]; [`TrainError::TooManySteps`] for `i32::MIN`;
    /// [`TrainError::TooLong`] where D does not fit 64 bits.
    ///
    /// # Examples
    /// ```
    /// use stepper_sync::{Rate, Timer, Trains};
    /// let timer = Timer::mcs51_mode1(11_059_200)?;
    /// let half_period = timer.half_period(Rate::from_millihertz(112_800)?)?;
    /// let trains = Trains::new([30, -7], half_period.nearest())?;
    /// assert_eq!(trains.end_ticks(), 2 * 30 * 4085);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn new(steps: [i32; N], half_period_ticks: u64) -> Result<Self, TrainError> {
        if half_period_ticks == 0 {
            return Err(TrainError::ZeroHalfPeriod);
        }
        let pulses = max_pulses(&steps)?;
        let half_ticks = u64::from(pulses).checked_mul(half_period_ticks);
        let ends = half_ticks.and_then(|half| Some((half, half.checked_mul(2)?)));
        let (half_ticks, end_ticks) = ends.ok_or(TrainError::TooLong {
            pulses,
            half_period_ticks,
        })?;
        Ok(Self {
            axes: steps.map(|n| AxisTrain::new(n.unsigned_abs(), half_ticks)),
            steps,
            end_ticks,
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
    pub fn axes(&self) -> [AxisTrain; N] {
        self.axes.clone()
    }

    /// The edges of all axes in time order, for one timer or a simulation.
    pub fn edges(&self) -> Edges<AxisTrain, N> {
        Edges::new(self.axes())
    }

    /// What each axis would do with one fixed reload for all its edges, as [Engraver 2000] has it.
    pub fn single_reload(&self, rounding: Rounding) -> [SingleReload; N] {
        self.axes
            .each_ref()
            .map(|axis| SingleReload::new(axis, self.end_ticks, rounding))
    }
}

impl<const N: usize> Edges<AxisTrain, N> {
    /// Edges still to come, over all axes.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.sum_of_rests(AxisTrain::remaining)
    }
}

/// The largest number of pulses of any axis.
fn max_pulses<const N: usize>(steps: &[i32; N]) -> Result<u32, TrainError> {
    let mut most = 0;
    for (axis, &n) in steps.iter().enumerate() {
        if n == i32::MIN {
            return Err(TrainError::TooManySteps {
                axis,
                steps: n,
                limit: i32::MAX,
            });
        }
        most = most.max(n.unsigned_abs());
    }
    Ok(most)
}
