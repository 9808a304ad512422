//! The range of numbers that the crate takes: what lies outside is refused by name.
//!
//! | number | range | `f64` | `f32` |
//! |---|---|---|---|
//! | upper and lower arm | 1/√h..=h | 2e-38..=3.6e75 | 9e-5..=1.3e8 |
//! | the same, in spans of the machine | ε^¼.. | 1.2e-4.. | 0.019.. |
//! | base and platform radius | 0..=h | 0..=3.6e75 | 0..=1.3e8 |
//! | coordinates of paths and measured points | ±4 h | ±1.4e76 | ±5.4e8 |
//! | angles, azimuths, zeros, ends of ranges, in rad | ±1/√ε | ±6.7e7 | ±2900 |
//! | feed, rates of the arms | 1/h²..=h² | 8e-152..=1e151 | 6e-17..=1.8e16 |
//!
//! h is the fourth root of the largest number, divided by 32: products of four lengths neither
//! overflow nor lose digits. In an arm shorter than ε^¼ of the span rounding would turn the rods
//! by more than ε^¾; an angle beyond 1/√ε has fewer than half its digits after the point.

use nalgebra::{RealField, SVector};
use trig_kernels::Trig;

/// h: the largest length of an arm, 2^251 in f64, 2^27 in f32.
pub(crate) fn largest_length<T: RealField + Copy>() -> T {
    of_precision([3.618_502_788_666_131e75, 134_217_728.0])
}

/// The smallest length of an upper or lower arm, 1/√h.
pub(crate) fn smallest_length<T: RealField + Copy>() -> T {
    of_precision([1.662_400_053_425_836e-38, 8.631_674_575_031_098e-5])
}

/// The smallest upper or lower arm of a machine, in units of its span: ε^¼.
pub(crate) fn smallest_ratio<T: RealField + Copy>() -> T {
    of_precision([0.000_122_070_312_5, 0.018_581_361_171_917_516])
}

/// The largest coordinate of a path or a measured point, either way.
pub(crate) fn largest_coordinate<T: RealField + Copy>() -> T {
    largest_length::<T>() * nalgebra::convert(4.0)
}

/// The largest angle, either way, in radians: 1/√ε.
pub(crate) fn largest_angle<T: RealField + Copy>() -> T {
    of_precision([67_108_864.0, 2_896.309_4])
}

/// The number for f64 or the one for f32. Written out, since the compiler does not fold a
/// square root that is computed in integers.
fn of_precision<T: RealField>([double, single]: [f64; 2]) -> T {
    let is_double = T::default_epsilon() < nalgebra::convert(1e-10);
    nalgebra::convert(if is_double { double } else { single })
}

/// The largest feed and rate; the smallest is its reciprocal.
pub(crate) fn largest_rate<T: RealField + Copy>() -> T {
    largest_length::<T>() * largest_length::<T>()
}

/// Whether `value` is a number within ±`max`.
pub(crate) fn is_within<T: RealField + Copy>(value: T, max: T) -> bool {
    value.abs() <= max
}

/// The largest finite number.
pub(crate) fn max_value<T: RealField>() -> T {
    let largest = nalgebra::convert::<f64, T>(f64::MAX);
    if largest.is_finite() {
        largest
    } else {
        nalgebra::convert(f64::from(f32::MAX))
    }
}

pub(crate) fn two<T: RealField>() -> T {
    T::one() + T::one()
}

pub(crate) fn half<T: RealField>() -> T {
    nalgebra::convert(0.5)
}

/// The square root, of `core` alone.
#[cfg(feature = "path-timing")]
pub(crate) fn sqrt(x: f64) -> f64 {
    nalgebra::ComplexField::sqrt(x)
}

/// The length of a vector whose squares may overflow or vanish. In `T` alone, as `hypot` of `f32`
/// is not.
pub(crate) fn length<T: RealField + Trig, const N: usize>(vector: &SVector<T, N>) -> T {
    let largest = vector.amax();
    if largest > T::zero() && largest.is_finite() {
        norm(&(vector / largest)) * largest
    } else {
        norm(vector)
    }
}

/// The length of a vector.
#[inline]
pub(crate) fn norm<T: RealField + Trig, const N: usize>(vector: &SVector<T, N>) -> T {
    trig_kernels::sqrt(vector.norm_squared())
}

#[cfg(test)]
mod tests {
    use nalgebra::{RealField, convert};

    use super::{largest_angle, largest_length, max_value, smallest_length, smallest_ratio};

    /// Of two roots and a reciprocal, in machine epsilons.
    const ROUNDING: f64 = 4.0;

    fn are_the_roots<T: RealField + Copy>() {
        let epsilon = T::default_epsilon();
        let h = max_value::<T>().sqrt().sqrt() / convert(32.0);
        for (written, computed) in [
            (largest_length::<T>(), h),
            (smallest_length(), h.sqrt().recip()),
            (smallest_ratio(), epsilon.sqrt().sqrt()),
            (largest_angle(), epsilon.sqrt().recip()),
        ] {
            let off = written / computed - T::one();
            assert!(
                off.abs() <= epsilon * convert(ROUNDING),
                "{written} {computed}"
            );
        }
    }

    #[test]
    fn written_numbers_are_the_roots_in_both_precisions() {
        are_the_roots::<f64>();
        are_the_roots::<f32>();
    }
}
