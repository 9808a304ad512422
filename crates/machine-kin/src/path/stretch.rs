//! A piece of a curve as intervals: every place of it, and every derivative.

use path_timing::CurveMotion;

use crate::{Interval, Jet, Number};

/// Where a point that runs along a curve is, and how it moves, over a part of its time.
pub(super) struct Stretch<const N: usize> {
    /// In the middle of the part: place and four derivatives.
    middle: [[f64; N]; 5],
    /// The longest that derivatives 1 to 5 are.
    longest: [f64; 5],
    /// Half of the part.
    half: f64,
    /// Rounding of a position, in the unit of length.
    rounding: f64,
}

/// What values, and derivatives of the same length, may be off by.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl<const N: usize> Stretch<N> {
    /// From τ = `from` to `to` of a motion whose places are computed to `rounding`.
    pub(super) fn new(motion: &CurveMotion<'_, N>, [from, to]: [f64; 2], rounding: f64) -> Self {
        let [l1, l2, l3, l4] = *motion.longest();
        Self {
            middle: motion.jet((from + to) * 0.5),
            longest: [l1, l2, l3, l4, motion.longest_fifth()],
            half: (to - from) * 0.5,
            rounding,
        }
    }

    /// The place in the middle.
    pub(super) const fn middle(&self) -> &[f64; N] {
        let [middle, ..] = &self.middle;
        middle
    }

    /// Half of the part.
    pub(super) const fn half(&self) -> f64 {
        self.half
    }

    /// Taylor coefficients at every τ of the part, each from the next.
    ///
    /// ```text
    /// P⁗(τ) ∈ P⁗(m) + t [P⁽⁵⁾]     P‴(τ) ∈ P‴(m) + t P⁗(m) + t²/2 [P⁽⁵⁾]     ...     t = τ - m
    /// ```
    pub(super) fn jets(&self) -> [Jet<Interval, 5>; N] {
        let [l1, l2, l3, l4, l5] = self.longest;
        let t = Interval::new(-self.half, self.half);
        let square = t.squared();
        let t2 = square * 0.5;
        let (t3, t4) = (t2 * t / 3.0, square.squared() / 24.0);
        let fifth = Interval::new(-l5, l5);
        let [rest, rest2, rest3, rest4] = [t, t2, t3, t4].map(|power| fifth * power);
        let rest5 = rest4 * (t / 5.0);
        let jet = |[p, p1, p2, p3, p4]: [f64; 5]| {
            let [first, second, third, fourth] = [(p1, l1), (p2, l2), (p3, l3), (p4, l4)]
                .map(|(value, longest)| Interval::around(value, longest * ROUNDING));
            let place = Interval::around(p, self.rounding);
            Jet::new([
                place + first * t + second * t2 + third * t3 + fourth * t4 + rest5,
                first + second * t + third * t2 + fourth * t3 + rest4,
                (second + third * t + fourth * t2 + rest3) * 0.5,
                (third + fourth * t + rest2) / 6.0,
                (fourth + rest) / 24.0,
            ])
        };
        transposed(&self.middle).map(jet)
    }

    /// The first Taylor coefficients in the middle.
    pub(super) fn middle_jets(&self) -> [Jet<Interval, 3>; N] {
        let [l1, l2, ..] = self.longest;
        transposed(&self.middle).map(|[p, p1, p2, ..]| {
            Jet::new([
                Interval::around(p, self.rounding),
                Interval::around(p1, l1 * ROUNDING),
                Interval::around(p2, l2 * ROUNDING) * 0.5,
            ])
        })
    }

    /// Every place of the part.
    pub(super) fn places(&self) -> [Interval; N] {
        self.jets().map(|jet| {
            let [place, ..] = *jet.coefficients();
            place
        })
    }
}

/// The numbers of each coordinate.
fn transposed<const K: usize, const N: usize>(rows: &[[f64; N]; K]) -> [[f64; K]; N] {
    let mut columns = [[0.0; K]; N];
    for (number, row) in rows.iter().enumerate() {
        for (column, value) in columns.iter_mut().zip(row) {
            if let Some(place) = column.get_mut(number) {
                *place = *value;
            }
        }
    }
    columns
}
