//! Cubics from one knot of the humps to another, and slopes at their ends with which the second
//! derivative does not step.

use super::super::vector::{along, difference, norm, scaled};
use super::super::{Curve, CurveError};
use crate::ToolLimits;

/// Most by which a slope is changed: about as much as the tool is then faster or slower than it
/// should.
const MAX_CHANGE: f64 = 1.0 / 64.0;

/// A cubic that has the points and slopes of the humps at its ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece<const D: usize> {
    pub(super) ends: [[f64; D]; 2],
    pub(super) slopes: [[f64; D]; 2],
    pub(super) length: f64,
    pub(super) is_straight: bool,
    /// Whether the direction steps at its end.
    pub(super) is_step: bool,
    /// The most by which it departs from the polyline, and how much more it may.
    pub(super) departure: f64,
    pub(super) slack: f64,
    pub(super) between: [usize; 2],
    pub(super) tool: Option<ToolLimits>,
}

/// By how much a slope is changed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change<const D: usize> {
    slope: [f64; D],
    size: f64,
}

impl<const D: usize> Change<D> {
    pub(super) const NONE: Self = Self {
        slope: [0.0; D],
        size: 0.0,
    };

    /// The change, or as much of it as may be.
    fn at_most(most: f64, slope: [f64; D]) -> Self {
        let size = norm(&slope);
        if size <= most {
            return Self { slope, size };
        }
        // Written so that NaN is none.
        let part = most / size;
        if part >= 0.0 {
            let slope = scaled(&slope, part);
            Self { slope, size: most }
        } else {
            Self::NONE
        }
    }
}

impl<const D: usize> Piece<D> {
    /// The curve with its slopes changed.
    pub(super) fn curve(&self, changes: [&Change<D>; 2]) -> Result<Curve<D>, CurveError> {
        let curve = if self.is_straight {
            let [from, to] = self.ends;
            Curve::line(from, to)?
        } else {
            let ([before, after], [first, last]) = (&self.slopes, changes);
            let before = along(before, 1.0, &first.slope);
            let after = along(after, 1.0, &last.slope);
            Curve::cubic(self.ends, [before, after], self.length)?
        };
        Ok(Curve {
            tool: self.tool,
            between: Some(self.between),
            ..curve
        })
    }

    /// The most by which it departs with its slopes changed: t (1 - t) of the length and of the
    /// larger change from the cubic.
    pub(super) fn departure(&self, [first, last]: [&Change<D>; 2]) -> f64 {
        self.departure + 0.25 * self.length * first.size.max(last.size)
    }

    /// The most by which a slope may be changed.
    fn most(&self) -> f64 {
        (4.0 * self.slack / self.length).clamp(0.0, MAX_CHANGE)
    }

    /// Whether the slope between this piece and the next may be changed.
    const fn gives_way(&self, next: &Self) -> bool {
        !(self.is_step || self.is_straight || next.is_straight)
    }

    /// Half of the step of the second derivative from this piece to the next, and the part of it
    /// that a change of the slope there takes away.
    ///
    /// ```text
    /// (m0 + 2 m1 - 3 (p1 - p0)/l)/l at the end,  (3 (p1 - p0)/l - 2 m0 - m1)/l at the start
    /// ```
    fn step(&self, next: &Self) -> ([f64; D], f64) {
        let (a, b) = (1.0 / self.length, 1.0 / next.length);
        let ([p0, p1], [m0, m1]) = (&self.ends, &self.slopes);
        let before = along(m0, -3.0 * a, &difference(p1, p0));
        let before = along(&before, 2.0, m1);
        let ([p1, p2], [m1, m2]) = (&next.ends, &next.slopes);
        let after = along(m2, -3.0 * b, &difference(p2, p1));
        let after = along(&after, 2.0, m1);
        let step = along(&scaled(&after, -b), -a, &before);
        (step, 2.0 * (a + b))
    }
}

/// The change of the slope at the end of the first piece with which the second derivative does not
/// step there, after the change at its start.
///
/// With half of the step r, and a and b the lengths of the two, changes d take it away where
///
/// ```text
/// d0/a + 2 d1 (1/a + 1/b) + d2/b = r
/// ```
///
/// The same for the next gives d2, with d3 as 0: a change goes on as a quarter of itself, or less.
pub(super) fn change<const D: usize>(
    before: &Change<D>,
    [first, second, third]: [Option<&Piece<D>>; 3],
) -> Change<D> {
    let (Some(first), Some(second)) = (first, second) else {
        return Change::NONE;
    };
    if !first.gives_way(second) {
        return Change::NONE;
    }
    let (step, mut part) = first.step(second);
    let mut rest = along(&step, -1.0 / first.length, &before.slope);
    if let Some(third) = third.filter(|third| second.gives_way(third)) {
        let (next_step, next_part) = second.step(third);
        let by = 1.0 / (second.length * next_part);
        rest = along(&rest, -by, &next_step);
        part -= by / second.length;
    }
    let most = first.most().min(second.most());
    Change::at_most(most, scaled(&rest, 1.0 / part))
}
