//! The second derivative of the humps from the start of a curve on.

use super::super::vector::{along, dot};
use super::vertex::Vertex;

/// Of the largest second derivative in a curve the most by which its own may be off at the ends.
const STEP: f64 = 1.0 / 64.0;

/// The second derivative of the humps from the start of a curve on, and by how much that of a cubic
/// in their place is off at its ends.
///
/// A jump J of the third derivative at a is a point load on a beam, clamped at 0 and at l, whose
/// moments there are
///
/// ```text
/// J a (l - a)²/l²    J a² (l - a)/l²
/// ```
pub(super) struct Bend<const D: usize> {
    /// The last knot, from the start.
    at: f64,
    /// The second derivative there, and the third one behind it.
    second: [f64; D],
    third: [f64; D],
    /// The square of the largest second derivative.
    largest: f64,
    /// Σ J a, Σ J a², Σ J a³.
    loads: [[f64; D]; 3],
}

impl<const D: usize> Bend<D> {
    /// From a place on, around which are the humps of these vertices.
    pub(super) fn new(s: f64, vertices: &[Vertex<D>]) -> Self {
        let (mut second, mut third) = ([0.0; D], [0.0; D]);
        for vertex in vertices {
            let jump = vertex.jump_per_turn();
            let rest = vertex.width - (vertex.s - s).abs();
            second = along(&second, jump * rest, &vertex.turn);
            let jump = if s < vertex.s { jump } else { -jump };
            third = along(&third, jump, &vertex.turn);
        }
        Self {
            at: 0.0,
            second,
            third,
            largest: dot(&second, &second),
            loads: [[0.0; D]; 3],
        }
    }

    /// Goes on to a knot where the third derivative jumps by a multiple of a turn.
    pub(super) fn go_on(&mut self, at: f64, jump: f64, turn: &[f64; D]) {
        self.second = along(&self.second, at - self.at, &self.third);
        self.largest = self.largest.max(dot(&self.second, &self.second));
        self.at = at;
        self.third = along(&self.third, jump, turn);
        let mut load = jump;
        for sum in &mut self.loads {
            load *= at;
            *sum = along(sum, load, turn);
        }
    }

    /// Whether a cubic that ends here has the second derivative of the humps at both ends, or
    /// nearly so.
    pub(super) fn is_kept(&self) -> bool {
        let [first, second, third] = &self.loads;
        let by_length = 1.0 / self.at;
        let last = along(second, -by_length, third).map(|sum| sum * by_length);
        let start = along(&along(first, -by_length, second), -1.0, &last);
        let most = STEP * STEP * self.largest;
        dot(&start, &start).max(dot(&last, &last)) <= most
    }
}
