//! Digital differential analyser: all axes on one clock.

use super::{AxesError, check, direction};
use crate::Direction;
use crate::line::size_of_rest;
use core::iter::FusedIterator;

/// A line of N axes on a common clock, by remainders: a digital differential analyser.
///
/// ```text
/// after tick k of K, axis i has made round(k n_i / K) steps, halves up
/// ```
/// Each axis is within half a step of its point of the line at every tick. With as many ticks as
/// the longest axis has steps, this is Bresenham's line for N axes: at most sqrt(N - 1)/2 steps off
/// the line.
///
/// # Examples
/// ```
/// use pulse_interp::Dda;
/// let dda = Dda::new([3, -1])?;
/// assert!(dda.ticks().eq([[1, 0], [1, -1], [1, 0]]));
/// // Slower than the longest axis.
/// assert_eq!(Dda::over([3, -1], 8)?.ticks().count(), 8);
/// # Ok::<(), pulse_interp::AxesError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Dda<const N: usize> {
    to: [i32; N],
    /// Not negative.
    ticks: i32,
}

impl<const N: usize> Dda<N> {
    /// The line to `to`, in steps from where the axes stand, in the fewest ticks.
    ///
    /// # Errors
    /// [`AxesError::TooLong`] for -2^31.
    pub fn new(to: [i32; N]) -> Result<Self, AxesError> {
        check(&to)?;
        let ticks = longest(&to);
        Ok(Self { to, ticks })
    }

    /// The line to `to` in `ticks` ticks, at least as many as the longest axis has steps.
    ///
    /// # Errors
    /// [`AxesError`].
    pub fn over(to: [i32; N], ticks: u32) -> Result<Self, AxesError> {
        check(&to)?;
        let least = longest(&to);
        match i32::try_from(ticks) {
            Ok(ticks) if ticks >= least => Ok(Self { to, ticks }),
            _ => Err(AxesError::Ticks {
                ticks,
                least: least.unsigned_abs(),
                limit: i32::MAX.unsigned_abs(),
            }),
        }
    }

    /// The end, in steps from the start.
    #[must_use]
    pub const fn to(&self) -> [i32; N] {
        self.to
    }

    /// What each axis does at each tick: -1, 0 or 1 step.
    pub fn ticks(&self) -> DdaTicks<N> {
        let ticks = self.ticks;
        DdaTicks {
            left: ticks.unsigned_abs(),
            ticks,
            axes: self.to.map(|steps| Axis {
                // A half is rounded up.
                credit: ticks.saturating_sub(1) >> 1,
                len: steps.wrapping_abs(),
                step: match direction(steps) {
                    Direction::Positive => 1,
                    Direction::Negative => -1,
                },
            }),
        }
    }
}

/// Steps of the longest of axes that are checked; 0 without axes.
fn longest(to: &[i32]) -> i32 {
    to.iter()
        .fold(0, |most, steps| steps.wrapping_abs().max(most))
}

/// The ticks of a [`Dda`]: an iterator of the steps of all axes.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct DdaTicks<const N: usize> {
    left: u32,
    ticks: i32,
    axes: [Axis; N],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Axis {
    // 0 <= credit < ticks between ticks, 0 <= len <= ticks.
    credit: i32,
    len: i32,
    step: i8,
}

impl<const N: usize> DdaTicks<N> {
    /// Ticks still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.left.into()
    }
}

impl<const N: usize> Iterator for DdaTicks<N> {
    type Item = [i8; N];

    #[inline]
    fn next(&mut self) -> Option<[i8; N]> {
        self.left = self.left.checked_sub(1)?;
        let mut steps = [0; N];
        for (axis, step) in self.axes.iter_mut().zip(&mut steps) {
            axis.credit = axis.credit.wrapping_sub(axis.len);
            if axis.credit < 0 {
                axis.credit = axis.credit.wrapping_add(self.ticks);
                *step = axis.step;
            }
        }
        Some(steps)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl<const N: usize> FusedIterator for DdaTicks<N> {}
