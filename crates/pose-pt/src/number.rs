//! Numbers of any float type, and the range of those that the crate computes with.

use nalgebra::{ComplexField, RealField};

/// A constant as a number of `T`.
pub(crate) fn constant<T: RealField>(value: f64) -> T {
    nalgebra::convert(value)
}

pub(crate) fn two<T: RealField>() -> T {
    T::one() + T::one()
}

pub(crate) fn half<T: RealField>() -> T {
    T::one() / two()
}

/// Machine epsilons as a number of `T`.
pub(crate) fn epsilons<T: RealField + Copy>(count: f64) -> T {
    T::default_epsilon() * nalgebra::convert(count)
}

/// Lengths, speeds, accelerations, jerks, times that the crate computes with: above all that a
/// machine has, and so far from the ends of the float type that no fourth power of one, no time
/// and no slope made of two of them leaves it.
///
/// ```text
/// f64: 1e-50..=1e50      f32: 1e-9..=1e9
/// ```
fn range<T: RealField + Copy>() -> [T; 2] {
    let wide = [1e-50, 1e50].map(constant::<T>);
    let [_, largest] = wide;
    if largest.is_finite() {
        wide
    } else {
        [1e-9, 1e9].map(constant)
    }
}

/// The largest number that the crate computes with; coordinates are within ± it.
pub(crate) fn largest<T: RealField + Copy>() -> T {
    let [_, largest] = range();
    largest
}

/// The smallest number above 0 that the crate computes with. Coordinates may be smaller, extents
/// may not.
pub(crate) fn smallest<T: RealField + Copy>() -> T {
    let [smallest, _] = range();
    smallest
}

/// The largest angle of a path, in radians: its rounding is that of half of the digits, 1.5e-8 in
/// f64 and 3.5e-4 in f32.
pub(crate) fn largest_angle<T: RealField + Copy>() -> T {
    T::default_epsilon().sqrt().recip()
}

/// The first of the values that is not finite or is beyond ±`max`.
pub(crate) fn first_beyond<'a, T: RealField + Copy>(
    values: impl IntoIterator<Item = &'a T>,
    max: T,
) -> Option<T> {
    let mut values = values.into_iter().copied();
    values.find(|value| !value.is_finite() || value.abs() > max)
}

/// The largest finite number.
pub(crate) fn max_value<T: RealField>() -> T {
    let largest = constant::<T>(f64::MAX);
    if largest.is_finite() {
        largest
    } else {
        constant(f64::from(f32::MAX))
    }
}

/// The larger of two numbers; a comparison where `RealField::max` is a call of a library.
#[inline]
pub(crate) fn larger<T: RealField + Copy>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The absolute value, without a call of a library.
#[inline]
pub(crate) fn magnitude<T: RealField + Copy>(value: T) -> T {
    larger(value, -value)
}

/// The square root, of `core` alone.
pub(crate) fn sqrt(x: f64) -> f64 {
    ComplexField::sqrt(x)
}

/// √(x² + y²), of `core` alone.
pub(crate) fn hypot(x: f64, y: f64) -> f64 {
    ComplexField::hypot(x, y)
}

/// The whole number below or at `x`, of `core` alone.
pub(crate) fn floor(x: f64) -> f64 {
    ComplexField::floor(x)
}

/// The whole number above or at `x`, of `core` alone.
pub(crate) fn ceil(x: f64) -> f64 {
    ComplexField::ceil(x)
}
