//! A polyline, smoothed within a tolerance: the points of CAM programs and slicers.

mod bend;
mod ends;
mod piece;
mod sight;
mod thinning;
mod vertex;

use core::f64::consts::PI;
use core::fmt::{self, Debug};

use super::vector::norm;
use super::{Curve, CurveError};
use crate::ToolLimits;
use crate::number::range;
use ends::End;
use piece::{Change, Piece, change};
use sight::{SHARPEST, Sight};
use thinning::{Point, Thinning};
pub use vertex::Vertex;

/// A point of a polyline, with the limits of the tool on the way to it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "a point, and how fast to it")]
pub struct Waypoint<const D: usize> {
    /// The point.
    pub point: [f64; D],
    /// Limits of the tool from the point before to this one.
    pub tool: Option<ToolLimits>,
}

impl<const D: usize> From<[f64; D]> for Waypoint<D> {
    fn from(point: [f64; D]) -> Self {
        Self { point, tool: None }
    }
}

/// Curves along a polyline within a tolerance of it, as they come in: a corner alone, and the
/// thousand points of an arc.
///
/// Points that the polyline does without within a quarter of the tolerance are passed over. Each
/// vertex that is left, at the arc length s, with the change D of direction, has a hump of the
/// half-width h:
///
/// ```text
/// P(u) = L(u) + Σ D B(u - s),    B(v) = (h - |v|)³ / 6h²  for |v| < h, else 0
/// ```
///
/// L is the polyline by its arc length u. P" are triangles, continuous; |P'| ≤ 1, so that the speed
/// of u is that of the tool, or more in a corner; an acceleration of the tool is limited as its own.
/// Humps are as wide as they may be and overlap; the half-widths of two differ by at most half of
/// their distance. |P - L| ≤ Σ |D| B is convex from a vertex to the next, and each half-width is such
/// that the sum is within what is allowed at every vertex. A corner alone has h = 6 ε/|D|.
///
/// The curves are cubics from some knots of P, the s - h, s and s + h, to others. With P and P' at
/// both ends one passes over others where that departs by at most 1/24 of the tolerance, and within
/// what the humps leave of it, for which the jumps J of P''' between ends that are l apart give
///
/// ```text
/// Σ |J| l³ / 192
/// ```
///
/// (a beam, clamped at both ends). P" would step there: so the slopes at the ends are those of the
/// cubic spline through the same points, but for what two knots ahead know nothing of. A change of
/// slope by d departs by at most d l/4, and is no larger than the tolerance allows. Where fewer
/// than two humps overlap, beside lines, whose slopes cannot change, a curve passes over knots only
/// where its own P" at both ends is that of the humps, but for 1/64 of the largest.
///
/// The curves join to the last bit, without a step of direction, and begin and end in the first and
/// last point. At turns sharper than 170° and with a tolerance of 0 at all of them they meet in the
/// corner, where the machine has to stop.
///
/// Vertices in sight are in memory of the caller's. Some 24 are enough for points on arcs; with
/// fewer humps are narrower: corners are slower then, never farther off.
///
/// ```
/// use path_timing::{AxisLimits, Knot, LookAhead, Smoothed, Vertex};
///
/// // A circle of 40 mm, as points half a millimetre apart with three decimals.
/// let rounded = |mm: f64| (mm * 1000.0).round() / 1000.0;
/// let angle = |n: i32| f64::from(n) * 0.5 / 40.0;
/// let points = (0..500).map(|n| [angle(n).cos(), angle(n).sin()].map(|x| rounded(40.0 * x)));
///
/// let mut vertices = [Vertex::default(); 24];
/// let mut refused = None; // a point that is no number, say: the stream ends before it
/// let curves = Smoothed::new(points, 0.01, &mut vertices)?;
/// let curves = curves.map_while(|curve| curve.map_err(|error| refused = Some(error)).ok());
/// let axis = AxisLimits { speed: 300.0, acceleration: 3000.0, jerk: None };
/// let mut window = [Knot::default(); 64];
/// let motion = LookAhead::new(curves, [axis; 2], |_| Ok(1), &mut window)?;
/// let last = motion.last().unwrap()?;
/// assert_eq!(refused, None);
/// assert!(last.time_s < 0.95); // 250 mm at 300 mm/s, and braking distance
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Smoothed<'m, I, const D: usize> {
    points: I,
    /// Points taken.
    count: usize,
    thinning: Thinning<D>,
    sight: Sight<'m, D>,
    /// A vertex that waits for room.
    waiting: [Option<Point<D>>; 2],
    last: Option<Point<D>>,
    /// Why there are no more points.
    error: Option<CurveError>,
    is_over: bool,
    node: Node<D>,
    tolerance: f64,
    departure: f64,
    /// What comes next, as far as the slope at the end of the first needs it.
    pieces: [Option<Piece<D>>; 3],
    /// By how much the slope at the start of the first is changed.
    change: Change<D>,
    /// Vertices that were decided when no end was found.
    looked: Option<usize>,
}

/// Where the curve before has ended.
#[derive(Debug, Clone, Copy)]
struct Node<const D: usize> {
    s: f64,
    /// The vertex with which the edge begins that goes on from here.
    edge: usize,
    /// How many humps overlap there.
    overlap: usize,
    /// The most by which the humps depart there.
    departure: f64,
    /// None before the first curve, and where the direction steps.
    at: Option<([f64; D], [f64; D])>,
}

/// Parts of the tolerance: for points passed over, and for cubics across several knots, where humps
/// leave it and where they do not.
const THINNED: f64 = 0.25;
const CUBICS: f64 = 1.0 / 24.0;
const LEAST_CUBICS: f64 = 1.0 / 48.0;

/// Least memory: an edge, those whose humps reach over it, and one that comes.
const MIN_VERTICES: usize = 6;

impl<'m, I: Iterator<Item: Into<Waypoint<D>>>, const D: usize> Smoothed<'m, I, D> {
    /// The curves along `points` within `tolerance` of the polyline, in memory for as many vertices
    /// as it may have in sight, at least 6.
    ///
    /// # Errors
    /// [`CurveError::Tolerance`], [`CurveError::Memory`].
    pub fn new(
        points: impl IntoIterator<IntoIter = I>,
        tolerance: f64,
        memory: &'m mut [Vertex<D>],
    ) -> Result<Self, CurveError> {
        if !(tolerance == 0.0 || range().contains(&tolerance)) {
            return Err(CurveError::Tolerance { tolerance });
        }
        if memory.len() < MIN_VERTICES {
            return Err(CurveError::Memory {
                needed: MIN_VERTICES,
                available: memory.len(),
            });
        }
        Ok(Self {
            points: points.into_iter(),
            count: 0,
            thinning: Thinning::new(tolerance * THINNED),
            sight: Sight::new(memory, tolerance * (1.0 - LEAST_CUBICS)),
            waiting: [None; 2],
            last: None,
            error: None,
            is_over: false,
            node: Node {
                s: 0.0,
                edge: 0,
                overlap: 0,
                departure: 0.0,
                at: None,
            },
            tolerance,
            departure: 0.0,
            pieces: [None; 3],
            change: Change::NONE,
            looked: None,
        })
    }

    /// With a stop at each turn by more than `angle`, in radians; 170° by itself, which is the
    /// most.
    #[must_use]
    pub fn with_stops_above(mut self, angle: f64) -> Self {
        let sharpest = 2.0 * libm::sin(angle.clamp(0.0, PI) * 0.5);
        self.sight.sharpest = sharpest.min(SHARPEST);
        self
    }

    /// The most by which the curves handed out depart from the polyline, by the proof.
    #[must_use]
    pub const fn departure(&self) -> f64 {
        self.departure
    }

    /// Takes the next point, or the end, of the input, or a vertex of it in sight. Whether there
    /// was something.
    fn take(&mut self) -> bool {
        let [first, second] = self.waiting;
        if let Some(point) = first.or(second) {
            self.waiting = [first.and(second), None];
            self.sight.push(Vertex::new(&point));
            return true;
        }
        if self.is_over {
            return !self.sight.is_whole() && {
                self.sight.end();
                true
            };
        }
        let next = self.points.next().map(Into::into);
        let next = next.filter(|waypoint| {
            let is_finite = norm(&waypoint.point).is_finite();
            if !is_finite {
                self.error = Some(CurveError::NotFinite);
            }
            is_finite
        });
        let Some(waypoint) = next else {
            self.is_over = true;
            if let Some(last) = &self.last {
                self.waiting = self.thinning.finish(last);
            }
            return true;
        };
        let point = Point {
            at: waypoint.point,
            index: self.count,
            tool: waypoint.tool,
            thinned: 0.0,
        };
        self.count = self.count.saturating_add(1);
        self.last = Some(point);
        self.waiting = [self.thinning.push(point), None];
        true
    }

    /// Knows more of what comes, if there is more to know. With memory that is full, first what is
    /// over goes, then what is to be decided later is decided now.
    fn look_ahead(&mut self) -> bool {
        if self.sight.decide(false) {
            return true;
        }
        if self.sight.has_room() {
            return self.take();
        }
        let (gone, start) = self.sight.forget(self.node.s);
        self.looked = None;
        self.node.s -= start;
        self.node.edge = self.node.edge.saturating_sub(gone);
        gone > 0 || self.sight.decide(true)
    }

    /// Where the next piece ends, by how much the humps depart there at most, and by how much the
    /// piece does.
    fn end(&self, is_last_chance: bool) -> Option<(End, f64, f64)> {
        let node = &self.node;
        let place = [node.edge, node.overlap];
        let farthest = |part: f64| {
            let allowed = self.tolerance * part;
            let end = self
                .sight
                .end_after(node.s, place, allowed, is_last_chance)?;
            let at_end = if end.is_vertex {
                self.sight.departure(node_after(&end))
            } else {
                self.sight.departure_at(end.edge, end.s)
            };
            let between = node.edge.saturating_add(1)..=end.edge;
            let humps = between.map(|vertex| self.sight.departure(vertex));
            let humps = humps.fold(node.departure.max(at_end), f64::max);
            Some((end, at_end, humps + end.departure))
        };
        let end = farthest(CUBICS)?;
        let (_, _, departure) = end;
        if departure <= self.tolerance {
            Some(end)
        } else {
            farthest(LEAST_CUBICS)
        }
    }

    /// The next piece, as far as its end is known; with `is_last_chance` as far as it goes.
    fn piece(&mut self, is_last_chance: bool) -> Option<Piece<D>> {
        let node = self.node;
        let decided = Some(self.sight.decided());
        if self.looked == decided && !is_last_chance {
            return None;
        }
        self.looked = decided;
        let (end, end_departure, departure) = self.end(is_last_chance)?;
        let (from, from_slope) = match node.at {
            Some(at) => at,
            None => self.sight.at(node.edge, node.s)?,
        };
        let next_edge = node_after(&end);
        let (to, next_slope) = self.sight.at(next_edge, end.s)?;
        let (_, to_slope) = self.sight.at(end.edge, end.s)?;
        let slope = if end.is_step { next_slope } else { to_slope };
        let [first, last] = [node.edge, end.edge.saturating_add(1)];
        let (first, last) = (self.sight.get(first)?, self.sight.get(last)?);
        let is_straight =
            node.edge == end.edge && self.sight.is_straight(end.edge, [node.s, end.s]);
        let piece = Piece {
            ends: [from, to],
            slopes: [from_slope, to_slope],
            length: end.s - node.s,
            is_straight,
            is_step: end.is_step,
            departure,
            slack: self.tolerance - departure,
            between: [first.index, last.index],
            tool: last.tool,
        };
        self.looked = None;
        self.node = Node {
            s: end.s,
            edge: next_edge,
            overlap: end.overlap,
            departure: end_departure,
            at: Some((to, slope)),
        };
        Some(piece)
    }

    /// The next piece, none at the end.
    fn next_piece(&mut self) -> Option<Piece<D>> {
        loop {
            if let Some(piece) = self.piece(false) {
                return Some(piece);
            }
            if !self.look_ahead() {
                return self.piece(true);
            }
        }
    }
}

/// The edge on which it goes on.
const fn node_after(end: &End) -> usize {
    end.edge.saturating_add(end.is_vertex as usize)
}

impl<I: Iterator<Item: Into<Waypoint<D>>>, const D: usize> Iterator for Smoothed<'_, I, D> {
    type Item = Result<Curve<D>, CurveError>;

    fn next(&mut self) -> Option<Self::Item> {
        for index in 0..self.pieces.len() {
            if self.pieces.get(index).is_some_and(Option::is_none) {
                let next = self.next_piece();
                if let Some(slot) = self.pieces.get_mut(index) {
                    *slot = next;
                }
            }
        }
        let [first, second, third] = &self.pieces;
        let Some(piece) = first else {
            return self.error.take().map(Err);
        };
        let pieces = [piece.into(), second.as_ref(), third.as_ref()];
        let next = change(&self.change, pieces);
        let changes = [&self.change, &next];
        let curve = piece.curve(changes);
        self.departure = self.departure.max(piece.departure(changes));
        self.change = next;
        self.pieces = [*second, *third, None];
        Some(curve)
    }
}

impl<I, const D: usize> Debug for Smoothed<'_, I, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Smoothed")
            .field("points", &self.count)
            .field("departure", &self.departure)
            .finish_non_exhaustive()
    }
}
