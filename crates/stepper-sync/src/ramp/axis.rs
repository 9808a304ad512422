//! The edges of one axis of a ramp.

use super::fixed::{of_whole, whole, whole_up};
use crate::Edges;
use crate::edges::size_of_rest;
use core::iter::FusedIterator;

/// The edges of one axis of a [`Ramp`](crate::Ramp): an iterator of the intervals between them, in
/// ticks.
///
/// While the speed changes, x = floor(sqrt(c² + g k)) is carried with its exact remainder, and the
/// new root is found by Newton's rule from the last interval: as a rule one 64-bit division an edge.
/// At constant speed an edge costs an addition. No panic.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct AxisRamp {
    accel_left: u32,
    decel_left: u32,
    /// log2 of subticks per tick.
    shift: u32,
    last_ticks: u64,
    /// Last edge, in subticks.
    end: u64,
    start: u64,
    root: Root,
    cruise: Cruise,
}

/// How the speed changes at both ends; times in subticks.
pub(super) struct Slope {
    /// c: time from rest to the start rate.
    pub(super) start: u64,
    /// g: growth of the squared time per edge, fixed point.
    pub(super) growth: u128,
    /// Edges while speeding up.
    pub(super) edges: u32,
}

/// Edges at constant speed; times in subticks, fixed point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cruise {
    /// Time of the next edge.
    pub(super) next: u128,
    /// Interval.
    pub(super) period: u128,
    /// Edges still to come.
    pub(super) edges_left: u32,
}

impl AxisRamp {
    pub(super) fn new(end: u64, shift: u32, slope: &Slope, cruise: Cruise) -> Self {
        Self {
            accel_left: slope.edges,
            // One more than on the way up, where the start is no edge.
            decel_left: slope.edges.wrapping_add(1),
            shift,
            last_ticks: 0,
            end,
            start: slope.start,
            root: Root::new(slope.start, slope.growth),
            cruise,
        }
    }

    pub(super) const fn at_rest() -> Self {
        Self {
            accel_left: 0,
            decel_left: 0,
            shift: 0,
            last_ticks: 0,
            end: 0,
            start: 0,
            root: Root::new(0, 0),
            cruise: Cruise {
                next: 0,
                period: 0,
                edges_left: 0,
            },
        }
    }

    /// Subticks to ticks, to the nearest, halves up.
    pub(super) const fn to_ticks(subticks: u64, shift: u32) -> u64 {
        let half = (1 << shift) >> 1;
        subticks.wrapping_add(half) >> shift
    }

    /// Edges still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        // 2n in all, which fits 32 bits.
        self.accel_left
            .wrapping_add(self.cruise.edges_left)
            .wrapping_add(self.decel_left)
            .into()
    }

    /// Time of the next edge, in subticks.
    fn next_subticks(&mut self) -> Option<u64> {
        if let Some(left) = self.accel_left.checked_sub(1) {
            self.accel_left = left;
            self.root.up();
            Some(self.root.x.wrapping_sub(self.start))
        } else if let Some(left) = self.cruise.edges_left.checked_sub(1) {
            self.cruise.edges_left = left;
            let subticks = whole(self.cruise.next);
            self.cruise.next = self.cruise.next.wrapping_add(self.cruise.period);
            Some(subticks)
        } else {
            self.decel_left = self.decel_left.checked_sub(1)?;
            let to_go = self.root.x.wrapping_sub(self.start);
            if self.decel_left > 0 {
                self.root.down();
            }
            Some(self.end.wrapping_sub(to_go))
        }
    }
}

impl Iterator for AxisRamp {
    type Item = u64;

    #[inline]
    fn next(&mut self) -> Option<u64> {
        let ticks = Self::to_ticks(self.next_subticks()?, self.shift);
        let interval = ticks.wrapping_sub(self.last_ticks);
        self.last_ticks = ticks;
        Some(interval)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl FusedIterator for AxisRamp {}

impl<const N: usize> Edges<AxisRamp, N> {
    /// Edges still to come, over all axes.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.sum_of_rests(AxisRamp::remaining)
    }
}

/// x = floor(sqrt(u)) for u = c² + g k, k going up and down by one.
///
/// x <= 2^31 + 1, g < 2^63, and the last difference d <= 2^31 + 1, so that no sum below wraps.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Root {
    x: u64,
    /// u - x², fixed point: 0 <= rest < 2x + 1.
    rest: u128,
    /// g, fixed point.
    growth: u128,
    /// Last difference of x; the next one differs by at most 1 against the trend.
    d: u64,
}

impl Root {
    const fn new(x: u64, growth: u128) -> Self {
        Self {
            x,
            rest: 0,
            growth,
            // sqrt(c² + g) - c <= sqrt(g).
            d: whole_up(growth).isqrt(),
        }
    }

    /// u grows by g: x grows by the largest d with d (2x + d) <= rest + g.
    ///
    /// Newton's rule from above: each d = floor((d² + r) / 2(x + d)) is still not below the
    /// solution, and less than the one before while that is above it.
    fn up(&mut self) {
        let rest = self.rest.wrapping_add(self.growth);
        let r = whole(rest);
        let twice_x = self.x << 1;
        let mut d = self.d.wrapping_add(1);
        let mut square = d.wrapping_mul(twice_x.wrapping_add(d));
        while square > r {
            let slope = self.x.wrapping_add(d) << 1;
            let Some(next) = d.wrapping_mul(d).wrapping_add(r).checked_div(slope) else {
                break;
            };
            d = next;
            square = d.wrapping_mul(twice_x.wrapping_add(d));
        }
        self.rest = rest.wrapping_sub(of_whole(square));
        self.x = self.x.wrapping_add(d);
        self.d = d;
    }

    /// u shrinks by g: x shrinks by the smallest d with d (2x - d) >= g - rest.
    ///
    /// Newton's rule from below: each d = ceil((q - d²) / 2(x - d)) is still not above the
    /// solution, and more than the one before while that is below it.
    fn down(&mut self) {
        let missing = self.growth.saturating_sub(self.rest);
        let q = whole_up(missing);
        let twice_x = self.x << 1;
        let mut d = self.d.saturating_sub(1);
        let mut square = d.wrapping_mul(twice_x.wrapping_sub(d));
        while square < q {
            let slope = self.x.wrapping_sub(d) << 1;
            let above = q.wrapping_sub(d.wrapping_mul(d)).wrapping_add(slope);
            let Some(next) = above.wrapping_sub(1).checked_div(slope) else {
                break;
            };
            d = next;
            square = d.wrapping_mul(twice_x.wrapping_sub(d));
        }
        self.rest = self
            .rest
            .wrapping_add(of_whole(square))
            .wrapping_sub(self.growth);
        self.x = self.x.wrapping_sub(d);
        self.d = d;
    }
}
