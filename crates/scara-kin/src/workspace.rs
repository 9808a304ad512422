//! What the arm can reach: an annulus round the base, cut by the joint limits.

mod edge;

use nalgebra::{Point2, RealField, Vector2};

use crate::{Arm, Elbow, Limits};
use edge::Edge;

/// What an arm can reach: the annulus `inner..=outer` round `centre`, within `limits`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Workspace<T: RealField = f64> {
    arm: Arm<T>,
}

impl<T: RealField + Copy> Workspace<T> {
    pub(crate) const fn new(arm: Arm<T>) -> Self {
        Self { arm }
    }

    /// Centre of the annulus: the base.
    #[must_use]
    pub fn centre(&self) -> Point2<T> {
        Point2::from(self.arm.base().translation.vector)
    }

    /// Inner radius of the annulus: [`Arm::inner_reach`].
    #[must_use]
    pub fn inner(&self) -> T {
        self.arm.inner_reach()
    }

    /// Outer radius of the annulus: [`Arm::reach`].
    #[must_use]
    pub fn outer(&self) -> T {
        self.arm.reach()
    }

    /// The joint limits that cut the annulus.
    #[must_use]
    pub const fn limits(&self) -> &Limits<T> {
        self.arm.limits()
    }

    /// Whether the arm reaches `point` within its limits with either elbow.
    #[must_use]
    pub fn contains(&self, point: Point2<T>) -> bool {
        self.arm.is_reachable(point)
    }

    /// How far `point` lies within the annulus; negative: how far outside. Limits are
    /// not looked at.
    #[must_use]
    pub fn margin(&self, point: Point2<T>) -> T {
        self.circle_margin(point, T::zero())
    }

    /// How far a disc lies within the annulus; negative: how far it sticks out. Limits
    /// are not looked at.
    #[must_use]
    pub fn circle_margin(&self, centre: Point2<T>, radius: T) -> T {
        let distance = (centre - self.centre()).norm();
        self.ring_margin((distance - radius).max(T::zero()), distance + radius)
    }

    /// How far the box between two opposite corners lies within the annulus; negative:
    /// how far it sticks out. Limits are not looked at.
    #[must_use]
    pub fn box_margin(&self, corner: Point2<T>, opposite: Point2<T>) -> T {
        let a = corner - self.centre();
        let b = opposite - self.centre();
        let (low, high) = (a.inf(&b), a.sup(&b));
        let nearest = Vector2::zeros().sup(&low).inf(&high);
        let farthest = low.abs().sup(&high.abs());
        self.ring_margin(nearest.norm(), farthest.norm())
    }

    /// Whether the arm reaches every point of a disc with one elbow, within the annulus,
    /// keep-out and limits: so that it can draw anything there without changing elbow.
    ///
    /// A disc that the arm reaches at its centre, and that meets no place where a joint
    /// is at an end of its range, is reached everywhere.
    #[must_use]
    pub fn covers_circle(&self, centre: Point2<T>, radius: T, elbow: Elbow) -> bool {
        let rounding = self.arm.tolerance();
        self.circle_margin(centre, radius) >= -rounding
            && self.arm.inverse_elbow(centre, elbow).is_ok()
            && !Edge::all(&self.arm, elbow).any(|edge| edge.meets_disc(centre, radius - rounding))
    }

    /// Whether the arm reaches every point of the box between two opposite corners with
    /// one elbow, as [`covers_circle`](Self::covers_circle) does for a disc.
    #[must_use]
    pub fn covers_box(&self, corner: Point2<T>, opposite: Point2<T>, elbow: Elbow) -> bool {
        let rounding = self.arm.tolerance();
        let inset = Vector2::repeat(rounding);
        let (low, high) = (corner.inf(&opposite) + inset, corner.sup(&opposite) - inset);
        self.box_margin(corner, opposite) >= -rounding
            && self
                .arm
                .inverse_elbow(nalgebra::center(&low, &high), elbow)
                .is_ok()
            && !Edge::all(&self.arm, elbow).any(|edge| edge.meets_box(low, high))
    }

    /// Margin of a region whose distances from the base run from `nearest` to `farthest`.
    fn ring_margin(&self, nearest: T, farthest: T) -> T {
        let outer = self.outer() - farthest;
        if self.inner() > T::zero() {
            outer.min(nearest - self.inner())
        } else {
            outer
        }
    }
}
