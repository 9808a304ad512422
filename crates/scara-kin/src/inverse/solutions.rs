//! The joint angles that reach one point: one elbow or both.

use nalgebra::{RealField, Vector2};
use trig_kernels::Trig;

use super::InverseError;
use crate::{Arm, Elbow, Joints};

/// The joint angles that reach one point: those of one elbow or of both.
///
/// There is always at least one, and every angle is a number within its range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solutions<T = f64> {
    right: Joints<T>,
    left: Joints<T>,
    allowed: Allowed,
}

/// The elbows whose joints keep their limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Allowed {
    Both,
    Only(Elbow),
}

impl<T: RealField + Trig> Solutions<T> {
    #[inline]
    pub(crate) fn new(
        arm: &Arm<T>,
        [right, left]: [Joints<T>; 2],
        tool: Vector2<T>,
    ) -> Result<Self, InverseError<T>> {
        if arm.principal_range().hold_both(&right, &left) {
            return Ok(Self {
                right,
                left,
                allowed: Allowed::Both,
            });
        }
        Self::near(arm, [right, left], arm.limits().middle(), tool)
    }

    /// The joints at the whole turns nearest to `near` that their ranges allow.
    #[inline(never)]
    pub(super) fn near(
        arm: &Arm<T>,
        [right, left]: [Joints<T>; 2],
        near: Joints<T>,
        tool: Vector2<T>,
    ) -> Result<Self, InverseError<T>> {
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
        })
    }

    /// The joints of one elbow; `None` if they would leave their limits, for which
    /// [`Arm::inverse_elbow`] names the reason.
    #[must_use]
    pub fn get(&self, elbow: Elbow) -> Option<Joints<T>> {
        match (self.allowed, elbow) {
            (Allowed::Both | Allowed::Only(Elbow::Right), Elbow::Right) => Some(self.right),
            (Allowed::Both | Allowed::Only(Elbow::Left), Elbow::Left) => Some(self.left),
            _ => None,
        }
    }

    /// The solutions, right elbow first: one or two.
    pub fn iter(&self) -> impl Iterator<Item = (Elbow, Joints<T>)> + Clone + use<T> {
        let solutions = *self;
        [Elbow::Right, Elbow::Left]
            .into_iter()
            .filter_map(move |elbow| Some((elbow, solutions.get(elbow)?)))
    }

    /// The solution of least joint travel; of two equal ones the right one.
    pub(super) fn nearest_to(&self, previous: Joints<T>) -> (Elbow, Joints<T>) {
        let (right, left) = ((Elbow::Right, self.right), (Elbow::Left, self.left));
        let travel = |joints: Joints<T>| (joints - previous).amax();
        match self.allowed {
            Allowed::Only(Elbow::Right) => right,
            Allowed::Only(Elbow::Left) => left,
            Allowed::Both if travel(self.left) < travel(self.right) => left,
            Allowed::Both => right,
        }
    }
}
