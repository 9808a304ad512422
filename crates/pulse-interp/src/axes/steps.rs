//! One axis at a time.

use super::{AxisStep, direction};
use crate::Direction;
use crate::line::size_of_rest;
use core::iter::FusedIterator;

/// The steps of an [`AxesLine`](super::AxesLine): an iterator of [`AxisStep`]s.
///
/// Comparisons and additions only, N² of each a step at most.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct AxesSteps<const N: usize> {
    left: u64,
    axes: [Axis<N>; N],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Axis<const N: usize> {
    // (2 p + 1) n_j - (2 p_j + 1) n for each axis j: each product is below 2^63.
    against: [i64; N],
    // 2 n.
    twice: i64,
    direction: Direction,
}

impl<const N: usize> AxesSteps<N> {
    pub(super) fn new(to: [i32; N]) -> Self {
        let lengths = to.map(|steps| i64::from(steps.unsigned_abs()));
        Self {
            // At most 2^31 each, of as many as fit memory.
            left: lengths
                .iter()
                .fold(0, |sum: u64, n| sum.wrapping_add(n.unsigned_abs())),
            axes: to.map(|steps| {
                let n = i64::from(steps.unsigned_abs());
                Axis {
                    against: lengths.map(|other| other.wrapping_sub(n)),
                    twice: n.wrapping_mul(2),
                    direction: direction(steps),
                }
            }),
        }
    }

    /// Steps still to come.
    #[must_use]
    pub const fn remaining(&self) -> u64 {
        self.left
    }
}

impl<const N: usize> Iterator for AxesSteps<N> {
    type Item = AxisStep;

    #[inline]
    fn next(&mut self) -> Option<AxisStep> {
        self.left = self.left.checked_sub(1)?;
        // An axis with all its steps made is at a fraction above 1, after each that has some left.
        let is_next = |axis: &Axis<N>| axis.against.iter().all(|f| *f <= 0);
        let next = self.axes.iter().position(is_next)?;
        let twice = self.axes.map(|axis| axis.twice);
        let stepping = self.axes.get_mut(next)?;
        let direction = stepping.direction;
        for (f, twice) in stepping.against.iter_mut().zip(twice) {
            *f = f.wrapping_add(twice);
        }
        for axis in &mut self.axes {
            if let Some(f) = axis.against.get_mut(next) {
                *f = f.wrapping_sub(axis.twice);
            }
        }
        Some(AxisStep {
            axis: next,
            direction,
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.left)
    }
}

impl<const N: usize> FusedIterator for AxesSteps<N> {}
