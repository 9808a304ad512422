//! From a polyline to joint waypoints within a chord tolerance of it.

mod bisect;
mod bound;
mod error;
mod walk;

use core::iter::FusedIterator;

use nalgebra::{Point2, RealField};
use trig_kernels::Trig;

pub use error::FollowError;

use crate::{Arm, Elbow, Joints};
use walk::Walk;

/// A joint pose on the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Waypoint<T: RealField = f64> {
    /// Joint angles in radians, continuous along the curve.
    pub joints: Joints<T>,
    /// Where the tool is then, on the curve.
    pub point: Point2<T>,
    /// Number of the line, counted from 0: from point `line` to point `line + 1`.
    pub line: usize,
    /// The fraction of the line up to there, 0..=1.
    pub fraction: T,
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
    /// number of waypoints is known: [`Follow::remaining`]; `points` must therefore give the same
    /// points again when cloned.
    ///
    /// # Errors
    /// [`FollowError`]; the point named is the first along the curve.
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
    /// [`FollowError`]; the point named is the first along the curve.
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
        let mut remaining: u64 = 0;
        for waypoint in walk.clone() {
            waypoint?;
            remaining = remaining.saturating_add(1);
        }
        if remaining == 0 {
            return Err(FollowError::Empty);
        }
        Ok(Follow { walk, remaining })
    }
}

/// The waypoints of a curve that has been found to be reachable: see [`Arm::follow`].
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Follow<I, T: RealField = f64> {
    walk: Walk<I, T>,
    remaining: u64,
}

impl<I, T: RealField> Follow<I, T> {
    /// Waypoints still to come.
    #[must_use]
    pub const fn remaining(&self) -> u64 {
        self.remaining
    }
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
        self.remaining = self.remaining.saturating_sub(1);
        Some(waypoint)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        match usize::try_from(self.remaining) {
            Ok(remaining) => (remaining, Some(remaining)),
            Err(_) => (usize::MAX, None),
        }
    }
}

impl<I, T> FusedIterator for Follow<I, T>
where
    I: Iterator<Item = Point2<T>>,
    T: RealField + Trig,
{
}
