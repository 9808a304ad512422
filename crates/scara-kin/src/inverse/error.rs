//! Why no joint angles reach a point.

use core::fmt::{Display, Formatter};

use nalgebra::RealField;

use crate::digits::Digits;
use crate::{Elbow, Joint, Joints};

/// Why no joint angles reach a point.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InverseError<T = f64> {
    /// A coordinate is infinite or not a number.
    NotFinite {
        /// X as given.
        x: T,
        /// Y as given.
        y: T,
    },
    /// The point lies outside the stretched arm's circle.
    TooFar {
        /// Distance from the base.
        distance: T,
        /// Distance of the stretched arm.
        reach: T,
    },
    /// The point lies inside the folded arm's circle, or inside the keep-out radius.
    TooNear {
        /// Distance from the base.
        distance: T,
        /// Least distance allowed.
        reach: T,
    },
    /// The point is the base itself and the links are equal: with the elbow folded,
    /// every shoulder angle is a solution. [`Arm::inverse_nearest`](crate::Arm::inverse_nearest)
    /// picks one.
    AnyAngle,
    /// The point is within reach, but a joint would leave its range.
    JointLimit {
        /// The elbow tried; where both fail, the one that misses by less.
        elbow: Elbow,
        /// The joint that would leave its range.
        joint: Joint,
        /// Its angle, in radians, at the whole turn that misses its range by least.
        angle: T,
        /// Lower end of its range, in radians.
        min: T,
        /// Upper end of its range, in radians.
        max: T,
    },
    /// The joints before are not numbers within the range of angles.
    Previous {
        /// The joints given.
        joints: Joints<T>,
        /// Largest angle that is accurate in `T`, in radians.
        largest: T,
    },
}

impl<T: RealField + Copy> Display for InverseError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match *self {
            Self::NotFinite { x, y } => {
                write!(f, "point ({}, {}) is not finite", Digits(x), Digits(y))
            }
            Self::TooFar { distance, reach } => write!(
                f,
                "too far: distance {} from the base is past the reach {} by {}",
                Digits(distance),
                Digits(reach),
                Digits(distance - reach)
            ),
            Self::TooNear { distance, reach } => write!(
                f,
                "too near: distance {} from the base is within the inner reach {} by {}",
                Digits(distance),
                Digits(reach),
                Digits(reach - distance)
            ),
            Self::AnyAngle => f.write_str(
                "the point is the base of an arm with equal links: any shoulder angle reaches it",
            ),
            Self::JointLimit {
                elbow,
                joint,
                angle,
                min,
                max,
            } => write!(
                f,
                "{joint} at {} rad ({elbow:?} elbow) is outside its range {}..={} rad by {} rad",
                Digits(angle),
                Digits(min),
                Digits(max),
                Digits((min - angle).max(angle - max))
            ),
            Self::Previous { joints, largest } => write!(
                f,
                "previous joints ({}, {}) rad are not within ±{} rad",
                Digits(joints.shoulder),
                Digits(joints.elbow),
                Digits(largest)
            ),
        }
    }
}

impl<T: RealField + Copy> core::error::Error for InverseError<T> {}
