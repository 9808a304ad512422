//! Taylor models: polynomials along a piece of a path, and the most that they are off by.
//!
//! ```text
//! f(t) ∈ Σ cₖ tᵏ ± r      |t| ≤ 1,  k < K
//! ```
//!
//! What a product has beyond the last power goes to the remainder, as does what its coefficients
//! are rounded by: less than K ε Σ |aᵢ| Σ |bⱼ| with ε = 2⁻⁵². Quotients and roots are found by the
//! recurrences of [`Jet`], whose rounding does not count, and judged by what they leave:
//!
//! ```text
//! |a / b - g| = |a - g b| / |b|      |√a - g| = |a - g²| / (√a + g)
//! ```
//!
//! So a function is known as well as its next derivative is small, however often a variable stands
//! in it. Sines and arc tangents are those of the middle turned by short series.

use trig_kernels::{atan2, sin_cos, sqrt};

use crate::interval::{LEAST, LOST};
use crate::matrix::Bounded;
use crate::number::{Number, Refusal, operators};
use crate::{Interval, Jet};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Model<const K: usize> {
    coefficients: [f64; K],
    /// Infinite or not a number where nothing is known.
    rest: f64,
}

/// Farthest that an angle is from its middle, as its tangent, for a series to be used.
const SHORT: f64 = 0.5;

impl<const K: usize> Model<K> {
    pub(crate) const fn new(coefficients: [f64; K], rest: f64) -> Self {
        Self { coefficients, rest }
    }

    /// The numbers that it can be.
    pub(crate) fn range(&self) -> Interval {
        Interval::around(self.first(), self.change())
    }

    /// The polynomial.
    pub(crate) const fn coefficients(&self) -> &[f64; K] {
        &self.coefficients
    }

    /// The most that it is off by.
    pub(crate) const fn rest(&self) -> f64 {
        self.rest
    }

    #[inline]
    fn first(&self) -> f64 {
        self.coefficients.first().copied().unwrap_or(f64::NAN)
    }

    /// Σ |cₖ|
    #[inline]
    fn size(&self) -> f64 {
        self.coefficients.iter().map(|c| c.abs()).sum()
    }

    /// The most that it is from its first coefficient.
    #[inline]
    fn change(&self) -> f64 {
        let rest = self.coefficients.iter().skip(1).map(|c| c.abs());
        (rest.sum::<f64>() + self.rest) * LOST
    }

    /// From a polynomial and a rest as computed, with what both are rounded by where the numbers
    /// that it was computed of are of this size.
    #[inline]
    fn rounded(coefficients: [f64; K], rest: f64, size: f64) -> Self {
        let rest = (rest + size * EACH + LEAST) * LOST;
        Self { coefficients, rest }
    }

    #[inline]
    fn pairs(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let mut coefficients = self.coefficients;
        for (a, b) in coefficients.iter_mut().zip(other.coefficients) {
            *a = of(*a, b);
        }
        let rest = self.rest + other.rest;
        let model = Self { coefficients, rest };
        Self::rounded(coefficients, rest, model.size())
    }

    #[inline]
    fn each(self, factor: f64, of: impl Fn(f64) -> f64) -> Self {
        let coefficients = self.coefficients.map(of);
        let rest = self.rest * factor.abs();
        let model = Self { coefficients, rest };
        Self::rounded(coefficients, rest, model.size())
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        self.pairs(other, |a, b| a + b)
    }

    #[inline]
    fn minus(self, other: Self) -> Self {
        self.pairs(other, |a, b| a - b)
    }

    #[inline]
    fn negated(self) -> Self {
        Self {
            coefficients: self.coefficients.map(|a| -a),
            rest: self.rest,
        }
    }

    #[inline]
    fn shifted(mut self, by: f64) -> Self {
        let Some(first) = self.coefficients.first_mut() else {
            return self;
        };
        *first += by;
        let rounding = first.abs() * f64::EPSILON;
        self.rest = (self.rest + rounding) * LOST;
        self
    }

    #[inline]
    fn scaled(self, by: f64) -> Self {
        self.each(by, |a| a * by)
    }

    #[inline]
    fn divided(self, by: f64) -> Self {
        let inverse = 1.0 / by;
        // Rounded once more, which is within what each is given.
        self.each(inverse, |a| a * inverse)
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        let mut coefficients = [0.0; K];
        for (i, a) in self.coefficients.iter().enumerate() {
            for (j, b) in other.coefficients.iter().enumerate() {
                if let Some(coefficient) = coefficients.get_mut(i.saturating_add(j)) {
                    *coefficient += a * b;
                }
            }
        }
        // Of the last coefficients of the other, so many: Σ |bⱼ|.
        let (mut beyond, mut last) = (0.0, 0.0);
        let pairs = self
            .coefficients
            .iter()
            .zip(other.coefficients.iter().rev());
        for (a, last_b) in pairs {
            beyond += a.abs() * last;
            last += last_b.abs();
        }
        let (a, b) = (self.size(), last);
        let rest = beyond + a * other.rest + self.rest * (b + other.rest);
        Self::rounded(coefficients, rest, a * b)
    }

    #[inline]
    fn over(self, other: Self) -> Self {
        let least = other.first().abs() - other.change();
        // Written so that NaN is unknown too.
        let is_apart = least > 0.0;
        if !is_apart {
            return Self::new([f64::NAN; K], f64::NAN);
        }
        let jets = Jet::new(self.coefficients) / Jet::new(other.coefficients);
        let found = Self::new(*jets.coefficients(), 0.0);
        let left = self - found * other;
        found.with_rest(left.most() / least)
    }

    /// Off by more.
    #[inline]
    pub(crate) fn farther(self, by: f64) -> Self {
        Self {
            rest: (self.rest + by + LEAST) * LOST,
            ..self
        }
    }

    #[inline]
    fn with_rest(self, rest: f64) -> Self {
        // A difference of what is close, and a quotient, are off by less than a thousandth.
        Self {
            rest: rest * (1.0 + LOOSE) + LEAST,
            ..self
        }
    }
}

/// The fifth power, rounded up.
fn fifth_power(x: f64) -> f64 {
    let square = x * x;
    square * square * x * (1.0 + LOOSE)
}

/// What the rounding of one coefficient is at most, as a part of the numbers that it was computed
/// of: of up to eight products and their sums.
const EACH: f64 = 8.0 * f64::EPSILON;

/// What least distances are rounded by.
const LOOSE: f64 = 1e-3;

impl<const K: usize> From<f64> for Model<K> {
    #[inline]
    fn from(value: f64) -> Self {
        let mut coefficients = [0.0; K];
        if let Some(first) = coefficients.first_mut() {
            *first = value;
        }
        // Of what is infinite or not a number nothing is known.
        Self::new(coefficients, value * 0.0)
    }
}

operators!([const K: usize] Model<K>);

impl<const K: usize> Bounded for Model<K> {
    #[inline]
    fn most(&self) -> f64 {
        (self.size() + self.rest) * LOST
    }
}

impl<const K: usize> Number for Model<K> {
    #[inline]
    fn squared(self) -> Self {
        self * self
    }

    fn root(self, reason: &'static str) -> Result<Self, Refusal> {
        let (middle, change) = (self.first(), self.change());
        let least = middle - change;
        // Written so that NaN is undecided.
        let is_positive = least > 0.0;
        if !is_positive {
            return Err(if -middle > change {
                Refusal::proven(reason, -middle - change)
            } else {
                Refusal::undecided(reason)
            });
        }
        let found = Jet::new(self.coefficients).root(reason)?;
        let found = Self::new(*found.coefficients(), 0.0);
        let left = (self - found * found).most();
        // That of the polynomial may be below 0, the root itself is not.
        let least = sqrt(least) * (1.0 - LOOSE) + (found.first() - found.change()).max(0.0);
        Ok(found.with_rest(left / least))
    }

    fn sin_cos(self) -> (Self, Self) {
        let middle = self.first();
        let turned = self - middle;
        let most = turned.most();
        // Written so that NaN is any angle.
        let is_short = most <= SHORT;
        if !is_short {
            let any = Self::new(Self::from(0.0).coefficients, 1.0);
            return (any, any);
        }
        let (sin, cos) = sin_cos(middle);
        let square = turned.squared();
        let small_sin = ((square / 120.0 - 1.0 / 6.0) * square + 1.0) * turned;
        let small_cos = (square / 24.0 - 0.5) * square + 1.0;
        // What follows the last term of each series, at most.
        let fifth = fifth_power(most);
        let small_sin = small_sin.farther(fifth * most * most / 5040.0 + EACH);
        let small_cos = small_cos.farther(fifth * most / 720.0 + EACH);
        (
            (small_cos * sin + small_sin * cos).farther(EACH),
            (small_cos * cos - small_sin * sin).farther(EACH),
        )
    }

    fn atan2(y: Self, x: Self, reason: &'static str) -> Result<Self, Refusal> {
        // Turned back by the angle in the middle.
        let (y0, x0) = (y.first(), x.first());
        let (along, across) = (x * x0 + y * y0, y * x0 - x * y0);
        let tangent = across / along;
        let most = tangent.most();
        let is_ahead = along.first() > along.change();
        // Written so that NaN is undecided.
        if !(is_ahead && most <= SHORT) {
            // A range is known where the vector is not 0, and nothing else.
            let range = Interval::atan2(y.range(), x.range(), reason)?;
            let model = Self::from(range.middle());
            return Ok(Self::new(model.coefficients, range.radius()));
        }
        let square = tangent.squared();
        let angle = ((square * 0.2 - 1.0 / 3.0) * square + 1.0) * tangent;
        let middle = atan2(y0, x0);
        // What follows the last term of the series, at most, and what its factors are rounded by.
        let beyond = fifth_power(most) * most * most / 7.0 + most * EACH;
        Ok((angle + middle).farther(beyond + middle.abs() * EACH))
    }

    fn is_positive(self, reason: &'static str) -> Result<bool, Refusal> {
        self.range().is_positive(reason)
    }

    fn middle(self) -> f64 {
        self.first()
    }
}

#[cfg(test)]
mod tests {
    use astro_float_num::{BigFloat, Consts, RoundingMode};
    use proptest::prelude::*;

    use super::Model;
    use crate::matrix::Bounded;
    use crate::{Number, Refusal};

    const BITS: usize = 256;
    const TO: RoundingMode = RoundingMode::ToEven;

    fn exact(x: f64) -> BigFloat {
        BigFloat::from_f64(x, BITS)
    }

    /// The polynomial, exactly.
    fn at(coefficients: &[f64], t: f64) -> BigFloat {
        let coefficients = coefficients.iter().rev();
        coefficients.fold(exact(0.0), |sum, c| {
            sum.mul(&exact(t), BITS, TO).add(&exact(*c), BITS, TO)
        })
    }

    fn holds<const K: usize>(model: &Model<K>, t: f64, value: &BigFloat) -> bool {
        let apart = at(&model.coefficients, t).sub(value, BITS, TO).abs();
        model.rest.is_nan() || apart <= exact(model.rest)
    }

    fn any_model() -> impl Strategy<Value = [f64; 4]> {
        let sizes = prop_oneof![Just(1.0), Just(1e-3), Just(1e-9), Just(300.0)];
        (prop::array::uniform4(-1.0..1.0_f64), sizes, -2.0..2.0_f64).prop_map(
            |([a, b, c, d], size, middle)| [middle + a * size, b * size, c * size, d * size],
        )
    }

    /// All functions, beside exact arithmetic of all that the models can be.
    fn all_hold<const K: usize>(
        [a, b]: [[f64; K]; 2],
        off: f64,
        by: f64,
        t: f64,
    ) -> Result<(), TestCaseError> {
        let (x, y) = (Model::new(a, off), Model::new(b, 0.0));
        let consts = Consts::new().map_err(|_| TestCaseError::fail("no constants"));
        let mut consts = consts?;
        for side in [-1.0, 0.0, 1.0] {
            let u = at(&a, t).add(&exact(off * side), BITS, TO);
            let v = at(&b, t);
            prop_assert!(holds(&(x + y), t, &u.add(&v, BITS, TO)));
            prop_assert!(holds(&(x - y), t, &u.sub(&v, BITS, TO)));
            prop_assert!(holds(&(x * y), t, &u.mul(&v, BITS, TO)));
            prop_assert!(holds(&(x / y), t, &u.div(&v, BITS, TO)));
            prop_assert!(holds(&(x + by), t, &u.add(&exact(by), BITS, TO)));
            prop_assert!(holds(&(x * by), t, &u.mul(&exact(by), BITS, TO)));
            prop_assert!(holds(&(x / by), t, &u.div(&exact(by), BITS, TO)));
            if let Ok(root) = x.root("") {
                prop_assert!(holds(&root, t, &u.sqrt(BITS, TO)));
            }
            let (sin, cos) = x.sin_cos();
            prop_assert!(holds(&sin, t, &u.sin(BITS, TO, &mut consts)));
            prop_assert!(holds(&cos, t, &u.cos(BITS, TO, &mut consts)));
            if let Ok(angle) = Model::atan2(x, y, "") {
                // The angle of (u, v) is that of the middle and an arc tangent.
                let turned = (angle - angle.middle()).most();
                prop_assume!(turned < 1.0);
                let found = at(&angle.coefficients, t);
                let (sin, cos) = (
                    found.sin(BITS, TO, &mut consts),
                    found.cos(BITS, TO, &mut consts),
                );
                let across = u.mul(&cos, BITS, TO).sub(&v.mul(&sin, BITS, TO), BITS, TO);
                let along = v.mul(&cos, BITS, TO).add(&u.mul(&sin, BITS, TO), BITS, TO);
                let apart = across
                    .div(&along, BITS, TO)
                    .atan(BITS, TO, &mut consts)
                    .abs();
                prop_assert!(apart <= exact(angle.rest), "{apart} {angle:?}");
            }
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn models_hold_the_exact_values(
            a in any_model(), b in any_model(), off in 0.0..1e-3_f64, by in -3.0..3.0_f64, t in -1.0..=1.0_f64,
        ) {
            all_hold([a, b], off, by, t)?;
            // Of more coefficients the last are those of products alone.
            let longer = |[a, b, c, d]: [f64; 4]| [a, b, c, d, 0.0, 0.0, 0.0, 0.0];
            all_hold([a, b].map(longer), off, by, t)?;
        }
    }

    /// What is known is known well: of a short piece to the fourth power of its length.
    #[test]
    fn models_are_narrow() -> Result<(), Refusal> {
        let found = [0.1, 0.05].map(|length| {
            let x = Model::<4>::new([2.0, length, 0.0, 0.0], 0.0);
            let y = (x * x + 1.0).root("")? / (x + 3.0);
            Model::atan2(y - x, x * y, "").map(|angle| angle.rest)
        });
        let [long, short] = found;
        let (long, short) = (long?, short?);
        assert!(long < 1e-4 && short < long / 12.0, "{long} {short}");
        let unknown = Model::<4>::from(1.0) / Model::new([0.1, 0.2, 0.0, 0.0], 0.0);
        assert!(unknown.rest.is_nan() && unknown.root("").is_err());
        assert!(unknown.is_positive("").is_err() && Model::atan2(unknown, unknown, "").is_err());
        assert!((Model::<4>::from(f64::INFINITY) * 0.0).rest.is_nan());
        Ok(())
    }
}
