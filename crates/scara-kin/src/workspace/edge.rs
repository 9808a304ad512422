//! Where a joint stands at the end of its range: arcs that cut the workspace.

use nalgebra::{Point2, RealField, Vector2};

use crate::{Arm, Elbow, Joints};

/// The places of the tool while one joint is at an end of its range: a circle, or the
/// half of one that an elbow can reach.
pub(super) struct Edge<T: RealField> {
    centre: Point2<T>,
    radius: T,
    /// For a half: the direction from the centre to its middle.
    half: Option<Vector2<T>>,
}

impl<T: RealField + Copy> Edge<T> {
    /// The edges that the limits of `arm` make for one elbow: at most two circles
    /// round the base, and two halves round places of the elbow.
    pub(super) fn all(arm: &Arm<T>, elbow: Elbow) -> impl Iterator<Item = Self> {
        let (arm, limits) = (*arm, *arm.limits());
        let ends = [limits.elbow.min(), limits.elbow.max()];
        let circles = ends.into_iter().filter_map(move |end| {
            let cuts = limits.elbow.is_within_a_turn() && Self::is_of(end, elbow);
            cuts.then(|| Self {
                centre: Point2::from(arm.base().translation.vector),
                radius: arm.tip(Joints::new(T::zero(), end)).norm(),
                half: None,
            })
        });
        let ends = [limits.shoulder.min(), limits.shoulder.max()];
        let halves = ends.into_iter().filter_map(move |end| {
            let cuts = limits.shoulder.is_within_a_turn();
            cuts.then(|| {
                let joints = Joints::new(end, T::zero());
                let along = arm.base().rotation * arm.tip(joints);
                let left = Vector2::new(-along.y, along.x).normalize();
                Self {
                    centre: arm.elbow_position(joints),
                    radius: arm.fore(),
                    half: Some(match elbow {
                        Elbow::Right => left,
                        Elbow::Left => -left,
                    }),
                }
            })
        });
        circles.chain(halves)
    }

    /// Whether an elbow angle is one of this elbow's, the arm neither straight nor folded.
    fn is_of(angle: T, elbow: Elbow) -> bool {
        let sin = angle.sin();
        match elbow {
            Elbow::Right => sin > T::default_epsilon(),
            Elbow::Left => sin < -T::default_epsilon(),
        }
    }

    /// Whether a disc and the edge have a point in common.
    pub(super) fn meets_disc(&self, centre: Point2<T>, radius: T) -> bool {
        let off = centre - self.centre;
        if self.has(off) {
            return (off.norm() - self.radius).abs() <= radius;
        }
        self.tips().any(|tip| (tip - centre).norm() <= radius)
    }

    /// Whether the box between two corners and the edge have a point in common.
    pub(super) fn meets_box(&self, low: Point2<T>, high: Point2<T>) -> bool {
        let inside = |p: Point2<T>| low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
        if self.half.is_none() {
            let a_point = self.centre + Vector2::x() * self.radius;
            if inside(a_point) {
                return true;
            }
        } else if self.tips().any(inside) {
            return true;
        }
        let corners = [
            low,
            Point2::new(high.x, low.y),
            high,
            Point2::new(low.x, high.y),
        ];
        let next = corners.into_iter().cycle().skip(1);
        corners
            .into_iter()
            .zip(next)
            .any(|(from, to)| self.crosses(from, to))
    }

    /// Whether the edge crosses the straight line between two points.
    fn crosses(&self, from: Point2<T>, to: Point2<T>) -> bool {
        let (off, way) = (from - self.centre, to - from);
        let (a, b) = (way.norm_squared(), off.dot(&way));
        let c = off.norm_squared() - self.radius * self.radius;
        let root = b * b - a * c;
        if a == T::zero() || root < T::zero() {
            return false;
        }
        [root.sqrt(), -root.sqrt()].into_iter().any(|root| {
            let share = (root - b) / a;
            share >= T::zero() && share <= T::one() && self.has(off + way * share)
        })
    }

    /// Whether the ray from the centre along `off` meets the edge.
    fn has(&self, off: Vector2<T>) -> bool {
        self.half.is_none_or(|half| off.dot(&half) >= T::zero())
    }

    /// The two ends of a half.
    fn tips(&self) -> impl Iterator<Item = Point2<T>> {
        let (centre, radius) = (self.centre, self.radius);
        self.half.into_iter().flat_map(move |half| {
            let across = Vector2::new(-half.y, half.x) * radius;
            [centre + across, centre - across]
        })
    }
}
