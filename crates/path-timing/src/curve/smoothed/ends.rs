//! Where one curve ends and the next begins: at some of the knots of all humps.

use super::bend::Bend;
use super::sight::Sight;
use super::vertex::Vertex;

/// Where a curve may end.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    pub(super) s: f64,
    /// The vertex with which the edge begins that comes here.
    pub(super) edge: usize,
    /// Whether it stands on the vertex after that.
    pub(super) is_vertex: bool,
    /// Whether the direction steps there.
    pub(super) is_step: bool,
    /// The most by which the curve departs from the humps.
    pub(super) departure: f64,
    /// How many humps overlap there.
    pub(super) overlap: usize,
}

/// A knot of the humps.
#[derive(Debug, Clone, Copy)]
struct HumpKnot<'a, const D: usize> {
    s: f64,
    vertex: &'a Vertex<D>,
    /// Jump of the third derivative, in those at the ends of the vertex' hump.
    jumps: f64,
    /// Whether it is the vertex itself.
    is_vertex: bool,
    /// Humps that reach over it.
    overlap: usize,
}

/// Knots nearer than this fraction of the coordinates are one.
const LEAST: f64 = 1e-9;

/// So are those nearer than this fraction of the arc length, which is a sum of rounded lengths.
const LEAST_OF_LENGTH: f64 = 1e-12;

/// Of the deflection of a clamped beam in whose middle a point load stands.
const BEAM: f64 = 192.0;

/// What jumps may add up to with the square of the length: a clamped beam then has a slope of about
/// a sixty-fourth of that, by which the tool is faster or slower than it should.
const SLOPE: f64 = 1.0;

/// How many humps overlap at both ends of a curve that may step in its second derivative: its
/// neighbours give way, but for straight lines.
const MANY: usize = 2;

/// The knots of all humps in their order. Those of one kind are in the order of the vertices.
struct HumpKnots<'a, const D: usize> {
    vertices: &'a [Vertex<D>],
    /// Of the next hump that begins, has its middle, ends.
    next: [usize; 3],
}

impl<'a, const D: usize> HumpKnots<'a, D> {
    /// Those behind `s`.
    fn after(s: f64, vertices: &'a [Vertex<D>]) -> Self {
        let first = |knot: fn(&Vertex<D>) -> f64| {
            let before = vertices.iter().take_while(|vertex| knot(vertex) <= s);
            before.count()
        };
        Self {
            vertices,
            next: [first(Vertex::begin), first(|it| it.s), first(Vertex::end)],
        }
    }

    /// The vertices whose humps have begun and not ended.
    fn around(&self) -> &'a [Vertex<D>] {
        let [begin, _, end] = self.next;
        self.vertices.get(end..begin).unwrap_or_default()
    }
}

impl<'a, const D: usize> Iterator for HumpKnots<'a, D> {
    type Item = HumpKnot<'a, D>;

    fn next(&mut self) -> Option<Self::Item> {
        let [begin, middle, end] = &mut self.next;
        let at = |index: usize, knot: fn(&Vertex<D>) -> f64| {
            self.vertices.get(index).map_or(f64::INFINITY, knot)
        };
        let begins = at(*begin, Vertex::begin);
        let stands = at(*middle, |it| it.s);
        let ends = at(*end, Vertex::end);
        let humps = begin.saturating_sub(*end);
        let (index, jumps, overlap) = if begins <= stands && begins <= ends {
            (begin, 1.0, humps)
        } else if stands <= ends {
            (middle, -2.0, humps)
        } else {
            (end, 1.0, humps.saturating_sub(1))
        };
        let vertex = self.vertices.get(*index)?;
        *index = index.saturating_add(1);
        Some(HumpKnot {
            s: begins.min(stands).min(ends),
            vertex,
            jumps,
            is_vertex: jumps < 0.0,
            overlap,
        })
    }
}

impl<const D: usize> Sight<'_, D> {
    /// The farthest knot at which a curve from `s` may end, on the edge that begins at a vertex and
    /// with so many humps that overlap, and depart from the humps by what is allowed; none while
    /// there may be a farther one, but for the last chance.
    pub(super) fn end_after(
        &self,
        s: f64,
        [edge, overlap]: [usize; 2],
        allowed: f64,
        is_last_chance: bool,
    ) -> Option<End> {
        let decided = self.vertices().get(..self.decided())?;
        let horizon = self.horizon();
        // Jumps inside a curve that ends at the next knot, and those at the knot before.
        let (mut edge, mut sum, mut last_jumps) = (edge, 0.0, 0.0);
        let mut farthest: Option<End> = None;
        let least = self.least_between_knots(s, edge);
        let knots = HumpKnots::after(s, decided);
        let mut bend = (overlap < MANY).then(|| Bend::new(s, knots.around()));
        for knot in knots {
            if knot.s > horizon {
                return farthest.filter(|_| is_last_chance);
            }
            let next = edge.saturating_add(usize::from(knot.is_vertex));
            let must_end = knot.is_vertex && self.must_end(next);
            let is_other = farthest.is_none_or(|end| knot.s - end.s > least);
            if is_other {
                sum += last_jumps;
                last_jumps = 0.0;
            }
            let length = knot.s - s;
            let departure = sum * length * length * length / BEAM;
            let is_off = departure > allowed || sum * length * length > SLOPE;
            if is_other && farthest.is_some() && is_off {
                return farthest;
            }
            let may_end = match &mut bend {
                Some(bend) => {
                    let jump = knot.jumps * knot.vertex.jump_per_turn();
                    bend.go_on(length, jump, &knot.vertex.turn);
                    bend.is_kept()
                }
                None => knot.overlap >= MANY,
            };
            if must_end || length > least {
                if may_end || !is_other || farthest.is_none() {
                    farthest = Some(End {
                        s: knot.s,
                        edge,
                        is_vertex: knot.is_vertex,
                        is_step: knot.is_vertex && self.is_step(next),
                        departure,
                        overlap: knot.overlap,
                    });
                }
                last_jumps += knot.jumps.abs() * knot.vertex.jump();
            }
            edge = next;
            if must_end {
                return farthest;
            }
        }
        farthest.filter(|_| is_last_chance)
    }

    /// Length at or below which knots on an edge are one.
    fn least_between_knots(&self, s: f64, edge: usize) -> f64 {
        let ends = [edge, edge.saturating_add(1)].map(|index| self.get(index));
        let coordinates = ends.iter().flatten().flat_map(|vertex| &vertex.point);
        let largest = coordinates.fold(0.0_f64, |a, b| a.max(b.abs()));
        (LEAST * largest).max(LEAST_OF_LENGTH * s)
    }

    /// Up to where all humps are known.
    fn horizon(&self) -> f64 {
        let decided = self.decided();
        let Some(next) = self.get(decided) else {
            return f64::INFINITY;
        };
        let before = self.get(decided.wrapping_sub(1));
        before.map_or(0.0, |before| next.s - before.widest_next(next))
    }

    /// Whether the direction steps at a vertex: it has no hump.
    fn is_step(&self, index: usize) -> bool {
        let vertex = self.get(index);
        vertex.is_some_and(|it| it.is_stop || (it.width == 0.0 && it.sharpness > 0.0))
    }

    /// Whether a curve has to end at a vertex: the direction steps there, or the tool has other
    /// limits.
    fn must_end(&self, index: usize) -> bool {
        let tool = |index| self.get(index).map(|vertex| vertex.tool);
        self.is_step(index) || tool(index) != tool(index.saturating_add(1))
    }
}
