//! Jacobian, speeds, accelerations, distance from singular poses.

use nalgebra::{Matrix2, RealField, Vector2};

use crate::limits::two;
use crate::{Arm, Joints};

/// The arm is straight or folded: the tool cannot move along the forearm, so that
/// joint speeds do not follow from a tool speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("singular pose: elbow at {elbow} rad leaves the arm straight or folded")]
#[expect(clippy::exhaustive_structs, reason = "there is one cause")]
pub struct SingularPose<T = f64> {
    /// The elbow angle, in radians.
    pub elbow: T,
}

impl<T: RealField + Copy> Arm<T> {
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
        self.upper() * self.fore() * joints.elbow.sin().abs()
    }

    /// Distance from a singular pose: the smaller singular value of the Jacobian, the
    /// least tool speed that one radian per second of joint speed gives, in length
    /// per radian.
    ///
    /// ```text
    /// σ₂ = 2 |det J| / (√(a + 2|det J|) + √(a - 2|det J|)),   a = Σ Jᵢⱼ²
    /// ```
    #[must_use]
    pub fn singularity_distance(&self, joints: Joints<T>) -> T {
        let double_det = self.manipulability(joints) * two();
        let a = self.jacobian(joints).norm_squared();
        let sum = (a + double_det).sqrt() + (a - double_det).max(T::zero()).sqrt();
        double_det / sum
    }

    /// Tool velocity in length per second from joint rates (shoulder, elbow) in rad/s.
    #[must_use]
    pub fn tool_velocity(&self, joints: Joints<T>, rates: Vector2<T>) -> Vector2<T> {
        self.jacobian(joints) * rates
    }

    /// Joint rates (shoulder, elbow) in rad/s that give a tool velocity in length per
    /// second: the honest way to hold a feed in mm/s at the tool.
    ///
    /// ```text
    /// q̇1 = (f · v) / det J,   q̇2 = -(t · v) / det J
    /// ```
    ///
    /// f the forearm, t the line from base to tool, det J = l1 l2 sin q2.
    ///
    /// # Errors
    /// [`SingularPose`] within a few machine epsilons of a straight or folded arm.
    pub fn joint_rates(
        &self,
        joints: Joints<T>,
        velocity: Vector2<T>,
    ) -> Result<Vector2<T>, SingularPose<T>> {
        // sin(π) in floating point is half an epsilon, not zero.
        let rounding = T::default_epsilon() * two();
        let sin = joints.elbow.sin();
        if sin.abs() <= rounding || !sin.is_finite() {
            let elbow = joints.elbow;
            return Err(SingularPose { elbow });
        }
        let links = self.links(joints);
        let local = self.base().rotation.inverse() * velocity;
        let det = self.upper() * self.fore() * sin;
        Ok(Vector2::new(links.fore.dot(&local), -links.tip().dot(&local)) / det)
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
    /// [`SingularPose`] as for [`joint_rates`](Self::joint_rates).
    pub fn joint_accelerations(
        &self,
        joints: Joints<T>,
        rates: Vector2<T>,
        acceleration: Vector2<T>,
    ) -> Result<Vector2<T>, SingularPose<T>> {
        self.joint_rates(joints, acceleration - self.centripetal(joints, rates))
    }

    /// The part of the tool's acceleration that the joint rates alone cause.
    fn centripetal(&self, joints: Joints<T>, rates: Vector2<T>) -> Vector2<T> {
        let links = self.links(joints);
        let (upper, fore) = (rates.x, rates.x + rates.y);
        let local = links.upper * (upper * upper) + links.fore * (fore * fore);
        -(self.base().rotation * local)
    }
}

fn quarter_turn<T: RealField + Copy>(v: Vector2<T>) -> Vector2<T> {
    Vector2::new(-v.y, v.x)
}
