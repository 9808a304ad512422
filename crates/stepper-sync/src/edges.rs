//! Edges of N axes in time order.

use core::iter::FusedIterator;

/// Pin level after an edge. The first edge of a pulse is [`High`](Self::High): it is the step.
///
/// For a driver whose step input is active low, exchange the two at the pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a pin has two levels")]
pub enum Level {
    /// The pulse begins: the motor makes its step.
    High,
    /// The pulse ends.
    Low,
}

/// One toggle of one step pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Edge {
    /// Time since the start of the move, in timer ticks.
    pub ticks: u64,
    /// Index of the axis, as in the array of steps.
    pub axis: usize,
    /// Level of the pin after this edge.
    pub level: Level,
}

/// Head of one axis that has no edge left. No edge falls there: every move ends on an even tick
/// or below 2^62.
const NEVER: u64 = u64::MAX;

/// An axis and its next edge, taken out already.
#[derive(Clone, Debug)]
struct Head<A> {
    axis: A,
    ticks: u64,
    level: Level,
}

impl<A: Iterator<Item = u64>> Head<A> {
    fn new(mut axis: A) -> Self {
        let ticks = axis.next().unwrap_or(NEVER);
        Self {
            axis,
            ticks,
            level: Level::High,
        }
    }

    #[inline]
    fn advance(&mut self) {
        self.ticks = match self.axis.next() {
            Some(interval) => self.ticks.wrapping_add(interval),
            None => NEVER,
        };
        self.level = match self.level {
            Level::High => Level::Low,
            Level::Low => Level::High,
        };
    }
}

/// Iterator of the edges of N axes in time order; edges of the same tick come in axis order.
///
/// `A` yields the intervals of one axis in ticks, the first one counted from the start of the
/// move: [`AxisTrain`](crate::AxisTrain), or a ramp of `pvt-steps`. Each edge costs a
/// comparison per axis and one interval; nothing is stored but one head per axis.
#[derive(Clone, Debug)]
#[must_use = "iterators are lazy"]
pub struct Edges<A, const N: usize> {
    heads: [Head<A>; N],
}

impl<A: Iterator<Item = u64>, const N: usize> Edges<A, N> {
    /// Merges the interval iterators of N axes.
    ///
    /// The sum of one axis' intervals must stay below 2^64 - 1, as it does for all trains.
    pub fn new(axes: [A; N]) -> Self {
        Self {
            heads: axes.map(Head::new),
        }
    }

    /// The edges of the heads, and what their axes have left.
    pub(crate) fn sum_of_rests(&self, rest: impl Fn(&A) -> u64) -> u64 {
        self.heads.iter().fold(0_u64, |sum, head| {
            sum.saturating_add(rest(&head.axis))
                .saturating_add(u64::from(head.ticks != NEVER))
        })
    }
}

impl<A: Iterator<Item = u64>, const N: usize> Iterator for Edges<A, N> {
    type Item = Edge;

    #[inline]
    fn next(&mut self) -> Option<Edge> {
        let mut first = NEVER;
        let mut axis = 0;
        for (index, head) in self.heads.iter().enumerate() {
            if head.ticks < first {
                first = head.ticks;
                axis = index;
            }
        }
        if first == NEVER {
            return None;
        }
        let head = self.heads.get_mut(axis)?;
        let edge = Edge {
            ticks: first,
            axis,
            level: head.level,
        };
        head.advance();
        Some(edge)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let none = (0_usize, Some(0_usize));
        self.heads.iter().fold(none, |(min, max), head| {
            let (more_min, more_max) = head.axis.size_hint();
            let own = usize::from(head.ticks != NEVER);
            let max = max.zip(more_max);
            (
                min.saturating_add(more_min).saturating_add(own),
                max.and_then(|(max, more)| max.checked_add(more)?.checked_add(own)),
            )
        })
    }
}

impl<A: Iterator<Item = u64>, const N: usize> FusedIterator for Edges<A, N> {}

/// The size hint of an iterator with `left` items: exact wherever `usize` holds it.
pub(crate) fn size_of_rest(left: u64) -> (usize, Option<usize>) {
    match usize::try_from(left) {
        Ok(left) => (left, Some(left)),
        Err(_) => (usize::MAX, None),
    }
}
