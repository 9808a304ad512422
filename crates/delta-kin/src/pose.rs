//! A pose and what holds in it: Jacobian, speeds, singularities, torques.

use nalgebra::{Matrix3, Point3, RealField, Vector3};

use crate::arm::{least, zip};
use crate::limits::two;
use crate::{Arm, Delta, ForwardError, InverseError, Knee};

/// A pose in which speeds or forces do not follow from each other.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Singular<T = f64> {
    /// An arm is stretched or folded, its upper arm in line with the rods as seen square to its
    /// plane: turning it does not move the platform along the rods.
    #[error("{arm} is stretched or folded: its lever is {lever}")]
    Serial {
        /// The arm.
        arm: Arm,
        /// How far the platform moves along the rods, in length per radian.
        lever: T,
    },
    /// The three rods lie in a plane: the platform can move although no arm does.
    #[error("the three lower arms lie in a plane within {sine}")]
    Parallel {
        /// The sine of the least angle between a rod and the plane of the others.
        sine: T,
    },
}

/// The machine in one pose: both the angles and the place of the platform.
///
/// For each arm, with e the unit vector along its rods, E its knee, v the platform's speed and
/// ω the arm's rate:
///
/// ```text
/// e · v = (e · dE/dθ) ω
/// ```
///
/// The bracket is the arm's lever, in length per radian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose<T: RealField = f64> {
    angles: Vector3<T>,
    point: Point3<T>,
    rods: [Vector3<T>; 3],
    levers: [T; 3],
    tolerance: T,
}

impl<T: RealField + Copy> Delta<T> {
    /// The pose with the platform's centre at `point`, knees out.
    ///
    /// # Errors
    /// [`InverseError`].
    pub fn pose_at(&self, point: Point3<T>) -> Result<Pose<T>, InverseError<T>> {
        self.pose_at_knees(point, [Knee::Out; 3])
    }

    /// The pose with the platform's centre at `point` and the knee of each arm as named.
    ///
    /// # Errors
    /// [`InverseError`].
    pub fn pose_at_knees(
        &self,
        point: Point3<T>,
        knees: [Knee; 3],
    ) -> Result<Pose<T>, InverseError<T>> {
        Ok(Pose::new(self, self.inverse_knees(point, knees)?, point))
    }

    /// The pose with the given angles, in the lower assembly.
    ///
    /// # Errors
    /// [`ForwardError`].
    pub fn pose_of(&self, angles: Vector3<T>) -> Result<Pose<T>, ForwardError<T>> {
        Ok(Pose::new(self, angles, self.forward(angles)?))
    }

    /// The knees, at the middle between an arm's two rods.
    #[must_use]
    pub fn knees(&self, angles: Vector3<T>) -> [Point3<T>; 3] {
        let bent = zip(
            zip(self.legs().each_ref(), self.arms().each_ref()),
            self.thetas(angles),
        );
        bent.map(|((leg, arm), theta)| {
            let knee = leg.centre(theta) + leg.in_plane(arm.platform, T::zero());
            Point3::from(self.flip(knee))
        })
    }
}

impl<T: RealField + Copy> Pose<T> {
    pub(crate) fn new(delta: &Delta<T>, angles: Vector3<T>, point: Point3<T>) -> Self {
        let local = delta.flip(point.coords);
        let arms = zip(delta.legs().each_ref(), delta.thetas(angles)).map(|(leg, theta)| {
            let rod = (local - leg.centre(theta)) / leg.lower;
            (delta.flip(rod), rod.dot(&leg.tangent(theta)) * leg.turn)
        });
        Self {
            angles,
            point,
            rods: arms.map(|(rod, _)| rod),
            levers: arms.map(|(_, lever)| lever),
            tolerance: delta.tolerance(),
        }
    }

    /// The angles as they read, in radians.
    #[must_use]
    pub const fn angles(&self) -> Vector3<T> {
        self.angles
    }

    /// The platform's centre.
    #[must_use]
    pub const fn point(&self) -> Point3<T> {
        self.point
    }

    /// Unit vectors along the rods, from the knees to the platform.
    #[must_use]
    pub const fn rods(&self) -> &[Vector3<T>; 3] {
        &self.rods
    }

    /// The levers of the arms: how far the platform moves along the rods, in length per radian.
    #[must_use]
    pub fn levers(&self) -> Vector3<T> {
        Vector3::from(self.levers)
    }

    /// The arm nearest to being stretched or folded, and its lever without sign, in length per
    /// radian: the distance from a serial singularity, where the bracket on the right vanishes.
    #[must_use]
    pub fn serial_distance(&self) -> (Arm, T) {
        least(self.levers.map(|lever| lever.abs()))
    }

    /// The sine of the least angle between a rod and the plane of the other two, 0..=1: the
    /// distance from a parallel singularity, where the three rods lie in a plane.
    #[must_use]
    pub fn parallel_distance(&self) -> T {
        let [a, b, c] = self.rods;
        let volume = a.dot(&b.cross(&c)).abs();
        let widest = b.cross(&c).norm().max(c.cross(&a).norm());
        let widest = widest.max(a.cross(&b).norm());
        // Three rods along one line span no plane at all.
        if widest > T::zero() {
            volume / widest
        } else {
            T::zero()
        }
    }

    /// The platform's speed per rate of each arm: columns arm 1, 2, 3, in length per radian.
    ///
    /// # Errors
    /// [`Singular::Parallel`].
    pub fn jacobian(&self) -> Result<Matrix3<T>, Singular<T>> {
        let columns = zip(self.rod_inverse()?, self.levers).map(|(column, lever)| column * lever);
        Ok(Matrix3::from_columns(&columns))
    }

    /// The platform's velocity from the rates of the arms in rad/s.
    ///
    /// # Errors
    /// [`Singular::Parallel`].
    pub fn platform_velocity(&self, rates: Vector3<T>) -> Result<Vector3<T>, Singular<T>> {
        Ok(self.jacobian()? * rates)
    }

    /// The rates of the arms in rad/s that give the platform a velocity.
    ///
    /// # Errors
    /// [`Singular::Serial`] where a lever is within rounding of zero.
    pub fn joint_rates(&self, velocity: Vector3<T>) -> Result<Vector3<T>, Singular<T>> {
        let (arm, lever) = self.serial_distance();
        if lever <= self.tolerance {
            return Err(Singular::Serial { arm, lever });
        }
        let rates = zip(self.rods, self.levers).map(|(rod, lever)| rod.dot(&velocity) / lever);
        Ok(Vector3::from(rates))
    }

    /// Yoshikawa's manipulability |det J|, in length³ per radian³: zero in serial, without
    /// bound near parallel singularities.
    ///
    /// # Errors
    /// [`Singular::Parallel`].
    pub fn manipulability(&self) -> Result<T, Singular<T>> {
        let [a, b, c] = self.rods;
        let [l1, l2, l3] = self.levers;
        self.rod_inverse()?;
        Ok((l1 * l2 * l3 / a.dot(&b.cross(&c))).abs())
    }

    /// The torques that hold the platform against a force on its centre, in force times length:
    /// positive the way the angles grow. The weight of the arms is not in it.
    ///
    /// ```text
    /// τ = -Jᵀ F
    /// ```
    ///
    /// # Errors
    /// [`Singular::Parallel`]: no torque holds a force square to the rods' plane.
    pub fn holding_torques(&self, force: Vector3<T>) -> Result<Vector3<T>, Singular<T>> {
        Ok(-self.jacobian()?.tr_mul(&force))
    }

    /// The forces along the lower arms (both rods of each) that hold the platform against a force
    /// on its centre; positive in compression.
    ///
    /// # Errors
    /// [`Singular::Parallel`].
    pub fn rod_forces(&self, force: Vector3<T>) -> Result<Vector3<T>, Singular<T>> {
        let forces = self.rod_inverse()?.map(|column| -column.dot(&force));
        Ok(Vector3::from(forces))
    }

    /// Columns of the inverse of the matrix whose rows are the rods.
    pub(crate) fn rod_inverse(&self) -> Result<[Vector3<T>; 3], Singular<T>> {
        invert_rods(&self.rods).ok_or_else(|| Singular::Parallel {
            sine: self.parallel_distance(),
        })
    }
}

/// Columns of the inverse of the matrix whose rows are three unit vectors; `None` where they
/// lie in a plane within rounding.
pub(crate) fn invert_rods<T: RealField + Copy>(rods: &[Vector3<T>; 3]) -> Option<[Vector3<T>; 3]> {
    let [a, b, c] = rods;
    let volume = a.dot(&b.cross(c));
    let rounding = T::default_epsilon() * two() * two();
    (volume.abs() > rounding).then(|| {
        [
            b.cross(c) / volume,
            c.cross(a) / volume,
            a.cross(b) / volume,
        ]
    })
}
