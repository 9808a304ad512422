//! Joint limits, and whole turns within them.

use nalgebra::RealField;

use crate::range::{is_angle, largest_angle};
use crate::{GeometryError, Joint, Joints};

/// The closed range of one joint, in radians.
///
/// A range may be wider than a whole turn, and need not hold zero. Its ends lie within
/// ±1/√ε rad (f64: 6.7e7, f32: 2896), beyond which an angle has lost half of its digits.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct JointRange<T = f64> {
    min: T,
    max: T,
}

impl<T: RealField + Copy> JointRange<T> {
    /// A range from `min` to `max`, in radians.
    ///
    /// # Errors
    /// [`GeometryError::JointRange`] unless `min < max` and both are within ±1/√ε.
    pub fn new(min: T, max: T) -> Result<Self, GeometryError<T>> {
        if is_angle(min) && is_angle(max) && min < max {
            Ok(Self { min, max })
        } else {
            let largest = largest_angle();
            Err(GeometryError::JointRange { min, max, largest })
        }
    }

    /// Any angle: within ±1/√ε rad.
    #[must_use]
    pub fn unlimited() -> Self {
        let largest = largest_angle::<T>();
        Self {
            min: -largest,
            max: largest,
        }
    }

    /// Lower end, in radians.
    #[must_use]
    pub fn min(&self) -> T {
        self.min
    }

    /// Upper end, in radians.
    #[must_use]
    pub fn max(&self) -> T {
        self.max
    }

    /// Whether `angle`, taken as it is, lies in the range.
    #[must_use]
    pub fn contains(&self, angle: T) -> bool {
        self.min <= angle && angle <= self.max
    }

    /// Whether `angle` lies in the range and no other turn of it is nearer to `near`.
    #[inline]
    pub(crate) fn holds_near(&self, angle: T, near: T) -> bool {
        self.contains(angle) && (angle - near).abs() <= T::pi()
    }

    /// `angle` at its whole turn nearest to `near`, and at the next one towards the range
    /// where that one is beyond an end.
    #[inline(never)]
    pub(crate) fn fit(&self, angle: T, near: T) -> [Fitted<T>; 2] {
        let near = near.max(self.min).min(self.max);
        let turns = ((near - angle) / T::two_pi()).round();
        let nearest = turned(angle, turns);
        let next = if nearest < self.min {
            turned(angle, turns + T::one())
        } else if nearest > self.max {
            turned(angle, turns - T::one())
        } else {
            nearest
        };
        [self.clamp(nearest), self.clamp(next)]
    }

    fn clamp(&self, angle: T) -> Fitted<T> {
        let clamped = angle.max(self.min).min(self.max);
        Fitted {
            angle: clamped,
            beyond: angle - clamped,
        }
    }

    /// The part of the range in which each angle is at the turn nearest to the middle.
    pub(crate) fn principal_range(&self) -> Self {
        Self {
            min: self.min.max(self.middle() - T::pi()),
            max: self.max.min(self.middle() + T::pi()),
        }
    }

    /// The angle of the range's middle, zero where unlimited: where a search for a
    /// whole turn starts when nothing came before.
    pub(crate) fn middle(&self) -> T {
        self.min / two() + self.max / two()
    }
}

/// The limits of both joints.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "two links have two joints")]
pub struct Limits<T = f64> {
    /// Range of the upper arm against the base.
    pub shoulder: JointRange<T>,
    /// Range of the forearm against the upper arm.
    pub elbow: JointRange<T>,
}

impl<T: RealField + Copy> Limits<T> {
    /// Both joints turn freely.
    #[must_use]
    pub fn unlimited() -> Self {
        Self {
            shoulder: JointRange::unlimited(),
            elbow: JointRange::unlimited(),
        }
    }

    /// Whether both angles, taken as they are, lie in their ranges.
    #[must_use]
    pub fn contains(&self, joints: &Joints<T>) -> bool {
        self.shoulder.contains(joints.shoulder) && self.elbow.contains(joints.elbow)
    }

    #[inline]
    pub(crate) fn holds_near(&self, joints: &Joints<T>, near: &Joints<T>) -> bool {
        self.shoulder.holds_near(joints.shoulder, near.shoulder)
            && self.elbow.holds_near(joints.elbow, near.elbow)
    }

    pub(crate) fn principal_range(&self) -> Self {
        Self {
            shoulder: self.shoulder.principal_range(),
            elbow: self.elbow.principal_range(),
        }
    }

    /// Whether both ranges hold the poses of both elbows, of which the right one's angle is not
    /// negative and the left one's its opposite.
    #[inline]
    pub(crate) fn hold_both(&self, right: &Joints<T>, left: &Joints<T>) -> bool {
        self.shoulder.contains(right.shoulder)
            && self.shoulder.contains(left.shoulder)
            && self.elbow.min <= left.elbow
            && right.elbow <= self.elbow.max
    }

    pub(crate) fn middle(&self) -> Joints<T> {
        Joints {
            shoulder: self.shoulder.middle(),
            elbow: self.elbow.middle(),
        }
    }

    pub(crate) fn range(&self, joint: Joint) -> &JointRange<T> {
        match joint {
            Joint::Shoulder => &self.shoulder,
            Joint::Elbow => &self.elbow,
        }
    }
}

/// An angle put into a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fitted<T> {
    /// The angle, or the end of the range beyond which it lies.
    pub(crate) angle: T,
    /// How far beyond: negative below the range, positive above.
    pub(crate) beyond: T,
}

/// `angle` and a number of whole turns, rounded to the nearest or next to it.
pub(crate) fn turned<T: RealField + Copy>(angle: T, turns: T) -> T {
    // 2π as a sum: products with the first part are exact, and the second one has the digits
    // that a rounded 2π lacks.
    let coarse: T = nalgebra::convert(6.281_25);
    let rest: T = nalgebra::convert(0.001_935_307_179_586_476_9);
    turns * coarse + (turns * rest + angle)
}

/// `angle` at its whole turn in -π..=π.
pub(crate) fn half_turn<T: RealField + Copy>(angle: T) -> T {
    turned(angle, -(angle / T::two_pi()).round())
}

pub(crate) fn two<T: RealField>() -> T {
    T::one() + T::one()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use super::*;

    /// Whole turns of an angle of a few radians are exact to this.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn angles_take_the_nearest_turn_that_fits() {
        let range = JointRange::new(-1.5 * PI, 2.5 * PI).unwrap();
        for (angle, near, wanted) in [
            (1.0, 0.0, 1.0),
            (1.0, TAU, 1.0 + TAU),
            (1.0, -100.0, 1.0),
            (-2.0, 9.0, -2.0 + TAU),
            (3.0, -3.0, 3.0 - TAU),
        ] {
            let fitted = range
                .fit(angle, near)
                .into_iter()
                .find(|fitted| fitted.beyond.abs() < ROUNDING)
                .unwrap();
            assert!(
                (fitted.angle - wanted).abs() < ROUNDING,
                "{angle} {near}: {fitted:?}"
            );
        }
    }

    #[test]
    fn angles_that_fit_at_no_turn_go_to_both_ends() {
        let range = JointRange::new(-0.5, 1.0).unwrap();
        for (angle, near, beyond) in [
            (1.1, 0.0, [0.1, 0.6 + 1.0 - TAU]),
            (-0.6, 0.0, [-0.1, TAU - 1.6]),
            (1.1 + TAU, 0.0, [0.1, 1.6 - TAU]),
            (-3.0, 0.0, [-2.5, TAU - 4.0]),
            (-3.0, 1.0, [TAU - 4.0, -2.5]),
        ] {
            let fitted = range.fit(angle, near);
            for (fitted, beyond) in fitted.into_iter().zip(beyond) {
                assert!((fitted.beyond - beyond).abs() < ROUNDING, "{fitted:?}");
                let end = if beyond < 0.0 { -0.5f64 } else { 1.0 };
                assert_eq!(fitted.angle.to_bits(), end.to_bits());
            }
        }
    }

    /// 2π · 10⁷ to 26 digits is 62831853.07179586476925286766; an f64 there has 7.5e-9 to
    /// its neighbour, an f32 of 2π · 400 = 2513.2741228718345907701 has 2.4e-4.
    #[test]
    fn turns_are_rounded_once() {
        assert_eq!(
            turned(0.0, 1e7f64).to_bits(),
            62_831_853.071_795_866_f64.to_bits()
        );
        assert_eq!(turned(0.0, 400.0f32).to_bits(), 2_513.274_2_f32.to_bits());
        assert!((half_turn(turned(1.0, -1e7)) - 1.0f64).abs() < 7.5e-9);
    }

    #[test]
    fn ranges_must_hold_something() {
        for (min, max) in [
            (1.0, 1.0),
            (1.0, 0.0),
            (f64::NAN, 1.0),
            (0.0, f64::INFINITY),
            (0.0, 6.8e7),
        ] {
            assert!(JointRange::new(min, max).is_err());
        }
        assert!(JointRange::<f64>::unlimited().contains(6.7e7));
    }
}
