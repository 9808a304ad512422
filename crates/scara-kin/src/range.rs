//! The range of numbers that the crate computes with.

use nalgebra::{RealField, Vector2};
use trig_kernels::Trig;

use crate::GeometryError;

/// The largest joint angle and limit in radians, 1/√ε: 2²⁶ (6.7e7) in f64, 2896 in f32. There
/// half of the digits are left: an angle is rounded to √ε/2 rad.
pub(crate) fn largest_angle<T: RealField>() -> T {
    of_precision([67_108_864.0, 2_896.309_4])
}

/// The number for f64 or the one for f32. Written out, since the compiler does not fold a
/// square root that is computed in integers.
fn of_precision<T: RealField>([double, single]: [f64; 2]) -> T {
    let is_double = T::default_epsilon() < nalgebra::convert(1e-10);
    nalgebra::convert(if is_double { double } else { single })
}

/// The longest link and the largest coordinate of the base, in units of the shorter link,
/// 1/64ε: 7e13 in f64, 1.3e5 in f32. There the shorter link is not much longer than what
/// positions are rounded by.
pub(crate) fn largest_ratio<T: RealField>() -> T {
    (T::default_epsilon() * nalgebra::convert(64.0)).recip()
}

/// Shortest and longest link: 2^-127 and 2^254 in f64 (6e-39 and 2.8e76), 2^-15 and 2^30 in f32
/// (3e-5 and 1e9). With h a quarter of the fourth root of the largest number they are 1/√h and h:
/// outside, products of four lengths would overflow or lose digits.
pub(crate) fn link_lengths<T: RealField + Copy>() -> (T, T) {
    let min = of_precision([5.877_471_754_111_438e-39, 3.051_757_812_5e-5]);
    let max = of_precision([2.894_802_230_932_905e76, 1_073_741_824.0]);
    (min, max)
}

/// Whether an angle is within ±[`largest_angle`]; NaN is not.
pub(crate) fn is_angle<T: RealField + Copy>(angle: T) -> bool {
    angle.abs() <= largest_angle()
}

/// Refuses by its name what is not within ±`largest`.
pub(crate) fn within<T: RealField + Copy>(
    largest: T,
    name: &'static str,
    value: T,
) -> Result<(), GeometryError<T>> {
    // Written so that NaN is refused too.
    if value.abs() <= largest {
        Ok(())
    } else {
        Err(GeometryError::OutOfRange {
            name,
            value,
            largest,
        })
    }
}

/// The length of a vector whose squares may overflow. In `T` alone, as `hypot` of `f32` is not.
pub(crate) fn length<T: RealField + Trig>(vector: Vector2<T>) -> T {
    let largest = vector.amax();
    if largest > T::zero() && largest.is_finite() {
        norm(vector / largest) * largest
    } else {
        norm(vector)
    }
}

/// The length of a vector.
pub(crate) fn norm<T: RealField + Trig>(vector: Vector2<T>) -> T {
    trig_kernels::sqrt(vector.norm_squared())
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

#[cfg(test)]
mod tests {
    use nalgebra::{RealField, convert};

    use super::{largest_angle, link_lengths, max_value};

    /// Of two roots and a reciprocal, in machine epsilons.
    const ROUNDING: f64 = 4.0;

    fn are_the_roots<T: RealField + Copy>() {
        let epsilon = T::default_epsilon();
        let h = max_value::<T>().sqrt().sqrt() / convert(4.0);
        let (min, max) = link_lengths::<T>();
        for (written, computed) in [
            (max, h),
            (min, h.sqrt().recip()),
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
