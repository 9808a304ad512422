//! A piece of a curve as intervals: every place of it, and every derivative.

use path_timing::CurveMotion;

use crate::matrix::Bounded;
use crate::model::Model;
use crate::{Interval, Jet};

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

/// One over k!
const FACTORIALS: [f64; 5] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0];

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

    /// Half of the part.
    pub(super) const fn half(&self) -> f64 {
        self.half
    }

    /// Taylor coefficients at every τ of the part, each derivative from the next two and what
    /// bounds the one after.
    ///
    /// ```text
    /// |P⁽ᵏ⁾(τ) - P⁽ᵏ⁾(m)| ≤ |P⁽ᵏ⁺¹⁾(m)| t + |P⁽ᵏ⁺²⁾(m)| t²/2 + max |P⁽ᵏ⁺³⁾| t³/6      t = max |τ - m|
    /// ```
    pub(super) fn jets(&self) -> [Jet<Interval, 5>; N] {
        let [_, _, l3, l4, l5] = self.longest;
        let (t, t2) = (self.half, self.half * self.half / 2.0);
        let t3 = t2 * t / 3.0;
        let jet = |[p, p1, p2, p3, p4]: [f64; 5]| {
            let [a1, a2, a3, a4] = [p1, p2, p3, p4].map(f64::abs);
            let derivatives = [
                (p, a1 * t + a2 * t2 + l3 * t3),
                (p1, a2 * t + a3 * t2 + l4 * t3),
                (p2, a3 * t + a4 * t2 + l5 * t3),
                (p3, a4 * t + l5 * t2),
                (p4, l5 * t),
            ];
            let mut coefficients = [Interval::UNKNOWN; 5];
            let known = derivatives.iter().zip(self.roundings()).zip(FACTORIALS);
            for (coefficient, (((value, by), rounding), factor)) in
                coefficients.iter_mut().zip(known)
            {
                let by = by * (1.0 + ROUNDING) + rounding;
                *coefficient = Interval::around(*value, by) * factor;
            }
            Jet::new(coefficients)
        };
        transposed(&self.middle).map(jet)
    }

    /// Every place within a radius of the part, along its time from -1 to 1.
    pub(super) fn models<const K: usize>(&self, radius: &[f64; N]) -> [Model<K>; N] {
        let [.., l5] = self.longest;
        let (t, t2) = (self.half, self.half * self.half / 2.0);
        let (t3, t4) = (t2 * t / 3.0, t2 * t2 / 6.0);
        let powers = [1.0, t, t2, t3, t4];
        let rounding = (self.roundings().into_iter().zip(powers)).map(|(by, power)| by * power);
        let rounding = rounding.sum::<f64>() + l5 * t4 * t / 5.0;
        let mut models = [Model::from(0.0); N];
        let known = transposed(&self.middle).into_iter().zip(radius);
        for (model, (derivatives, by)) in models.iter_mut().zip(known) {
            let mut coefficients = [0.0; K];
            let mut rest = by + rounding;
            for (number, (derivative, power)) in derivatives.iter().zip(powers).enumerate() {
                match coefficients.get_mut(number) {
                    Some(coefficient) => *coefficient = derivative * power,
                    None => rest += (derivative * power).abs(),
                }
            }
            *model = Model::new(coefficients, rest * (1.0 + ROUNDING));
        }
        models
    }

    /// Every place of a whole segment, along its time from -1 to 1, as a series of a series: known
    /// better than by [`models`](Self::models) where the point is accelerated.
    pub(super) fn series<const K: usize>(&self, motion: &CurveMotion<'_, N>) -> [Model<K>; N] {
        let series = motion.series(0.5);
        let mut parameter = [0.0; K];
        let mut power = 1.0;
        for (place, coefficient) in parameter.iter_mut().skip(1).zip(series.parameter) {
            power *= 0.5;
            *place = coefficient * power;
        }
        let parameter = Model::new(parameter, 0.0);
        let most = parameter.most();
        let cube = most * most * most;
        // The place, its derivatives, and the parameter are rounded.
        let rest = 4.0 * self.rounding + series.longest_sixth * (cube * cube) / 720.0;
        let mut places = [Model::from(0.0); N];
        for (place, [.., fifth]) in places.iter_mut().zip(transposed(&series.derivatives)) {
            *place = Model::from(fifth / 120.0);
        }
        let factors = [1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];
        let lower = series.derivatives.iter().rev().skip(1);
        for (derivatives, factor) in lower.zip(factors) {
            for (place, derivative) in places.iter_mut().zip(derivatives) {
                *place = *place * parameter + derivative * factor;
            }
        }
        places.map(|place| place.farther(rest))
    }

    /// Every place of the part.
    pub(super) fn places(&self) -> [Interval; N] {
        self.models::<2>(&[0.0; N]).map(|model| model.range())
    }

    /// What the place and each derivative are rounded by.
    fn roundings(&self) -> [f64; 5] {
        let [l1, l2, l3, l4, _] = self.longest;
        let [l1, l2, l3, l4] = [l1, l2, l3, l4].map(|longest| longest * ROUNDING);
        [self.rounding, l1, l2, l3, l4]
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
