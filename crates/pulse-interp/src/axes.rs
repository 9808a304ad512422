//! Lines of any number of axes.

mod dda;
mod steps;

pub use dda::{Dda, DdaTicks};
pub use steps::AxesSteps;

use crate::Direction;
use crate::line::first_too_long;
use thiserror::Error;

/// Why a line of several axes is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum AxesError {
    /// -2^31 has no positive counterpart.
    #[error("axis {axis}: {steps} steps, more than {limit} either way")]
    TooLong {
        /// Index of the axis.
        axis: usize,
        /// Steps asked for.
        steps: i32,
        /// Largest number of steps either way.
        limit: i32,
    },
    /// Fewer ticks than the longest axis has steps, or more than 2^31 - 1.
    #[error("{ticks} ticks, not within {least}..={limit}")]
    Ticks {
        /// Ticks asked for.
        ticks: u32,
        /// The fewest: the steps of the longest axis.
        least: u32,
        /// The most.
        limit: u32,
    },
}

/// A step of one of several axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "an axis and its direction")]
pub struct AxisStep {
    /// Index of the axis.
    pub axis: usize,
    /// The direction of the step.
    pub direction: Direction,
}

/// A line of N axes, one of which steps at a time: the nearest rule for each pair of axes.
///
/// ```text
/// axis i makes its step p + 1 at the fraction (2 p + 1) / (2 n_i) of the line
/// before axis j where F_ij = (2 p_i + 1) n_j - (2 p_j + 1) n_i <= 0
/// ```
/// Whenever an axis steps, every axis is within half a step of its point at that fraction, so the
/// path is at most sqrt(N)/2 steps off the line: 0.7071 in a plane, where it is [`Line`]'s by
/// [`Rule::Nearest`], and 0.8661 in space.
///
/// [`Line`]: crate::Line
/// [`Rule::Nearest`]: crate::Rule::Nearest
///
/// # Examples
/// ```
/// use pulse_interp::AxesLine;
/// let line = AxesLine::new([4, -2, 1])?;
/// let axes = line.steps().map(|step| step.axis);
/// assert!(axes.eq([0, 1, 0, 2, 0, 1, 0]));
/// # Ok::<(), pulse_interp::AxesError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AxesLine<const N: usize> {
    to: [i32; N],
}

impl<const N: usize> AxesLine<N> {
    /// The line to `to`, in steps from where the axes stand.
    ///
    /// # Errors
    /// [`AxesError::TooLong`] for -2^31.
    pub fn new(to: [i32; N]) -> Result<Self, AxesError> {
        check(&to)?;
        Ok(Self { to })
    }

    /// The end, in steps from the start.
    #[must_use]
    pub const fn to(&self) -> [i32; N] {
        self.to
    }

    /// The steps, one axis at a time, as many as all axes have together.
    pub fn steps(&self) -> AxesSteps<N> {
        AxesSteps::new(self.to)
    }
}

fn check(to: &[i32]) -> Result<(), AxesError> {
    match first_too_long(to) {
        Some((axis, steps)) => Err(AxesError::TooLong {
            axis,
            steps,
            limit: i32::MAX,
        }),
        None => Ok(()),
    }
}

/// The direction of an axis with these steps.
const fn direction(steps: i32) -> Direction {
    if steps < 0 {
        Direction::Negative
    } else {
        Direction::Positive
    }
}
