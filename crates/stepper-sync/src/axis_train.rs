//! The edges of one axis, spread over the time of a move.

use core::iter::FusedIterator;

use crate::edges::size_of_rest;

/// The distributed edges of one axis: an iterator of the intervals between them, in ticks.
///
/// ```text
/// edge k = floor(k D / m),  k = 1..m,  m = 2 n,  D = 2 n_max T
/// interval = q or q + 1,    q = floor(n_max T / n)
/// ```
/// The remainder of the division is carried from edge to edge as an integer, so the intervals sum
/// to exactly D and each edge is less than one tick early, never late.
///
/// This is the form for an interrupt handler: `next()` is a handful of integer instructions
/// without division, multiplication or panic. When the intervals pass the width of the counter,
/// cut each with [`Timer::periods`](crate::Timer::periods).
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct AxisTrain {
    edges_left: u32,
    pulses: u32,
    whole_ticks: u64,
    remainder: u32,
    // pulses - 1 - (k remainder mod pulses): the interval is long where this goes below zero.
    to_next_long: u32,
}

impl AxisTrain {
    /// `pulses` pulses over `half_ticks` ticks, made twice: edge k at floor(k `half_ticks` /
    /// `pulses`).
    #[expect(
        clippy::arithmetic_side_effects,
        clippy::cast_possible_truncation,
        reason = "once per move; the divisor is not zero; 2 pulses <= 2 i32::MAX; a remainder is \
                  below its divisor"
    )]
    pub(crate) fn new(pulses: u32, half_ticks: u64) -> Self {
        let (whole_ticks, remainder) = match core::num::NonZeroU64::new(u64::from(pulses)) {
            Some(divisor) => (half_ticks / divisor, half_ticks % divisor),
            None => (0, 0),
        };
        Self {
            edges_left: pulses * 2,
            pulses,
            whole_ticks,
            remainder: remainder as u32,
            to_next_long: pulses.saturating_sub(1),
        }
    }

    /// The shorter of the two intervals, floor(D / m), in ticks; 0 for an axis at rest.
    #[must_use]
    pub const fn shortest_ticks(&self) -> u64 {
        self.whole_ticks
    }

    /// The longer of the two intervals, ceil(D / m), in ticks; 0 for an axis at rest.
    #[must_use]
    pub fn longest_ticks(&self) -> u64 {
        self.whole_ticks.wrapping_add(u64::from(self.remainder > 0))
    }

    /// How many of all edges of the move come after the longer interval, D mod m.
    #[must_use]
    pub fn long_intervals(&self) -> u32 {
        // Below 2 pulses, which fits.
        self.remainder.wrapping_mul(2)
    }

    /// Edges still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.edges_left.into()
    }

    pub(crate) const fn pulses(&self) -> u32 {
        self.pulses
    }
}

impl Iterator for AxisTrain {
    type Item = u64;

    #[inline]
    fn next(&mut self) -> Option<u64> {
        self.edges_left = self.edges_left.checked_sub(1)?;
        let (to_next_long, long) = self.to_next_long.overflowing_sub(self.remainder);
        self.to_next_long = if long {
            to_next_long.wrapping_add(self.pulses)
        } else {
            to_next_long
        };
        Some(self.whole_ticks.wrapping_add(u64::from(long)))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl FusedIterator for AxisTrain {}
