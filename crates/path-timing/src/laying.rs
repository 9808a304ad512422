//! Laying the knots of a leg, each asked for by the path.

use crate::knot::SegmentTool;
use crate::knots::{fraction, span_in_a_second};
use crate::leg::Leg;
use crate::{Knot, Path, PathPoint, PlanError};

/// Largest number of segments of a leg: 12 machine epsilons of the length from its last knot but
/// one to its end.
pub(crate) const MAX_SEGMENTS: u32 = 1 << 24;

/// A number of segments that a leg can have, `fewest` or more.
pub(crate) fn bounded<E>(leg: usize, segments: u32, fewest: u32) -> Result<u32, PlanError<E>> {
    let max = MAX_SEGMENTS;
    if segments <= max {
        Ok(segments.max(fewest))
    } else {
        Err(PlanError::TooFine { leg, max })
    }
}

/// The number of knots of a leg with this number of segments.
pub(crate) fn knots_of(segments: u32) -> usize {
    usize::try_from(segments).map_or(usize::MAX, |segments| segments.saturating_add(1))
}

/// The knots of a leg, one behind the other.
#[derive(Debug, Clone)]
pub(crate) struct Laying<P: Path> {
    pub(crate) leg: Leg<P>,
    index: u32,
    pub(crate) last: Knot<P::Axes>,
}

impl<P: Path> Laying<P> {
    /// From the first knot on, whose point is `start`.
    pub(crate) fn new(leg: Leg<P>, start: PathPoint<P::Axes>) -> Self {
        Self {
            leg,
            index: 0,
            last: Knot::start(start),
        }
    }

    /// The knot at a parameter behind the last one, the length of its segment stretched by a factor
    /// of the points at its ends and the length itself.
    ///
    /// Whatever the speeds, each position of a cubic of duration 2κΔs/(w₀ + w₁) lies between those
    /// with which it begins and ends at rest: what the path allows for both, it allows for all.
    pub(crate) fn knot(
        &mut self,
        s: f64,
        stretch: impl FnOnce(&PathPoint<P::Axes>, &PathPoint<P::Axes>, f64) -> f64,
    ) -> Result<Knot<P::Axes>, PlanError<P::Error>> {
        let knot = self.next(s, stretch)?;
        for start in [0.0, 2.0] {
            let span = span_in_a_second([&self.last, &knot], start);
            let refused = |reason| self.leg.refused_segment(self.last.s, reason);
            self.leg.path().check(&span).map_err(refused)?;
        }
        self.take(knot);
        Ok(knot)
    }

    /// The same without asking the path: for plans that nothing runs by.
    pub(crate) fn unchecked_knot(
        &mut self,
        s: f64,
        stretch: impl FnOnce(&PathPoint<P::Axes>, &PathPoint<P::Axes>, f64) -> f64,
    ) -> Result<Knot<P::Axes>, PlanError<P::Error>> {
        let knot = self.next(s, stretch)?;
        self.take(knot);
        Ok(knot)
    }

    const fn take(&mut self, knot: Knot<P::Axes>) {
        self.index = self.index.saturating_add(1);
        self.last = knot;
    }

    fn next(
        &self,
        s: f64,
        stretch: impl FnOnce(&PathPoint<P::Axes>, &PathPoint<P::Axes>, f64) -> f64,
    ) -> Result<Knot<P::Axes>, PlanError<P::Error>> {
        let (point, length) = (self.leg.point(s)?, s - self.last.s);
        let knot = Knot {
            point,
            s,
            ds: length * stretch(&self.last.point, &point, length),
            tool: self.tool(s),
            ends_leg: s >= self.leg.length(),
            cap: f64::INFINITY,
            ..Knot::default()
        };
        // Written so that NaN is refused too.
        let is_behind = knot.ds > 0.0;
        if !is_behind {
            let (leg, knot) = (self.leg.number, self.index.saturating_add(1));
            return Err(PlanError::Indistinct { leg, knot });
        }
        Ok(knot)
    }

    /// Limits of the tool from the last knot to the next.
    fn tool(&self, s: f64) -> SegmentTool {
        let rates = || [self.last.s, s].map(|s| self.leg.path().tool_rate(s));
        let tool = self.leg.tool();
        tool.map_or(SegmentTool::NONE, |tool| SegmentTool::new(tool, rates))
    }

    /// Takes the last knot back: the one before it is the last again.
    const fn take_back(&mut self, before: Knot<P::Axes>) {
        self.last = before;
        self.index = self.index.saturating_sub(1);
    }
}

/// How often a segment is halved that the path refuses as too coarse.
const MOST_HALVINGS: u32 = 12;

/// A leg cut into segments, one behind the other. Those that are too coarse are halved until they
/// are not: next to the end of a range that it touches a path asks for ever shorter ones, and
/// beyond for longer ones again.
#[derive(Debug, Clone)]
pub(crate) struct Cutting<P: Path> {
    pub(crate) laying: Laying<P>,
    /// How evenly knots stand at both ends: 0 where it is slow, else 1.
    evenness: [f64; 2],
    /// Of the size of the next one.
    segments: u32,
    /// How often it has been halved.
    halvings: u32,
    /// Segments of its size before it.
    index: u32,
}

impl<P: Path> Cutting<P> {
    /// A leg with a number of segments, dense at an end where it is slow.
    pub(crate) fn new(laying: Laying<P>, is_slow: [bool; 2], segments: u32) -> Self {
        Self {
            laying,
            evenness: is_slow.map(|is_slow| if is_slow { 0.0 } else { 1.0 }),
            segments,
            halvings: 0,
            index: 0,
        }
    }

    /// The next knot, the length of its segment stretched by a factor; `is_known` tells whether the
    /// path from one knot to the next is, on a segment that has been halved as often.
    pub(crate) fn next_knot(
        &mut self,
        stretch: impl Fn(&PathPoint<P::Axes>, &PathPoint<P::Axes>, f64) -> f64,
        is_known: impl Fn(&Knot<P::Axes>, &Knot<P::Axes>, u32) -> bool,
    ) -> Result<Knot<P::Axes>, PlanError<P::Error>> {
        loop {
            let from = self.laying.last;
            let refused = match self.laying.knot(self.next_s(), &stretch) {
                Ok(to) if is_known(&from, &to, self.halvings) => {
                    self.advance();
                    return Ok(to);
                }
                Ok(_) => {
                    self.laying.take_back(from);
                    let (leg, s) = (self.laying.leg.number, from.s);
                    PlanError::TooCoarse { leg, s }
                }
                Err(refused) => refused,
            };
            let is_coarse = matches!(refused, PlanError::TooCoarse { .. });
            if !is_coarse || self.halvings == MOST_HALVINGS || self.segments > MAX_SEGMENTS / 2 {
                return Err(refused);
            }
            self.halvings = self.halvings.saturating_add(1);
            self.index = self.index.saturating_mul(2);
            self.segments = self.segments.saturating_mul(2);
        }
    }

    /// Behind the segment, and to the largest ones that begin there.
    const fn advance(&mut self) {
        self.index = self.index.saturating_add(1);
        while self.halvings > 0 && self.index.is_multiple_of(2) {
            self.halvings = self.halvings.saturating_sub(1);
            self.index /= 2;
            self.segments /= 2;
        }
    }

    /// The parameter of the next knot.
    fn next_s(&self) -> f64 {
        let (index, length) = (self.index.saturating_add(1), self.laying.leg.length());
        if index >= self.segments {
            return length;
        }
        let u = f64::from(index) / f64::from(self.segments);
        length * fraction(u, self.evenness)
    }
}
