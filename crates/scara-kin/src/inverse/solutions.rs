//! The joint angles that reach one point: one elbow or both.

use nalgebra::{RealField, Vector2};

use super::InverseError;
use crate::{Arm, Elbow, Joints, Limits};

/// The joint angles that reach one point: those of one elbow or of both.
///
/// There is always at least one, and every angle is a number within its range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solutions<T = f64> {
    right: Joints<T>,
    left: Joints<T>,
    allowed: Allowed,
    limits: Limits<T>,
}

/// The elbows whose joints keep their limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Allowed {
    Both,
    Only(Elbow),
}

impl<T: RealField + Copy> Solutions<T> {
    #[inline]
    pub(super) fn new(
        arm: &Arm<T>,
        [right, left]: [Joints<T>; 2],
        tool: Vector2<T>,
    ) -> Result<Self, InverseError<T>> {
        if arm.window().hold_both(&right, &left) {
            return Ok(Self {
                right,
                left,
                allowed: Allowed::Both,
                limits: *arm.limits(),
            });
        }
        Self::sorted(arm, [right, left], tool)
    }

    /// The same where a joint has to be put on another turn, or leaves its range.
    #[cold]
    fn sorted(
        arm: &Arm<T>,
        [right, left]: [Joints<T>; 2],
        tool: Vector2<T>,
    ) -> Result<Self, InverseError<T>> {
        let limits = *arm.limits();
        let near = limits.middle();
        let (right, left, allowed) =
            match (arm.admit(right, near, tool), arm.admit(left, near, tool)) {
                (Ok(right), Ok(left)) => (right, left, Allowed::Both),
                (Ok(right), Err(_)) => (right, left, Allowed::Only(Elbow::Right)),
                (Err(_), Ok(left)) => (right, left, Allowed::Only(Elbow::Left)),
                (Err(a), Err(b)) if a.by() <= b.by() => return Err(a.error(Elbow::Right)),
                (Err(_), Err(b)) => return Err(b.error(Elbow::Left)),
            };
        Ok(Self {
            right,
            left,
            allowed,
            limits,
        })
    }

    /// The joints of one elbow; `None` if they would leave their limits, for which
    /// [`Arm::inverse_elbow`] names the reason.
    #[must_use]
    pub fn get(&self, elbow: Elbow) -> Option<Joints<T>> {
        match self.allowed {
            Allowed::Only(only) if only != elbow => None,
            _ => Some(self.branch(elbow)),
        }
    }

    /// The solutions, right elbow first: one or two.
    pub fn iter(&self) -> impl Iterator<Item = (Elbow, Joints<T>)> + Clone + use<T> {
        let solutions = *self;
        [Elbow::Right, Elbow::Left]
            .into_iter()
            .filter_map(move |elbow| Some((elbow, solutions.get(elbow)?)))
    }

    /// The solution of least joint travel from `previous`, counting the joint that
    /// turns further; each joint at the whole turn nearest to where it was, within its
    /// range. Of two equal ones the right elbow is taken.
    #[must_use]
    pub fn nearest_to(&self, previous: Joints<T>) -> (Elbow, Joints<T>) {
        let candidate = |elbow| (elbow, self.limits.fit(self.branch(elbow), previous));
        let travel = |(_, joints): &(Elbow, Joints<T>)| previous.way_to(*joints).amax();
        match self.allowed {
            Allowed::Only(elbow) => candidate(elbow),
            Allowed::Both => {
                let (right, left) = (candidate(Elbow::Right), candidate(Elbow::Left));
                if travel(&left) < travel(&right) {
                    left
                } else {
                    right
                }
            }
        }
    }

    fn branch(&self, elbow: Elbow) -> Joints<T> {
        match elbow {
            Elbow::Right => self.right,
            Elbow::Left => self.left,
        }
    }
}
