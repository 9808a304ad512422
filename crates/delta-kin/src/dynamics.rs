//! Inverse dynamics: the torques of the arms that a motion takes.
//!
//! The upper arms turn about their shoulders, platform and payload move without turning, and the
//! rods are straight and even: the forces of such a rod's inertia are those of thirds of its mass
//! at its ends and of a sixth between them, exactly. With K an elbow, P the platform, m the rods of
//! an arm, by virtual work:
//!
//! ```text
//! Eᵢ = m (2K̈ᵢ + P̈) / 6 - m g / 2                  at each elbow
//! F  = (M + payload) (P̈ - g) + Σ m (K̈ᵢ + 2P̈) / 6 - m g / 2    at the platform
//! τᵢ = Iᵢ θ̈ᵢ + weight of the arm + K'ᵢ · Eᵢ + Jᵢ · F           Jᵢ = ∂P/∂θᵢ
//! ```
//!
//! P̈ follows from the rods' constant lengths: D · (P̈ - K̈) = -|Ṗ - K̇|², D = P - K.

mod masses;
#[cfg(feature = "path-timing")]
mod planned;

use nalgebra::{Matrix3, RealField, Vector3};
use trig_kernels::{Trig, sin_cos};

pub use masses::{DeltaMasses, DynamicsError};

use crate::arm::zip;
use crate::{Delta, Pose, PoseError};

/// What a Delta weighs against a motion, in SI units.
///
/// ```
/// use delta_kin::nalgebra::{Point3, Vector3};
/// use delta_kin::{Delta, DeltaMasses, Dimensions};
///
/// let delta = Delta::new(Dimensions { base: 42.0, platform: 18.0, upper: 120.0, lower: 243.0 })?; // mm
/// let dynamics = delta.dynamics(1e-3, DeltaMasses { // 1 mm in m
///     arm_kg_m2: 2e-3,   // about the shoulder, with the rotor through its gear
///     arm_kg_m: 0.01,    // mass times the distance of its centre from the shoulder
///     rods_kg: 0.05,     // both rods of an arm
///     platform_kg: 0.2,
///     payload_kg: 0.5,
///     gravity_m_s2: 9.80665,
///     ..DeltaMasses::default()
/// })?;
/// let pose = delta.pose_at(Point3::new(20.0, -10.0, -260.0))?;
/// let (rates, accelerations) = (Vector3::new(1.0, 0.5, -1.0), Vector3::new(30.0, 10.0, -20.0));
/// let torques = dynamics.torques(&pose, rates, accelerations)?; // Nm
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeltaDynamics<T: RealField = f64> {
    delta: Delta<T>,
    masses: DeltaMasses<T>,
    /// The machine's unit of length, in m.
    unit_m: T,
}

impl<T: RealField + Trig> Delta<T> {
    /// The machine with masses. `unit_m` is the unit of its lengths in metres: 1e-3 for mm.
    ///
    /// # Errors
    /// [`DynamicsError`] for a negative number or one that is not finite, and a unit that is not
    /// above 0.
    pub fn dynamics(
        &self,
        unit_m: T,
        masses: DeltaMasses<T>,
    ) -> Result<DeltaDynamics<T>, DynamicsError<T>> {
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
        Ok(DeltaDynamics {
            delta: *self,
            masses,
            unit_m,
        })
    }
}

impl<T: RealField + Trig> DeltaDynamics<T> {
    /// The masses.
    #[must_use]
    pub const fn masses(&self) -> &DeltaMasses<T> {
        &self.masses
    }

    /// The dynamics with another payload, in kg.
    ///
    /// # Errors
    /// [`DynamicsError`] for a negative number or one that is not finite.
    pub fn with_payload(self, payload_kg: T) -> Result<Self, DynamicsError<T>> {
        let masses = DeltaMasses {
            payload_kg,
            ..self.masses
        };
        masses.check()?;
        Ok(Self { masses, ..self })
    }

    /// The torques of the arms in Nm that a motion takes in a pose, at rates in rad/s and
    /// accelerations in rad/s²: what a servo drive takes as feed-forward. At the arms' side of the
    /// gears.
    ///
    /// An arm at rest has no Coulomb friction here: it may have any up to that.
    ///
    /// # Errors
    /// [`PoseError::Parallel`].
    pub fn torques(
        &self,
        pose: &Pose<T>,
        rates: Vector3<T>,
        accelerations: Vector3<T>,
    ) -> Result<Vector3<T>, PoseError<T>> {
        let masses = &self.masses;
        let friction = rates.map(|rate| {
            let coulomb = if rate == T::zero() {
                T::zero()
            } else {
                masses.coulomb_nm.copysign(rate)
            };
            masses.viscous_nm_s * rate + coulomb
        });
        Ok(self.posture(pose)?.torques(rates, accelerations) + friction)
    }

    /// What the torques of all motions through a pose have in common.
    fn posture(&self, pose: &Pose<T>) -> Result<Posture<'_, T>, PoseError<T>> {
        let delta = &self.delta;
        let arms = zip(delta.prepared().each_ref(), delta.thetas(pose.angles()));
        let elbows = arms.map(|(prepared, theta)| {
            let (sin, cos) = sin_cos(theta);
            let inward = prepared.in_plane(-prepared.upper * sin, prepared.upper * cos);
            Elbow {
                tangent: delta.flip(prepared.tangent((sin, cos))) * prepared.turn,
                inward: delta.flip(inward),
                outward: sin * prepared.turn,
                lower: prepared.lower,
            }
        });
        Ok(Posture {
            masses: &self.masses,
            unit_m: self.unit_m,
            inverse: pose.rod_inverse()?,
            jacobian: pose.jacobian()?,
            rods: *pose.rods(),
            elbows,
            gravity: delta.flip(Vector3::new(
                T::zero(),
                T::zero(),
                -self.masses.gravity_m_s2 / self.unit_m,
            )),
        })
    }
}

/// An elbow in a pose.
struct Elbow<T> {
    /// Its place's derivative by the arm's angle, and that one's.
    tangent: Vector3<T>,
    inward: Vector3<T>,
    /// sin θ, the upper arm's reach outward, with the sign of its angle.
    outward: T,
    /// The length of its rods.
    lower: T,
}

/// A Delta in a pose.
struct Posture<'a, T> {
    masses: &'a DeltaMasses<T>,
    unit_m: T,
    /// Of the matrix of the rods' directions, by columns.
    inverse: [Vector3<T>; 3],
    jacobian: Matrix3<T>,
    rods: [Vector3<T>; 3],
    elbows: [Elbow<T>; 3],
    gravity: Vector3<T>,
}

impl<T: RealField + Copy> Posture<'_, T> {
    /// The torques of a motion, without friction.
    fn torques(&self, rates: Vector3<T>, accelerations: Vector3<T>) -> Vector3<T> {
        let (masses, gravity) = (self.masses, self.gravity);
        let velocity = self.jacobian * rates;
        let turning = zip(rates.into(), accelerations.into());
        let of_elbows =
            zip(self.elbows.each_ref(), turning).map(|(elbow, (rate, acceleration))| {
                elbow.tangent * acceleration + elbow.inward * (rate * rate)
            });
        let elbows = zip(zip(self.elbows.each_ref(), of_elbows), rates.into());
        let [a, b, c] = zip(zip(self.rods, self.inverse), elbows).map(
            |((rod, column), ((elbow, acceleration), rate))| {
                let turned = (velocity - elbow.tangent * rate).norm_squared() / elbow.lower;
                column * (rod.dot(&acceleration) - turned)
            },
        );
        let acceleration = a + b + c;

        let number = |value: f64| nalgebra::convert::<f64, T>(value);
        let (sixth, half) = (masses.rods_kg / number(6.0), masses.rods_kg * number(0.5));
        let mut force = (acceleration - gravity) * (masses.platform_kg + masses.payload_kg);
        for of_elbow in &of_elbows {
            force += (of_elbow + acceleration * number(2.0)) * sixth - gravity * half;
        }
        let at_platform = self.jacobian.tr_mul(&force);
        let square = self.unit_m * self.unit_m;
        let elbows = zip(self.elbows.each_ref(), of_elbows);
        let arms = zip(elbows, zip(at_platform.into(), accelerations.into()));
        let torques = arms.map(|((elbow, of_elbow), (at_platform, of_arm))| {
            let at_elbow = (of_elbow * number(2.0) + acceleration) * sixth - gravity * half;
            let own =
                masses.arm_kg_m2 * of_arm + masses.arm_kg_m * masses.gravity_m_s2 * elbow.outward;
            own + (elbow.tangent.dot(&at_elbow) + at_platform) * square
        });
        torques.into()
    }
}
