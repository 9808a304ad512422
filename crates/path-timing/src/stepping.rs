//! From a knot to the next: what a [`LookAhead`](crate::LookAhead) and a
//! [`Playback`](crate::Playback) do at each row, whatever limits the speeds at both.

use crate::knot::{SegmentTool, ToolTimes};
use crate::passes::time_of;
use crate::reciprocals::Reciprocals;
use crate::segment::Segment;
use crate::{Axes, Knot, passes};

/// The speeds that a segment can be run with, w₀ at its start and w₁ at its end. Where a pair
/// holds, each slower one of the same ratio does.
pub(crate) trait Pair {
    /// The highest speed at the start, at most `cap`, from which the rest can be run, with the one
    /// at the end that goes with it, at most `ceiling`.
    fn begin(&self, ceiling: f64, cap: f64) -> (f64, f64);
    /// The highest speed at the end, at most `ceiling`, after `w0`, where w₀ times `ratio` holds.
    fn end(&self, w0: f64, ceiling: f64, ratio: f64) -> f64;
    /// The speed at the end nearest to `wanted` after `w0`, where `known` holds.
    fn toward(&self, w0: f64, wanted: f64, known: f64) -> f64;
    /// The lowest speed at the end after `w0`, where `known` holds.
    fn slowest(&self, w0: f64, known: f64) -> f64;
    fn holds(&self, w0: f64, w1: f64) -> bool;
    /// The highest speed at the end after a rest.
    fn speed_from_rest(&self) -> f64;
    /// The highest speed at the start before a rest.
    fn speed_to_rest(&self) -> f64;
}

/// What limits speeds besides the limits of axes and tool.
pub(crate) trait Pairs<A: Axes> {
    type Pair: Pair;

    /// Of the segment between two knots.
    fn of(
        &self,
        limits: &Reciprocals<A>,
        knots: [&Knot<A>; 2],
        tool_times: ToolTimes,
    ) -> Self::Pair;

    /// The shortest time from rest to rest between two knots.
    fn rest_to_rest_s(
        &self,
        limits: &Reciprocals<A>,
        knots: [&Knot<A>; 2],
        tool: &SegmentTool,
    ) -> f64;
}

/// The limits of axes and tool alone.
pub(crate) struct OfAxes;

impl<A: Axes> Pairs<A> for OfAxes {
    type Pair = Segment<A>;

    fn of(
        &self,
        limits: &Reciprocals<A>,
        [from, to]: [&Knot<A>; 2],
        tool_times: ToolTimes,
    ) -> Segment<A> {
        Segment::new(limits, from, to, tool_times)
    }

    fn rest_to_rest_s(
        &self,
        limits: &Reciprocals<A>,
        knots: [&Knot<A>; 2],
        tool: &SegmentTool,
    ) -> f64 {
        passes::rest_to_rest_s(limits, knots, tool)
    }
}

impl<A: Axes> Pair for Segment<A> {
    fn begin(&self, ceiling: f64, cap: f64) -> (f64, f64) {
        Self::begin(self, ceiling, cap)
    }

    fn end(&self, w0: f64, ceiling: f64, ratio: f64) -> f64 {
        Self::end(self, w0, ceiling, ratio)
    }

    fn toward(&self, w0: f64, wanted: f64, known: f64) -> f64 {
        Self::toward(self, w0, wanted, known)
    }

    fn slowest(&self, w0: f64, known: f64) -> f64 {
        Self::slowest(self, w0, known)
    }

    fn holds(&self, w0: f64, w1: f64) -> bool {
        Self::holds(self, w0, w1)
    }

    fn speed_from_rest(&self) -> f64 {
        Self::speed_from_rest(self)
    }

    fn speed_to_rest(&self) -> f64 {
        Self::speed_to_rest(self)
    }
}

/// The segment to the next knot and the one after that.
pub(crate) struct Ahead<'a, S, L> {
    pub(crate) segment: &'a S,
    /// From the next knot on, where there is one: asked for by a hold alone.
    pub(crate) later: L,
    /// The highest speed at the next knot.
    pub(crate) ceiling: f64,
    /// A speed at the next knot that holds, as a ratio to the one here.
    pub(crate) ratio: f64,
    /// Of both segments.
    pub(crate) lengths: [f64; 2],
    /// Whether the next knot, too, may be gone to from rest.
    pub(crate) may_rest: bool,
}

/// How many times as slow as it may be from rest a knot is at which one rest more costs no time.
const SLOW: f64 = 4.0;

/// Whether the machine may go from rest to rest between two knots: where it was held at the last
/// before the end of a path, or a window ended there. Departures are bounded for that, and there the
/// next may be slow.
pub(crate) const fn may_rest<A: Axes>([from, to]: [&Knot<A>; 2]) -> bool {
    to.ends_leg && from.cap > 0.0
}

/// Whether the machine goes from rest to rest between two knots, since the next is so slow that this
/// takes less time: a sharp corner.
pub(crate) fn leads_to_rest<A: Axes>(
    limits: &Reciprocals<A>,
    [from, to]: [&Knot<A>; 2],
    tool_times: impl FnOnce() -> ToolTimes,
) -> bool {
    let from_rest = || Segment::new(limits, from, to, tool_times()).speed_from_rest();
    may_rest([from, to]) && to.ds > 0.0 && to.speed * SLOW < from_rest()
}

impl<S: Pair, L: Fn() -> Option<S>> Ahead<'_, S, L> {
    /// The speed at the next knot that is nearest to the wanted one.
    pub(crate) fn toward(&self, speed: f64, wanted: f64) -> f64 {
        if self.ceiling <= 0.0 {
            return 0.0;
        }
        let wanted = wanted.min(self.ceiling);
        if speed <= 0.0 {
            let highest = self.segment.speed_from_rest();
            let rests = self.may_rest && self.ceiling * SLOW < highest;
            return if rests { 0.0 } else { wanted.min(highest) };
        }
        self.segment.toward(speed, wanted, speed * self.ratio)
    }

    /// The speed at the next knot towards a rest there or at the one after it, whichever is sooner.
    pub(crate) fn hold(&self, speed: f64) -> f64 {
        if speed <= 0.0 || self.ceiling <= 0.0 {
            return 0.0;
        }
        let known = speed * self.ratio;
        let rest = (self.later)().map_or(0.0, |later| later.speed_to_rest());
        let highest = rest.min(self.ceiling);
        if self.segment.holds(speed, 0.0) {
            // Slow as it is, it would crawl to the knot.
            let faster = self.segment.end(speed, highest, self.ratio);
            return if self.rests_sooner(speed, faster) {
                faster
            } else {
                0.0
            };
        }
        let nearest = self.segment.slowest(speed, known);
        // Braking as hard as it can before, it would crawl to the knot after it.
        let highest = highest.min(speed);
        if highest > nearest && self.segment.holds(speed, highest) {
            highest
        } else {
            nearest
        }
    }

    /// Whether it is sooner at rest at the knot after the next, with a speed at the next.
    fn rests_sooner(&self, speed: f64, next: f64) -> bool {
        let [first, last] = self.lengths;
        let after_next_s = time_of(first, [speed, next]) + time_of(last, [next, 0.0]);
        after_next_s < time_of(first, [speed, 0.0])
    }
}
