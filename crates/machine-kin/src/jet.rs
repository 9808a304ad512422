//! Derivatives along a parameter, by the recurrences of Taylor coefficients.
//!
//! With a = Σ aₖ hᵏ and so on, each from the coefficients before it:
//!
//! ```text
//! c = a b        cₖ = Σ aⱼ bₖ₋ⱼ
//! c = a / b      cₖ = (aₖ - Σ cⱼ bₖ₋ⱼ) / b₀                        j < k
//! c = √a         cₖ = (aₖ - Σ cⱼ cₖ₋ⱼ) / 2c₀                       0 < j < k
//! s, c = sin a, cos a     k sₖ = Σ j aⱼ cₖ₋ⱼ,  k cₖ = -Σ j aⱼ sₖ₋ⱼ     0 < j ≤ k
//! θ = atan2(y, x)         θ' = (x y' - y x') / (x² + y²)
//! ```

use crate::number::{Number, Refusal, operators};

/// A number that changes along a parameter: `K` Taylor coefficients, the k-th of them the k-th
/// derivative over k!. `Jet<f64, 3>` has value, slope and half the second derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet<T, const K: usize> {
    coefficients: [T; K],
}

/// What divides coefficients: whole numbers.
#[expect(clippy::cast_precision_loss, reason = "a handful of coefficients")]
const fn whole(k: usize) -> f64 {
    k as f64
}

impl<T: Number, const K: usize> Jet<T, K> {
    /// By its Taylor coefficients.
    #[must_use]
    pub const fn new(coefficients: [T; K]) -> Self {
        Self { coefficients }
    }

    /// The Taylor coefficients.
    #[must_use]
    pub const fn coefficients(&self) -> &[T; K] {
        &self.coefficients
    }

    #[inline]
    fn first(&self) -> T {
        self.coefficients
            .first()
            .map_or_else(|| T::from(0.0), |c| *c)
    }

    #[inline]
    fn each(self, of: impl Fn(T) -> T) -> Self {
        Self::new(self.coefficients.map(of))
    }

    #[inline]
    fn pairs(self, other: Self, of: impl Fn(T, T) -> T) -> Self {
        let mut coefficients = self.coefficients;
        for (a, b) in coefficients.iter_mut().zip(other.coefficients) {
            *a = of(*a, b);
        }
        Self::new(coefficients)
    }

    /// Each coefficient from its number.
    #[inline(always)]
    fn by_number(of: impl Fn(usize) -> T) -> Self {
        let mut coefficients = [T::from(0.0); K];
        for (k, coefficient) in coefficients.iter_mut().enumerate() {
            *coefficient = of(k);
        }
        Self::new(coefficients)
    }

    /// Coefficients each of which follows from those before it.
    #[inline(always)]
    fn one_by_one(first: T, next: impl Fn(usize, &[T; K]) -> T) -> Self {
        let mut coefficients = [first; K];
        for k in 1..K {
            let value = next(k, &coefficients);
            if let Some(coefficient) = coefficients.get_mut(k) {
                *coefficient = value;
            }
        }
        Self::new(coefficients)
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
        self.each(|a| -a)
    }

    #[inline]
    fn shifted(mut self, by: f64) -> Self {
        if let Some(first) = self.coefficients.first_mut() {
            *first = *first + by;
        }
        self
    }

    #[inline]
    fn scaled(self, by: f64) -> Self {
        self.each(|a| a * by)
    }

    #[inline]
    fn divided(self, by: f64) -> Self {
        self.each(|a| a / by)
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        let (a, b) = (&self.coefficients, &other.coefficients);
        Self::by_number(|k| folded(a, b, 0..k.saturating_add(1), k))
    }

    #[inline]
    fn over(self, other: Self) -> Self {
        let (a, b) = (&self.coefficients, &other.coefficients);
        let inverse = T::from(1.0) / other.first();
        Self::one_by_one(self.first() * inverse, |k, c| {
            (at(a, k) - folded(c, b, 0..k, k)) * inverse
        })
    }

    /// The derivative; its last coefficient is not known and 0.
    #[inline]
    fn derivative(self) -> Self {
        let next = |k: usize| k.saturating_add(1);
        Self::by_number(|k| at(&self.coefficients, next(k)) * whole(next(k)))
    }
}

#[inline(always)]
fn at<T: Number, const K: usize>(coefficients: &[T; K], k: usize) -> T {
    coefficients.get(k).map_or_else(|| T::from(0.0), |c| *c)
}

/// Σ aⱼ bₖ₋ⱼ over a range of j up to k.
#[inline(always)]
fn folded<T: Number, const K: usize>(
    a: &[T; K],
    b: &[T; K],
    range: core::ops::Range<usize>,
    k: usize,
) -> T {
    let mut sum = None;
    for j in range {
        let term = at(a, j) * at(b, k.saturating_sub(j));
        sum = Some(match sum {
            None => term,
            Some(sum) => sum + term,
        });
    }
    sum.unwrap_or_else(|| T::from(0.0))
}

impl<T: Number, const K: usize> From<f64> for Jet<T, K> {
    #[inline]
    fn from(value: f64) -> Self {
        let mut coefficients = [T::from(0.0); K];
        if let Some(first) = coefficients.first_mut() {
            *first = T::from(value);
        }
        Self::new(coefficients)
    }
}

operators!([T: Number, const K: usize] Jet<T, K>);

impl<T: Number, const K: usize> Number for Jet<T, K> {
    #[inline]
    fn squared(self) -> Self {
        let a = &self.coefficients;
        Self::by_number(|k| {
            // Each pair once, and the square in the middle.
            let pairs = folded(a, a, 0..k.div_ceil(2), k) * 2.0;
            if k % 2 == 0 {
                pairs + at(a, k / 2).squared()
            } else {
                pairs
            }
        })
    }

    fn root(self, reason: &'static str) -> Result<Self, Refusal> {
        let root = self.first().root(reason)?;
        let inverse = T::from(0.5) / root;
        Ok(Self::one_by_one(root, |k, c| {
            (at(&self.coefficients, k) - folded(c, c, 1..k, k)) * inverse
        }))
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.first().sin_cos();
        let slope = self.derivative().coefficients;
        let (mut s, mut c) = ([sin; K], [cos; K]);
        for k in 1..K {
            let before = k.saturating_sub(1);
            let (rise, fall) = (
                folded(&slope, &c, 0..k, before) / whole(k),
                -folded(&slope, &s, 0..k, before) / whole(k),
            );
            if let (Some(s), Some(c)) = (s.get_mut(k), c.get_mut(k)) {
                (*s, *c) = (rise, fall);
            }
        }
        (Self::new(s), Self::new(c))
    }

    fn atan2(y: Self, x: Self, reason: &'static str) -> Result<Self, Refusal> {
        let angle = T::atan2(y.first(), x.first(), reason)?;
        let turn = x * y.derivative() - y * x.derivative();
        let slope = turn / (x.squared() + y.squared());
        Ok(Self::one_by_one(angle, |k, _| {
            at(&slope.coefficients, k.saturating_sub(1)) / whole(k)
        }))
    }

    fn is_positive(self, reason: &'static str) -> Result<bool, Refusal> {
        self.first().is_positive(reason)
    }

    fn middle(self) -> f64 {
        self.first().middle()
    }
}
