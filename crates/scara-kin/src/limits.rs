//! Joint limits, and whole turns within them.

use nalgebra::RealField;

use crate::{GeometryError, Joint, Joints};

/// The closed range of one joint, in radians.
///
/// A range may be wider than a whole turn, and need not hold zero.
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
    /// [`GeometryError::EmptyRange`] unless both are finite and `min < max`.
    pub fn new(min: T, max: T) -> Result<Self, GeometryError<T>> {
        if min.is_finite() && max.is_finite() && min < max {
            Ok(Self { min, max })
        } else {
            Err(GeometryError::EmptyRange { min, max })
        }
    }

    /// Any angle.
    #[must_use]
    pub fn unlimited() -> Self {
        let huge = max_value::<T>();
        Self {
            min: -huge,
            max: huge,
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

    /// Whether some angle is in the range at no turn.
    pub(crate) fn is_within_a_turn(&self) -> bool {
        self.max - self.min < T::two_pi()
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

    /// The angle of the range, equal to `angle` but for whole turns, that is
    /// nearest to `near`; an `angle` that fits at no turn is returned at the end
    /// of the range which it misses least.
    pub(crate) fn fit(&self, angle: T, near: T) -> T {
        if self.holds_near(angle, near) {
            return angle;
        }
        let turn = T::two_pi();
        let lowest = ((self.min - angle) / turn).ceil();
        let highest = ((self.max - angle) / turn).floor();
        if lowest <= highest {
            let turns = ((near - angle) / turn).round();
            let turned = angle + turns.max(lowest).min(highest) * turn;
            // The sum is rounded.
            return turned.max(self.min).min(self.max);
        }
        let below = self.min - (angle + highest * turn);
        let above = angle + lowest * turn - self.max;
        if below <= above { self.min } else { self.max }
    }

    /// The part of the range in which each angle is at the turn nearest to the middle.
    pub(crate) fn window(&self) -> Self {
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

    /// Each joint at the whole turn nearest to `near`, at the end of its range
    /// where no turn fits.
    pub(crate) fn fit(&self, joints: Joints<T>, near: Joints<T>) -> Joints<T> {
        Joints {
            shoulder: self.shoulder.fit(joints.shoulder, near.shoulder),
            elbow: self.elbow.fit(joints.elbow, near.elbow),
        }
    }

    pub(crate) fn window(&self) -> Self {
        Self {
            shoulder: self.shoulder.window(),
            elbow: self.elbow.window(),
        }
    }

    /// Whether both ranges hold both poses; without branches, for the fast path.
    #[inline]
    pub(crate) fn hold_both(&self, a: &Joints<T>, b: &Joints<T>) -> bool {
        (self.shoulder.min <= a.shoulder)
            & (a.shoulder <= self.shoulder.max)
            & (self.elbow.min <= a.elbow)
            & (a.elbow <= self.elbow.max)
            & (self.shoulder.min <= b.shoulder)
            & (b.shoulder <= self.shoulder.max)
            & (self.elbow.min <= b.elbow)
            & (b.elbow <= self.elbow.max)
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

/// The largest finite number; every `RealField` of machine floats has one.
pub(crate) fn max_value<T: RealField>() -> T {
    T::max_value().unwrap_or_else(T::one)
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
            let fitted = range.fit(angle, near);
            assert!(
                (fitted - wanted).abs() < ROUNDING,
                "{angle} {near}: {fitted}"
            );
        }
    }

    #[test]
    fn angles_that_fit_at_no_turn_go_to_the_nearer_end() {
        let range = JointRange::new(-0.5, 1.0).unwrap();
        for (angle, end) in [
            (1.1, 1.0),
            (-0.6, -0.5),
            (1.1 + TAU, 1.0),
            (3.0, 1.0),
            (-2.0, -0.5),
            (-3.0, 1.0),
        ] {
            assert_eq!(
                range.fit(angle, 0.0).to_bits(),
                f64::to_bits(end),
                "{angle}"
            );
        }
    }

    #[test]
    fn ranges_must_hold_something() {
        for (min, max) in [
            (1.0, 1.0),
            (1.0, 0.0),
            (f64::NAN, 1.0),
            (0.0, f64::INFINITY),
        ] {
            assert!(JointRange::new(min, max).is_err());
        }
        assert!(JointRange::<f64>::unlimited().contains(1e300));
    }
}
