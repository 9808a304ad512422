//! From a position to joint angles: both elbows, within the limits, with reasons.

mod admit;
mod error;
mod solutions;

use nalgebra::{Point2, RealField, Vector2};
use trig_kernels::{Trig, atan2_of_length, atan2_of_length_lanes, sin_cos, sqrt};

pub use error::InverseError;
pub use solutions::Solutions;

#[cfg(feature = "path-timing")]
use crate::limits::two;
use crate::range::{largest_angle, length, max_value};
use crate::{Arm, Elbow, Joints};

/// The triangle base, elbow, tool of a reachable point, in the base's frame.
#[derive(Clone, Copy)]
pub(crate) struct Triangle<T> {
    pub(crate) tool: Vector2<T>,
    /// Four times the triangle's area.
    s: T,
    /// r² + l1² - l2²
    k1: T,
    /// r² - l1² + l2²
    #[cfg_attr(
        not(feature = "path-timing"),
        expect(dead_code, reason = "slopes of paths")
    )]
    other_k1: T,
    /// r² - l1² - l2²
    k2: T,
    /// One over the length of the vector (k2, s), 2 l1 l2, and of the shoulders', 2 l1 r².
    per_elbow: T,
    per_shoulder: T,
}

#[cfg(feature = "path-timing")]
/// How fast both joints turn along a direction, if they do at a finite rate.
type Slopes<T> = Option<Vector2<T>>;

impl<T: RealField + Trig> Triangle<T> {
    #[inline]
    fn joints(&self, elbow: Elbow) -> Joints<T> {
        let s = self.signed(elbow);
        let (sin, cos, inverse) = self.shoulder(s);
        let [shoulder, elbow] =
            atan2_of_length_lanes([sin, s], [cos, self.k2], [inverse, self.per_elbow]);
        Joints { shoulder, elbow }
    }

    #[inline]
    fn both(&self) -> [Joints<T>; 2] {
        let (right, left) = (self.right_shoulder(), self.left_shoulder());
        let (sin, cos, inverse) = self.elbow();
        let elbow = atan2_of_length(sin, cos, inverse);
        let [right, left] =
            atan2_of_length_lanes([right.0, left.0], [right.1, left.1], [right.2, left.2]);
        [Joints::new(right, elbow), Joints::new(left, -elbow)]
    }

    #[cfg(feature = "path-timing")]
    /// How fast both joints turn while the tool moves along `v`, from the triangle alone.
    ///
    /// ```text
    /// q1' = (f · v) / det J = ((r² - l1² + l2²) (p · v)/s + p × v) / r²     det J = s/2
    /// q2' = -(p · v) / det J = -2 (p · v)/s
    /// ```
    ///
    /// p the tool, f the forearm.
    #[inline]
    fn slopes(&self, upper: T, v: Vector2<T>, elbow: Elbow) -> Vector2<T> {
        let s = self.signed(elbow);
        let ahead = self.tool.dot(&v) / s;
        let per_square = self.per_shoulder * upper * two();
        Vector2::new(
            (self.other_k1 * ahead + self.tool.perp(&v)) * per_square,
            -ahead * two(),
        )
    }

    /// The area with the elbow's sign.
    #[inline(always)]
    fn signed(&self, elbow: Elbow) -> T {
        match elbow {
            Elbow::Right => self.s,
            Elbow::Left => -self.s,
        }
    }

    /// Sine and cosine of the right elbow times some area, and one over that, as the next two.
    #[inline(always)]
    pub(crate) fn elbow(&self) -> (T, T, T) {
        (self.s, self.k2, self.per_elbow)
    }

    #[inline(always)]
    pub(crate) fn right_shoulder(&self) -> (T, T, T) {
        self.shoulder(self.s)
    }

    #[inline(always)]
    pub(crate) fn left_shoulder(&self) -> (T, T, T) {
        self.shoulder(-self.s)
    }

    /// Both sides of the shoulder's angle and one over their length, for the area `s` with the
    /// elbow's sign.
    #[inline(always)]
    fn shoulder(&self, s: T) -> (T, T, T) {
        let (x, y) = (self.tool.x, self.tool.y);
        (self.k1 * y - s * x, self.k1 * x + s * y, self.per_shoulder)
    }
}

impl<T: RealField + Trig> Arm<T> {
    /// Joint angles of both elbows that bring the tool to `point`.
    ///
    /// ```text
    /// r² = |point - base|²
    /// s  = √((r² - (l1 - l2)²) ((l1 + l2)² - r²))
    /// k1 = r² + (l1 - l2)(l1 + l2)         or r² - l2² + l1²   where l2 > l1
    /// k2 = r² - l1² - l2²                  or r² - l2² - l1²   where l2 > l1
    /// q2 = ±atan2(s, k2)
    /// q1 = atan2(k1 y ∓ s x, k1 x ± s y)
    /// ```
    ///
    /// The lengths of these vectors are known, 2 l1 l2 and 2 l1 r², so that the angles come by
    /// their halves. What the differences round off is what a change of r² by its own last place
    /// would do, at the rim, at the fold, for equal links and for very unequal ones:
    /// `forward(inverse(p))` is within 8 machine epsilons of reach plus base distance everywhere.
    /// What [`forward`](Self::forward) made of allowed joints is never refused: up to
    /// [`tolerance`](Self::tolerance) past an edge counts as on it, for limits too.
    ///
    /// Angles are in radians at the whole turn nearest to the middle of their range.
    ///
    /// # Errors
    /// [`InverseError`]; with limits, only if neither elbow keeps them.
    #[inline]
    pub fn inverse(&self, point: impl Into<Point2<T>>) -> Result<Solutions<T>, InverseError<T>> {
        let triangle = self.triangle(point.into())?;
        Solutions::new(self, triangle.both(), triangle.tool)
    }

    /// Joint angles of one elbow that bring the tool to `point`.
    ///
    /// # Errors
    /// [`InverseError`]; with limits, if this elbow does not keep them.
    pub fn inverse_elbow(
        &self,
        point: impl Into<Point2<T>>,
        elbow: Elbow,
    ) -> Result<Joints<T>, InverseError<T>> {
        self.elbow_near(point.into(), elbow, self.limits().middle())
    }

    /// As [`inverse_elbow`](Self::inverse_elbow), each joint at the whole turn nearest
    /// to `previous` that is within its range. Turns from zero an angle is rounded to its
    /// own last place, and the tool with it: by up to reach · ε/2 · angle.
    ///
    /// # Errors
    /// [`InverseError`]; with limits, if this elbow does not keep them.
    #[inline]
    pub fn inverse_elbow_near(
        &self,
        point: impl Into<Point2<T>>,
        elbow: Elbow,
        previous: Joints<T>,
    ) -> Result<Joints<T>, InverseError<T>> {
        self.elbow_near(point.into(), elbow, checked(previous)?)
    }

    /// Joint angles that bring the tool to `point` with the least joint travel from
    /// `previous`, counting the joint that turns further: over both elbows and all whole
    /// turns within the limits. Of two equal ones the right elbow is taken.
    ///
    /// On the base of an arm with equal links the shoulder stays where it is.
    ///
    /// # Errors
    /// [`InverseError`], but never [`InverseError::AnyAngle`].
    pub fn inverse_nearest(
        &self,
        point: impl Into<Point2<T>>,
        previous: Joints<T>,
    ) -> Result<(Elbow, Joints<T>), InverseError<T>> {
        let previous = checked(previous)?;
        match self.triangle(point.into()) {
            Ok(triangle) => Solutions::near(self, triangle.both(), previous, triangle.tool)
                .map(|solutions| solutions.nearest_to(previous)),
            Err(InverseError::AnyAngle) => self.folded(previous),
            Err(error) => Err(error),
        }
    }

    /// Whether `point` can be reached within the limits.
    #[must_use]
    pub fn is_reachable(&self, point: impl Into<Point2<T>>) -> bool {
        self.inverse_nearest(point, self.limits().middle()).is_ok()
    }

    /// The folded arm of equal links, the shoulder as near as may be to `previous`.
    fn folded(&self, previous: Joints<T>) -> Result<(Elbow, Joints<T>), InverseError<T>> {
        let raw = Joints::new(previous.shoulder, T::pi());
        let joints = self
            .admit(raw, previous, Vector2::zeros())
            .map_err(|miss| miss.error(Elbow::Right))?;
        let elbow = if sin_cos(joints.elbow).0 < T::zero() {
            Elbow::Left
        } else {
            Elbow::Right
        };
        Ok((elbow, joints))
    }

    #[inline]
    fn elbow_near(
        &self,
        point: Point2<T>,
        elbow: Elbow,
        near: Joints<T>,
    ) -> Result<Joints<T>, InverseError<T>> {
        let triangle = self.triangle(point)?;
        self.admit(triangle.joints(elbow), near, triangle.tool)
            .map_err(|miss| miss.error(elbow))
    }

    #[cfg(feature = "path-timing")]
    /// As [`inverse_elbow_near`](Self::inverse_elbow_near), with the slopes of both joints along
    /// the direction `along`; these are `None` within a few machine epsilons of a straight or
    /// folded arm.
    #[inline]
    pub(crate) fn inverse_with_slopes(
        &self,
        point: Point2<T>,
        along: Vector2<T>,
        elbow: Elbow,
        near: Joints<T>,
    ) -> Result<(Joints<T>, Slopes<T>), InverseError<T>> {
        let triangle = self.triangle(point)?;
        let joints = self
            .admit(triangle.joints(elbow), checked(near)?, triangle.tool)
            .map_err(|miss| miss.error(elbow))?;
        let along = self.base().rotation.inverse() * along;
        let rounding = T::default_epsilon() * joints.elbow.abs().max(two());
        let is_bent = triangle.s * triangle.per_elbow > rounding;
        let slopes = is_bent.then(|| triangle.slopes(self.upper(), along, elbow));
        Ok((joints, slopes))
    }

    // Handed on in registers: as a call it costs a third of the whole.
    #[inline(always)]
    pub(crate) fn triangle(&self, point: Point2<T>) -> Result<Triangle<T>, InverseError<T>> {
        let tool = self.base().inverse_transform_point(&point).coords;
        let squares = self.squares();
        // A square that overflows is out of reach; one that vanishes is at the centre
        // by more digits than the lengths have.
        let r2 = tool.norm_squared();
        // Written so that NaN is outside too.
        let is_inside = r2 <= squares.farthest;
        if !is_inside {
            return Err(Self::outside(point, tool, self.reach()));
        }
        if r2 < squares.nearest {
            let (distance, reach) = (sqrt(r2), self.inner_reach());
            return Err(InverseError::TooNear { distance, reach });
        }
        if r2 == T::zero() && squares.folded == T::zero() {
            return Err(InverseError::AnyAngle);
        }
        let s2 = (r2 - squares.folded) * (squares.reach - r2);
        // Beyond an edge by rounding.
        let s = if s2 > T::zero() { sqrt(s2) } else { T::zero() };
        // The longer link's square first: it cancels where the other link is short.
        let less = r2 - squares.longer;
        let (k1, other_k1) = if squares.difference.is_sign_positive() {
            (r2 + squares.difference, less + squares.shorter)
        } else {
            (less + squares.shorter, r2 - squares.difference)
        };
        let k2 = less - squares.shorter;
        Ok(Triangle {
            tool,
            s,
            k1,
            other_k1,
            k2,
            per_elbow: squares.per_elbow,
            per_shoulder: squares.per_shoulder / r2,
        })
    }

    #[cold]
    fn outside(point: Point2<T>, tool: Vector2<T>, reach: T) -> InverseError<T> {
        if point.x.is_finite() && point.y.is_finite() {
            // Near the largest number the distance overflows.
            let distance = length(tool).min(max_value());
            InverseError::TooFar { distance, reach }
        } else {
            let (x, y) = (point.x, point.y);
            InverseError::NotFinite { x, y }
        }
    }
}

/// The joints before, within the range of angles.
fn checked<T: RealField + Trig>(joints: Joints<T>) -> Result<Joints<T>, InverseError<T>> {
    if joints.are_angles() {
        Ok(joints)
    } else {
        let largest = largest_angle();
        Err(InverseError::Previous { joints, largest })
    }
}
