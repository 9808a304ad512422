//! Whole turns and limits: from the angles of a triangle to those of a machine.

use nalgebra::{RealField, Vector2};

use super::InverseError;
use crate::limits::Fitted;
use crate::{Arm, Elbow, Joint, Joints};

impl<T: RealField + Copy> Arm<T> {
    /// `joints` at the whole turn nearest to `near` within the limits; a joint beyond
    /// an end of its range is put on the end if the tool then still is at `tool` within
    /// rounding.
    #[inline]
    pub(super) fn admit(
        &self,
        joints: Joints<T>,
        near: Joints<T>,
        tool: Vector2<T>,
    ) -> Result<Joints<T>, Miss<T>> {
        if self.limits().holds_near(&joints, &near) {
            Ok(joints)
        } else {
            self.admit_turned(joints, near, tool)
        }
    }

    #[cold]
    fn admit_turned(
        &self,
        joints: Joints<T>,
        near: Joints<T>,
        tool: Vector2<T>,
    ) -> Result<Joints<T>, Miss<T>> {
        let shoulders = self.limits().shoulder.fit(joints.shoulder, near.shoulder);
        let elbows = self.limits().elbow.fit(joints.elbow, near.elbow);
        // The turn nearest to `near` comes first, even if it is the end of a range that
        // rounding missed.
        shoulders
            .into_iter()
            .flat_map(|shoulder| elbows.into_iter().map(move |elbow| (shoulder, elbow)))
            .find_map(|(shoulder, elbow)| self.settle(shoulder, elbow, tool))
            .ok_or_else(|| Miss::new(self, shoulders, elbows))
    }

    /// The joints within the limits that bring the tool to `tool`, the fitted ones or,
    /// within rounding, some beside them.
    fn settle(&self, shoulder: Fitted<T>, elbow: Fitted<T>, tool: Vector2<T>) -> Option<Joints<T>> {
        let fitted = Joints::new(shoulder.angle, elbow.angle);
        if shoulder.beyond == T::zero() && elbow.beyond == T::zero() {
            return Some(fitted);
        }
        // Near a straight or folded arm rounding moves both joints by far more than
        // itself, against each other: one on its end, the other as that needs it.
        let limits = self.limits();
        let elbow = self.elbow_behind(fitted.shoulder, tool);
        let [elbow, _] = limits.elbow.fit(elbow, fitted.elbow);
        let shoulder = self.shoulder_before(fitted.elbow, tool);
        let [shoulder, _] = limits.shoulder.fit(shoulder, fitted.shoulder);
        [
            fitted,
            Joints::new(fitted.shoulder, elbow.angle),
            Joints::new(shoulder.angle, fitted.elbow),
        ]
        .into_iter()
        .find(|joints| (self.tip(*joints) - tool).norm() <= self.rounding(*joints))
    }

    /// How far from its place rounding alone may put the tool, in the unit of length: the
    /// tolerance or, many turns from zero, the rounding of the angles.
    pub(crate) fn rounding(&self, joints: Joints<T>) -> T {
        let (shoulder, elbow) = (joints.shoulder.abs(), joints.elbow.abs());
        let angles = shoulder * self.reach() + elbow * self.fore();
        self.tolerance().max(angles * T::default_epsilon())
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
pub(super) struct Miss<T> {
    joint: Joint,
    angle: T,
    min: T,
    max: T,
    /// By how many radians the angle misses its range.
    by: T,
}

impl<T: RealField + Copy> Miss<T> {
    /// The joint that misses its range by more, at the turn that misses by less.
    #[cold]
    fn new(arm: &Arm<T>, shoulders: [Fitted<T>; 2], elbows: [Fitted<T>; 2]) -> Self {
        let (shoulder, elbow) = (nearer(shoulders), nearer(elbows));
        let (joint, fitted) = if shoulder.beyond.abs() >= elbow.beyond.abs() {
            (Joint::Shoulder, shoulder)
        } else {
            (Joint::Elbow, elbow)
        };
        let range = arm.limits().range(joint);
        Self {
            joint,
            angle: fitted.angle + fitted.beyond,
            min: range.min(),
            max: range.max(),
            by: fitted.beyond.abs(),
        }
    }

    pub(super) fn error(self, elbow: Elbow) -> InverseError<T> {
        InverseError::JointLimit {
            elbow,
            joint: self.joint,
            angle: self.angle,
            min: self.min,
            max: self.max,
        }
    }

    pub(super) fn by(&self) -> T {
        self.by
    }
}

/// The turn of an angle that is nearer to its range.
fn nearer<T: RealField + Copy>([a, b]: [Fitted<T>; 2]) -> Fitted<T> {
    if b.beyond.abs() < a.beyond.abs() {
        b
    } else {
        a
    }
}
