#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(test)]
extern crate std;

mod atan2;
mod f32;
mod f64;
mod known_length;
mod large;
mod sin_cos;
mod six_digits;
mod sqrt;

pub use six_digits::SixDigits;

mod sealed {
    #[expect(unnameable_types, reason = "that is what seals `Trig`")]
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// `f32` or `f64`: what the functions of this crate are for.
///
/// Its functions are not methods, so that code which is generic over `T: RealField + Trig` can
/// go on calling those of `nalgebra` by `x.sin_cos()`, and calls these by name:
///
/// ```
/// use trig_kernels::{Trig, atan2, sin_cos};
///
/// fn turned<T: Trig + core::ops::Add<Output = T>>(angle: T, by: T) -> T {
///     let (sin, cos) = sin_cos(angle + by);
///     atan2(sin, cos)
/// }
/// assert_eq!(turned(0.5_f32, 0.25), 0.75);
/// ```
pub trait Trig: Copy + sealed::Sealed {
    /// See [`sin_cos`].
    #[must_use]
    fn sin_cos(x: Self) -> (Self, Self);

    /// See [`sin_cos_lanes`].
    #[must_use]
    fn sin_cos_lanes<const L: usize>(x: [Self; L]) -> ([Self; L], [Self; L]);

    /// See [`atan2`].
    #[must_use]
    fn atan2(y: Self, x: Self) -> Self;

    /// See [`atan2_lanes`].
    #[must_use]
    fn atan2_lanes<const L: usize>(y: [Self; L], x: [Self; L]) -> [Self; L];

    /// See [`atan2_of_length`].
    #[must_use]
    fn atan2_of_length(y: Self, x: Self, inverse_length: Self) -> Self;

    /// See [`atan2_of_length_lanes`].
    #[must_use]
    fn atan2_of_length_lanes<const L: usize>(
        y: [Self; L],
        x: [Self; L],
        inverse_length: [Self; L],
    ) -> [Self; L];

    /// See [`sqrt`].
    #[must_use]
    fn sqrt(x: Self) -> Self;
}

macro_rules! trig {
    ($($float:ident $instruction:path, $integers:ident;)*) => {$(
        impl Trig for $float {
            #[inline]
            fn sin_cos(x: Self) -> (Self, Self) {
                self::$float::sin_cos(x)
            }

            #[inline]
            fn sin_cos_lanes<const L: usize>(x: [Self; L]) -> ([Self; L], [Self; L]) {
                self::$float::sin_cos_lanes(x)
            }

            #[inline]
            fn atan2(y: Self, x: Self) -> Self {
                self::$float::atan2(y, x)
            }

            #[inline]
            fn atan2_lanes<const L: usize>(y: [Self; L], x: [Self; L]) -> [Self; L] {
                self::$float::atan2_lanes(y, x)
            }

            #[inline]
            fn atan2_of_length(y: Self, x: Self, inverse_length: Self) -> Self {
                self::$float::atan2_of_length(y, x, inverse_length)
            }

            #[inline]
            fn atan2_of_length_lanes<const L: usize>(
                y: [Self; L],
                x: [Self; L],
                inverse_length: [Self; L],
            ) -> [Self; L] {
                self::$float::atan2_of_length_lanes(y, x, inverse_length)
            }

            #[inline]
            fn sqrt(x: Self) -> Self {
                if HAS_ROOT { $instruction(x) } else { sqrt::$integers(x) }
            }
        }
    )*};
}
trig! {
    f32 libm::sqrtf, sqrt_f32;
    f64 libm::sqrt, sqrt_f64;
}

/// Whether `libm` makes one instruction of a root.
const HAS_ROOT: bool = cfg!(any(target_feature = "sse2", target_feature = "neon"));
/// Whether lanes become vector instructions.
const HAS_VECTORS: bool = HAS_ROOT || cfg!(target_feature = "simd128");

/// Sine and cosine of an angle in radians, of any size.
///
/// Off by at most 0.85 of the last place. The sine of ±0 is ±0; both of an infinite angle are NaN.
#[must_use]
#[inline]
pub fn sin_cos<T: Trig>(x: T) -> (T, T) {
    T::sin_cos(x)
}

/// Sines and cosines of several angles in radians: the bits of [`sin_cos`] for each.
///
/// Vector instructions compute them while all lanes are in the common range, which is 2^13 quarter
/// turns in `f32` and 2^26 in `f64`.
#[must_use]
#[inline]
pub fn sin_cos_lanes<T: Trig, const L: usize>(x: [T; L]) -> ([T; L], [T; L]) {
    T::sin_cos_lanes(x)
}

/// The angle of the vector (x, y) against the axis of x, in radians from -π to π.
///
/// Off by at most 0.75 of the last place. x and y are in any unit. Signed zeros and infinities as
/// in IEEE 754-2019, section 9.2.1: on the axes the exact angle rounded, and of (x, ±0) with x < 0
/// it is ±π.
#[must_use]
#[inline]
pub fn atan2<T: Trig>(y: T, x: T) -> T {
    T::atan2(y, x)
}

/// The angles of several vectors (x, y) against the axis of x, in radians from -π to π: the bits of
/// [`atan2`] for each.
///
/// Vector instructions compute them while no lane is (0, 0), infinite or NaN, or has a side below
/// 2^-100 (`f32`) or 2^-900 (`f64`) that is not zero, or its larger side beyond 2^±60 or 2^±500.
#[must_use]
#[inline]
pub fn atan2_lanes<T: Trig, const L: usize>(y: [T; L], x: [T; L]) -> [T; L] {
    T::atan2_lanes(y, x)
}

/// The angle of the vector (x, y) of a length that is known, in radians from -π to π: with
/// u = y/N, w = |x|/N
///
/// ```text
/// g = (1 + u² + w²)/2     tan(angle/2) = u / (g + w), or π less that angle where x < 0
/// ```
///
/// In `f64`, where |y| is the larger side, tan(angle/2) = w / (g + u), taken from π/2.
///
/// `inverse_length` is 1/N, as near as about 2^-12 in `f32` and 2^-27 in `f64`: what the length is
/// off by δ changes the angle by δ²/2 of it. Where it is off by more, or no number, the answer is
/// that of [`atan2`]. Off by at most 4 of the last place; signed zeros as in `atan2`. It takes two
/// thirds of `atan2`'s time.
#[must_use]
#[inline]
pub fn atan2_of_length<T: Trig>(y: T, x: T, inverse_length: T) -> T {
    T::atan2_of_length(y, x, inverse_length)
}

/// The angles of several vectors (x, y) whose lengths are known: the bits of [`atan2_of_length`]
/// for each.
#[must_use]
#[inline]
pub fn atan2_of_length_lanes<T: Trig, const L: usize>(
    y: [T; L],
    x: [T; L],
    inverse_length: [T; L],
) -> [T; L] {
    T::atan2_of_length_lanes(y, x, inverse_length)
}

/// The square root, rounded to the nearest as IEEE 754 says; of what is negative, NaN.
///
/// One instruction on x86 with SSE2 and on 64-bit ARM, elsewhere integers.
#[must_use]
#[inline]
pub fn sqrt<T: Trig>(x: T) -> T {
    T::sqrt(x)
}
