//! Fixed-point numbers in 64 bits: fractions of a row and small ratios in 2^-62, and reciprocals.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "each function states its ranges"
)]

/// Bits after the point of fractions and ratios.
pub(crate) const RATIO_BITS: u32 = 62;
/// The whole of a row.
pub(crate) const ONE: u64 = 1 << RATIO_BITS;

/// a b 2^-64, rounded down.
pub(crate) const fn high(a: u64, b: u64) -> u64 {
    ((a as u128 * b as u128) >> 64) as u64
}

/// a b 2^-64, rounded down.
pub(crate) const fn signed_high(a: i64, b: u64) -> i64 {
    // As unsigned, a negative a is too great by 2^64.
    high(a as u64, b).wrapping_sub(b & (a >> 63) as u64) as i64
}

/// a s rounded down, for a fraction s <= [`ONE`] and |a| < 2^62.
pub(crate) const fn fraction(a: i64, s: u64) -> i64 {
    signed_high(a << 1, s << 1)
}

/// Product of two ratios rounded down, for |a| < 1 and b < 2.
pub(crate) const fn times(a: i64, b: u64) -> i64 {
    signed_high(a << 1, b << 1)
}

/// x · 2^bits, rounded down.
pub(crate) const fn shifted(x: i64, bits: i32) -> i64 {
    let count = bits.unsigned_abs();
    if count > 63 {
        0
    } else if bits < 0 {
        x >> count
    } else {
        x << count
    }
}

/// 1 / x = `factor` · 2^(`zeros` - 126), never too great and within 2^-58 of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Inverse {
    /// Above 2^62, below 2^63.
    factor: u64,
    /// Leading zeros of x.
    zeros: u32,
}

impl Inverse {
    /// `None` for 0.
    pub(crate) const fn of(x: u64) -> Option<Self> {
        if x == 0 {
            return None;
        }
        let zeros = x.leading_zeros();
        let m = x << zeros;
        // 2^80 / m within 2^-15 by division, then Newton's rule, which squares what it is off:
        // r = 2^n / m (1 + e) becomes r - r e.
        let q = match u32::MAX.checked_div((m >> 48) as u32) {
            Some(q) => q as i64,
            None => return None,
        };
        let e = (1 << 48) - (m >> 32) as i64 * q;
        let r = (q << 15) + ((q * e) >> 33);
        let e = (1 << 62) - high(m, (r as u64) << 31) as i64;
        let r = (r << 31) + ((r * (e >> 2)) >> 29);
        // e was rounded up by a quarter of its unit at most, which is 8 here.
        let r = r - 8;
        Some(Self {
            factor: r as u64,
            zeros,
        })
    }

    /// n / x as a fraction; `None` above [`ONE`].
    pub(crate) const fn fraction(self, n: u64) -> Option<u64> {
        if n.leading_zeros() < self.zeros {
            return None;
        }
        let fraction = high(n << self.zeros, self.factor);
        if fraction <= ONE {
            Some(fraction)
        } else {
            None
        }
    }

    /// n / x as a ratio, for |n| <= x / 2.
    pub(crate) const fn ratio(self, n: i64) -> i64 {
        signed_high(n << self.zeros, self.factor)
    }

    /// n 2^bits / x, rounded down, for results below 2^63.
    pub(crate) const fn quotient(self, n: u64, bits: i32) -> u64 {
        let bits = self.zeros as i32 + bits - RATIO_BITS as i32;
        shifted(self.times(n) as i64, bits) as u64
    }

    /// n 2^(62 - zeros) / x, rounded down, below 2^63.
    pub(crate) const fn times(self, n: u64) -> u64 {
        high(n, self.factor)
    }
}

/// n / d, rounded down; 0 for d = 0. Small rather than fast.
pub(crate) const fn quotient(n: u64, d: u64) -> u64 {
    let Some(inverse) = Inverse::of(d) else {
        return 0;
    };
    // Never too great, as 1 / d is not, and less than 2^6 too small.
    let mut quotient = inverse.quotient(n, 0);
    let mut rest = n - quotient * d;
    while rest >= d {
        rest -= d;
        quotient += 1;
    }
    quotient
}

/// The first fraction from `low` to `high` where `test` holds, when it holds from there on.
pub(crate) fn first(mut low: u64, mut high: u64, test: impl Fn(u64) -> bool) -> u64 {
    while high - low > 1 {
        let middle = low + ((high - low) >> 1);
        if test(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

#[cfg(test)]
#[expect(clippy::integer_division_remainder_used, reason = "no divisor is zero")]
mod tests {
    use super::*;

    /// Numbers of all magnitudes, and those next to powers of two.
    fn numbers() -> impl Iterator<Item = u64> {
        let mut state = 1_u64;
        let random = (0..2000).map(move |n| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> (n % 64)).max(1)
        });
        let edges = (0..64).flat_map(|bit| {
            let power = 1_u64 << bit;
            [
                power,
                power | (power >> 1),
                power.wrapping_sub(1).max(1),
                power | 1,
            ]
        });
        random.chain(edges)
    }

    #[test]
    fn reciprocals_are_never_too_great_and_nearly_exact() {
        for x in numbers() {
            let inverse = Inverse::of(x).unwrap();
            let exact = (1_u128 << 126) / (u128::from(x) << inverse.zeros);
            let off = exact.checked_sub(u128::from(inverse.factor));
            // 2^-58 of 2^62 to 2^63.
            assert!(off.is_some_and(|off| off <= 32), "{x}: {off:?}");
        }
        assert!(Inverse::of(0).is_none());
    }

    #[test]
    fn quotients_are_exact() {
        for (n, d) in numbers().zip(numbers().skip(7)) {
            assert_eq!(quotient(n, d), n / d, "{n} / {d}");
        }
        assert_eq!(quotient(u64::MAX, 1), u64::MAX);
        assert_eq!(quotient(7, 0), 0);
    }

    #[test]
    fn products_are_rounded_down() {
        for (a, b) in numbers().zip(numbers().skip(3)) {
            let (a, b) = ((a >> 3) as i64, b & (ONE - 1));
            for a in [a, -a] {
                let exact = (i128::from(a) * i128::from(b)) >> RATIO_BITS;
                assert_eq!(i128::from(fraction(a, b)), exact);
            }
            assert_eq!(fraction(a, ONE), a);
        }
    }

    #[test]
    fn shares_and_ratios_of_small_numbers() {
        let third = Inverse::of(3).unwrap();
        assert_eq!(third.fraction(4), None);
        let close = |a: u64, b: u64| assert!(a.abs_diff(b) <= 64, "{a} {b}");
        close(third.fraction(3).unwrap(), ONE);
        close(third.fraction(1).unwrap(), ONE / 3);
        close(third.ratio(-1).unsigned_abs(), ONE / 3);
        close(third.quotient(1 << 62, -2), ONE / 12);
        assert_eq!(shifted(-5, -1), -3);
        assert_eq!((shifted(5, 2), shifted(5, 64), shifted(5, -64)), (20, 0, 0));
        assert_eq!(first(0, 100, |s| s >= 17), 17);
    }
}
