//! Written by `derive/derive.py`, which says how. Do not edit.

#![expect(clippy::approx_constant, reason = "cut off where sums are exact")]
/// S of `sin t = t + t³ S(t²)`, off by at most 2^-27.89 of it for
/// arguments up to 0.78617.
pub(super) const SINE: [f32; 3] = [-0.16666655, 0.008332188, -0.00019518074];
/// C of `cos t = 1 - t²/2 + t⁴ C(t²)`, off by at most 2^-32.98 of it for
/// arguments up to 0.78617.
pub(super) const COSINE: [f32; 3] = [0.041666646, -0.001388731, 2.4432338e-5];
/// A of `atan q = q + q³ A(q²)`, off by at most 2^-28.48 of it for
/// arguments up to 0.33333.
pub(super) const ARCTAN: [f32; 4] = [-0.33333257, 0.19993213, -0.14096566, 0.089809865];
/// A of `atan t = t + t³ A(t²)`, off by at most 2^-25.83 of it for
/// arguments up to 1.0.
pub(super) const HALF_ARCTAN: [f32; 8] = [
    -0.33333153,
    0.19993769,
    -0.14211024,
    0.10665893,
    -0.075519934,
    0.043209426,
    -0.01636652,
    0.0029203598,
];

/// 2^13 quarter turns: up to here the products of [`QUARTER`] are exact.
pub(super) const COMMON_ANGLE: f32 = 12867.963;
/// π/2 in four parts; the products of the first three with 2^13 are exact.
pub(super) const QUARTER: [f32; 4] = [
    1.5703125,    // 201 · 2^-7
    0.0004837513, // 2029 · 2^-22
    7.5495336e-8, // 1297 · 2^-34
    2.563344e-12, // the rest
];
/// π/2 to a multiple of 2^-22, so that sums with [`TWICE_ATAN_HALF`] are exact.
pub(super) const HALF_PI: f32 = 1.5707963;
/// What [`HALF_PI`] lacks, as a part of it.
pub(super) const HALF_PI_TAIL: f32 = 4.806346e-8;
/// 2 atan 1/2, its half a multiple of 2^-22.
pub(super) const TWICE_ATAN_HALF: f32 = 0.9272952;
/// What [`TWICE_ATAN_HALF`] lacks.
pub(super) const TWICE_ATAN_HALF_TAIL: f32 = 1.0024317e-8;

/// π/2 · 2^31
pub(super) const HALF_PI_WORD: u32 = 0xC90F_DAA2;
/// The bits of 2/π after a word of zeros.
pub(super) const TWO_OVER_PI: [u32; 8] = [
    0,
    0xA2F9_836E,
    0x4E44_1529,
    0xFC27_57D1,
    0xF534_DDC0,
    0xDB62_9599,
    0x3C43_9041,
    0xFE51_63AB,
];
