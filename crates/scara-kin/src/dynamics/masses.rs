//! What an arm weighs.

use nalgebra::RealField;

use super::DynamicsError;

/// A link as a rigid body, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "a body in the plane has no more to it"
)]
pub struct LinkMass<T = f64> {
    /// Mass, in kg; with that of a motor that rides on the link.
    pub mass_kg: T,
    /// Distance of the centre of mass from the link's joint, towards the next, in m.
    pub centre_m: T,
    /// Inertia about the centre of mass, in kg m²: m l²/12 of an even rod.
    pub inertia_kg_m2: T,
}

/// The drive of a joint as the joint feels it, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct JointDrive<T = f64> {
    /// Inertia of rotor and gear at the joint, in kg m²: that of the rotor times the square of the
    /// gear ratio.
    pub rotor_kg_m2: T,
    /// Viscous friction, in Nm per rad/s.
    pub viscous_nm_s: T,
    /// Coulomb friction, in Nm.
    pub coulomb_nm: T,
}

/// What an arm weighs, with its payload and drives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct ArmMasses<T = f64> {
    /// The upper arm.
    pub upper: LinkMass<T>,
    /// The forearm, without payload.
    pub fore: LinkMass<T>,
    /// A point mass at the tool, in kg.
    pub payload_kg: T,
    /// The shoulder's drive.
    pub shoulder: JointDrive<T>,
    /// The elbow's drive.
    pub elbow: JointDrive<T>,
    /// 0 where the arm moves in a horizontal plane, 9.80665 where -Y of the world points down, in
    /// m/s².
    pub gravity_m_s2: T,
}

impl<T: RealField + Copy> LinkMass<T> {
    /// Inertia about the joint.
    pub(super) fn about_joint(&self) -> T {
        self.inertia_kg_m2 + self.mass_kg * self.centre_m * self.centre_m
    }
}

impl<T: RealField + Copy> ArmMasses<T> {
    /// Refuses by name what no body has.
    pub(super) fn check(&self) -> Result<(), DynamicsError<T>> {
        let Self {
            upper,
            fore,
            payload_kg,
            shoulder,
            elbow,
            gravity_m_s2,
        } = *self;
        let numbers = [
            ("mass of the upper arm", upper.mass_kg),
            ("inertia of the upper arm", upper.inertia_kg_m2),
            ("mass of the forearm", fore.mass_kg),
            ("inertia of the forearm", fore.inertia_kg_m2),
            ("payload", payload_kg),
            ("rotor of the shoulder", shoulder.rotor_kg_m2),
            ("viscous friction of the shoulder", shoulder.viscous_nm_s),
            ("Coulomb friction of the shoulder", shoulder.coulomb_nm),
            ("rotor of the elbow", elbow.rotor_kg_m2),
            ("viscous friction of the elbow", elbow.viscous_nm_s),
            ("Coulomb friction of the elbow", elbow.coulomb_nm),
        ];
        let is_weight = |value: T| value >= T::zero() && value.is_finite();
        let refused = numbers.into_iter().find(|(_, value)| !is_weight(*value));
        // A centre may lie behind its joint, and gravity may point up.
        let signed = [
            ("centre of the upper arm", upper.centre_m),
            ("centre of the forearm", fore.centre_m),
            ("gravity", gravity_m_s2),
        ];
        let refused = refused.or_else(|| signed.into_iter().find(|(_, value)| !value.is_finite()));
        refused.map_or(Ok(()), |(name, value)| Err(DynamicsError { name, value }))
    }
}
