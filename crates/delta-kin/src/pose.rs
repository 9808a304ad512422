//! A pose and what holds in it: Jacobian, speeds, singularities, torques.

mod error;

pub use error::PoseError;

use nalgebra::{Matrix3, Point3, RealField, Vector3};
use trig_kernels::{Trig, sin_cos};

use crate::arm::{smallest, zip};
use crate::{Arm, Delta, ForwardError, InverseError};

/// The machine in one pose: the angles and the position of the platform.
///
/// For each arm, with e the unit vector along its rods, E its elbow, v the platform's speed and
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
    elbows: [Point3<T>; 3],
    rods: [Vector3<T>; 3],
    levers: [T; 3],
    tolerance: T,
    /// What rounding does to the direction of a rod.
    rounding: T,
}

impl<T: RealField + Trig> Delta<T> {
    /// The pose with the platform's centre at `point`, in the machine's modes.
    ///
    /// # Errors
    /// [`InverseError`].
    pub fn pose_at(&self, point: impl Into<Point3<T>>) -> Result<Pose<T>, InverseError<T>> {
        let point = point.into();
        Ok(Pose::new(self, self.inverse(point)?, point))
    }

    /// The pose with the given angles, in the machine's assembly mode.
    ///
    /// # Errors
    /// [`ForwardError`].
    pub fn pose_of(&self, angles: Vector3<T>) -> Result<Pose<T>, ForwardError<T>> {
        Ok(Pose::new(self, angles, self.forward(angles)?))
    }
}

impl<T: RealField + Trig> Pose<T> {
    pub(crate) fn new(delta: &Delta<T>, angles: Vector3<T>, point: Point3<T>) -> Self {
        let local = delta.flip(point.coords);
        let prepared = zip(delta.prepared().each_ref(), delta.arms().each_ref());
        let arms = zip(prepared, delta.thetas(angles)).map(|((prepared, arm), theta)| {
            let theta = sin_cos(theta);
            let centre = prepared.centre(theta);
            let rod = (local - centre) / prepared.lower;
            let lever = rod.dot(&prepared.tangent(theta)) * prepared.turn;
            let elbow = centre + prepared.in_plane(arm.platform, T::zero());
            (Point3::from(delta.flip(elbow)), delta.flip(rod), lever)
        });
        let [first, second, third] = delta.prepared().each_ref().map(|prepared| prepared.lower);
        Self {
            angles,
            point,
            elbows: arms.map(|(elbow, _, _)| elbow),
            rods: arms.map(|(_, rod, _)| rod),
            levers: arms.map(|(_, _, lever)| lever),
            tolerance: delta.tolerance(),
            rounding: delta.tolerance() / first.min(second).min(third),
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

    /// The elbows, at the middle between an arm's two rods.
    #[must_use]
    pub const fn elbows(&self) -> &[Point3<T>; 3] {
        &self.elbows
    }

    /// Unit vectors along the rods, from the elbows to the platform.
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
        smallest(self.levers.map(|lever| lever.abs()))
    }

    /// The sine of the smallest angle between a rod and the plane of the other two, 0..=1: the
    /// distance from a parallel singularity, where the three rods lie in a plane.
    #[must_use]
    pub fn parallel_distance(&self) -> T {
        smallest_sine(&self.rods)
    }

    /// The platform's speed per rate of each arm: columns arm 1, 2, 3, in length per radian.
    ///
    /// # Errors
    /// [`PoseError::Parallel`].
    pub fn jacobian(&self) -> Result<Matrix3<T>, PoseError<T>> {
        let columns = zip(self.rod_inverse()?, self.levers).map(|(column, lever)| column * lever);
        Ok(Matrix3::from_columns(&columns))
    }

    /// The platform's velocity from the rates of the arms in rad/s.
    ///
    /// # Errors
    /// [`PoseError::Parallel`], [`PoseError::NotFinite`].
    pub fn platform_velocity(&self, rates: Vector3<T>) -> Result<Vector3<T>, PoseError<T>> {
        finite("rates", rates)?;
        finite("velocity", self.jacobian()? * rates)
    }

    /// The rates of the arms in rad/s that give the platform a velocity.
    ///
    /// # Errors
    /// [`PoseError::Serial`] where a lever is within rounding of zero, [`PoseError::NotFinite`].
    pub fn joint_rates(&self, velocity: Vector3<T>) -> Result<Vector3<T>, PoseError<T>> {
        finite("velocity", velocity)?;
        let (arm, lever) = self.serial_distance();
        if lever <= self.tolerance {
            return Err(PoseError::Serial { arm, lever });
        }
        let rates = zip(self.rods, self.levers).map(|(rod, lever)| rod.dot(&velocity) / lever);
        finite("rates", Vector3::from(rates))
    }

    /// Yoshikawa's manipulability |det J|, in length³ per radian³: zero in serial, without
    /// bound near parallel singularities.
    ///
    /// # Errors
    /// [`PoseError::Parallel`].
    pub fn manipulability(&self) -> Result<T, PoseError<T>> {
        let [a, b, c] = self.rods;
        let [l1, l2, l3] = self.levers;
        self.rod_inverse()?;
        Ok((l1 * l2 * l3 / a.dot(&b.cross(&c))).abs())
    }

    /// The torques that hold the platform against a force on its centre, in force times length:
    /// positive in the direction in which the angles grow. The weight of the arms is not in it.
    ///
    /// ```text
    /// τ = -Jᵀ F
    /// ```
    ///
    /// # Errors
    /// [`PoseError::Parallel`]: no torque holds a force perpendicular to the rods' plane.
    /// [`PoseError::NotFinite`].
    pub fn holding_torques(&self, force: Vector3<T>) -> Result<Vector3<T>, PoseError<T>> {
        finite("force", force)?;
        finite("torques", -self.jacobian()?.tr_mul(&force))
    }

    /// The forces along the lower arms (both rods of each) that hold the platform against a force
    /// on its centre; positive in compression.
    ///
    /// # Errors
    /// [`PoseError::Parallel`], [`PoseError::NotFinite`].
    pub fn rod_forces(&self, force: Vector3<T>) -> Result<Vector3<T>, PoseError<T>> {
        finite("force", force)?;
        let forces = self.rod_inverse()?.map(|column| -column.dot(&force));
        finite("rod forces", Vector3::from(forces))
    }

    /// What rounding does to the direction of a rod.
    pub(crate) const fn rounding(&self) -> T {
        self.rounding
    }

    /// Columns of the inverse of the matrix whose rows are the rods.
    pub(crate) fn rod_inverse(&self) -> Result<[Vector3<T>; 3], PoseError<T>> {
        let sine = self.parallel_distance();
        if sine <= self.rounding {
            return Err(PoseError::Parallel { sine });
        }
        Ok(invert_rods(&self.rods))
    }
}

/// Columns of the inverse of the matrix whose rows are three vectors.
pub(crate) fn invert_rods<T: RealField + Copy>([a, b, c]: &[Vector3<T>; 3]) -> [Vector3<T>; 3] {
    let volume = a.dot(&b.cross(c));
    [
        b.cross(c) / volume,
        c.cross(a) / volume,
        a.cross(b) / volume,
    ]
}

/// The sine of the smallest angle between one of three unit vectors and the plane of the other two.
pub(crate) fn smallest_sine<T: RealField + Copy>([a, b, c]: &[Vector3<T>; 3]) -> T {
    let volume = a.dot(&b.cross(c)).abs();
    let widest = b.cross(c).norm().max(c.cross(a).norm());
    let widest = widest.max(a.cross(b).norm());
    // Three rods along one line span no plane at all.
    if widest > T::zero() {
        volume / widest
    } else {
        T::zero()
    }
}

/// `vector`, if it is one.
fn finite<T: RealField + Copy>(
    name: &'static str,
    vector: Vector3<T>,
) -> Result<Vector3<T>, PoseError<T>> {
    if vector.iter().all(T::is_finite) {
        return Ok(vector);
    }
    let (x, y, z) = (vector.x, vector.y, vector.z);
    Err(PoseError::NotFinite { name, x, y, z })
}
