//! The vertices in sight, in the caller's memory, and how wide the hump of each may be.

use super::super::vector::along;
use super::vertex::{GROWTH, Vertex};

/// Reach of a hump that counts at a vertex of the half-width 1: h + v/2 = v.
const REACH: f64 = 1.0 / (1.0 - GROWTH);

/// Steps in which a width is sought, and how near it has to be.
const STEPS: u32 = 8;
const CLOSE: f64 = 0.98;

/// A width is known when it is this part less than what is in sight allows.
const IN_SIGHT: f64 = 1.0 - 1e-6;

/// Change of direction at the sharpest turn that has a hump: 2 sin(85°).
pub(super) const SHARPEST: f64 = 1.992_389_396_183_491;

/// Of the vertices in sight a hump that is decided on too early reaches over one in so many.
const AHEAD: usize = 4;

/// The part of the width of the vertex before that is to be in sight before one is measured.
const LIKELY: f64 = 0.75;

/// Half-widths below this fraction of the coordinates are none.
const LEAST_WIDTH: f64 = 1e-8;

/// The vertices in sight.
pub(super) struct Sight<'m, const D: usize> {
    vertices: &'m mut [Vertex<D>],
    count: usize,
    /// Vertices, from the first, whose [`widest`](Vertex::widest) is known.
    measured: usize,
    /// Vertices, from the first, whose [`width`](Vertex::width) is known.
    decided: usize,
    /// Whether the last vertex is the end.
    is_whole: bool,
    /// Whether nothing has changed since what was in sight was not enough to decide.
    is_stuck: bool,
    /// Departure allowed to humps and what was thinned.
    humps: f64,
    /// Change of direction above which the machine is to stop.
    pub(super) sharpest: f64,
}

impl<'m, const D: usize> Sight<'m, D> {
    pub(super) const fn new(vertices: &'m mut [Vertex<D>], humps: f64) -> Self {
        Self {
            vertices,
            count: 0,
            measured: 0,
            decided: 0,
            is_whole: false,
            is_stuck: false,
            humps,
            sharpest: SHARPEST,
        }
    }

    pub(super) fn vertices(&self) -> &[Vertex<D>] {
        self.vertices.get(..self.count).unwrap_or_default()
    }

    pub(super) fn get(&self, index: usize) -> Option<&Vertex<D>> {
        self.vertices().get(index)
    }

    /// How many vertices have their humps.
    pub(super) const fn decided(&self) -> usize {
        self.decided
    }

    /// Whether the end of the polyline is in sight, and all is decided.
    pub(super) const fn is_whole(&self) -> bool {
        self.is_whole
    }

    pub(super) const fn has_room(&self) -> bool {
        self.count < self.vertices.len()
    }

    /// A vertex comes in sight.
    pub(super) fn push(&mut self, mut vertex: Vertex<D>) {
        self.is_stuck = false;
        let known = self.vertices.get_mut(..self.count).unwrap_or_default();
        if let [.., before, last] = known {
            last.go_on(&mut vertex, Some(&before.direction), self.sharpest);
        } else if let [last] = known {
            last.go_on(&mut vertex, None, self.sharpest);
        }
        if let Some(slot) = self.vertices.get_mut(self.count) {
            *slot = vertex;
            self.count = self.count.saturating_add(1);
        }
    }

    /// The last vertex is the end of the polyline.
    pub(super) fn end(&mut self) {
        self.is_whole = true;
        self.is_stuck = false;
        let known = self.vertices.get_mut(..self.count).unwrap_or_default();
        if let Some(last) = known.last_mut() {
            last.is_stop = true;
        }
    }

    /// Takes what is before `s`, and has no part in what comes, out of sight, and counts from the
    /// new start: how many vertices, and the arc length of the new start.
    pub(super) fn forget(&mut self, s: f64) -> (usize, f64) {
        let far = |vertex: &Vertex<D>, reach: f64| vertex.s + reach * vertex.width < s;
        let vertices = self.vertices();
        // The edge on which the place lies stays.
        let most = vertices.iter().take_while(|vertex| vertex.s < s).count();
        let most = most.saturating_sub(1).min(self.decided.saturating_sub(1));
        let leading = |reach| {
            let leading = vertices.iter().take(most);
            leading.take_while(|vertex| far(vertex, reach)).count()
        };
        let gone = match leading(REACH) {
            0 => leading(1.0),
            some => some,
        };
        let start = vertices.get(gone).map_or(0.0, |vertex| vertex.s);
        for to in 0..self.count.saturating_sub(gone) {
            let moved = self.vertices.get(to.saturating_add(gone)).copied();
            if let (Some(moved), Some(slot)) = (moved, self.vertices.get_mut(to)) {
                *slot = Vertex {
                    s: moved.s - start,
                    ..moved
                };
            }
        }
        self.is_stuck = false;
        self.count = self.count.saturating_sub(gone);
        self.measured = self.measured.saturating_sub(gone);
        self.decided = self.decided.saturating_sub(gone);
        (gone, start)
    }

    /// Decides on the hump of one vertex more, if what is in sight is enough: with `is_last_chance`
    /// it has to be. Whether it did.
    pub(super) fn decide(&mut self, is_last_chance: bool) -> bool {
        let index = self.decided;
        if (self.is_stuck && !is_last_chance) || !self.is_known(index) {
            return false;
        }
        let Some(vertex) = self.get(index).copied() else {
            return false;
        };
        let Some(width) = self.width(index, &vertex, is_last_chance) else {
            self.is_stuck = true;
            return false;
        };
        self.is_stuck = false;
        let largest = vertex.point.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        if let Some(vertex) = self.vertices.get_mut(index) {
            // Written so that NaN is none.
            let is_some = width > LEAST_WIDTH * largest;
            vertex.width = if is_some { width } else { 0.0 };
            if self.measured <= index {
                vertex.widest = vertex.width;
            }
        }
        self.decided = index.saturating_add(1);
        self.measured = self.measured.max(self.decided);
        true
    }

    /// The half-width of a hump: within [`GROWTH`] of what every vertex bears.
    fn width(&mut self, index: usize, vertex: &Vertex<D>, is_last_chance: bool) -> Option<f64> {
        if vertex.is_stop {
            return Some(0.0);
        }
        let before = self.get(index.wrapping_sub(1));
        let mut width = before.map_or(f64::INFINITY, |before| before.widest_next(vertex));
        width = width.min(vertex.s - self.start(index));
        if is_last_chance {
            // Not so wide that it keeps others from going out of sight; the one before, with more
            // in sight, counted on no less than that.
            let ahead = self.vertices.len().div_euclid(AHEAD);
            let far = self.get(index.saturating_add(ahead));
            let narrowest = before.map_or(0.0, |before| before.narrowest_next(vertex));
            width = far.map_or(width, |far| width.min(narrowest.max(far.s - vertex.s)));
        }
        let mut later = index;
        while let Some(other) = self.get(later).copied() {
            let away = other.s - vertex.s;
            if self.is_stop(later) {
                width = width.min(away);
                break;
            }
            let widest = self.measure(later, is_last_chance)?;
            width = width.min(widest + GROWTH * away);
            later = later.saturating_add(1);
            let Some(next) = self.get(later) else { break };
            if GROWTH * (next.s - vertex.s) >= width {
                break;
            }
        }
        Some(width)
    }

    /// Whether the turn of a vertex is known: that of the last one only at the end.
    fn is_known(&self, index: usize) -> bool {
        self.is_whole || index.saturating_add(1) < self.count
    }

    fn is_stop(&self, index: usize) -> bool {
        self.is_known(index) && self.get(index).is_some_and(|vertex| vertex.is_stop)
    }

    /// What a vertex bears, which is kept where more in sight would not change it.
    fn measure(&mut self, index: usize, is_last_chance: bool) -> Option<f64> {
        let vertex = self.get(index)?;
        if index < self.measured {
            return Some(vertex.widest);
        }
        let in_sight = if self.is_whole {
            f64::INFINITY
        } else {
            self.vertices().last().map_or(0.0, |last| last.s) - vertex.s
        };
        let in_sight = in_sight / REACH;
        // What the vertex before bears is about what this one does: no need to look yet.
        let before = self.get(index.wrapping_sub(1));
        let likely = before.map_or(0.0, |before| before.widest * LIKELY);
        if in_sight < likely && !is_last_chance {
            return None;
        }
        let widest = if self.is_known(index) {
            self.widest(index, in_sight)
        } else {
            0.0
        };
        let is_final = self.is_whole || widest < in_sight * IN_SIGHT;
        if is_final && index == self.measured {
            self.measured = index.saturating_add(1);
            self.vertices.get_mut(index)?.widest = widest;
        }
        (is_final || is_last_chance).then_some(widest)
    }

    /// The widest that a hump may be beside what the vertex before bears, as far as that is known.
    fn beside(&self, index: usize) -> f64 {
        let (Some(vertex), Some(before)) = (self.get(index), self.get(index.wrapping_sub(1)))
        else {
            return f64::INFINITY;
        };
        if index <= self.decided {
            before.widest_next(vertex)
        } else if index <= self.measured {
            before.widest + GROWTH * (vertex.s - before.s)
        } else {
            f64::INFINITY
        }
    }

    /// Arc length at the last stop before a vertex, else that from which on all is in sight.
    fn start(&self, index: usize) -> f64 {
        let before = self.vertices().iter().take(index).rev();
        let mut stops = before.filter(|vertex| vertex.is_stop);
        stops.next().map_or(0.0, |stop| stop.s)
    }

    /// The widest hump at a vertex with which the departure there is within what is allowed, while
    /// every other hump is wider by as much as it may be.
    fn widest(&self, index: usize, in_sight: f64) -> f64 {
        let Some(vertex) = self.get(index) else {
            return 0.0;
        };
        let thinned = self.get(index.saturating_add(1));
        let thinned = thinned.map_or(0.0, |next| next.thinned).max(vertex.thinned);
        let allowed = self.humps - thinned;
        let alone = allowed * 6.0 / vertex.sharpness;
        let behind = vertex.s - self.vertices().first().map_or(0.0, |first| first.s);
        let is_start_in_sight = self.vertices().first().is_some_and(|first| first.is_stop);
        let behind = if is_start_in_sight {
            behind
        } else {
            behind / REACH
        };
        // The bound is convex in h and 0 at 0: Newton's steps come down to what is allowed, and a
        // part of h departs by no more than that part.
        let mut widest = alone.min(in_sight).min(behind).min(self.beside(index));
        for _ in 0..STEPS {
            let (bound, slope) = self.bound(index, widest);
            // Written so that NaN is enough.
            let is_too_wide = bound > allowed;
            if !is_too_wide {
                return widest;
            }
            let part = allowed / bound;
            if part > CLOSE {
                return widest * part;
            }
            widest -= (bound - allowed) / slope;
        }
        let (bound, _) = self.bound(index, widest);
        widest * (allowed / bound).min(1.0)
    }

    /// The most by which humps of the half-width h, and more by [`GROWTH`] where they are farther
    /// away, depart at a vertex; and its derivative by h.
    fn bound(&self, index: usize, h: f64) -> (f64, f64) {
        let (before, after) = self.vertices().split_at_checked(index).unwrap_or_default();
        let Some(vertex) = after.first() else {
            return (0.0, 0.0);
        };
        let reach = h * REACH;
        let away = |other: &Vertex<D>| (other.s - vertex.s).abs();
        let sum = |(sum, slope): (f64, f64), other: &Vertex<D>| {
            let v = away(other);
            let wide = h + GROWTH * v;
            let rest = 1.0 - v / wide;
            let by = other.sharpness * rest * rest / 6.0;
            (sum + by * rest * wide, slope + by * (1.0 + 2.0 * v / wide))
        };
        let counts = |other: &&Vertex<D>| away(other) < reach && !other.is_stop;
        let before = before.iter().rev().take_while(counts);
        let before = before.fold((0.0, 0.0), sum);
        after.iter().take_while(counts).fold(before, sum)
    }

    /// The most by which the humps depart at a vertex: with what was thinned there.
    pub(super) fn departure(&self, index: usize) -> f64 {
        let [own, next] = [index, index.saturating_add(1)].map(|index| self.get(index));
        let thinned = own.map_or(0.0, |own| own.thinned);
        let thinned = next.map_or(thinned, |next| next.thinned.max(thinned));
        thinned + own.map_or(0.0, |own| self.departure_of_humps(index, own.s))
    }

    /// The same at a place on the edge that begins at a vertex.
    pub(super) fn departure_at(&self, edge: usize, s: f64) -> f64 {
        let next = edge.saturating_add(1);
        let thinned = self.get(next).map_or(0.0, |next| next.thinned);
        thinned + self.departure_of_humps(next, s)
    }

    /// At a place before the vertex `index`, or at it.
    fn departure_of_humps(&self, index: usize, s: f64) -> f64 {
        let sum = |sum: f64, other: &Vertex<D>| {
            let rest = other.width - (other.s - s).abs();
            sum + other.jump() * rest * rest * rest / 6.0
        };
        let (before, after) = self.reaching(s, index);
        let departure = before.map(|(_, other)| other).fold(0.0, sum);
        after.map(|(_, other)| other).fold(departure, sum)
    }

    /// The vertices whose humps reach to a place: those before `index`, the last one first, and the
    /// others. Where humps begin, and where they end, is in the order of the vertices.
    fn reaching(
        &self,
        s: f64,
        index: usize,
    ) -> (
        impl Iterator<Item = (bool, &Vertex<D>)>,
        impl Iterator<Item = (bool, &Vertex<D>)>,
    ) {
        let decided = self.vertices().get(..self.decided).unwrap_or_default();
        let (before, after) = decided.split_at_checked(index).unwrap_or_default();
        (
            before
                .iter()
                .rev()
                .take_while(move |it| it.end() > s)
                .map(|it| (false, it)),
            after
                .iter()
                .take_while(move |it| it.begin() < s)
                .map(|it| (true, it)),
        )
    }

    /// Whether no hump reaches between two places on the edge that begins at a vertex.
    pub(super) fn is_straight(&self, edge: usize, [from, to]: [f64; 2]) -> bool {
        let (before, after) = (self.get(edge), self.get(edge.saturating_add(1)));
        before.is_none_or(|it| it.end() <= from) && after.is_none_or(|it| it.begin() >= to)
    }

    /// Point and slope on the edge that begins at a vertex, with all humps.
    pub(super) fn at(&self, edge: usize, s: f64) -> Option<([f64; D], [f64; D])> {
        let from = self.get(edge)?;
        let mut point = along(&from.point, s - from.s, &from.direction);
        let mut slope = from.direction;
        let (before, after) = self.reaching(s, edge.saturating_add(1));
        for (is_before, vertex) in before.chain(after) {
            vertex.add_hump(s, is_before, [&mut point, &mut slope]);
        }
        Some((point, slope))
    }
}
