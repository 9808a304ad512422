//! The machine: three arms, frame, limits.

use nalgebra::{RealField, Vector3};
use trig_kernels::{Trig, sin_cos_lanes};

use crate::arm::zip;
use crate::geometry::checked_span;
use crate::prepared::PreparedArm;
use crate::{
    Arm, ArmGeometry, ArmRange, AssemblyMode, Dimensions, ElbowSide, GeometryError, Positive, ZAxis,
};

/// A rotary Delta robot, in any unit of length, the same throughout.
///
/// The frame is that of [Delta thesis] unless set otherwise: z up from the plane of the shoulders,
/// the platform hanging at z < 0; angles zero straight down, outward (upward) positive. The
/// machine works with its elbows out and its platform below them; the other solutions are another
/// machine's, asked for by name with [`with_working_mode`](Self::with_working_mode) and
/// [`with_assembly_mode`](Self::with_assembly_mode). Each `with_` method returns the changed
/// machine:
///
/// ```
/// use core::f64::consts::FRAC_PI_2;
/// use delta_kin::{ArmRange, Delta, Dimensions};
///
/// // Angles read zero with the arms horizontal, and may go 90° down and 30° up.
/// let delta = Delta::new(Dimensions { base: 42.0, platform: 18.0, upper: 120.0, lower: 243.0 })?
///     .with_zero(FRAC_PI_2)?
///     .with_range(ArmRange::new(-FRAC_PI_2, 0.52)?)
///     .with_ball_joints(0.6)?;
/// # Ok::<(), delta_kin::GeometryError<f64>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delta<T: RealField = f64> {
    arms: [ArmGeometry<T>; 3],
    z: ZAxis,
    positive: Positive,
    ranges: [ArmRange<T>; 3],
    max_swivel: Option<T>,
    working_mode: [ElbowSide; 3],
    assembly_mode: AssemblyMode,
    /// What follows from the above, ready for use.
    prepared: [PreparedArm<T>; 3],
    span: T,
    tolerance: T,
    /// See [`Self::is_assembled`].
    min_product: T,
}

/// Rounding steps allowed between `forward` and `inverse`, in machine epsilons of the sum of
/// an arm's lengths: a sine, two products and two sums for each of three spheres.
const ROUNDING_STEPS: f64 = 16.0;

impl<T: RealField + Trig> Delta<T> {
    /// A machine of three equal arms, 120° apart, without limits.
    ///
    /// # Errors
    /// As for [`from_arms`](Self::from_arms).
    pub fn new(dimensions: Dimensions<T>) -> Result<Self, GeometryError<T>> {
        Self::from_arms(Arm::ALL.map(|arm| ArmGeometry::nominal(arm, dimensions)))
    }

    /// A machine of three arms as they are, each with its own lengths, azimuth and zero.
    ///
    /// With h the fourth root of the largest number of `T`, divided by 32, the radii are within
    /// 0..=h, upper and lower arms within 1/√h..=h (f64: 2e-38..=3.6e75, f32: 9e-5..=1.3e8) and
    /// no shorter than ε^¼ of the [`span`](Self::span) (f64: 1.2e-4, f32: 0.019); angles are
    /// within ±1/√ε (f64: 6.7e7 rad, f32: 2900 rad).
    ///
    /// # Errors
    /// [`GeometryError::Length`], [`GeometryError::Angle`].
    pub fn from_arms(arms: [ArmGeometry<T>; 3]) -> Result<Self, GeometryError<T>> {
        let span = checked_span(&arms)?;
        let delta = Self {
            arms,
            z: ZAxis::default(),
            positive: Positive::default(),
            ranges: [ArmRange::unlimited(); 3],
            max_swivel: None,
            working_mode: [ElbowSide::Out; 3],
            assembly_mode: AssemblyMode::Lower,
            prepared: arms
                .map(|arm| PreparedArm::new(&arm, ArmRange::unlimited(), None, Positive::Outward)),
            span,
            tolerance: T::zero(),
            min_product: T::zero(),
        };
        Ok(delta.prepare())
    }

    /// The machine with other arms, in the same frame and with the same limits.
    ///
    /// # Errors
    /// As for [`from_arms`](Self::from_arms).
    pub fn with_arms(self, arms: [ArmGeometry<T>; 3]) -> Result<Self, GeometryError<T>> {
        let delta = Self {
            z: self.z,
            positive: self.positive,
            ranges: self.ranges,
            max_swivel: self.max_swivel,
            working_mode: self.working_mode,
            assembly_mode: self.assembly_mode,
            ..Self::from_arms(arms)?
        };
        Ok(delta.prepare())
    }

    /// The machine with all angles zero at `theta`, in radians from straight down, outward
    /// positive: π/2 for arms that are homed horizontal.
    ///
    /// # Errors
    /// [`GeometryError::Angle`].
    pub fn with_zero(self, theta: T) -> Result<Self, GeometryError<T>> {
        self.with_arms(self.arms.map(|arm| ArmGeometry { zero: theta, ..arm }))
    }

    /// The machine with angles that grow in the given direction.
    #[must_use]
    pub fn with_positive(mut self, positive: Positive) -> Self {
        self.positive = positive;
        self.prepare()
    }

    /// The machine with the given direction of z.
    #[must_use]
    pub const fn with_z(mut self, z: ZAxis) -> Self {
        self.z = z;
        self
    }

    /// The machine with the same joint range for all arms, as their angles read.
    #[must_use]
    pub fn with_range(self, range: ArmRange<T>) -> Self {
        self.with_ranges([range; 3])
    }

    /// The machine with a joint range for each arm, as their angles read.
    #[must_use]
    pub fn with_ranges(mut self, ranges: [ArmRange<T>; 3]) -> Self {
        self.ranges = ranges;
        self.prepare()
    }

    /// The machine with ball joints that let the rods swivel by `max_swivel` radians.
    ///
    /// The studs of the balls lie along the motor's axis, at elbow and wrist alike, and a rod
    /// swings about them freely; out of the plane perpendicular to them it swivels by at most this
    /// angle: the cone that the joint's housing leaves.
    ///
    /// # Errors
    /// [`GeometryError::Swivel`] unless 0 < `max_swivel` < π/2.
    pub fn with_ball_joints(mut self, max_swivel: T) -> Result<Self, GeometryError<T>> {
        if !(max_swivel > T::zero() && max_swivel < T::frac_pi_2()) {
            return Err(GeometryError::Swivel { max_swivel });
        }
        self.max_swivel = Some(max_swivel);
        Ok(self.prepare())
    }

    /// The machine with each elbow on the side named: the working mode in which it is built, elbows
    /// out unless set. It is left only through a serial singularity, an arm stretched or folded.
    #[must_use]
    pub const fn with_working_mode(mut self, working_mode: [ElbowSide; 3]) -> Self {
        self.working_mode = working_mode;
        self
    }

    /// The machine in the assembly mode named, [`AssemblyMode::Lower`] unless set. It is left only
    /// through a parallel singularity, the three rods in a plane, or where the plane of the elbows
    /// is upright.
    #[must_use]
    pub const fn with_assembly_mode(mut self, assembly_mode: AssemblyMode) -> Self {
        self.assembly_mode = assembly_mode;
        self
    }

    fn prepare(mut self) -> Self {
        self.prepared = zip(self.arms, self.ranges)
            .map(|(arm, range)| PreparedArm::new(&arm, range, self.max_swivel, self.positive));
        let [first, second, third] = self.prepared.each_ref().map(PreparedArm::angle_rounding);
        let steps = self.span * nalgebra::convert(ROUNDING_STEPS);
        self.tolerance = T::default_epsilon() * (steps + first.max(second).max(third));
        let [out, rods] = [PreparedArm::farthest_centre, |arm: &PreparedArm<T>| {
            arm.lower
        }]
        .map(|of| {
            let [first, second, third] = self.prepared.each_ref().map(of);
            first.max(second).max(third)
        });
        let sixteen: T = nalgebra::convert(16.0);
        self.min_product = sixteen * self.tolerance * (out + rods) * out * out * out;
        self
    }

    /// The geometry of the arms.
    #[must_use]
    pub const fn arms(&self) -> &[ArmGeometry<T>; 3] {
        &self.arms
    }

    /// Which way z points.
    #[must_use]
    pub const fn z(&self) -> ZAxis {
        self.z
    }

    /// Which way an arm turns when its angle grows.
    #[must_use]
    pub const fn positive(&self) -> Positive {
        self.positive
    }

    /// The joint ranges, as the angles read.
    #[must_use]
    pub const fn ranges(&self) -> &[ArmRange<T>; 3] {
        &self.ranges
    }

    /// By how many radians the rods may swivel at their ball joints; `None`: no limit.
    #[must_use]
    pub const fn max_swivel(&self) -> Option<T> {
        self.max_swivel
    }

    /// On which side of the line from shoulder to wrist each elbow is.
    #[must_use]
    pub const fn working_mode(&self) -> [ElbowSide; 3] {
        self.working_mode
    }

    /// At which of its two points the platform is.
    #[must_use]
    pub const fn assembly_mode(&self) -> AssemblyMode {
        self.assembly_mode
    }

    /// The sum of the lengths of an arm, of the longest: no point farther from the origin is
    /// reached. Errors are stated in units of it.
    #[must_use]
    pub const fn span(&self) -> T {
        self.span
    }

    /// How far past an edge of the workspace a point may lie by rounding alone, in the unit of
    /// length: 16 machine epsilons of the [`span`](Self::span), and where angles read far from
    /// zero their own rounding, 2 ε (|zero| + the farther end of the range) times the upper arm.
    /// Such a point is taken as being on the edge.
    #[must_use]
    pub const fn tolerance(&self) -> T {
        self.tolerance
    }

    /// 1 where the platform is the higher of its two points, -1 where it is the lower.
    #[inline]
    pub(crate) fn side(&self) -> T {
        match self.assembly_mode {
            AssemblyMode::Lower => -T::one(),
            AssemblyMode::Upper => T::one(),
        }
    }

    pub(crate) const fn min_product(&self) -> T {
        self.min_product
    }

    pub(crate) const fn prepared(&self) -> &[PreparedArm<T>; 3] {
        &self.prepared
    }

    /// The thesis' angles, from the angles as they read.
    #[inline]
    pub(crate) fn thetas(&self, angles: Vector3<T>) -> [T; 3] {
        zip(self.prepared, angles.into()).map(|(prepared, angle)| prepared.theta(angle))
    }

    /// Centres of the three spheres on which the platform's centre lies.
    #[inline]
    pub(crate) fn centres_at(&self, thetas: [T; 3]) -> [Vector3<T>; 3] {
        let (sines, cosines) = sin_cos_lanes(thetas);
        zip(self.prepared.each_ref(), zip(sines, cosines))
            .map(|(prepared, theta)| prepared.centre(theta))
    }

    /// A point or vector in the thesis' frame, or from it: the same either way.
    #[inline]
    pub(crate) fn flip(&self, vector: Vector3<T>) -> Vector3<T> {
        match self.z {
            ZAxis::Up => vector,
            ZAxis::Down => Vector3::new(vector.x, vector.y, -vector.z),
        }
    }
}
