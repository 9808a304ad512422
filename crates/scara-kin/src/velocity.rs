//! Jacobian, speeds, accelerations, distance from singular poses.

use core::fmt::{Display, Formatter};

use nalgebra::{Matrix2, RealField, Vector2};
use trig_kernels::{Trig, sin_cos};

use crate::digits::Digits;
use crate::limits::two;
use crate::{Arm, Joints};

/// Why joint speeds do not follow from a tool speed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RatesError<T = f64> {
    /// The arm is straight or folded, within the rounding of the elbow angle: the tool cannot
    /// move along the forearm.
    Singular {
        /// The elbow angle, in radians.
        elbow: T,
    },
    /// Something given is infinite or not a number, or what follows from it is too large for
    /// `T`.
    NotFinite {
        /// What it is.
        name: &'static str,
        /// Its value.
        value: T,
    },
}

impl<T: RealField + Copy> Display for RatesError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match *self {
            Self::Singular { elbow } => write!(
                f,
                "singular pose: elbow at {} rad leaves the arm straight or folded within rounding",
                Digits(elbow)
            ),
            Self::NotFinite { name, value } => {
                write!(f, "{name} is {}, not a finite number", Digits(value))
            }
        }
    }
}

impl<T: RealField + Copy> core::error::Error for RatesError<T> {}

impl<T: RealField + Trig> Arm<T> {
    /// The Jacobian of the tool position: columns shoulder and elbow, in length per radian.
    ///
    /// ```text
    /// J = base rotation · [ ẑ × (upper + fore),  ẑ × fore ],   det J = l1 l2 sin q2
    /// ```
    #[must_use]
    pub fn jacobian(&self, joints: Joints<T>) -> Matrix2<T> {
        let links = self.links(joints);
        let rotation = &self.base().rotation;
        Matrix2::from_columns(&[
            rotation * quarter_turn(links.tip()),
            rotation * quarter_turn(links.fore),
        ])
    }

    /// Yoshikawa's manipulability |det J| = l1 l2 |sin q2|, in length² per radian²:
    /// zero where the arm is straight or folded.
    #[must_use]
    pub fn manipulability(&self, joints: Joints<T>) -> T {
        self.upper() * self.fore() * sin_cos(joints.elbow).0.abs()
    }

    /// Distance from a singular pose: the smaller singular value of the Jacobian, the
    /// smallest tool speed that one radian per second of joint speed gives, in length
    /// per radian.
    ///
    /// ```text
    /// σ₂ = 2 |det J| / (σ₁ + σ₂ + σ₁ - σ₂),   σ₁ ± σ₂ = √((J₁₁ ± J₂₂)² + (J₁₂ ∓ J₂₁)²)
    /// ```
    #[must_use]
    pub fn singularity_distance(&self, joints: Joints<T>) -> T {
        let j = self.jacobian(joints);
        // For det J < 0 sum and difference are swapped.
        let sum = (j.m11 + j.m22).hypot(j.m12 - j.m21);
        let difference = (j.m11 - j.m22).hypot(j.m12 + j.m21);
        self.manipulability(joints) * two() / (sum + difference)
    }

    /// Tool velocity in length per second from joint rates (shoulder, elbow) in rad/s.
    #[must_use]
    pub fn tool_velocity(&self, joints: Joints<T>, rates: Vector2<T>) -> Vector2<T> {
        self.jacobian(joints) * rates
    }

    /// Joint rates (shoulder, elbow) in rad/s that give a tool velocity in length per
    /// second, to hold a feed in mm/s at the tool.
    ///
    /// ```text
    /// q̇1 = (f · v) / det J,   q̇2 = -(t · v) / det J
    /// ```
    ///
    /// f the forearm, t the line from base to tool, det J = l1 l2 sin q2.
    ///
    /// # Errors
    /// [`RatesError::Singular`] within a few machine epsilons of a straight or folded arm,
    /// [`RatesError::NotFinite`].
    pub fn joint_rates(
        &self,
        joints: Joints<T>,
        velocity: Vector2<T>,
    ) -> Result<Vector2<T>, RatesError<T>> {
        finite(["shoulder", "elbow"], [joints.shoulder, joints.elbow])?;
        finite(["velocity x", "velocity y"], velocity.into())?;
        self.solve(joints, velocity)
    }

    /// The rates that the Jacobian turns into `velocity`, all given being finite.
    fn solve(&self, joints: Joints<T>, velocity: Vector2<T>) -> Result<Vector2<T>, RatesError<T>> {
        let elbow = joints.elbow;
        // sin(π) in floating point is half an epsilon, not zero; turns from zero it is what
        // the angle was rounded by.
        let rounding = T::default_epsilon() * elbow.abs().max(two());
        let (sin, _) = sin_cos(elbow);
        if sin.abs() <= rounding {
            return Err(RatesError::Singular { elbow });
        }
        let links = self.links(joints);
        let local = self.base().rotation.inverse() * velocity;
        let det = self.upper() * self.fore() * sin;
        // Divided first: a product of length and velocity could leave the range of `T`.
        let rates = Vector2::new(
            (links.fore / det).dot(&local),
            -(links.tip() / det).dot(&local),
        );
        finite(["rate of the shoulder", "rate of the elbow"], rates.into())?;
        Ok(rates)
    }

    /// Tool acceleration in length per second² from joint rates in rad/s and joint
    /// accelerations in rad/s², each (shoulder, elbow).
    ///
    /// ```text
    /// a = J q̈ - upper q̇1² - fore (q̇1 + q̇2)²
    /// ```
    #[must_use]
    pub fn tool_acceleration(
        &self,
        joints: Joints<T>,
        rates: Vector2<T>,
        accelerations: Vector2<T>,
    ) -> Vector2<T> {
        self.jacobian(joints) * accelerations + self.centripetal(joints, rates)
    }

    /// Joint accelerations (shoulder, elbow) in rad/s² that give a tool acceleration in
    /// length per second² at the given joint rates in rad/s.
    ///
    /// # Errors
    /// [`RatesError`] as for [`joint_rates`](Self::joint_rates).
    pub fn joint_accelerations(
        &self,
        joints: Joints<T>,
        rates: Vector2<T>,
        acceleration: Vector2<T>,
    ) -> Result<Vector2<T>, RatesError<T>> {
        finite(["shoulder", "elbow"], [joints.shoulder, joints.elbow])?;
        finite(["rate of the shoulder", "rate of the elbow"], rates.into())?;
        finite(["acceleration x", "acceleration y"], acceleration.into())?;
        let centripetal = self.centripetal(joints, rates);
        finite(["centripetal x", "centripetal y"], centripetal.into())?;
        self.solve(joints, acceleration - centripetal)
    }

    /// The most by which the tool is moved where shoulder and elbow are off by at most these
    /// radians, in the unit of length: at any pose.
    ///
    /// ```text
    /// |Δp| ≤ (l1 + l2) |Δq1| + l2 |Δq2|
    /// ```
    #[must_use]
    pub fn tool_shift(&self, [shoulder, elbow]: [T; 2]) -> T {
        self.reach() * shoulder.abs() + self.fore() * elbow.abs()
    }

    /// The part of the tool's acceleration that the joint rates alone cause.
    fn centripetal(&self, joints: Joints<T>, rates: Vector2<T>) -> Vector2<T> {
        let links = self.links(joints);
        let (upper, fore) = (rates.x, rates.x + rates.y);
        // Not by the squares: they could leave the range of `T`.
        let local = links.upper * upper * upper + links.fore * fore * fore;
        -(self.base().rotation * local)
    }
}

pub(crate) fn quarter_turn<T: RealField + Copy>(v: Vector2<T>) -> Vector2<T> {
    Vector2::new(-v.y, v.x)
}

/// Refuses by its name what is not finite.
fn finite<T: RealField + Copy>(
    names: [&'static str; 2],
    values: [T; 2],
) -> Result<(), RatesError<T>> {
    for (name, value) in names.into_iter().zip(values) {
        if !value.is_finite() {
            return Err(RatesError::NotFinite { name, value });
        }
    }
    Ok(())
}
