//! The range of the numbers that the crate computes with, and roots of them.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, RangeInclusive, Sub};

/// The smallest number above 0 that the crate computes with.
pub(crate) const SMALLEST: f64 = 1e-50;

/// The largest number that the crate computes with: above all that a machine has, and so far from
/// the end of the float type that no fourth power of it leaves it.
pub(crate) const LARGEST: f64 = 1e50;

/// Lengths, speeds, accelerations, jerks and feeds that the crate computes with.
pub(crate) fn range() -> RangeInclusive<f64> {
    SMALLEST..=LARGEST
}

/// What speeds are computed in.
pub(crate) trait Real:
    Copy
    + Default
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Into<f64>
{
    const ZERO: Self;
    const ONE: Self;
    const EPSILON: Self;

    /// The nearest number.
    fn of(x: f64) -> Self;

    /// A number that is not above, next to it.
    #[inline(always)]
    fn at_most(x: f64) -> Self {
        let near = Self::of(x);
        if near.into() > x {
            near * (Self::ONE - Self::EPSILON)
        } else {
            near
        }
    }

    fn abs(self) -> Self;
    fn max(self, other: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn copysign(self, sign: Self) -> Self;
    fn sqrt(self) -> Self;
}

macro_rules! real {
    ($float:ident, $of:expr, $sqrt:path) => {
        impl Real for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const EPSILON: Self = Self::EPSILON;

            #[inline(always)]
            fn of(x: f64) -> Self {
                let of: fn(f64) -> Self = $of;
                of(x)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                self.max(other)
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                self.min(other)
            }

            #[inline(always)]
            fn copysign(self, sign: Self) -> Self {
                self.copysign(sign)
            }

            #[inline]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
        }
    };
}
real!(f64, |x| x, sqrt);
real!(f32, nearest_f32, trig_kernels::sqrt);

#[expect(
    clippy::cast_possible_truncation,
    reason = "the nearest number is wanted"
)]
#[inline(always)]
const fn nearest_f32(x: f64) -> f32 {
    x as f32
}

/// The larger of two numbers; a comparison where `f64::max` is a call of a library.
#[inline]
pub(crate) fn larger<R: PartialOrd>(a: R, b: R) -> R {
    if a > b { a } else { b }
}

/// The smaller of two numbers; a comparison where `f64::min` is a call of a library.
#[inline]
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The larger of two numbers; not a number where either is none, unlike `f64::max`.
pub(crate) fn larger_or_nan(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// The square root: the same bits on a PC and on a microcontroller.
pub(crate) fn sqrt(x: f64) -> f64 {
    libm::sqrt(x)
}

/// Rounds that bring the guess, a few percent off, to its last digits: each triples them.
const ROOT_ROUNDS: u32 = 4;

/// The cube root of a positive number, by Halley's iteration from a third of its logarithm; 0 of
/// those below. The library's has an index in it that cannot be proven.
///
/// ```text
/// y ← y (y³ + 2x) / (2y³ + x)
/// ```
pub(crate) fn cube_root(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if !x.is_finite() {
        return x;
    }
    // The bits of a float are its logarithm, nearly; two thirds of the bits of 1 go on top.
    let guess = f64::from_bits(x.to_bits() / 3 + 1.0_f64.to_bits() / 3 * 2);
    (0..ROOT_ROUNDS).fold(guess, |y, _| {
        let cube = y * y * y;
        y * ((cube + 2.0 * x) / (2.0 * cube + x))
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn cube_roots() {
        for x in [1e-300, 1e-80, 1e-9, 0.3, 1.0, 8.0, 1e9, 1e86, 1e300] {
            let root = super::cube_root(x);
            assert!(
                (root / libm::cbrt(x) - 1.0).abs() < 4.0 * f64::EPSILON,
                "{x}"
            );
        }
        assert_eq!(super::cube_root(0.0).to_bits(), 0);
        assert_eq!(super::cube_root(-1.0).to_bits(), 0);
        assert!(super::cube_root(f64::NAN).is_nan());
    }
}
