//! The outline of the workspace in a plane.

use core::iter::FusedIterator;

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::{Trig, sin_cos};

use super::Workspace;

/// The points at which rays from a centre first leave the workspace.
///
/// Each is inside, with a [`clearance`](Workspace::clearance) of at most 1e-6 of the machine's
/// span.
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Outline<T: RealField = f64> {
    workspace: Workspace<T>,
    centre: Point3<T>,
    plane: [Vector3<T>; 2],
    points: u32,
    next: u32,
}

/// How near to the edge a point of the outline is, in spans.
const NEAR: f64 = 1e-6;

impl<T: RealField + Trig> Outline<T> {
    pub(super) const fn new(
        workspace: Workspace<T>,
        centre: Point3<T>,
        plane: [Vector3<T>; 2],
        points: u32,
    ) -> Self {
        Self {
            workspace,
            centre,
            plane,
            points,
            next: 0,
        }
    }

    /// Points still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.points.saturating_sub(self.next).into()
    }

    /// The last place on a ray that is known to be inside: steps of the clearance, until it is
    /// small. As each is longer than 1e-6 spans, a million leave the machine's reach.
    fn leave(&self, direction: Vector3<T>) -> Point3<T> {
        let near = self.workspace.delta.span() * nalgebra::convert(NEAR);
        let mut place = self.centre;
        loop {
            let step = self.workspace.clearance(place);
            if step <= near {
                return place;
            }
            place += direction * step;
        }
    }
}

impl<T: RealField + Trig> Iterator for Outline<T> {
    type Item = Point3<T>;

    fn next(&mut self) -> Option<Point3<T>> {
        if self.next >= self.points {
            return None;
        }
        let share: T = nalgebra::convert(f64::from(self.next) / f64::from(self.points));
        self.next = self.next.saturating_add(1);
        let (sin, cos) = sin_cos(share * T::two_pi());
        let [right, up] = self.plane;
        Some(self.leave(right * cos + up * sin))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        match usize::try_from(self.remaining()) {
            Ok(remaining) => (remaining, Some(remaining)),
            Err(_) => (usize::MAX, None),
        }
    }
}

impl<T: RealField + Trig> FusedIterator for Outline<T> {}
