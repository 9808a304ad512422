//! Thinning: points that the polyline does without, within a part of the tolerance.

use super::super::vector::{along, difference, norm, scaled};
use crate::ToolLimits;

/// A point of the input, and which it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point<const D: usize> {
    pub(super) at: [f64; D],
    pub(super) index: usize,
    pub(super) tool: Option<ToolLimits>,
    /// How far the input departs at most from the edge that ends here.
    pub(super) thinned: f64,
}

/// Takes points and gives those that matter.
///
/// From a point that was kept on, an edge may go in all directions d for which the points passed
/// over are within δ of it. A point at the distance r in the direction e allows those with
/// |d - e| ≤ δ/r; of two such balls a ball inside both is kept. Points that come no farther than
/// [`SAME`] of δ from the one before, or nearer to the start of the edge than it, are no progress:
/// the first are left out, at the second the edge ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Thinning<const D: usize> {
    /// δ
    allowed: f64,
    /// The point kept last; none before the first.
    from: Option<[f64; D]>,
    /// The point at which the edge may end, being in all balls.
    to: Option<Point<D>>,
    /// Its distance from the start of the edge.
    distance: f64,
    centre: [f64; D],
    radius: f64,
    /// How far points depart that were passed over at the start of the input.
    start_departs: f64,
}

/// Points nearer than this part of δ are the same.
const SAME: f64 = 0.125;

/// So are those nearer than this fraction of their coordinates, between which rounding hides the
/// direction.
const ROUNDED: f64 = 1e-9;

impl<const D: usize> Thinning<D> {
    pub(super) const fn new(allowed: f64) -> Self {
        Self {
            allowed,
            from: None,
            to: None,
            distance: 0.0,
            centre: [0.0; D],
            radius: 0.0,
            start_departs: 0.0,
        }
    }

    /// The most by which the input departs from an edge that passes over points.
    pub(super) const fn largest(allowed: f64) -> f64 {
        allowed * (1.0 + SAME)
    }

    /// The next point of the input: what is kept for it, if that is known now.
    pub(super) fn push(&mut self, point: Point<D>) -> Option<Point<D>> {
        let Some(from) = self.from else {
            self.from = Some(point.at);
            return Some(point);
        };
        let Some(to) = self.to else {
            if self.is_same(&point.at, &from) {
                if norm(&difference(&point.at, &from)) > 0.0 {
                    self.start_departs = Self::largest(self.allowed);
                }
            } else {
                let thinned = self.start_departs;
                self.begin(from, Point { thinned, ..point });
            }
            return None;
        };
        if self.is_same(&point.at, &to.at) {
            if norm(&difference(&point.at, &to.at)) > 0.0 {
                self.pass_over();
            }
            return None;
        }
        if to.tool == point.tool && self.extend(&from, point) {
            return None;
        }
        self.begin(to.at, point);
        Some(to)
    }

    /// The end of the input, which is its last point to the last bit: what is kept before it, and
    /// it.
    pub(super) fn finish(&mut self, last: &Point<D>) -> [Option<Point<D>>; 2] {
        let Some(from) = self.from else {
            return [None, None];
        };
        let Some(to) = self.to else {
            let is_other = norm(&difference(&last.at, &from)) > 0.0;
            let thinned = self.start_departs;
            return [None, is_other.then_some(Point { thinned, ..*last })];
        };
        let by = norm(&difference(&last.at, &to.at));
        let is_other = by > 0.0 && !self.extend(&from, *last);
        // Between points that differ by rounding there is no edge: it ends in the last.
        let is_rounded = by <= ROUNDED * norm(&to.at) && !self.is_same(&last.at, &from);
        let kept = (is_other && !is_rounded).then_some(to);
        let thinned = self.to.map_or(0.0, |to| to.thinned);
        [kept, Some(Point { thinned, ..*last })]
    }

    fn is_same(&self, a: &[f64; D], b: &[f64; D]) -> bool {
        let same = (SAME * self.allowed).max(ROUNDED * norm(b));
        norm(&difference(a, b)) <= same
    }

    /// A new edge.
    fn begin(&mut self, from: [f64; D], to: Point<D>) {
        let edge = difference(&to.at, &from);
        let distance = norm(&edge);
        self.from = Some(from);
        self.distance = distance;
        self.centre = scaled(&edge, 1.0 / distance);
        self.radius = self.allowed / distance;
        self.to = Some(to);
    }

    fn pass_over(&mut self) {
        let thinned = Self::largest(self.allowed);
        if let Some(to) = &mut self.to {
            to.thinned = thinned;
        }
    }

    /// Whether the edge may end at this point, which it does then.
    fn extend(&mut self, from: &[f64; D], point: Point<D>) -> bool {
        let edge = difference(&point.at, from);
        let distance = norm(&edge);
        let direction = scaled(&edge, 1.0 / distance);
        let off = difference(&direction, &self.centre);
        let apart = norm(&off);
        // Written so that what is not a number ends an edge.
        let is_inside = distance > self.distance && apart <= self.radius;
        if !is_inside {
            return false;
        }
        let allowed = self.allowed / distance;
        if apart + allowed <= self.radius {
            (self.centre, self.radius) = (direction, allowed);
        } else if apart + self.radius > allowed {
            let radius = (self.radius + allowed - apart) * 0.5;
            let step = (self.radius - radius) / apart;
            self.centre = along(&self.centre, step, &off);
            self.radius = radius;
        }
        self.distance = distance;
        self.to = Some(point);
        self.pass_over();
        true
    }
}
