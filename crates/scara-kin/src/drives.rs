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

/// The angles of the two drives, in radians: at the joints' side of their gears, or at the motors'
/// with [`Drives::with_ratios`].
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

/// How the drives sit on the joints: zero offsets, senses of turning, ratios, coupling.
///
/// ```text
/// d1 = ±(q1 - zero1) / ratio1
/// d2 = ±(q2 + coupling · q1 - zero2) / ratio2
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
    /// Of shoulder and elbow.
    ratios: [T; 2],
    coupling: T,
}

impl<T: RealField + Copy> Default for Drives<T> {
    /// Drive angles are joint angles.
    fn default() -> Self {
        Self {
            zero: Joints::new(T::zero(), T::zero()),
            shoulder: DriveSense::Forward,
            elbow: DriveSense::Forward,
            ratios: [T::one(); 2],
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

    /// What shoulder and elbow turn for each radian of their drives: 1 where those are at the
    /// joints' side of the gears, 1/27 at the motor of a gear of 27:1. Above 0, between √ε and
    /// 1/√ε.
    ///
    /// # Errors
    /// [`GeometryError::Ratio`].
    pub fn with_ratios(mut self, [shoulder, elbow]: [T; 2]) -> Result<Self, GeometryError<T>> {
        let max = largest_angle::<T>();
        let min = max.recip();
        for (joint, ratio) in [("shoulder", shoulder), ("elbow", elbow)] {
            // Written so that NaN is refused too.
            let is_ratio = ratio >= min && ratio <= max;
            if !is_ratio {
                return Err(GeometryError::Ratio {
                    joint,
                    ratio,
                    min,
                    max,
                });
            }
        }
        self.ratios = [shoulder, elbow];
        Ok(self)
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

    /// What shoulder and elbow turn for each radian of their drives.
    #[must_use]
    pub const fn ratios(&self) -> [T; 2] {
        self.ratios
    }

    /// The fraction of the shoulder's turning that the forearm's drive sees.
    #[must_use]
    pub const fn coupling(&self) -> T {
        self.coupling
    }

    /// Drive angles for joint angles.
    #[must_use]
    pub fn from_joints(&self, joints: Joints<T>) -> DriveAngles<T> {
        let [shoulder, elbow] = self.ratios;
        let turned = joints.elbow + self.coupling * joints.shoulder - self.zero.elbow;
        DriveAngles {
            shoulder: self.shoulder.of(joints.shoulder - self.zero.shoulder) / shoulder,
            elbow: self.elbow.of(turned) / elbow,
        }
    }

    /// Joint angles for drive angles.
    #[must_use]
    pub fn to_joints(&self, drives: DriveAngles<T>) -> Joints<T> {
        let turned = self.turned(drives);
        let shoulder = turned.shoulder * self.ratios[0] + self.zero.shoulder;
        Joints {
            shoulder,
            elbow: turned.elbow * self.ratios[1] + self.zero.elbow - self.coupling * shoulder,
        }
    }
}

impl<T: RealField + Copy> Drives<T> {
    /// The drives' angles in the joints' senses.
    pub(crate) fn turned(&self, drives: DriveAngles<T>) -> DriveAngles<T> {
        DriveAngles {
            shoulder: self.shoulder.of(drives.shoulder),
            elbow: self.elbow.of(drives.elbow),
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
