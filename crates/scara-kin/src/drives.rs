//! From joint angles to the angles of the drives that turn them, and back.

use nalgebra::RealField;

use crate::range::{largest_angle, within};
use crate::{GeometryError, Joints};

/// The sense in which a drive turns its joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_enums,
    reason = "a joint turns one way or the other"
)]
pub enum DriveSense {
    /// Counter-clockwise drive, counter-clockwise joint.
    #[default]
    Forward,
    /// Counter-clockwise drive, clockwise joint.
    Reversed,
}

/// The angles of the two drives at the joints' side of their gears, in radians.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "two links have two drives")]
pub struct DriveAngles<T = f64> {
    /// Drive of the upper arm, in radians.
    pub shoulder: T,
    /// Drive of the forearm, in radians.
    pub elbow: T,
}

/// How the drives sit on the joints: zero offsets, senses of turning, coupling.
///
/// ```text
/// d1 = ±(q1 - zero1)
/// d2 = ±(q2 + coupling · q1 - zero2)
/// ```
///
/// `coupling` is what the forearm's drive sees of the shoulder's turning: 0 where its
/// motor rides on the upper arm, 1 where it stands on the base and turns the forearm
/// through a parallel 1:1 belt, other values for belts of other ratios.
///
/// Both ways an angle is exact to the rounding of its largest term. An angle that is not
/// finite gives one that is not.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Drives<T = f64> {
    zero: Joints<T>,
    shoulder: DriveSense,
    elbow: DriveSense,
    coupling: T,
}

impl<T: RealField + Copy> Default for Drives<T> {
    /// Drive angles are joint angles.
    fn default() -> Self {
        Self {
            zero: Joints::new(T::zero(), T::zero()),
            shoulder: DriveSense::Forward,
            elbow: DriveSense::Forward,
            coupling: T::zero(),
        }
    }
}

impl<T: RealField + Copy> Drives<T> {
    /// The drives read zero when their sums above equal `zero`, in radians, each within
    /// ±1/√ε (f64: 6.7e7, f32: 2896).
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`].
    pub fn with_zero(mut self, zero: Joints<T>) -> Result<Self, GeometryError<T>> {
        within(largest_angle(), "shoulder zero", zero.shoulder)?;
        within(largest_angle(), "elbow zero", zero.elbow)?;
        self.zero = zero;
        Ok(self)
    }

    /// The senses of turning of shoulder and elbow.
    #[must_use]
    pub const fn with_senses(mut self, shoulder: DriveSense, elbow: DriveSense) -> Self {
        self.shoulder = shoulder;
        self.elbow = elbow;
        self
    }

    /// The fraction of the shoulder's turning that the forearm's drive sees, within ±1/√ε.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`].
    pub fn with_coupling(mut self, coupling: T) -> Result<Self, GeometryError<T>> {
        within(largest_angle(), "coupling", coupling)?;
        self.coupling = coupling;
        Ok(self)
    }

    /// The sums at which the drives read zero, in radians.
    #[must_use]
    pub const fn zero(&self) -> Joints<T> {
        self.zero
    }

    /// The senses of turning of shoulder and elbow.
    #[must_use]
    pub const fn senses(&self) -> (DriveSense, DriveSense) {
        (self.shoulder, self.elbow)
    }

    /// The fraction of the shoulder's turning that the forearm's drive sees.
    #[must_use]
    pub const fn coupling(&self) -> T {
        self.coupling
    }

    /// Drive angles for joint angles.
    #[must_use]
    pub fn from_joints(&self, joints: Joints<T>) -> DriveAngles<T> {
        DriveAngles {
            shoulder: self.shoulder.of(joints.shoulder - self.zero.shoulder),
            elbow: self
                .elbow
                .of(joints.elbow + self.coupling * joints.shoulder - self.zero.elbow),
        }
    }

    /// Joint angles for drive angles.
    #[must_use]
    pub fn to_joints(&self, drives: DriveAngles<T>) -> Joints<T> {
        let shoulder = self.shoulder.of(drives.shoulder) + self.zero.shoulder;
        Joints {
            shoulder,
            elbow: self.elbow.of(drives.elbow) + self.zero.elbow - self.coupling * shoulder,
        }
    }
}

impl DriveSense {
    fn of<T: RealField>(self, angle: T) -> T {
        match self {
            Self::Forward => angle,
            Self::Reversed => -angle,
        }
    }
}
