//! Single precision: no operation of it is in double.

mod derived;

use self::derived::{
    ARCTAN, COMMON_ANGLE, COSINE, HALF_ARCTAN, HALF_PI, HALF_PI_TAIL, HALF_PI_WORD, QUARTER, SINE,
    TWICE_ATAN_HALF, TWICE_ATAN_HALF_TAIL, TWO_OVER_PI,
};
use crate::{
    HAS_VECTORS, atan2::atan2, known_length::known_length, large::reduce_large, sin_cos::sin_cos,
};

/// 1.5 · 2^23: numbers of this size have no fraction.
const SHIFT: f32 = 1.5 * power_of_two(23);
/// The highest 12 of 24 bits of a significand, with sign and exponent.
const HEAD: u32 = !0xFFF;

/// Lengths whose reciprocals have all their bits.
const COMMON_LENGTHS: [f32; 2] = [power_of_two(-60), power_of_two(60)];
/// From here on no remainder of a division is cut off at the end of the range of f32.
const COMMON_SMALL: f32 = power_of_two(-100);
/// Bring all other lengths into the common range.
const SCALES: [f32; 2] = [power_of_two(-90), power_of_two(90)];
/// Quotients below do not change π/2.
const TINY_QUOTIENT: f32 = power_of_two(-30);

/// By how much a length may differ from what was said of it: half the square of that is left out of
/// the angle.
const KNOWN: f32 = power_of_two(-12);

#[inline(always)]
fn sine_polynomial(z: f32) -> f32 {
    let [c0, c1, c2] = SINE;
    c0 + z * (c1 + z * c2)
}

#[inline(always)]
fn cosine_polynomial(z: f32) -> f32 {
    let [c0, c1, c2] = COSINE;
    c0 + z * (c1 + z * c2)
}

#[inline(always)]
fn arctan_polynomial(z: f32) -> f32 {
    let [c0, c1, c2, c3] = ARCTAN;
    c0 + z * (c1 + z * (c2 + z * c3))
}

/// The angle of (±cosine, |sine|) by its half.
///
/// ```text
/// t = sine / (length + cosine) = tan(angle/2)     t <= 1     angle = 2 atan t, or π less it
/// ```
#[inline(always)]
fn size_of_angle(unit: Unit, is_obtuse: bool) -> f32 {
    let t = unit.sine.abs() / (unit.length + unit.cosine);
    let z = t * t;
    let [c0, c1, c2, c3, c4, c5, c6, c7] = HALF_ARCTAN;
    let inner = c0 + z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * (c6 + z * c7))))));
    let half = t + t * (z * inner);
    let size = half + half;
    if is_obtuse {
        core::f32::consts::PI - size
    } else {
        size
    }
}

/// `small < large` of two numbers that are not negative, without a comparison of floats: it is
/// slow where they are computed in software, and the FPU's flags must be fetched elsewhere.
#[inline(always)]
fn is_less(small: f32, large: f32) -> bool {
    small.to_bits() < large.to_bits()
}

#[inline(always)]
fn is_common_large(large: f32) -> bool {
    let [min, max] = COMMON_LENGTHS;
    large.to_bits().wrapping_sub(min.to_bits()) <= max.to_bits() - min.to_bits()
}

/// Above [`COMMON_SMALL`], and zero.
#[inline(always)]
fn is_common_small(small: f32) -> bool {
    small.to_bits().wrapping_sub(1) >= COMMON_SMALL.to_bits()
}

sin_cos!(f32, u32);
reduce_large!(f32, u32, u64, i64);
atan2!(f32, u32);
known_length!(f32, u32);
