//! From a position to joint angles: both elbows, within the limits, with reasons.

mod solutions;

use nalgebra::{Point2, RealField, Vector2};

pub use solutions::Solutions;

use crate::limits::max_value;
use crate::{Arm, Elbow, Joint, Joints};

/// Why no joint angles reach a point.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InverseError<T = f64> {
    /// A coordinate is infinite or not a number.
    #[error("point ({x}, {y}) is not finite")]
    NotFinite {
        /// X as given.
        x: T,
        /// Y as given.
        y: T,
    },
    /// The point lies outside the stretched arm's circle.
    #[error("too far: distance {distance} from the base is past the reach {reach}")]
    TooFar {
        /// Distance from the base.
        distance: T,
        /// Distance of the stretched arm.
        reach: T,
    },
    /// The point lies inside the folded arm's circle, or inside the keep-out radius.
    #[error("too near: distance {distance} from the base is within the inner reach {reach}")]
    TooNear {
        /// Distance from the base.
        distance: T,
        /// Least distance allowed.
        reach: T,
    },
    /// The point is the base itself and the links are equal: with the elbow folded,
    /// every shoulder angle is a solution. [`Arm::inverse_nearest`] picks one.
    #[error("the point is the base of an arm with equal links: any shoulder angle reaches it")]
    Centre,
    /// The point is within reach, but a joint would leave its range.
    #[error("{joint} at {angle} rad ({elbow:?} elbow) is outside its range {min}..={max} rad")]
    JointLimit {
        /// The elbow tried; where both fail, the one that misses by less.
        elbow: Elbow,
        /// The joint that would leave its range.
        joint: Joint,
        /// Its angle, in radians.
        angle: T,
        /// Lower end of its range, in radians.
        min: T,
        /// Upper end of its range, in radians.
        max: T,
    },
}

/// The triangle base, elbow, tool of a reachable point, in the base's frame.
struct Triangle<T> {
    tool: Vector2<T>,
    /// Four times the triangle's area.
    s: T,
    /// r² + l1² - l2²
    k1: T,
    /// Elbow angle of the right elbow, 0..=π.
    elbow: T,
}

impl<T: RealField + Copy> Triangle<T> {
    #[inline]
    fn joints(&self, elbow: Elbow) -> Joints<T> {
        let (k1, s) = match elbow {
            Elbow::Right => (self.k1, self.s),
            Elbow::Left => (self.k1, -self.s),
        };
        let (x, y) = (self.tool.x, self.tool.y);
        Joints {
            shoulder: (k1 * y - s * x).atan2(k1 * x + s * y),
            elbow: match elbow {
                Elbow::Right => self.elbow,
                Elbow::Left => -self.elbow,
            },
        }
    }
}

impl<T: RealField + Copy> Arm<T> {
    /// Joint angles of both elbows that bring the tool to `point`.
    ///
    /// ```text
    /// r  = |point - base|
    /// s  = √((r - (l1 - l2)) (r + (l1 - l2)) ((l1 + l2) - r) ((l1 + l2) + r))
    /// k1 = r² + (l1 - l2)(l1 + l2)         or (r - l2)(r + l2) + l1²   where l2 > l1
    /// k2 = (r - l1)(r + l1) - l2²          or (r - l2)(r + l2) - l1²   where l2 > l1
    /// q2 = ±atan2(s, k2)
    /// q1 = atan2(k1 y ∓ s x, k1 x ± s y)
    /// ```
    ///
    /// The factors are exact differences, so nothing cancels at the rim, at the fold,
    /// for equal links or for very unequal ones: `forward(inverse(p))` is within 1e-15 of
    /// the reach in f64 (plus as much of the base's distance) everywhere. What [`forward`](Self::forward)
    /// made is never refused: up to [`tolerance`](Self::tolerance) past an edge counts
    /// as on it, for limits too.
    ///
    /// Angles are in radians at the whole turn nearest to the middle of their range.
    ///
    /// # Errors
    /// [`InverseError`]; with limits, only if neither elbow keeps them.
    #[inline]
    pub fn inverse(&self, point: Point2<T>) -> Result<Solutions<T>, InverseError<T>> {
        let triangle = self.triangle(point)?;
        let raw = [triangle.joints(Elbow::Right), triangle.joints(Elbow::Left)];
        Solutions::new(self, raw, triangle.tool)
    }

    /// Joint angles of one elbow that bring the tool to `point`.
    ///
    /// # Errors
    /// [`InverseError`]; with limits, if this elbow does not keep them.
    pub fn inverse_elbow(
        &self,
        point: Point2<T>,
        elbow: Elbow,
    ) -> Result<Joints<T>, InverseError<T>> {
        self.inverse_elbow_near(point, elbow, self.limits().middle())
    }

    /// As [`inverse_elbow`](Self::inverse_elbow), each joint at the whole turn nearest
    /// to `previous` that is within its range.
    ///
    /// # Errors
    /// [`InverseError`]; with limits, if this elbow does not keep them.
    #[inline]
    pub fn inverse_elbow_near(
        &self,
        point: Point2<T>,
        elbow: Elbow,
        previous: Joints<T>,
    ) -> Result<Joints<T>, InverseError<T>> {
        let triangle = self.triangle(point)?;
        self.admit(triangle.joints(elbow), previous, triangle.tool)
            .map_err(|miss| miss.error(elbow))
    }

    /// Joint angles that bring the tool to `point` with the least joint travel from
    /// `previous`: over both elbows and all whole turns within the limits.
    ///
    /// On the base of an arm with equal links the shoulder stays where it is.
    ///
    /// # Errors
    /// [`InverseError`], but never [`InverseError::Centre`].
    pub fn inverse_nearest(
        &self,
        point: Point2<T>,
        previous: Joints<T>,
    ) -> Result<Joints<T>, InverseError<T>> {
        match self.inverse(point) {
            Ok(solutions) => Ok(solutions.nearest_to(previous).1),
            Err(InverseError::Centre) => self.folded(previous),
            Err(error) => Err(error),
        }
    }

    /// Whether `point` can be reached within the limits.
    #[must_use]
    pub fn is_reachable(&self, point: Point2<T>) -> bool {
        self.inverse_nearest(point, self.limits().middle()).is_ok()
    }

    /// The folded arm of equal links, the shoulder as near as may be to `previous`.
    fn folded(&self, previous: Joints<T>) -> Result<Joints<T>, InverseError<T>> {
        let tool = Vector2::zeros();
        let raw = Joints::new(previous.shoulder, T::pi());
        self.admit(raw, previous, tool)
            .or_else(|miss| {
                // Any shoulder angle will do: the end of its range that was missed.
                let shoulder = self
                    .limits()
                    .shoulder
                    .fit(previous.shoulder, previous.shoulder);
                self.admit(Joints::new(shoulder, T::pi()), previous, tool)
                    .map_err(|_| miss)
            })
            .map_err(|miss| miss.error(Elbow::Right))
    }

    // Handed on in registers: as a call it costs a third of the whole.
    #[inline(always)]
    fn triangle(&self, point: Point2<T>) -> Result<Triangle<T>, InverseError<T>> {
        let tool = self.base().inverse_transform_point(&point).coords;
        let (l1, l2) = (self.upper(), self.fore());
        // A square that overflows is out of reach; one that vanishes is at the centre
        // by more digits than the lengths have.
        let r2 = tool.norm_squared();
        let r = r2.sqrt();
        let (folded, reach, tolerance) = (l1 - l2, self.reach(), self.tolerance());
        if r > reach + tolerance || !r.is_finite() {
            return Err(Self::outside(point, tool, reach));
        }
        if r < self.inner_reach() - tolerance {
            let reach = self.inner_reach();
            return Err(InverseError::TooNear { distance: r, reach });
        }
        if r == T::zero() && folded == T::zero() {
            return Err(InverseError::Centre);
        }
        let s2 = (r - folded) * (r + folded) * ((reach - r) * (reach + r));
        let s = s2.max(T::zero()).sqrt();
        // r² less the longer link's square, as a product: it cancels where they are close.
        let square = |longer| (r - longer) * (r + longer);
        let (k1, k2) = if l1 >= l2 {
            (r2 + folded * reach, square(l1) - l2 * l2)
        } else {
            (square(l2) + l1 * l1, square(l2) - l1 * l1)
        };
        let elbow = s.atan2(k2);
        Ok(Triangle { tool, s, k1, elbow })
    }

    #[cold]
    fn outside(point: Point2<T>, tool: Vector2<T>, reach: T) -> InverseError<T> {
        if point.x.is_finite() && point.y.is_finite() {
            // Near the largest number the distance overflows.
            let distance = tool.x.hypot(tool.y).min(max_value());
            InverseError::TooFar { distance, reach }
        } else {
            let (x, y) = (point.x, point.y);
            InverseError::NotFinite { x, y }
        }
    }

    /// `joints` at the whole turn nearest to `near` within the limits; a joint beyond
    /// an end of its range is put on the end if the tool then still is at `tool` within
    /// rounding.
    #[inline]
    fn admit(
        &self,
        joints: Joints<T>,
        near: Joints<T>,
        tool: Vector2<T>,
    ) -> Result<Joints<T>, Miss<T>> {
        if self.limits().holds_near(&joints, &near) {
            Ok(joints)
        } else {
            self.admit_fitted(joints, near, tool)
        }
    }

    #[cold]
    fn admit_fitted(
        &self,
        joints: Joints<T>,
        near: Joints<T>,
        tool: Vector2<T>,
    ) -> Result<Joints<T>, Miss<T>> {
        let fitted = self.limits().fit(joints, near);
        // Near a straight or folded arm rounding moves both joints by far more than
        // itself, against each other: one on its end, the other as that needs it.
        let candidates = [
            fitted,
            Joints {
                elbow: self.elbow_behind(fitted.shoulder, tool),
                ..fitted
            },
            Joints {
                shoulder: self.shoulder_before(fitted.elbow, tool),
                ..fitted
            },
        ];
        candidates
            .into_iter()
            .map(|candidate| self.limits().fit(candidate, fitted))
            .find(|candidate| (self.tip(*candidate) - tool).norm() <= self.tolerance())
            .ok_or_else(|| Miss::new(self, joints, fitted))
    }

    /// The elbow that points the forearm at `tool` with the shoulder as given.
    fn elbow_behind(&self, shoulder: T, tool: Vector2<T>) -> T {
        let (sin, cos) = shoulder.sin_cos();
        let along = cos * tool.x + sin * tool.y - self.upper();
        let across = cos * tool.y - sin * tool.x;
        across.atan2(along)
    }

    /// The shoulder that points the arm at `tool` with the elbow as given.
    fn shoulder_before(&self, elbow: T, tool: Vector2<T>) -> T {
        let tip = self.tip(Joints::new(T::zero(), elbow));
        tip.perp(&tool).atan2(tip.dot(&tool))
    }
}

/// A joint that cannot take the angle that a point asks for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Miss<T> {
    joint: Joint,
    angle: T,
    min: T,
    max: T,
    /// By how many radians the angle misses its range.
    by: T,
}

impl<T: RealField + Copy> Miss<T> {
    #[cold]
    fn new(arm: &Arm<T>, joints: Joints<T>, fitted: Joints<T>) -> Self {
        let shoulder = off_turn(joints.shoulder, fitted.shoulder);
        let elbow = off_turn(joints.elbow, fitted.elbow);
        let (joint, angle, by) = if shoulder >= elbow {
            (Joint::Shoulder, joints.shoulder, shoulder)
        } else {
            (Joint::Elbow, joints.elbow, elbow)
        };
        let range = arm.limits().range(joint);
        Self {
            joint,
            angle,
            min: range.min(),
            max: range.max(),
            by,
        }
    }

    pub(crate) fn error(self, elbow: Elbow) -> InverseError<T> {
        InverseError::JointLimit {
            elbow,
            joint: self.joint,
            angle: self.angle,
            min: self.min,
            max: self.max,
        }
    }

    fn by(&self) -> T {
        self.by
    }
}

/// How far two angles are apart, whole turns aside: 0..=π.
fn off_turn<T: RealField + Copy>(a: T, b: T) -> T {
    let turn = T::two_pi();
    let way = a - b;
    (way - (way / turn).round() * turn).abs()
}
