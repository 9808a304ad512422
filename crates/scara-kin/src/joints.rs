//! Joint angles, and the names of an arm's two joints and two elbows.

use core::ops::Sub;

use nalgebra::{RealField, Vector2};
use trig_kernels::{Trig, sin_cos};

use crate::range::is_angle;

/// The joint angles of a two-link arm, in radians.
///
/// ```text
///              tool
///              o
///             /
///            /  forearm           elbow:    forearm against upper arm
///   elbow   o. . . .              shoulder: upper arm against the base's X axis
///          /                      counter-clockwise positive;
///         /  upper arm            both zero: stretched along X
///   base o. . . . X
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "two links have two joints")]
pub struct Joints<T = f64> {
    /// Upper arm against the base's X axis, in radians.
    pub shoulder: T,
    /// Forearm against the upper arm, in radians.
    pub elbow: T,
}

impl<T> Joints<T> {
    /// Joint angles from shoulder and elbow, in radians.
    pub const fn new(shoulder: T, elbow: T) -> Self {
        Self { shoulder, elbow }
    }
}

impl<T: RealField + Copy> Joints<T> {
    /// Whether both angles are within the range of angles.
    pub(crate) fn are_angles(&self) -> bool {
        is_angle(self.shoulder) && is_angle(self.elbow)
    }
}

impl<T: RealField + Copy> Sub for Joints<T> {
    type Output = Vector2<T>;

    /// The joint displacement from `from` to `self`: (shoulder, elbow) in radians.
    fn sub(self, from: Self) -> Vector2<T> {
        Vector2::new(self.shoulder - from.shoulder, self.elbow - from.elbow)
    }
}

/// Which side of the line from base to tool the elbow lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a two-link arm has two elbows")]
pub enum Elbow {
    /// Elbow angle in 0..=π: the elbow is right of the line from base to tool.
    Right,
    /// Elbow angle in -π..=0: the elbow is left of the line from base to tool.
    Left,
}

impl Elbow {
    /// The elbow of an arm pose: by the sign of the elbow angle's sine, so that
    /// whole turns do not matter. An elbow at zero counts as `Right`, one at the float ±π as
    /// its sign says. `None` where the angle is not finite.
    #[must_use]
    pub fn of<T: RealField + Trig>(joints: &Joints<T>) -> Option<Self> {
        let sin = sin_cos(joints.elbow).0;
        if sin < T::zero() {
            Some(Self::Left)
        } else if sin >= T::zero() {
            Some(Self::Right)
        } else {
            None
        }
    }

    /// The other elbow.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
        }
    }
}

/// One of the arm's two joints, for errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "two links have two joints")]
pub enum Joint {
    /// Upper arm against base.
    Shoulder,
    /// Forearm against upper arm.
    Elbow,
}

impl core::fmt::Display for Joint {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Shoulder => "shoulder",
            Self::Elbow => "elbow",
        })
    }
}
