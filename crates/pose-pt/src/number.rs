//! Constants of any float type.

use nalgebra::RealField;

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

/// The largest coordinate whose square's square does not overflow.
pub(crate) fn largest<T: RealField + Copy>() -> T {
    let max = T::max_value().unwrap_or_else(T::one);
    max.sqrt().sqrt() * half::<T>()
}

/// The first of the values that is not finite or is beyond ±`max`.
pub(crate) fn first_beyond<'a, T: RealField + Copy>(
    values: impl IntoIterator<Item = &'a T>,
    max: T,
) -> Option<T> {
    let mut values = values.into_iter().copied();
    values.find(|value| !value.is_finite() || value.abs() > max)
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
