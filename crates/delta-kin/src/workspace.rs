//! What the machine can reach: clearances, the largest cylinder, outlines.

mod clearance;
mod cylinder;
mod outline;

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::{Trig, sin_cos};

use crate::rounded::Rounded;
use crate::scale::{is_within, widest};
use crate::{Delta, InverseError};
pub use outline::Outline;

/// What a machine can reach in its working and assembly modes, within its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Workspace<T: RealField = f64> {
    delta: Delta<T>,
}

/// Why a question about the workspace has no answer.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WorkspaceError<T: RealField + Copy = f64> {
    /// The place from which rays would go out is not reached.
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
        /// The greatest allowed, either way: 1/√ε.
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
        /// The least allowed: 1/4096 of the machine's span.
        min: T,
        /// The greatest allowed: the machine's span.
        max: T,
    },
    /// Not even a cylinder whose radius is the resolution is known to be inside.
    #[error("not even a cylinder of radius {} is inside between these heights", Rounded(*.resolution))]
    NoCylinder {
        /// The resolution given.
        resolution: T,
    },
}

impl<T: RealField + Trig> Workspace<T> {
    pub(crate) const fn new(delta: Delta<T>) -> Self {
        Self { delta }
    }

    /// Whether the platform's centre can be at `point`: [`Delta::inverse`] says why not.
    #[must_use]
    pub fn contains(&self, point: Point3<T>) -> bool {
        self.delta.inverse(point).is_ok()
    }

    /// The outline of the workspace at a height, as `points` points counter-clockwise from X: where
    /// rays from the base's axis first leave it.
    ///
    /// # Errors
    /// [`WorkspaceError::Outside`].
    pub fn horizontal_slice(&self, z: T, points: u32) -> Result<Outline<T>, WorkspaceError<T>> {
        self.slice(z, [Vector3::x(), Vector3::y()], points)
    }

    /// The outline of the workspace in the plane through the base's axis at an azimuth in radians,
    /// as `points` points from the azimuth over z: where rays from height `z` on the axis first
    /// leave it.
    ///
    /// # Errors
    /// [`WorkspaceError::Outside`], [`WorkspaceError::Azimuth`].
    pub fn vertical_slice(
        &self,
        azimuth: T,
        z: T,
        points: u32,
    ) -> Result<Outline<T>, WorkspaceError<T>> {
        let largest = widest();
        if !is_within(azimuth, largest) {
            return Err(WorkspaceError::Azimuth { azimuth, largest });
        }
        let (sin, cos) = sin_cos(azimuth);
        self.slice(z, [Vector3::new(cos, sin, T::zero()), Vector3::z()], points)
    }

    fn slice(
        &self,
        z: T,
        plane: [Vector3<T>; 2],
        points: u32,
    ) -> Result<Outline<T>, WorkspaceError<T>> {
        let centre = Point3::new(T::zero(), T::zero(), z);
        match self.delta.inverse(centre) {
            Ok(_) => Ok(Outline::new(*self, centre, plane, points)),
            Err(reason) => Err(WorkspaceError::Outside { z, reason }),
        }
    }
}
