//! What the machine can reach: clearances, the largest cylinder and box, outlines.

mod cover;
mod outline;

use nalgebra::{Point3, RealField, Vector3};

use crate::arm::least;
use crate::leg::Leg;
use crate::limits::half;
use crate::{Arm, Delta};
use cover::Solid;
pub use outline::Outline;

/// What a machine can reach with all knees out, in the lower assembly, within its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Workspace<T: RealField = f64> {
    delta: Delta<T>,
}

/// Steps and cells are no larger than this share of the span, so that the assembly is looked at
/// everywhere.
const COARSEST: f64 = 1.0 / 32.0;

impl<T: RealField + Copy> Workspace<T> {
    pub(crate) const fn new(delta: Delta<T>) -> Self {
        Self { delta }
    }

    /// Whether the platform's centre can be at `point`.
    #[must_use]
    pub fn contains(&self, point: Point3<T>) -> bool {
        self.delta
            .inverse(point)
            .is_ok_and(|angles| self.hangs(point, angles))
    }

    /// Whether `point` is in the lower of the assemblies that belong to `angles`.
    fn hangs(&self, point: Point3<T>, angles: Vector3<T>) -> bool {
        let delta = &self.delta;
        let local = delta.flip(point.coords);
        let [c1, c2, c3] = delta.centres(angles);
        let n = (c2 - c1).cross(&(c3 - c1));
        let below = (local - c1).dot(&n);
        // On the plane of the knees the two are one.
        if n.z < T::zero() {
            below >= T::zero()
        } else {
            below <= T::zero()
        }
    }

    /// How far the platform can be moved from `point` in any direction, for reach, joint ranges
    /// and ball joints, in the unit of length: the whole ball round it is kept. Zero where
    /// `point` itself cannot be reached. The assembly is not part of it: how near its edge is,
    /// [`Pose::parallel_distance`](crate::Pose::parallel_distance) says.
    ///
    /// ```text
    /// reach:   La - |P - nearest place of the knee|,  |P - farthest place of the knee| - La
    /// ranges:  ||P - knee at the end of the range| - La|
    /// balls:   La sin(max lean) - |w|
    /// ```
    ///
    /// Each is the distance to a surface beyond which a limit is passed, so none changes by more
    /// than the point moves, and by continuity no angle leaves its range inside the ball.
    #[must_use]
    pub fn clearance(&self, point: Point3<T>) -> T {
        if !self.contains(point) {
            return T::zero();
        }
        let local = self.delta.flip(point.coords);
        self.delta
            .legs()
            .iter()
            .map(|leg| Self::leg_clearance(leg, &local))
            .fold(self.delta.span(), T::min)
            .max(T::zero())
    }

    fn leg_clearance(leg: &Leg<T>, local: &Vector3<T>) -> T {
        let side = local.dot(&leg.sideways()).abs();
        let mut clearance = leg.reach_margin(local).min(leg.max_side - side);
        let turn = T::two_pi();
        if leg.high - leg.low <= turn {
            // The knee at the lower end may also be behind the knee-in solution: then the wrist's
            // distance from the upper arm's line at that end holds the other solution off.
            let hip = leg.centre(leg.low) - leg.spoke(leg.low);
            let ahead = (local - hip).dot(&leg.tangent(leg.low)) / leg.upper;
            let low = leg.stretch(local, leg.low).abs().max(ahead);
            clearance = clearance.min(low).min(leg.stretch(local, leg.high).abs());
        }
        clearance
    }

    /// The arm by whose reach, range or ball joints the clearance at `point` is limited.
    #[must_use]
    pub fn tightest_arm(&self, point: Point3<T>) -> Arm {
        let local = self.delta.flip(point.coords);
        let legs = self.delta.legs().each_ref();
        least(legs.map(|leg| Self::leg_clearance(leg, &local))).0
    }

    /// Radius of the largest cylinder round the base's axis between two heights, every point of
    /// which is reached; `None` where not even one of radius `resolution` is.
    ///
    /// The radius is at most a few `resolution` below the true one, never above. Reach, ranges
    /// and ball joints are kept by the whole volume ([`clearance`](Self::clearance)); that the
    /// assembly is the lower one is looked at in the middle of cells of at most 1/32 span, smaller
    /// in proportion near parallel singularities.
    #[must_use]
    pub fn largest_cylinder(&self, heights: [T; 2], resolution: T) -> Option<T> {
        self.largest(heights, resolution, |radius| Solid::Cylinder { radius })
    }

    /// Half the side of the largest square box round the base's axis between two heights, its
    /// sides along X and Y, every point of which is reached; as
    /// [`largest_cylinder`](Self::largest_cylinder).
    #[must_use]
    pub fn largest_box(&self, heights: [T; 2], resolution: T) -> Option<T> {
        self.largest(heights, resolution, |half_side| Solid::Box { half_side })
    }

    /// Whether every point of a cylinder round the base's axis between two heights is reached;
    /// false also where `resolution` is too coarse to tell.
    #[must_use]
    pub fn covers_cylinder(&self, radius: T, heights: [T; 2], resolution: T) -> bool {
        cover::covers(self, Solid::Cylinder { radius }, heights, resolution)
    }

    /// Whether every point of a square box round the base's axis between two heights is reached;
    /// false also where `resolution` is too coarse to tell.
    #[must_use]
    pub fn covers_box(&self, half_side: T, heights: [T; 2], resolution: T) -> bool {
        cover::covers(self, Solid::Box { half_side }, heights, resolution)
    }

    fn largest(&self, heights: [T; 2], resolution: T, solid: impl Fn(T) -> Solid<T>) -> Option<T> {
        let resolution = resolution.max(self.delta.tolerance());
        let holds = |size| cover::covers(self, solid(size), heights, resolution);
        let (mut low, mut high) = (resolution, self.delta.span());
        if !holds(low) {
            return None;
        }
        while high - low > resolution {
            let middle = (low + high) * half();
            if middle <= low || middle >= high {
                break;
            }
            if holds(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(low)
    }

    /// The outline of the workspace at a height, as `points` points counter-clockwise from X: where
    /// rays from the base's axis first leave it. No point where the axis itself is outside.
    pub fn horizontal_slice(&self, z: T, points: u32) -> Outline<T> {
        let centre = Point3::new(T::zero(), T::zero(), z);
        Outline::new(*self, centre, [Vector3::x(), Vector3::y()], points)
    }

    /// The outline of the workspace in the plane through the base's axis at an azimuth in radians,
    /// as `points` points from the azimuth over z: where rays from height `z` on the axis first
    /// leave it. No point where that is outside.
    pub fn vertical_slice(&self, azimuth: T, z: T, points: u32) -> Outline<T> {
        let centre = Point3::new(T::zero(), T::zero(), z);
        let (sin, cos) = azimuth.sin_cos();
        let across = Vector3::new(cos, sin, T::zero());
        Outline::new(*self, centre, [across, Vector3::z()], points)
    }

    /// How far from `point` the assembly can be taken to be the same: a share of the span, and
    /// less where the rods nearly lie in a plane. Zero where `point` cannot be reached.
    fn steady(&self, point: Point3<T>) -> T {
        let coarsest = self.delta.span() * nalgebra::convert(COARSEST);
        self.delta.pose_at(point).map_or(T::zero(), |pose| {
            let lower = self.delta.legs().each_ref().map(|leg| leg.lower);
            let shortest = lower.into_iter().fold(self.delta.span(), T::min);
            coarsest.min(shortest * half() * pose.parallel_distance())
        })
    }
}
