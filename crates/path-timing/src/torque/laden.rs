//! Pairs of speeds with which no motor gives more torque than it has, all along a segment.
//!
//! Goal: what a stream may be promised segment by segment. Method: the pairs of `passes`, whose
//! torques are within the limits at both ends; where the cubic between them asks for more, the pair
//! is slowed, or the speed at the end brought nearer to one that is known to hold.

use super::passes::{Pair as Ends, farthest};
use super::{Dynamics, TorqueLimits, slowed};
use crate::knot::{SegmentTool, ToolTimes};
use crate::knots::span;
use crate::number::larger_or_nan;
use crate::reciprocals::Reciprocals;
use crate::segment::GROWTH;
use crate::stepping::{Pair, Pairs};
use crate::{Knot, passes};

/// The parts of a speed at the end of a segment that are tried where it is too high for a motor.
const BRAKING: [f64; 8] = [0.999, 0.99, 0.97, 0.9, 0.75, 0.5, 0.25, 0.0];

/// What motors carry.
pub(super) struct Laden<'a, D: Dynamics>(pub(super) &'a TorqueLimits<D>);

impl<'a, D: Dynamics> Pairs<D::Axes> for Laden<'a, D> {
    type Pair = LadenPair<'a, D>;

    fn of(
        &self,
        limits: &Reciprocals<D::Axes>,
        [from, to]: [&Knot<D::Axes>; 2],
        tool_times: ToolTimes,
    ) -> LadenPair<'a, D> {
        LadenPair {
            ends: Ends::new(self.0, 1.0, limits, [from, to], tool_times),
            torque: self.0,
            knots: [*from, *to],
        }
    }

    fn rest_to_rest_s(
        &self,
        limits: &Reciprocals<D::Axes>,
        knots: [&Knot<D::Axes>; 2],
        tool: &SegmentTool,
    ) -> f64 {
        let own = passes::rest_to_rest_s(limits, knots, tool);
        let asked = |slowness: f64| self.0.utilisation(&span(knots, [0.0; 2], own * slowness));
        let speed = slowed(asked(1.0), |speed| asked(1.0 / speed));
        speed.map_or(f64::INFINITY, |speed| own / speed)
    }
}

/// A segment with the limits of its axes and motors.
pub(super) struct LadenPair<'a, D: Dynamics> {
    ends: Ends<'a, D::Axes>,
    torque: &'a TorqueLimits<D>,
    knots: [Knot<D::Axes>; 2],
}

impl<D: Dynamics> LadenPair<'_, D> {
    /// The largest part of a motor's torque on the cubic.
    fn asked(&self, speeds: [f64; 2]) -> f64 {
        let [from, to] = &self.knots;
        let duration_s = passes::time_of(to.ds, speeds);
        self.torque
            .utilisation(&span([from, to], speeds, duration_s))
    }

    /// The pair, or the fastest slower one of the same ratio that is found; at rest where there is
    /// none.
    fn whole(&self, (w0, w1): (f64, f64)) -> (f64, f64) {
        let asked = |speed: f64| {
            if w0 + w1 > 0.0 {
                self.asked([w0 * speed, w1 * speed])
            } else {
                0.0
            }
        };
        let speed = slowed(asked(1.0), asked).unwrap_or(0.0);
        (w0 * speed, w1 * speed)
    }

    /// The largest part of a limit that a pair takes anywhere on the segment.
    fn used(&self, w0: f64, w1: f64) -> f64 {
        larger_or_nan(self.ends.used(w0, w1), self.asked([w0, w1]))
    }

    /// The speed at the end nearest to `wanted` that is found, from one that holds.
    fn nearest(&self, w0: f64, wanted: f64, known: f64) -> f64 {
        let found = farthest(known, wanted, |w1| self.used(w0, w1));
        let is_between = (found - known).abs() > 0.0;
        if is_between || self.used(w0, known) <= 1.0 {
            return found;
        }
        // Slower than planned at a speed that a motor cannot hold: it brakes harder.
        let holds = |w1: &f64| self.used(w0, *w1) <= 1.0;
        let slower = BRAKING.iter().map(|part| known * part).find(holds);
        slower.map_or(known, |slower| {
            farthest(slower, known, |w1| self.used(w0, w1))
        })
    }
}

impl<D: Dynamics> Pair for LadenPair<'_, D> {
    fn begin(&self, ceiling: f64, cap: f64) -> (f64, f64) {
        let (w0, w1) = self.ends.begin(ceiling, cap);
        // What brakes as hard as it can brakes a little less, and is not slower as a whole.
        if w0 > w1 && w1 > 0.0 && self.used(w1, w1) <= 1.0 {
            return (farthest(w1, w0, |w0| self.used(w0, w1)), w1);
        }
        self.whole((w0, w1))
    }

    fn end(&self, w0: f64, ceiling: f64, ratio: f64) -> f64 {
        let highest = self.ends.end(w0, ceiling, ratio);
        self.nearest(w0, highest, (w0 * ratio).min(ceiling))
    }

    fn toward(&self, w0: f64, wanted: f64, known: f64) -> f64 {
        self.nearest(w0, wanted, known)
    }

    fn slowest(&self, w0: f64, known: f64) -> f64 {
        self.nearest(w0, (w0 / GROWTH).min(known), known)
    }

    fn holds(&self, w0: f64, w1: f64) -> bool {
        self.used(w0, w1) <= 1.0
    }

    fn speed_from_rest(&self) -> f64 {
        self.whole((0.0, self.ends.speed_from_rest())).1
    }

    fn speed_to_rest(&self) -> f64 {
        self.whole((self.ends.speed_to_rest(), 0.0)).0
    }
}
