//! Whole turns and limits: from the angles of a triangle to those of a machine.

use nalgebra::{RealField, Vector2};
use trig_kernels::Trig;

use super::InverseError;
use crate::limits::Fitted;
use crate::range::norm;
use crate::{Arm, Elbow, Joint, Joints};

impl<T: RealField + Trig> Arm<T> {
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
        let travel = |joints: Joints<T>| (joints - near).amax();
        let mut nearest = None;
        let mut consider = |candidate| {
            if nearest.is_none_or(|nearest| travel(candidate) < travel(nearest)) {
                nearest = Some(candidate);
            }
        };
        for (shoulder, elbow) in pairs(shoulders, elbows) {
            let fitted = Joints::new(shoulder.angle, elbow.angle);
            if shoulder.beyond == T::zero() && elbow.beyond == T::zero() {
                consider(fitted);
                break;
            }
            for candidate in self.beside(fitted, near, tool) {
                if self.stands_for(candidate, joints, tool) {
                    consider(candidate);
                }
            }
        }
        nearest.ok_or_else(|| Miss::new(self, shoulders, elbows))
    }

    /// `fitted`, and joints of which one stays and the other points at `tool`. Near a straight
    /// or folded arm rounding moves both by far more than itself, against each other: where
    /// one is put on its end, the other goes with it.
    fn beside(&self, fitted: Joints<T>, near: Joints<T>, tool: Vector2<T>) -> [Joints<T>; 5] {
        let Joints { shoulder, elbow } = fitted;
        let limits = self.limits();
        let elbows = limits
            .elbow
            .fit(self.elbow_towards(shoulder, tool), near.elbow);
        let shoulders = limits
            .shoulder
            .fit(self.shoulder_towards(elbow, tool), near.shoulder);
        let [a, b] = elbows.map(|elbow| Joints::new(shoulder, elbow.angle));
        let [c, d] = shoulders.map(|shoulder| Joints::new(shoulder.angle, elbow));
        [fitted, a, b, c, d]
    }

    /// Whether `candidate` is, within rounding, what `joints` is: the tool is at `tool`, and
    /// the elbow on the same side.
    fn stands_for(&self, candidate: Joints<T>, joints: Joints<T>, tool: Vector2<T>) -> bool {
        let rounding = self.rounding(candidate);
        let side = sin_cos(candidate.elbow).0;
        let beyond = if joints.elbow.is_sign_negative() {
            side
        } else {
            -side
        };
        // The sine of π as the float has it, and of what that is less whole turns.
        let is_same_side = beyond <= T::default_epsilon() * candidate.elbow.abs().max(T::one());
        is_same_side && norm(self.tip(candidate) - tool) <= rounding
    }

    /// How far rounding alone may displace the tool, in the unit of length: the
    /// tolerance or, many turns from zero, the rounding of the angles.
    pub(crate) fn rounding(&self, joints: Joints<T>) -> T {
        let (shoulder, elbow) = (joints.shoulder.abs(), joints.elbow.abs());
        let angles = shoulder * self.reach() + elbow * self.fore();
        self.tolerance().max(angles * T::default_epsilon())
    }

    /// Why a joint turns by more than half a turn on the way to `to`: the nearer whole turn is out
    /// of range.
    pub(crate) fn forced_turn(
        &self,
        elbow: Elbow,
        from: Joints<T>,
        to: Joints<T>,
    ) -> Option<InverseError<T>> {
        let change = to - from;
        let joints = [
            (Joint::Shoulder, change.x, to.shoulder),
            (Joint::Elbow, change.y, to.elbow),
        ];
        joints.into_iter().find_map(|(joint, change, angle)| {
            let angle = angle - T::two_pi().copysign(change);
            let range = self.limits().range(joint);
            let is_forced = change.abs() > T::pi() && !range.contains(angle);
            is_forced.then(|| InverseError::JointLimit {
                elbow,
                joint,
                angle,
                min: range.min(),
                max: range.max(),
            })
        })
    }

    /// The elbow that points the forearm at `tool` with the shoulder as given.
    fn elbow_towards(&self, shoulder: T, tool: Vector2<T>) -> T {
        let (sin, cos) = sin_cos(shoulder);
        let along = cos * tool.x + sin * tool.y - self.upper();
        let across = cos * tool.y - sin * tool.x;
        atan2(across, along)
    }

    /// The shoulder that points the arm at `tool` with the elbow as given.
    fn shoulder_towards(&self, elbow: T, tool: Vector2<T>) -> T {
        let tip = self.tip(Joints::new(T::zero(), elbow));
        atan2(tip.perp(&tool), tip.dot(&tool))
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

impl<T: RealField + Trig> Miss<T> {
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

/// The turns of both joints, the nearest ones first.
fn pairs<T: RealField + Trig>(
    shoulders: [Fitted<T>; 2],
    elbows: [Fitted<T>; 2],
) -> impl Iterator<Item = (Fitted<T>, Fitted<T>)> {
    shoulders
        .into_iter()
        .flat_map(move |shoulder| elbows.map(|elbow| (shoulder, elbow)))
}

/// The turn of an angle that is nearer to its range.
fn nearer<T: RealField + Trig>([a, b]: [Fitted<T>; 2]) -> Fitted<T> {
    if b.beyond.abs() < a.beyond.abs() {
        b
    } else {
        a
    }
}

/// Sine and cosine out of line: what is rare should be small.
#[inline(never)]
fn sin_cos<T: Trig>(angle: T) -> (T, T) {
    trig_kernels::sin_cos(angle)
}

/// As [`sin_cos`].
#[inline(never)]
fn atan2<T: Trig>(y: T, x: T) -> T {
    trig_kernels::atan2(y, x)
}
