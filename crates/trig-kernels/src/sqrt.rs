//! Square roots in integers, for processors whose own root code without `unsafe` does not reach.
//!
//! ```text
//! m = x 4^-n, 1 <= m < 4
//! r0 ≈ 1/√m from a table       r (3 - m r²)/2 ≈ 1/√m, its error 1.5 times the square of that of r
//! s = m r, shortened           s + r (m - s²)/2 ≈ √m, likewise
//! ```
//!
//! What is cut off on the way, and the sign of these errors, leave the last below √m by less than
//! half a unit of the result's last place. So the root rounded down is q or q + 1 with q that
//! number rounded down, and the nearest one is q + 1 just where the whole number m 2^k is above
//! q² + q.

#![expect(
    clippy::cast_possible_truncation,
    reason = "upper halves of products, and exponents"
)]

/// 2^16 / √m in the middle of 64 intervals each of m in 2..4 and in 1..2.
static RECIPROCAL_ROOTS: [u16; 128] = reciprocal_roots();

#[expect(
    clippy::indexing_slicing,
    reason = "computed by the compiler, which would say so"
)]
const fn reciprocal_roots() -> [u16; 128] {
    let mut roots = [0; 128];
    let mut index = 0;
    while index < roots.len() {
        let in_128ths = (129 + 2 * (index as u64 % 64)) << (1 - index / 64);
        let mut bit = 1 << 15;
        while bit > 0 {
            let longer = roots[index] | bit;
            if longer as u64 * longer as u64 * in_128ths <= 128 << 32 {
                roots[index] = longer;
            }
            bit >>= 1;
        }
        index += 1;
    }
    roots
}

/// 1/√m in 2^-16, from the lowest bit of the exponent and the highest six of the fraction.
#[inline(always)]
fn reciprocal_root(index: usize) -> u32 {
    // The remainder shows the compiler that the index is not too large.
    let root = RECIPROCAL_ROOTS.get(index % RECIPROCAL_ROOTS.len());
    root.copied().unwrap_or_default().into()
}

/// The upper half of a product.
#[inline(always)]
fn upper_product(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> 32) as u32
}

/// Makes the root of one precision from that of its normal numbers, and from a power of two whose
/// square makes all others normal.
macro_rules! sqrt {
    ($float:ident, $sqrt:ident, $of_rare:ident, $of_normal:ident, $scale:literal) => {
        /// The square root, rounded to the nearest.
        #[inline(never)]
        pub(crate) fn $sqrt(x: $float) -> $float {
            let bits = x.to_bits();
            let least = $float::MIN_POSITIVE.to_bits();
            if bits.wrapping_sub(least) < $float::INFINITY.to_bits() - least {
                $float::from_bits($of_normal(bits))
            } else {
                $of_rare(x)
            }
        }

        /// Zeros, infinities, NaN, and what is negative or subnormal.
        #[cold]
        #[inline(never)]
        fn $of_rare(x: $float) -> $float {
            const UP: $float = $scale * $scale;
            const DOWN: $float = 1.0 / $scale;
            if x == 0.0 || x == $float::INFINITY {
                x
            } else if x > 0.0 {
                $sqrt(x * UP) * DOWN
            } else {
                $float::NAN
            }
        }
    };
}
sqrt!(f32, sqrt_f32, sqrt_of_rare_f32, sqrt_of_normal_f32, 4096.0);
sqrt!(
    f64,
    sqrt_f64,
    sqrt_of_rare_f64,
    sqrt_of_normal_f64,
    134_217_728.0
);

/// The bits of the root of a number that is positive, finite and normal.
#[inline]
fn sqrt_of_normal_f32(bits: u32) -> u32 {
    const ODD: u32 = 1 << 23;
    let m_q31 = bits << 8 | 1 << 31;
    // An odd exponent is that of an even power.
    let m_q30 = if bits & ODD == 0 { m_q31 } else { m_q31 >> 1 };
    let m_q14 = m_q30 >> 16;

    let r0_q16 = reciprocal_root((bits >> 17) as usize);
    // Rounded up, so that r comes out too small.
    let three_less_q30 = (3 << 30) - (m_q14 + 1) * ((r0_q16 * r0_q16) >> 16);
    let r_q16 = (r0_q16 * (three_less_q30 >> 16)) >> 15;
    let s_q15 = (m_q14 * r_q16) >> 15;
    let rest_q30 = m_q30.wrapping_sub(s_q15 * s_q15).cast_signed();
    let change_q28 = ((rest_q30 >> 5) * r_q16.cast_signed()) >> 14;
    let q_q23 = (s_q15 << 13).wrapping_add_signed(change_q28) >> 5;

    let rest_q46 = (m_q30 << 16).wrapping_sub(q_q23.wrapping_mul(q_q23));
    let is_above = q_q23.wrapping_sub(rest_q46) >> 31;
    // Half of the exponent, less one for the highest bit of q.
    ((bits + (125 << 23)) >> 24 << 23) + q_q23 + is_above
}

/// The bits of the root of a number that is positive, finite and normal.
#[inline]
fn sqrt_of_normal_f64(bits: u64) -> u64 {
    const ODD: u64 = 1 << 52;
    let m_q63 = bits << 11 | 1 << 63;
    let m_q62 = if bits & ODD == 0 { m_q63 } else { m_q63 >> 1 };
    let m_q30 = (m_q62 >> 32) as u32;

    let r0_q16 = reciprocal_root((bits >> 46) as usize);
    let three_less_q30 = (3 << 30) - upper_product(m_q30, r0_q16 * r0_q16);
    let r1_q47 = u64::from(r0_q16) * u64::from(three_less_q30);
    let r1_q16 = ((r1_q47 + (1 << 30)) >> 31) as u32;
    // Rounded up, so that r comes out too small.
    let three_less_q30 = (3 << 30) - upper_product(m_q30, r1_q16 * r1_q16) - 1;
    let r_q32 = ((u64::from(r1_q16) * u64::from(three_less_q30)) >> 15) as u32;
    let s_q30 = u64::from(upper_product(m_q30, r_q32));
    let rest_q62 = m_q62.wrapping_sub((s_q30 * s_q30) << 2).cast_signed();
    let change_q60 = ((rest_q62 >> 8) * i64::from(r_q32)) >> 27;
    let q_q52 = (s_q30 << 30).wrapping_add_signed(change_q60) >> 8;

    let rest_q104 = (m_q62 << 42).wrapping_sub(q_q52.wrapping_mul(q_q52));
    let is_above = q_q52.wrapping_sub(rest_q104) >> 63;
    ((bits + (1021 << 52)) >> 53 << 52) + q_q52 + is_above
}

#[cfg(test)]
mod tests {
    use super::{sqrt_f32, sqrt_f64};

    /// One period of exponents holds all fractions that there are; of the rest the ends.
    #[test]
    fn every_root_of_f32_is_the_nearest() {
        let (one, four) = (1.0_f32.to_bits(), 4.0_f32.to_bits());
        let others = (0..=u32::MAX).step_by(65_521);
        let ends = [
            0,
            1,
            0x007F_FFFF,
            0x0080_0000,
            0x7F7F_FFFF,
            0x7F80_0000,
            1 << 31,
        ];
        for bits in (one..four).chain(others).chain(ends) {
            let x = f32::from_bits(bits);
            let (found, exact) = (sqrt_f32(x), x.sqrt());
            assert!(
                found.to_bits() == exact.to_bits() || (found.is_nan() && exact.is_nan()),
                "{x:e}: {found:e} {exact:e}"
            );
        }
    }

    /// Arguments at and next to the ends of 2^14 intervals, squares of short numbers and of halves
    /// between numbers, and any bits.
    #[test]
    fn roots_of_f64_are_the_nearest() {
        let one = 1.0_f64.to_bits();
        let mut state = 0x0139_408D_CBBF_7A44_u64;
        for round in 0..1_000_000_u64 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            let beside = state % 5;
            let near_end = one + ((round % (1 << 14)) << 39) + beside - 2;
            let root = f64::from_bits(one | state >> 12);
            let near_square = (root * root).to_bits() + beside - 2;
            let short = f64::from_bits(one | (state >> 38) << 26);
            let short = (short * short).to_bits();
            for bits in [near_end, near_square, short, state] {
                let x = f64::from_bits(bits);
                let (found, exact) = (sqrt_f64(x), x.sqrt());
                assert!(
                    found.to_bits() == exact.to_bits() || (found.is_nan() && exact.is_nan()),
                    "{x:e}: {found:e} {exact:e}"
                );
            }
        }
        for x in [
            0.0,
            -0.0,
            f64::INFINITY,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
            2.2e-308,
        ] {
            assert_eq!(sqrt_f64(x).to_bits(), x.sqrt().to_bits(), "{x:e}");
        }
    }
}
