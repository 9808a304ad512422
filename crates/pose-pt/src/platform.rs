//! The platform: N locators that hold one body.

use nalgebra::{Isometry3, Matrix3, Point3, RealField, Rotation3, Vector3};

use crate::Locator;
use crate::fit::{FitError, rigid_fit};
use crate::rotation::to_matrix;

mod check;
mod error;

pub use error::{LimitError, PlatformError};

/// A rigid body on `N` three-axis locators.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Platform<const N: usize, T: RealField = f64> {
    locators: [Locator<T>; N],
    /// Apart from the limits, so that one pose reads few cache lines.
    anchors: [Point3<T>; N],
    origins: [Vector3<T>; N],
    /// What turns a position less the locator's origin into axis coordinates.
    to_axes: [Matrix3<T>; N],
    /// All axes are parallel to the world's: nothing needs turning.
    parallel: bool,
    largest_distance: T,
}

/// The two locators whose distance departs most from that of their anchors.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct DistanceError<T = f64> {
    /// The two locators, from 0.
    pub locators: [usize; 2],
    /// Distance between their anchors in the body.
    pub distance: T,
    /// What the locators are farther apart than that; negative where they squeeze.
    pub change: T,
}

/// The pose of a body, and how far the locators are from it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct BodyFit<const N: usize, T: RealField = f64> {
    /// The pose that is nearest to the locators, by least squares.
    pub pose: Isometry3<T>,
    /// Where each locator is, less where the pose puts it, in the world.
    pub residuals: [Vector3<T>; N],
    /// Root of the mean square of the residuals' lengths.
    pub rms: T,
    /// Worst change of a distance between two locators.
    pub distance_error: DistanceError<T>,
}

impl<const N: usize, T: RealField + Copy> Platform<N, T> {
    /// A platform of `N` locators, at least 3, with at most 32 axes in all.
    ///
    /// # Errors
    /// [`PlatformError`].
    pub fn new(locators: [Locator<T>; N]) -> Result<Self, PlatformError<T>> {
        check::count(N)?;
        let mut to_axes = [Matrix3::identity(); N];
        for (number, (locator, to_axes)) in locators.iter().zip(&mut to_axes).enumerate() {
            *to_axes = check::locator(number, locator)?;
        }
        let anchors = locators.map(|locator| locator.anchor);
        let largest_distance = check::anchors(&anchors)?;
        Ok(Self {
            locators,
            anchors,
            origins: locators.map(|locator| locator.origin.coords),
            to_axes,
            parallel: to_axes.iter().all(|m| *m == Matrix3::identity()),
            largest_distance,
        })
    }

    /// The locators.
    #[must_use]
    pub const fn locators(&self) -> &[Locator<T>; N] {
        &self.locators
    }

    /// The points of the body that the locators hold, in the body's frame.
    #[must_use]
    pub const fn anchors(&self) -> &[Point3<T>; N] {
        &self.anchors
    }

    /// The largest distance between two anchors.
    #[must_use]
    pub const fn largest_anchor_distance(&self) -> T {
        self.largest_distance
    }

    /// Where the body's anchors are in the world: P = R p + T.
    #[must_use]
    pub fn positions(&self, pose: &Isometry3<T>) -> [Point3<T>; N] {
        let rotation = to_matrix(&pose.rotation);
        self.anchors
            .map(|anchor| rotation * anchor + pose.translation.vector)
    }

    /// Axis coordinates of a pose, without a check of the strokes.
    ///
    /// ```text
    /// q = A⁻¹ (R p + T - origin)   for each locator with its axes A
    /// ```
    ///
    /// A finite pose gives finite coordinates unless they overflow.
    #[must_use]
    pub fn axes(&self, pose: &Isometry3<T>) -> [Vector3<T>; N] {
        self.axes_at(&to_matrix(&pose.rotation), &pose.translation.vector)
    }

    /// Axis coordinates of a pose whose rotation is at hand as a matrix, as from
    /// [`PoseVector::to_rotation`](crate::PoseVector::to_rotation), which is fastest.
    #[must_use]
    #[inline]
    pub fn axes_at(&self, rotation: &Rotation3<T>, translation: &Vector3<T>) -> [Vector3<T>; N] {
        let m = rotation.matrix();
        // Each sum from both ends: half as long a chain of additions.
        let moved = |p: &Point3<T>, origin: &Vector3<T>| {
            let shift = translation - origin;
            Vector3::new(
                m.m11 * p.x + m.m12 * p.y + (m.m13 * p.z + shift.x),
                m.m21 * p.x + m.m22 * p.y + (m.m23 * p.z + shift.y),
                m.m31 * p.x + m.m32 * p.y + (m.m33 * p.z + shift.z),
            )
        };
        let mut axes = [Vector3::zeros(); N];
        let locators = self.anchors.iter().zip(&self.origins).zip(&mut axes);
        if self.parallel {
            for ((anchor, origin), axes) in locators {
                *axes = moved(anchor, origin);
            }
        } else {
            for (((anchor, origin), axes), to_axes) in locators.zip(&self.to_axes) {
                *axes = to_axes * moved(anchor, origin);
            }
        }
        axes
    }

    /// Axis coordinates of a pose, all within their strokes.
    ///
    /// An axis at the end of its stroke may be past it by what the pose rounds off: 16
    /// machine epsilons of the distances of anchor and origin and of the largest coordinate.
    ///
    /// # Errors
    /// [`LimitError`]; the axis that is farthest out of its stroke.
    pub fn checked_axes(&self, pose: &Isometry3<T>) -> Result<[Vector3<T>; N], LimitError<T>> {
        let axes = self.axes(pose);
        self.check_axes(&axes)?;
        Ok(axes)
    }

    /// Whether all axis coordinates are within their strokes.
    ///
    /// # Errors
    /// [`LimitError`]; the axis that is farthest out of its stroke.
    pub fn check_axes(&self, axes: &[Vector3<T>; N]) -> Result<(), LimitError<T>> {
        check::strokes(&self.locators, axes)
    }

    /// Axis speeds at a pose whose reference point moves at `linear` while the body turns at
    /// `angular`, rad per second about axes of the world.
    #[must_use]
    pub fn axis_velocities(
        &self,
        pose: &Isometry3<T>,
        linear: &Vector3<T>,
        angular: &Vector3<T>,
    ) -> [Vector3<T>; N] {
        let rotation = to_matrix(&pose.rotation);
        self.in_axes(
            self.anchors
                .map(|anchor| linear + angular.cross(&(rotation * anchor.coords))),
        )
    }

    /// Axis accelerations at a pose: of the reference point `linear`, of the rotation
    /// `angular_acceleration`, while the body turns at `angular`.
    #[must_use]
    pub fn axis_accelerations(
        &self,
        pose: &Isometry3<T>,
        linear: &Vector3<T>,
        angular: &Vector3<T>,
        angular_acceleration: &Vector3<T>,
    ) -> [Vector3<T>; N] {
        let rotation = to_matrix(&pose.rotation);
        self.in_axes(self.anchors.map(|anchor| {
            let arm = rotation * anchor.coords;
            linear + angular_acceleration.cross(&arm) + angular.cross(&angular.cross(&arm))
        }))
    }

    /// Where the locators are in the world at these axis coordinates.
    #[must_use]
    pub fn locator_positions(&self, axes: &[Vector3<T>; N]) -> [Point3<T>; N] {
        let mut positions = [Point3::origin(); N];
        for ((locator, axes), position) in self.locators.iter().zip(axes).zip(&mut positions) {
            *position = locator.position(axes);
        }
        positions
    }

    /// The pose of the body at these axis coordinates, and its distance error.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn pose(&self, axes: &[Vector3<T>; N]) -> Result<BodyFit<N, T>, FitError<T>> {
        self.pose_of_points(&self.locator_positions(axes))
    }

    /// The pose of the body from measured world positions of its anchors.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn pose_of_points(&self, points: &[Point3<T>; N]) -> Result<BodyFit<N, T>, FitError<T>> {
        let fit = rigid_fit(&self.anchors, points)?;
        let mut residuals = [Vector3::zeros(); N];
        for ((anchor, point), residual) in self.anchors.iter().zip(points).zip(&mut residuals) {
            *residual = fit.residual(anchor, point);
        }
        Ok(BodyFit {
            pose: fit.motion,
            residuals,
            rms: fit.rms,
            distance_error: self.distance_error(points),
        })
    }

    /// The two locators whose distance departs most from that of their anchors when they
    /// are at these points of the world. A point that is not finite gives a change that is not.
    #[must_use]
    pub fn distance_error(&self, points: &[Point3<T>; N]) -> DistanceError<T> {
        let mut worst = DistanceError {
            locators: [0, 1],
            distance: T::zero(),
            change: T::zero(),
        };
        let both = || self.anchors.iter().zip(points).enumerate();
        for (second, (anchor, point)) in both() {
            for (first, (other_anchor, other_point)) in both().take(second) {
                let distance = (anchor - other_anchor).norm();
                let change = (point - other_point).norm() - distance;
                let known = worst.change.abs();
                if change.abs() >= known || (known.is_finite() && !change.is_finite()) {
                    worst = DistanceError {
                        locators: [first, second],
                        distance,
                        change,
                    };
                }
            }
        }
        worst
    }

    /// World vectors in the coordinates of each locator's axes.
    #[inline]
    pub(crate) fn in_axes(&self, mut vectors: [Vector3<T>; N]) -> [Vector3<T>; N] {
        if !self.parallel {
            for (to_axes, vector) in self.to_axes.iter().zip(&mut vectors) {
                *vector = to_axes * *vector;
            }
        }
        vectors
    }
}
