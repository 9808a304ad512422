//! What can be calibrated, and how the tool moves when it changes.

use core::fmt;

use nalgebra::{Isometry2, Vector2};

use super::DrivenArm;
use crate::velocity::quarter_turn;
use crate::{Arm, DriveAngles, GeometryError};

/// One number that a calibration may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_enums,
    reason = "these ten determine an arm and its drives"
)]
pub enum Parameter {
    /// Length of the upper arm.
    Upper,
    /// Length of the forearm.
    Fore,
    /// The shoulder's part of [`Drives::zero`](crate::Drives::zero). With no coupling it is the
    /// base's angle: points determine their sum.
    ShoulderZero,
    /// The elbow's part of [`Drives::zero`](crate::Drives::zero).
    ElbowZero,
    /// The shoulder's of [`Drives::ratios`](crate::Drives::ratios).
    ShoulderRatio,
    /// The elbow's of [`Drives::ratios`](crate::Drives::ratios).
    ElbowRatio,
    /// [`Drives::coupling`](crate::Drives::coupling).
    Coupling,
    /// Position of the base along X.
    BaseX,
    /// Position of the base along Y.
    BaseY,
    /// Angle of the base.
    BaseAngle,
}

impl Parameter {
    /// What a change of 1 is in a calibration: the arm's reach, a radian, or 1.
    pub(super) const fn unit(self, reach: f64) -> f64 {
        match self {
            Self::Upper | Self::Fore | Self::BaseX | Self::BaseY => reach,
            Self::ShoulderZero
            | Self::ElbowZero
            | Self::ShoulderRatio
            | Self::ElbowRatio
            | Self::Coupling
            | Self::BaseAngle => 1.0,
        }
    }

    /// An arm with changed parameters.
    pub(super) fn changed(
        start: &DrivenArm,
        changes: impl Iterator<Item = (Self, f64)>,
    ) -> Result<DrivenArm, GeometryError> {
        let DrivenArm { arm, drives } = *start;
        let [mut upper, mut fore] = [arm.upper(), arm.fore()];
        let mut base = arm.base().translation.vector;
        let mut turned = 0.0;
        let mut zero = drives.zero();
        let [mut shoulder, mut elbow] = drives.ratios();
        let mut coupling = drives.coupling();
        for (parameter, change) in changes {
            *match parameter {
                Self::Upper => &mut upper,
                Self::Fore => &mut fore,
                Self::ShoulderZero => &mut zero.shoulder,
                Self::ElbowZero => &mut zero.elbow,
                Self::ShoulderRatio => &mut shoulder,
                Self::ElbowRatio => &mut elbow,
                Self::Coupling => &mut coupling,
                Self::BaseX => &mut base.x,
                Self::BaseY => &mut base.y,
                Self::BaseAngle => &mut turned,
            } += change;
        }
        let rotation = Isometry2::new(base, turned).rotation * arm.base().rotation;
        let arm = Arm::new(upper, fore)?
            .with_base(Isometry2::from_parts(base.into(), rotation))?
            .with_limits(*arm.limits())
            .with_keep_out(arm.keep_out())?;
        let drives = drives
            .with_zero(zero)?
            .with_ratios([shoulder, elbow])?
            .with_coupling(coupling)?;
        Ok(DrivenArm { arm, drives })
    }

    /// How the tool moves when the parameter grows and the drives stay.
    ///
    /// ```text
    /// q1 = ratio1 d1 + zero1,  q2 = ratio2 d2 + zero2 - coupling q1
    /// dp = J (dq1, dq2) + upper/l1 dl1 + fore/l2 dl2 + dbase + ẑ × (p - base) dangle
    /// ```
    pub(super) fn influence(self, machine: &DrivenArm, drives: DriveAngles) -> Vector2<f64> {
        let DrivenArm { arm, drives: on } = machine;
        let turned = on.turned(drives);
        let joints = on.to_joints(drives);
        let (links, jacobian) = (arm.links(joints), arm.jacobian(joints));
        // The forearm's drive holds its own sum while the shoulder turns.
        let shoulder = jacobian * Vector2::new(1.0, -on.coupling());
        let elbow = jacobian.column(1);
        match self {
            Self::Upper => arm.base().rotation * links.upper / arm.upper(),
            Self::Fore => arm.base().rotation * links.fore / arm.fore(),
            Self::ShoulderZero => shoulder,
            Self::ElbowZero => elbow.into(),
            Self::ShoulderRatio => shoulder * turned.shoulder,
            Self::ElbowRatio => elbow * turned.elbow,
            Self::Coupling => -elbow * joints.shoulder,
            Self::BaseX => Vector2::x(),
            Self::BaseY => Vector2::y(),
            Self::BaseAngle => {
                let base = arm.base().translation.vector;
                quarter_turn(arm.forward(joints).coords - base)
            }
        }
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Upper => "upper arm",
            Self::Fore => "forearm",
            Self::ShoulderZero => "shoulder zero",
            Self::ElbowZero => "elbow zero",
            Self::ShoulderRatio => "shoulder ratio",
            Self::ElbowRatio => "elbow ratio",
            Self::Coupling => "coupling",
            Self::BaseX => "base x",
            Self::BaseY => "base y",
            Self::BaseAngle => "base angle",
        })
    }
}
