//! From joint angles to positions.

use nalgebra::{Point2, RealField, Vector2};
use trig_kernels::{Trig, sin_cos, sin_cos_lanes};

use crate::{Arm, Joints};

/// The two links of a pose as vectors in the base's frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Links<T> {
    pub(crate) upper: Vector2<T>,
    pub(crate) fore: Vector2<T>,
}

impl<T: RealField + Copy> Links<T> {
    pub(crate) fn tip(&self) -> Vector2<T> {
        self.upper + self.fore
    }
}

impl<T: RealField + Trig> Arm<T> {
    /// Position of the tool.
    ///
    /// ```text
    /// p = base · R(q1) · (l1 + l2 cos q2, l2 sin q2)
    /// ```
    ///
    /// q1 the shoulder, q2 the elbow, in radians. The angles are not added first:
    /// their sum would be rounded once more. Limits are not looked at. Any finite angles
    /// are right to 4 machine epsilons of reach plus base distance; angles that are not
    /// finite give coordinates that are not numbers.
    #[must_use]
    #[inline]
    pub fn forward(&self, joints: Joints<T>) -> Point2<T> {
        self.base() * Point2::from(self.tip(joints))
    }

    /// Position of the elbow's axis.
    #[must_use]
    pub fn elbow_position(&self, joints: Joints<T>) -> Point2<T> {
        let (sin, cos) = sin_cos(joints.shoulder);
        self.base() * Point2::new(self.upper() * cos, self.upper() * sin)
    }

    /// The tool in the base's frame.
    #[inline]
    pub(crate) fn tip(&self, joints: Joints<T>) -> Vector2<T> {
        let (sines, cosines) = sin_cos_lanes([joints.shoulder, joints.elbow]);
        self.tip_of(sines, cosines)
    }

    /// The tool in the base's frame, from sines and cosines of shoulder and elbow.
    #[inline]
    pub(crate) fn tip_of(&self, [sin1, sin2]: [T; 2], [cos1, cos2]: [T; 2]) -> Vector2<T> {
        let along = self.upper() + self.fore() * cos2;
        let across = self.fore() * sin2;
        Vector2::new(cos1 * along - sin1 * across, sin1 * along + cos1 * across)
    }

    /// Both links in the base's frame.
    pub(crate) fn links(&self, joints: Joints<T>) -> Links<T> {
        let ([sin1, sin2], [cos1, cos2]) = sin_cos_lanes([joints.shoulder, joints.elbow]);
        Links {
            upper: Vector2::new(cos1, sin1) * self.upper(),
            fore: Vector2::new(cos1 * cos2 - sin1 * sin2, sin1 * cos2 + cos1 * sin2) * self.fore(),
        }
    }
}
