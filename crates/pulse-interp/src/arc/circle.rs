//! The midpoint arc in closed form: where it goes, and how long it is.

use super::geometry::{Place, Sweep, rounded_root, signed};

/// The path about a centre, from axis to axis.
pub(super) struct Circle {
    square: u64,
    /// Where the octants meet.
    pub(super) middle: Place,
}

impl Circle {
    pub(super) fn new(square: u64) -> Self {
        let mut circle = Self {
            square,
            middle: Place { a: 0, b: 0 },
        };
        // The first b with a <= b is R / sqrt(2), but for rounding.
        let mut b = signed((square >> 1).isqrt()).wrapping_sub(1).max(1);
        while circle.beside(b) > b {
            b = b.wrapping_add(1);
        }
        // One move lowers a by at most 1.
        let before = circle.beside(b.wrapping_sub(1)).wrapping_sub(1);
        circle.middle = Place {
            a: circle.beside(b).max(before),
            b,
        };
        circle
    }

    /// The other coordinate of the path where the leading one is `along`.
    ///
    /// a where b leads: the largest with (a - 1/2)² + b² < R². b where a leads: the least with
    /// a² + (b + 1/2)² > R². Both are the least n with n (n + 1) >= R² - along².
    fn beside(&self, along: i64) -> i64 {
        let along = along.unsigned_abs();
        let rest = self.square.saturating_sub(along.wrapping_mul(along));
        rounded_root(rest)
    }

    /// Moves from the axis of departure to a place on the path.
    fn progress(&self, to: Place) -> i64 {
        if to.b < to.a {
            to.b.min(self.middle.b)
        } else {
            let beyond = self.middle.a.wrapping_sub(to.a).max(0);
            self.middle.b.wrapping_add(beyond)
        }
    }

    /// All moves of an arc.
    pub(super) fn moves(&self, sweep: &Sweep) -> u64 {
        let quadrant = self.middle.b.wrapping_add(self.middle.a);
        let whole = quadrant.wrapping_mul(i64::from(sweep.crossings));
        let ends = self
            .progress(sweep.end)
            .wrapping_sub(self.progress(sweep.start));
        let by_rule = whole.wrapping_add(ends).max(0);
        by_rule.wrapping_add(self.closing(sweep)).unsigned_abs()
    }

    /// Moves from where the rule stops to the end.
    fn closing(&self, sweep: &Sweep) -> i64 {
        let Place { a, b } = sweep.end;
        let stop = if b < a {
            let b = b.min(self.middle.b);
            Place {
                a: if b < self.middle.b {
                    self.beside(b)
                } else {
                    self.middle.a
                },
                b,
            }
        } else {
            let a = a.min(self.middle.a);
            Place {
                a,
                b: self.beside(a),
            }
        };
        let stands_still =
            sweep.crossings == 0 && self.progress(stop) <= self.progress(sweep.start);
        let from = if stands_still { sweep.start } else { stop };
        let (da, db) = (a.wrapping_sub(from.a), b.wrapping_sub(from.b));
        da.abs().max(db.abs())
    }
}
