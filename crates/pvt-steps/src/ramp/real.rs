//! Positive numbers of all magnitudes, for plans.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_wrap,
    reason = "mantissas are normalised; exponents of some products of 64-bit numbers"
)]

use crate::fixed::{Inverse, high};
use core::cmp::Ordering;

/// `mantissa` · 2^`exponent`, 0 or with the highest bit of the mantissa set. Each operation is off
/// by less than 2^-57 of its result. They are functions of their own: once a move, small counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Real {
    mantissa: u64,
    exponent: i32,
}

impl Real {
    pub(super) const ZERO: Self = Self {
        mantissa: 0,
        exponent: 0,
    };

    /// n · 2^exponent.
    pub(super) const fn scaled(n: u64, exponent: i32) -> Self {
        let zeros = n.leading_zeros();
        match n.checked_shl(zeros) {
            Some(mantissa) => Self {
                mantissa,
                exponent: exponent - zeros as i32,
            },
            None => Self::ZERO,
        }
    }

    pub(super) const fn whole(n: u32) -> Self {
        Self::scaled(n as u64, 0)
    }

    #[inline(never)]
    pub(super) const fn times(self, other: Self) -> Self {
        let product = high(self.mantissa, other.mantissa);
        Self::scaled(product, self.exponent + other.exponent + 64)
    }

    /// 0 when divided by 0.
    #[inline(never)]
    pub(super) const fn over(self, other: Self) -> Self {
        match Inverse::of(other.mantissa) {
            Some(inverse) => {
                // A mantissa has no leading zeros.
                let quotient = inverse.times(self.mantissa);
                Self::scaled(quotient, self.exponent - other.exponent - 62)
            }
            None => Self::ZERO,
        }
    }

    pub(super) fn half(self) -> Self {
        Self::scaled(self.mantissa, self.exponent - 1)
    }

    #[inline(never)]
    pub(super) fn plus(self, other: Self) -> Self {
        let (more, less) = if self >= other {
            (self, other)
        } else {
            (other, self)
        };
        let sum = (more.mantissa >> 1) + (less.mantissa_at(more.exponent) >> 1);
        Self::scaled(sum, more.exponent + 1)
    }

    /// 0 when the other is greater.
    #[inline(never)]
    pub(super) fn minus(self, other: Self) -> Self {
        if self <= other {
            return Self::ZERO;
        }
        let rest = self.mantissa - other.mantissa_at(self.exponent);
        Self::scaled(rest, self.exponent)
    }

    pub(super) fn squared(self) -> Self {
        self.times(self)
    }

    #[inline(never)]
    pub(super) fn root(self) -> Self {
        // An even exponent, then the root of 62 or 63 bits, bit by bit, and what is left over
        // twice of it.
        let odd = self.exponent & 1;
        let square = self.mantissa >> (2 - odd);
        let root = (0..32).rev().fold(0_u64, |root, bit| {
            let more = root | (1 << bit);
            if more * more <= square { more } else { root }
        });
        let rest = square - root * root;
        let fraction = Inverse::of(root).map_or(0, |inverse| inverse.quotient(rest, 31));
        Self::scaled(
            (root << 32) + fraction,
            ((self.exponent + 2 - odd) >> 1) - 32,
        )
    }

    /// The nearest whole number, halves up; `None` from 2^63 on.
    #[inline(never)]
    pub(super) fn rounded(self) -> Option<u64> {
        let doubled = self.floor(1)?;
        Some((doubled >> 1) + (doubled & 1))
    }

    /// self · 2^bits, rounded down; `None` from 2^64 on.
    pub(super) fn floor(self, bits: i32) -> Option<u64> {
        let shift = self.exponent + bits;
        if shift <= 0 {
            Some(self.mantissa.checked_shr(shift.unsigned_abs()).unwrap_or(0))
        } else {
            (self.mantissa == 0).then_some(0)
        }
    }

    /// The mantissa at an exponent that is not below its own.
    fn mantissa_at(self, exponent: i32) -> u64 {
        let bits = exponent.abs_diff(self.exponent);
        self.mantissa.checked_shr(bits).unwrap_or(0)
    }
}

impl Ord for Real {
    fn cmp(&self, other: &Self) -> Ordering {
        // 0 has no exponent to compare.
        let key = |real: &Self| (real.mantissa > 0, real.exponent, real.mantissa);
        key(self).cmp(&key(other))
    }
}

impl PartialOrd for Real {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "compared within a tolerance")]
mod tests {
    use super::Real;

    /// Relative error of an operation here and of an `f64` together.
    const CLOSE: f64 = 3e-16;

    fn value(real: Real) -> f64 {
        real.mantissa as f64 * f64::from(real.exponent).exp2()
    }

    #[test]
    fn operations_agree_with_floating_point() {
        let numbers = [
            1_u64,
            2,
            3,
            10,
            999,
            1 << 31,
            u64::from(u32::MAX),
            10_u64.pow(18),
            u64::MAX,
        ];
        for (a, b) in numbers.into_iter().flat_map(|a| numbers.map(|b| (a, b))) {
            for exponent in [-70, -1, 0, 3] {
                let (x, y) = (Real::scaled(a, exponent), Real::scaled(b, 2));
                let (p, q) = (value(x), value(y));
                let close = |real: Real, wanted: f64| {
                    let off = (value(real) - wanted).abs();
                    assert!(
                        off <= CLOSE * wanted,
                        "{a} {exponent} {b}: {real:?}, not {wanted}"
                    );
                };
                close(x.times(y), p * q);
                close(x.over(y), p / q);
                close(x.plus(y), p + q);
                close(x.root(), p.sqrt());
                close(x.half(), p / 2.0);
                assert_eq!(x < y, p < q);
                if p > q {
                    // Of numbers next to each other only the integers are exact.
                    let off = (value(x.minus(y)) - (p - q)).abs();
                    assert!(off <= CLOSE * p);
                } else {
                    assert_eq!(x.minus(y), Real::ZERO);
                }
            }
        }
    }

    #[test]
    fn whole_numbers_come_back() {
        for n in [0, 1, 2, 3, 7, 1000, 1 << 31, 4_294_967_291] {
            let real = Real::whole(n);
            assert_eq!(real.squared().root().rounded(), Some(n.into()));
            assert_eq!(real.rounded(), Some(n.into()));
            assert_eq!(real.floor(3), Some(u64::from(n) << 3));
        }
        assert_eq!(Real::scaled(5, -1).rounded(), Some(3));
        assert_eq!(Real::scaled(5, -1).floor(0), Some(2));
        assert_eq!(Real::scaled(u64::MAX, 1).floor(0), None);
        assert_eq!(Real::scaled(u64::MAX, 0).rounded(), None);
        assert_eq!(Real::ZERO.over(Real::ZERO), Real::ZERO);
    }
}
