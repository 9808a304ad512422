//! What can be calibrated, and how the platform moves when it changes.

use core::fmt;

use nalgebra::Vector3;
use trig_kernels::sin_cos;

use crate::arm::zip;
use crate::{Arm, ArmGeometry, Delta, Pose};

/// A quantity of an arm's geometry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "these six determine an arm")]
pub enum Quantity {
    /// [`ArmGeometry::azimuth`].
    Azimuth,
    /// [`ArmGeometry::base`]. Only its difference from the platform's radius shows.
    Base,
    /// [`ArmGeometry::platform`]. Only its difference from the base's radius shows.
    Platform,
    /// [`ArmGeometry::upper`].
    Upper,
    /// [`ArmGeometry::lower`].
    Lower,
    /// [`ArmGeometry::zero`].
    Zero,
}

/// One number that a calibration may change: a quantity of one arm, or of all three alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "a parameter is just this")]
pub struct Parameter {
    /// The quantity.
    pub quantity: Quantity,
    /// The arm; `None`: the same change for all three.
    pub arm: Option<Arm>,
}

impl Parameter {
    /// A quantity of one arm.
    #[must_use]
    pub const fn of(quantity: Quantity, arm: Arm) -> Self {
        Self {
            quantity,
            arm: Some(arm),
        }
    }

    /// A quantity of all three arms, changed alike.
    #[must_use]
    pub const fn common(quantity: Quantity) -> Self {
        Self {
            quantity,
            arm: None,
        }
    }

    fn is_of(self, arm: Arm) -> bool {
        self.arm.is_none_or(|own| own == arm)
    }

    /// What a change of 1 is in a calibration: the machine's span, or a radian.
    pub(super) fn unit(self, span: f64) -> f64 {
        match self.quantity {
            Quantity::Azimuth | Quantity::Zero => 1.0,
            Quantity::Base | Quantity::Platform | Quantity::Upper | Quantity::Lower => span,
        }
    }

    pub(super) fn add(self, arms: &mut [ArmGeometry; 3], change: f64) {
        for (arm, geometry) in zip(Arm::ALL, arms.each_mut()) {
            if self.is_of(arm) {
                *match self.quantity {
                    Quantity::Azimuth => &mut geometry.azimuth,
                    Quantity::Base => &mut geometry.base,
                    Quantity::Platform => &mut geometry.platform,
                    Quantity::Upper => &mut geometry.upper,
                    Quantity::Lower => &mut geometry.lower,
                    Quantity::Zero => &mut geometry.zero,
                } += change;
            }
        }
    }

    /// How the platform moves when the parameter grows and the angles stay, from
    ///
    /// ```text
    /// e · dP = e · dC + dLa
    /// ```
    ///
    /// for each arm, e along its rods and C the centre of its sphere.
    pub(super) fn influence(
        self,
        delta: &Delta,
        pose: &Pose,
        inverse: &[Vector3<f64>; 3],
    ) -> Vector3<f64> {
        let prepared = zip(delta.prepared().each_ref(), delta.thetas(pose.angles()));
        let rods = zip(pose.rods().map(|rod| delta.flip(rod)), *inverse);
        zip(Arm::ALL, zip(prepared, rods))
            .into_iter()
            .filter(|(arm, _)| self.is_of(*arm))
            .map(|(_, ((prepared, theta), (rod, column)))| {
                let theta = sin_cos(theta);
                let along = match self.quantity {
                    Quantity::Azimuth => {
                        let centre = prepared.centre(theta);
                        Vector3::z().cross(&centre).dot(&rod)
                    }
                    Quantity::Base => prepared.in_plane(1.0, 0.0).dot(&rod),
                    Quantity::Platform => -prepared.in_plane(1.0, 0.0).dot(&rod),
                    Quantity::Upper => prepared.spoke(theta).dot(&rod) / prepared.upper,
                    Quantity::Lower => 1.0,
                    Quantity::Zero => prepared.tangent(theta).dot(&rod),
                };
                column * along
            })
            .sum()
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let quantity = match self.quantity {
            Quantity::Azimuth => "azimuth",
            Quantity::Base => "base radius",
            Quantity::Platform => "platform radius",
            Quantity::Upper => "upper arm",
            Quantity::Lower => "lower arm",
            Quantity::Zero => "zero",
        };
        match self.arm {
            Some(arm) => write!(f, "{quantity} of {arm}"),
            None => write!(f, "{quantity} of all arms"),
        }
    }
}
