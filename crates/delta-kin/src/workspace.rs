//! What the machine can reach: clearances, the largest cylinder, outlines.

mod clearance;
mod cylinder;

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::{Trig, sin_cos};

use crate::range::{is_within, largest_angle};
use crate::rounded::Rounded;
use crate::{Delta, InverseError};

/// Why a question about the workspace has no answer.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WorkspaceError<T: RealField + Copy = f64> {
    /// The point from which rays would go out is not reached.
    #[error("the axis at z = {} is outside: {reason}", Rounded(*.z))]
    Outside {
        /// The height given.
        z: T,
        /// Why it is not reached.
        reason: InverseError<T>,
    },
    /// The azimuth is not an angle.
    #[error("azimuth {} rad is not within ±{} rad", Rounded(*.azimuth), Rounded(*.largest))]
    Azimuth {
        /// The azimuth given, in radians.
        azimuth: T,
        /// The largest allowed, either way: 1/√ε.
        largest: T,
    },
    /// A height is not within the machine's span.
    #[error("height {} is not within ±{}", Rounded(*.z), Rounded(*.largest))]
    Height {
        /// The height given.
        z: T,
        /// The machine's span.
        largest: T,
    },
    /// The resolution is not a length of the stated size.
    #[error("resolution {} is not within {}..={}", Rounded(*.resolution), Rounded(*.min), Rounded(*.max))]
    Resolution {
        /// The resolution given.
        resolution: T,
        /// The smallest allowed: 1/4096 of the machine's span.
        min: T,
        /// The largest allowed: the machine's span.
        max: T,
    },
    /// Not even a cylinder whose radius is the resolution is known to be inside.
    #[error("not even a cylinder of radius {} is inside between these heights", Rounded(*.resolution))]
    NoCylinder {
        /// The resolution given.
        resolution: T,
    },
}

impl<T: RealField + Trig> Delta<T> {
    /// Whether the platform's centre can be at `point` in the machine's modes and within its
    /// limits: [`inverse`](Self::inverse) says why not.
    #[must_use]
    pub fn is_reachable(&self, point: impl Into<Point3<T>>) -> bool {
        self.inverse(point).is_ok()
    }

    /// The outline of the workspace at a height: `points` points counter-clockwise from X, where
    /// rays from the base's axis first leave it.
    ///
    /// Each is inside, with a [`clearance`](Self::clearance) of at most 1e-6 of the machine's span.
    ///
    /// # Errors
    /// [`WorkspaceError::Outside`].
    pub fn horizontal_slice(
        &self,
        z: T,
        points: u32,
    ) -> Result<impl ExactSizeIterator<Item = Point3<T>> + Clone + use<T>, WorkspaceError<T>> {
        self.slice(z, [Vector3::x(), Vector3::y()], points)
    }

    /// The outline of the workspace in the plane through the base's axis at an azimuth in radians:
    /// `points` points from the azimuth over z, where rays from height `z` on the axis first leave
    /// it; each as near to the edge as those of [`horizontal_slice`](Self::horizontal_slice).
    ///
    /// # Errors
    /// [`WorkspaceError::Outside`], [`WorkspaceError::Azimuth`].
    pub fn vertical_slice(
        &self,
        azimuth: T,
        z: T,
        points: u32,
    ) -> Result<impl ExactSizeIterator<Item = Point3<T>> + Clone + use<T>, WorkspaceError<T>> {
        let largest = largest_angle();
        if !is_within(azimuth, largest) {
            return Err(WorkspaceError::Azimuth { azimuth, largest });
        }
        let (sin, cos) = sin_cos(azimuth);
        self.slice(z, [Vector3::new(cos, sin, T::zero()), Vector3::z()], points)
    }

    /// The points at which rays from height `z` on the base's axis first leave the workspace, in
    /// the plane of two unit vectors.
    fn slice(
        &self,
        z: T,
        [right, up]: [Vector3<T>; 2],
        points: u32,
    ) -> Result<impl ExactSizeIterator<Item = Point3<T>> + Clone + use<T>, WorkspaceError<T>> {
        let centre = Point3::new(T::zero(), T::zero(), z);
        if let Err(reason) = self.inverse(centre) {
            return Err(WorkspaceError::Outside { z, reason });
        }
        let delta = *self;
        Ok((0..points).map(move |number| {
            let turn: T = nalgebra::convert(f64::from(number) / f64::from(points));
            let (sin, cos) = sin_cos(turn * T::two_pi());
            delta.leave(centre, right * cos + up * sin)
        }))
    }

    /// The last point on a ray that is known to be inside: steps of the clearance, until it is
    /// small. As each is longer than 1e-6 spans, a million leave the machine's reach.
    fn leave(&self, centre: Point3<T>, direction: Vector3<T>) -> Point3<T> {
        let near = self.span() * nalgebra::convert(NEAR);
        let mut point = centre;
        loop {
            let step = self.clearance(point);
            if step <= near {
                return point;
            }
            point += direction * step;
        }
    }
}

/// How near to the edge a point of an outline is, in spans.
const NEAR: f64 = 1e-6;
