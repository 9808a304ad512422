//! The largest cylinder: halved into boxes until each is in the ball of its middle's clearance.

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::Trig;

use super::WorkspaceError;
use crate::Delta;
use crate::range::{half, is_within};

/// How many resolutions the span may have.
const FINEST: f64 = 4096.0;

impl<T: RealField + Trig> Delta<T> {
    /// Radius of the largest cylinder round the base's axis between two heights, every point of
    /// which is reached in the machine's modes and within its limits.
    ///
    /// The radius is at most a few `resolution` below the true one, never above: the cylinder is
    /// covered by balls of [`clearance`](Self::clearance), which is proven and not sampled. The
    /// time that this takes grows with the square of the radius over the `resolution`.
    ///
    /// # Errors
    /// [`WorkspaceError::Height`], [`WorkspaceError::Resolution`], [`WorkspaceError::NoCylinder`].
    pub fn largest_cylinder(&self, heights: [T; 2], resolution: T) -> Result<T, WorkspaceError<T>> {
        let span = self.span();
        for z in heights {
            if !is_within(z, span) {
                return Err(WorkspaceError::Height { z, largest: span });
            }
        }
        let min = span / nalgebra::convert(FINEST);
        // Written so that NaN is refused too.
        if !(resolution >= min && resolution <= span) {
            return Err(WorkspaceError::Resolution {
                resolution,
                min,
                max: span,
            });
        }
        let (mut low, mut high) = (resolution, span);
        if !self.covers(low, heights, resolution) {
            return Err(WorkspaceError::NoCylinder { resolution });
        }
        while high - low > resolution {
            let middle = (low + high) * half();
            if self.covers(middle, heights, resolution) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(low)
    }

    /// Whether every point of the cylinder is known to be reached.
    fn covers(&self, radius: T, [one, other]: [T; 2], resolution: T) -> bool {
        let cylinder = Cylinder {
            delta: self,
            radius,
            resolution,
        };
        let middle = Point3::new(T::zero(), T::zero(), (one + other) * half());
        let reach = Vector3::new(radius, radius, (one - other).abs() * half());
        cylinder.holds(middle, reach)
    }
}

/// A cylinder round the base's axis.
struct Cylinder<'a, T: RealField> {
    delta: &'a Delta<T>,
    radius: T,
    /// Boxes smaller than this are not halved.
    resolution: T,
}

impl<T: RealField + Trig> Cylinder<'_, T> {
    /// Whether what a box has of the cylinder is reached. Each level halves the longest side, so
    /// that there are at most 3 log2(4096) levels.
    fn holds(&self, middle: Point3<T>, reach: Vector3<T>) -> bool {
        if !self.meets(middle, reach) {
            return true;
        }
        let size = reach.norm();
        if size <= self.delta.clearance(middle) {
            return true;
        }
        if size <= self.resolution {
            return false;
        }
        let longest = if reach.x >= reach.y && reach.x >= reach.z {
            Vector3::x()
        } else if reach.y >= reach.z {
            Vector3::y()
        } else {
            Vector3::z()
        };
        let step = reach.component_mul(&longest) * half::<T>();
        let reach = reach - step;
        self.holds(middle - step, reach) && self.holds(middle + step, reach)
    }

    /// Whether the cylinder has a point within `reach` of `middle` along X and Y.
    fn meets(&self, middle: Point3<T>, reach: Vector3<T>) -> bool {
        let x = (middle.x.abs() - reach.x).max(T::zero());
        let y = (middle.y.abs() - reach.y).max(T::zero());
        x.hypot(y) <= self.radius
    }
}
