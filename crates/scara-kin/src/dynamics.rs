//! Inverse dynamics: the torques that a motion takes.
//!
//! Both links are rigid bodies in the plane whose centres of mass lie on the line through their
//! joints; the payload is a point at the tool. Lagrange's equations, with cᵢ the distance of a
//! centre from its joint and Iᵢ the inertia about it:
//!
//! ```text
//! k = (m2 c2 + m l2) l1    δ = I2 + m2 c2² + m l2²    α = I1 + m1 c1² + (m2 + m) l1² + δ
//! τ1 = (α + 2k cos q2) q̈1 + (δ + k cos q2) q̈2 - k sin q2 (2 q̇1 q̇2 + q̇2²)
//! τ2 = (δ + k cos q2) q̈1 + δ q̈2 + k sin q2 q̇1²
//! ```
//!
//! Source: any textbook, such as Spong, Hutchinson and Vidyasagar, "Robot Modeling and Control",
//! section 7.3.2, there without payload and motors.

mod error;
mod masses;
#[cfg(feature = "path-timing")]
mod planned;

use nalgebra::{RealField, Vector2};
use trig_kernels::{Trig, sin_cos};

pub use error::DynamicsError;
pub use masses::{ArmMasses, JointDrive, LinkMass};

use crate::limits::two;
use crate::{Arm, Joints};

/// What both links, the payload and the drives weigh against a motion, in SI units.
///
/// ```
/// use scara_kin::nalgebra::Vector2;
/// use scara_kin::{Arm, ArmMasses, JointDrive, Joints, LinkMass};
///
/// let arm = Arm::new(300.0, 300.0)?; // mm
/// let link = LinkMass { mass_kg: 2.0, centre_m: 0.15, inertia_kg_m2: 0.02 };
/// let dynamics = arm.dynamics(1e-3, ArmMasses { // 1 mm in m
///     upper: link,
///     fore: link,
///     payload_kg: 1.0,
///     shoulder: JointDrive { rotor_kg_m2: 0.1, viscous_nm_s: 0.2, coulomb_nm: 0.5 },
///     elbow: JointDrive::default(),
///     gravity_m_s2: 0.0, // a horizontal plane
/// })?;
/// let (rates, accelerations) = (Vector2::new(1.0, -2.0), Vector2::new(20.0, 30.0)); // rad/s, rad/s²
/// let torques = dynamics.torques(Joints::new(0.3, 1.2), rates, accelerations); // Nm
/// assert!(torques.x > torques.y && torques.y > 0.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmDynamics<T: RealField = f64> {
    masses: ArmMasses<T>,
    /// Link lengths in m.
    lengths: [T; 2],
    /// Sine and cosine of the base's angle.
    base: (T, T),
}

/// The sums that a payload and both links come down to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lumped<T> {
    /// Inertia about the shoulder with the elbow at a right angle, rotor included: α.
    pub(crate) alpha: T,
    /// Inertia about the elbow: δ.
    pub(crate) delta: T,
    /// The same with the elbow's rotor.
    pub(crate) elbow: T,
    /// Coupling: k.
    pub(crate) coupling: T,
    /// First moments times gravity: of the upper arm with all that it carries, of the forearm.
    pub(crate) weights: [T; 2],
}

impl<T: RealField + Trig> Arm<T> {
    /// The arm with masses. `unit_m` is the unit of its lengths in metres: 1e-3 for an arm in mm.
    ///
    /// # Errors
    /// [`DynamicsError`] for a negative number or one that is not finite, and a unit that is not
    /// above 0.
    pub fn dynamics(
        &self,
        unit_m: T,
        masses: ArmMasses<T>,
    ) -> Result<ArmDynamics<T>, DynamicsError<T>> {
        masses.check()?;
        // Written so that NaN is refused too.
        let is_unit = unit_m > T::zero() && unit_m.is_finite();
        if !is_unit {
            let name = "unit of length, in metres,";
            return Err(DynamicsError {
                name,
                value: unit_m,
            });
        }
        let rotation = &self.base().rotation;
        Ok(ArmDynamics {
            masses,
            lengths: [self.upper(), self.fore()].map(|length| length * unit_m),
            base: (rotation.im, rotation.re),
        })
    }
}

impl<T: RealField + Trig> ArmDynamics<T> {
    /// The masses.
    #[must_use]
    pub const fn masses(&self) -> &ArmMasses<T> {
        &self.masses
    }

    /// The same with another payload, in kg.
    ///
    /// # Errors
    /// [`DynamicsError`] for a negative number or one that is not finite.
    pub fn with_payload(self, payload_kg: T) -> Result<Self, DynamicsError<T>> {
        let masses = ArmMasses {
            payload_kg,
            ..self.masses
        };
        masses.check()?;
        Ok(Self { masses, ..self })
    }

    /// The torques of shoulder and elbow in Nm that a motion takes, at rates in rad/s and
    /// accelerations in rad/s²: what a servo drive takes as feed-forward. At the joints' side of
    /// the gears.
    ///
    /// ```text
    /// τ = M(q) q̈ + h(q, q̇) + g(q) + viscous q̇ + coulomb sign(q̇)
    /// ```
    ///
    /// A joint at rest has no Coulomb friction here: it may have any up to that.
    #[must_use]
    pub fn torques(
        &self,
        joints: Joints<T>,
        rates: Vector2<T>,
        accelerations: Vector2<T>,
    ) -> Vector2<T> {
        let frictionless = self.posture(joints).torques(rates, accelerations);
        let friction = |drive: &JointDrive<T>, rate: T| {
            let coulomb = if rate == T::zero() {
                T::zero()
            } else {
                drive.coulomb_nm.copysign(rate)
            };
            drive.viscous_nm_s * rate + coulomb
        };
        let JointDrives { shoulder, elbow } = self.drives();
        frictionless + Vector2::new(friction(shoulder, rates.x), friction(elbow, rates.y))
    }

    const fn drives(&self) -> JointDrives<'_, T> {
        JointDrives {
            shoulder: &self.masses.shoulder,
            elbow: &self.masses.elbow,
        }
    }

    /// What the torques of all motions through a pose have in common.
    fn posture(&self, joints: Joints<T>) -> Posture<T> {
        let lumped = self.lumped();
        let (sin, cos) = sin_cos(joints.elbow);
        let coupled = lumped.coupling * cos;
        Posture {
            shoulder: lumped.alpha + coupled * two(),
            mixed: lumped.delta + coupled,
            elbow: lumped.elbow,
            turning: lumped.coupling * sin,
            weight: self.weight(joints, &lumped),
        }
    }

    /// What gravity takes, along -Y of the world.
    fn weight(&self, joints: Joints<T>, lumped: &Lumped<T>) -> Vector2<T> {
        if self.masses.gravity_m_s2 == T::zero() {
            return Vector2::zeros();
        }
        let [upper, fore] = lumped.weights;
        let (base_sin, base_cos) = self.base;
        // The horizontal part of each link's direction.
        let across = |angle: T| {
            let (sin, cos) = sin_cos(angle);
            cos * base_cos - sin * base_sin
        };
        let fore = fore * across(joints.shoulder + joints.elbow);
        Vector2::new(upper * across(joints.shoulder) + fore, fore)
    }

    /// The sums of masses.
    pub(crate) fn lumped(&self) -> Lumped<T> {
        let ArmMasses {
            upper,
            fore,
            payload_kg: load,
            shoulder,
            elbow,
            gravity_m_s2: gravity,
        } = self.masses;
        let [l1, l2] = self.lengths;
        let moment = fore.mass_kg * fore.centre_m + load * l2;
        let delta = fore.about_joint() + load * l2 * l2;
        let carried = fore.mass_kg + load;
        Lumped {
            alpha: upper.about_joint() + carried * l1 * l1 + delta + shoulder.rotor_kg_m2,
            delta,
            elbow: delta + elbow.rotor_kg_m2,
            coupling: moment * l1,
            weights: [upper.mass_kg * upper.centre_m + carried * l1, moment]
                .map(|moment| moment * gravity),
        }
    }
}

/// An arm in a pose.
struct Posture<T> {
    /// Inertia of both joints, and what each has of the other.
    shoulder: T,
    elbow: T,
    mixed: T,
    /// k sin q2.
    turning: T,
    weight: Vector2<T>,
}

impl<T: RealField + Copy> Posture<T> {
    /// The torques of a motion, without friction.
    fn torques(&self, rates: Vector2<T>, accelerations: Vector2<T>) -> Vector2<T> {
        let inertial = Vector2::new(
            self.shoulder * accelerations.x + self.mixed * accelerations.y,
            self.mixed * accelerations.x + self.elbow * accelerations.y,
        );
        let centrifugal = Vector2::new(-(rates.x * two() + rates.y) * rates.y, rates.x * rates.x);
        inertial + centrifugal * self.turning + self.weight
    }
}

/// The drives of both joints.
struct JointDrives<'a, T> {
    shoulder: &'a JointDrive<T>,
    elbow: &'a JointDrive<T>,
}
