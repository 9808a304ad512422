//! What a Delta weighs.

use nalgebra::RealField;

use crate::rounded::Rounded;

/// A number that no body has: negative, or not finite.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{name} is {}, which no body has", Rounded(*.value))]
#[expect(clippy::exhaustive_structs, reason = "there is one cause")]
pub struct DynamicsError<T: RealField + Copy = f64> {
    /// What it is.
    pub name: &'static str,
    /// Its value.
    pub value: T,
}

/// What a Delta of three equal arms weighs, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct DeltaMasses<T = f64> {
    /// Inertia of an upper arm about its shoulder, in kg m², with that of its rotor times the
    /// square of the gear ratio, and the elbow's joints.
    pub arm_kg_m2: T,
    /// Mass of an upper arm times the distance of its centre from the shoulder, in kg m.
    pub arm_kg_m: T,
    /// Mass of both rods of an arm, in kg: straight and even.
    pub rods_kg: T,
    /// Mass of the platform with the rods' joints, in kg.
    pub platform_kg: T,
    /// Mass that the platform carries, in kg.
    pub payload_kg: T,
    /// Viscous friction of an arm, in Nm per rad/s.
    pub viscous_nm_s: T,
    /// Coulomb friction of an arm, in Nm.
    pub coulomb_nm: T,
    /// 9.80665 where the platform hangs below, 0 without gravity, in m/s².
    pub gravity_m_s2: T,
}

impl<T: RealField + Copy> DeltaMasses<T> {
    /// Refuses by name what no body has.
    pub(super) fn check(&self) -> Result<(), DynamicsError<T>> {
        let numbers = [
            ("inertia of an arm", self.arm_kg_m2),
            ("mass of the rods", self.rods_kg),
            ("mass of the platform", self.platform_kg),
            ("payload", self.payload_kg),
            ("viscous friction", self.viscous_nm_s),
            ("Coulomb friction", self.coulomb_nm),
        ];
        let is_weight = |value: T| value >= T::zero() && value.is_finite();
        let refused = numbers.into_iter().find(|(_, value)| !is_weight(*value));
        // An arm may be balanced beyond its shoulder, and gravity may point up.
        let signed = [
            ("moment of an arm", self.arm_kg_m),
            ("gravity", self.gravity_m_s2),
        ];
        let refused = refused.or_else(|| signed.into_iter().find(|(_, value)| !value.is_finite()));
        refused.map_or(Ok(()), |(name, value)| Err(DynamicsError { name, value }))
    }
}
