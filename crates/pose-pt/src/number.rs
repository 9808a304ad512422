//! Numbers of any float type.

use nalgebra::RealField;

/// A count as a number of `T`.
pub(crate) fn count<T: RealField>(count: u32) -> T {
    nalgebra::convert(f64::from(count))
}

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

/// Rounds that bring any finite number's root to its last digits: each leaves a quarter of the
/// error of the logarithm.
const ROOT_ROUNDS: u32 = 36;

/// The cube root of a positive number as the limit of y = ⁴√(x y); zero of those below. The
/// library's has an index in it that cannot be proven.
pub(crate) fn cube_root<T: RealField + Copy>(x: T) -> T {
    if !x.is_finite() {
        return x;
    }
    let x = larger(x, T::zero());
    let root = x.sqrt();
    (0..ROOT_ROUNDS).fold(root, |y, _| (root * y.sqrt()).sqrt())
}

#[cfg(test)]
mod tests {
    #[test]
    fn cube_roots() {
        for x in [1e-80, 1e-9, 0.3, 1.0, 8.0, 1e9, 1e86] {
            let root = super::cube_root::<f64>(x);
            assert!(
                (root / libm::cbrt(x) - 1.0).abs() < 4.0 * f64::EPSILON,
                "{x}"
            );
        }
        assert_eq!(super::cube_root::<f64>(0.0).to_bits(), 0);
        assert!((super::cube_root(27.0_f32) - 3.0).abs() < 1e-6);
    }
}
