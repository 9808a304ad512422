//! Double precision.

mod derived;

use self::derived::{
    ARCTAN, COMMON_ANGLE, COSINE, HALF_ARCTAN, HALF_PI, HALF_PI_TAIL, HALF_PI_WORD, QUARTER, SINE,
    TWICE_ATAN_HALF, TWICE_ATAN_HALF_TAIL, TWO_OVER_PI,
};
use crate::{
    HAS_VECTORS, atan2::atan2, known_length::known_length, large::reduce_large, sin_cos::sin_cos,
};

/// 1.5 · 2^52: numbers of this size have no fraction.
const SHIFT: f64 = 1.5 * power_of_two(52);
/// The highest 26 of 53 bits of a significand, with sign and exponent.
const HEAD: u64 = !0x7FF_FFFF;

/// Lengths whose reciprocals have all their bits.
const COMMON_LENGTHS: [f64; 2] = [power_of_two(-500), power_of_two(500)];
/// From here on no remainder of a division is cut off at the end of the range of f64.
const COMMON_SMALL: f64 = power_of_two(-900);
/// Bring all other lengths into the common range.
const SCALES: [f64; 2] = [power_of_two(-600), power_of_two(600)];
/// Quotients below do not change π/2.
const TINY_QUOTIENT: f64 = power_of_two(-60);

/// By how much a length may differ from what was said of it: half the square of that is left out of
/// the angle.
const KNOWN: f64 = power_of_two(-27);

// In pairs instead of one chain: a processor computes them side by side.
#[inline(always)]
fn sine_polynomial(z: f64) -> f64 {
    let [c0, c1, c2, c3, c4, c5] = SINE;
    let z2 = z * z;
    ((c0 + z * c1) + z2 * (c2 + z * c3)) + (z2 * z2) * (c4 + z * c5)
}

#[inline(always)]
fn cosine_polynomial(z: f64) -> f64 {
    let [c0, c1, c2, c3, c4, c5] = COSINE;
    let z2 = z * z;
    ((c0 + z * c1) + z2 * (c2 + z * c3)) + (z2 * z2) * (c4 + z * c5)
}

#[inline(always)]
fn arctan_polynomial(z: f64) -> f64 {
    let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = ARCTAN;
    let z2 = z * z;
    let z4 = z2 * z2;
    let low = (c0 + z * c1) + z2 * (c2 + z * c3);
    let high = (c4 + z * c5) + z2 * (c6 + z * c7);
    low + z4 * (high + z4 * c8)
}

/// The angle of (±cosine, |sine|) by its half, where it is nearer to the other axis the rest of a
/// right angle.
///
/// ```text
/// t = small / (length + large) = tan(angle/2)     t <= tan π/8     angle = 2 atan t
/// ```
#[inline(always)]
fn size_of_angle(unit: Unit, is_obtuse: bool) -> f64 {
    use core::f64::consts::{FRAC_PI_2, PI};
    let (sine, cosine) = (unit.sine.abs(), unit.cosine);
    let is_steep = is_less(cosine, sine);
    let (small, large) = if is_steep {
        (cosine, sine)
    } else {
        (sine, cosine)
    };
    let t = small / (unit.length + large);
    let z = t * t;
    let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9] = HALF_ARCTAN;
    let inner = c4 + z * (c5 + z * (c6 + z * (c7 + z * (c8 + z * c9))));
    let inner = c0 + z * (c1 + z * (c2 + z * (c3 + z * inner)));
    let half = t + t * (z * inner);
    let size = half + half;
    let base = match (is_steep, is_obtuse) {
        (true, _) => FRAC_PI_2,
        (false, true) => PI,
        (false, false) => 0.0,
    };
    base + if is_steep == is_obtuse { size } else { -size }
}

// Vectors compare numbers; processors without vectors, mostly without an FPU for f64, their bits.

/// `small < large` of two numbers that are not negative.
#[inline(always)]
fn is_less(small: f64, large: f64) -> bool {
    if HAS_VECTORS {
        small < large
    } else {
        small.to_bits() < large.to_bits()
    }
}

#[inline(always)]
fn is_common_large(large: f64) -> bool {
    let [min, max] = COMMON_LENGTHS;
    if HAS_VECTORS {
        (large >= min) & (large <= max)
    } else {
        large.to_bits().wrapping_sub(min.to_bits()) <= max.to_bits() - min.to_bits()
    }
}

/// Above [`COMMON_SMALL`], and zero.
#[inline(always)]
fn is_common_small(small: f64) -> bool {
    if HAS_VECTORS {
        (small > COMMON_SMALL) | (small == 0.0)
    } else {
        small.to_bits().wrapping_sub(1) >= COMMON_SMALL.to_bits()
    }
}

sin_cos!(f64, u64);
reduce_large!(f64, u64, u128, i128);
atan2!(f64, u64);
known_length!(f64, u64);
