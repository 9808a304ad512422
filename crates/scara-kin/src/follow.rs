//! From a polyline to joint waypoints within a chord tolerance of it.

mod bisect;
mod bound;
mod error;
mod walk;

use core::fmt::{Display, Formatter};
use core::iter::FusedIterator;

use nalgebra::{Point2, RealField};
use trig_kernels::Trig;

pub use error::FollowError;

use crate::digits::Digits;
use crate::{Arm, Elbow, Joints};
use walk::Walk;

/// A place along a polyline.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "a place is just this")]
pub struct CurvePlace<T: RealField = f64> {
    /// Number of the line, counted from 0: from point `line` to point `line + 1`.
    pub line: usize,
    /// Share of the line that lies behind, 0..=1.
    pub fraction: T,
    /// The point there.
    pub point: Point2<T>,
}

impl<T: RealField + Copy> Display for CurvePlace<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        let (x, y) = (Digits(self.point.x), Digits(self.point.y));
        let fraction = Digits(self.fraction);
        write!(f, "line {} at {fraction} ({x}, {y})", self.line)
    }
}

/// A joint pose on the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Waypoint<T: RealField = f64> {
    /// Joint angles in radians, continuous along the curve.
    pub joints: Joints<T>,
    /// Where on the curve the tool is then.
    pub place: CurvePlace<T>,
}

impl<T: RealField + Trig> Arm<T> {
    /// Joint waypoints along the polyline `points` such that the straight joint move
    /// from each waypoint to the next keeps the tool within `tolerance` of the curve.
    ///
    /// The tolerance is a guarantee: a step is taken when its [`chord_bound`](Self::chord_bound),
    /// which is proven and not sampled, and the rounding of its ends keep it, and is halved
    /// until they do. Both ends of a step lie on the polyline, so this holds from path to
    /// curve and from curve to path.
    ///
    /// The elbow is kept along the curve, angles are continuous and within the limits;
    /// since limits are ranges, the moves between waypoints keep them too. Each point of
    /// the polyline becomes a waypoint, but for repeated points. The curve is walked
    /// once before anything is handed out, so that an error comes first, and the
    /// number of waypoints is known; `points` must therefore give the same points
    /// again when cloned.
    ///
    /// # Errors
    /// [`FollowError`]; the place named is the first along the curve.
    pub fn follow<I>(
        &self,
        points: I,
        elbow: Elbow,
        tolerance: T,
    ) -> Result<Follow<I::IntoIter, T>, FollowError<T>>
    where
        I: IntoIterator<Item = Point2<T>>,
        I::IntoIter: Clone,
    {
        self.follow_from(points, elbow, tolerance, self.limits().middle())
    }

    /// As [`follow`](Self::follow), the first waypoint at the whole turn nearest to
    /// `previous`.
    ///
    /// # Errors
    /// [`FollowError`]; the place named is the first along the curve.
    pub fn follow_from<I>(
        &self,
        points: I,
        elbow: Elbow,
        tolerance: T,
        previous: Joints<T>,
    ) -> Result<Follow<I::IntoIter, T>, FollowError<T>>
    where
        I: IntoIterator<Item = Point2<T>>,
        I::IntoIter: Clone,
    {
        let walk = Walk::new(*self, points.into_iter(), elbow, tolerance, previous);
        let mut waypoints = 0;
        for waypoint in walk.clone() {
            waypoint?;
            waypoints += 1;
        }
        if waypoints == 0 {
            return Err(FollowError::Empty);
        }
        Ok(Follow { walk, waypoints })
    }
}

/// The waypoints of a curve that has been found to be reachable: see [`Arm::follow`].
#[derive(Debug, Clone)]
pub struct Follow<I, T: RealField = f64> {
    walk: Walk<I, T>,
    waypoints: usize,
}

impl<I, T> Iterator for Follow<I, T>
where
    I: Iterator<Item = Point2<T>>,
    T: RealField + Trig,
{
    type Item = Waypoint<T>;

    fn next(&mut self) -> Option<Waypoint<T>> {
        // The walk has no error: it is the one that was checked.
        let waypoint = self.walk.next()?.ok()?;
        self.waypoints = self.waypoints.saturating_sub(1);
        Some(waypoint)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.waypoints, Some(self.waypoints))
    }
}

impl<I, T> ExactSizeIterator for Follow<I, T>
where
    I: Iterator<Item = Point2<T>>,
    T: RealField + Trig,
{
}

impl<I, T> FusedIterator for Follow<I, T>
where
    I: Iterator<Item = Point2<T>>,
    T: RealField + Trig,
{
}
