//! Vertices of a polyline, each with the hump that rounds it.

use super::super::vector::{along, difference, norm, scaled};
use super::thinning::Point;
use crate::ToolLimits;

/// How much wider a hump may be for each unit of length that it is farther away.
pub(super) const GROWTH: f64 = 0.5;

/// Memory for one vertex of the polyline that a [`Smoothed`](super::Smoothed) has in sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex<const D: usize> {
    pub(super) point: [f64; D],
    /// Which of the input's points it is, from 0.
    pub(super) index: usize,
    /// Limits of the tool on the edge that ends here.
    pub(super) tool: Option<ToolLimits>,
    /// How far the input departs at most from the edge that ends here.
    pub(super) thinned: f64,
    /// Arc length of the polyline.
    pub(super) s: f64,
    /// Unit vector of the edge that begins here; zero while there is none.
    pub(super) direction: [f64; D],
    /// Change of direction: zero at ends, and where the machine is to stop.
    pub(super) turn: [f64; D],
    /// Length of the change of direction.
    pub(super) sharpness: f64,
    /// Whether the machine is to stop here.
    pub(super) is_stop: bool,
    /// Most of a hump here with which the bound is kept, whatever the others are.
    pub(super) widest: f64,
    /// Half-width of the hump.
    pub(super) width: f64,
}

impl<const D: usize> Default for Vertex<D> {
    fn default() -> Self {
        Self {
            point: [0.0; D],
            index: 0,
            tool: None,
            thinned: 0.0,
            s: 0.0,
            direction: [0.0; D],
            turn: [0.0; D],
            sharpness: 0.0,
            is_stop: false,
            widest: 0.0,
            width: 0.0,
        }
    }
}

impl<const D: usize> Vertex<D> {
    pub(super) fn new(point: &Point<D>) -> Self {
        Self {
            point: point.at,
            index: point.index,
            tool: point.tool,
            thinned: point.thinned,
            ..Self::default()
        }
    }

    /// Goes on from here to the next vertex: its arc length, and this one's direction. The
    /// direction before is that of the vertex before, none at a start.
    pub(super) fn go_on(&mut self, next: &mut Self, before: Option<&[f64; D]>, sharpest: f64) {
        let edge = difference(&next.point, &self.point);
        let length = norm(&edge);
        next.s = self.s + length;
        self.direction = scaled(&edge, 1.0 / length);
        let Some(before) = before else {
            self.is_stop = true;
            return;
        };
        let turn = difference(&self.direction, before);
        let sharpness = norm(&turn);
        self.is_stop = sharpness > sharpest;
        if !self.is_stop {
            (self.turn, self.sharpness) = (turn, sharpness);
        }
    }

    /// The widest that the hump of the next vertex may be beside this one.
    pub(super) fn widest_next(&self, next: &Self) -> f64 {
        let growth = if self.is_stop { 1.0 } else { GROWTH };
        self.width + growth * (next.s - self.s)
    }

    /// The narrowest that the hump of the next vertex may be beside this one, but for a stop.
    pub(super) fn narrowest_next(&self, next: &Self) -> f64 {
        self.width - GROWTH * (next.s - self.s)
    }

    /// Where its hump begins.
    pub(super) const fn begin(&self) -> f64 {
        self.s - self.width
    }

    /// Where its hump ends.
    pub(super) const fn end(&self) -> f64 {
        self.s + self.width
    }

    /// What its hump adds to a point and to the direction, on an edge before the vertex or behind
    /// it.
    ///
    /// ```text
    /// B(v) = (h - |v|)³ / 6h²    B'(v) = ∓ (h - |v|)² / 2h²
    /// ```
    pub(super) fn add_hump(&self, s: f64, is_before: bool, [point, slope]: [&mut [f64; D]; 2]) {
        let rest = 1.0 - (s - self.s).abs() / self.width;
        // Written so that a hump without width adds nothing.
        let is_inside = self.width > 0.0 && rest > 0.0;
        if !is_inside {
            return;
        }
        let by = rest * rest * 0.5;
        *point = along(point, by * rest * self.width / 3.0, &self.turn);
        *slope = along(slope, if is_before { by } else { -by }, &self.turn);
    }

    /// Jump of the third derivative where the hump begins and where it ends; in its middle it is
    /// twice as much.
    pub(super) fn jump(&self) -> f64 {
        self.sharpness * self.jump_per_turn()
    }

    /// The same for a change of direction by 1.
    pub(super) fn jump_per_turn(&self) -> f64 {
        if self.width > 0.0 {
            1.0 / (self.width * self.width)
        } else {
            0.0
        }
    }
}
