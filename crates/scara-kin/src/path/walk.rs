//! The walk along a curve that makes it a path of the joints.

use nalgebra::Vector2;
use path_timing::{Curve, Path};

use super::swing::{Between, Swing};
use super::turns::Turns;
use super::{ArmPath, ArmPathError, joints_at};
use crate::{Arm, Elbow, Joints};

/// Nearest to the edge of the workspace, as a fraction of the reach, that a path may come.
const EDGE: f64 = 1e-6;

/// Longest curve that stays within the workspace, in reaches: an arc of 100 rad. A Bézier curve of
/// degree 5 in a disc of radius 1 is at most 71 long, by Markov's inequality. Beyond, the arm may
/// be too small for the digits of the curve, and would be walked on without end.
const LONGEST: f64 = 100.0;

/// The largest turn of a joint from one place of the survey to the next, in radians.
const MAX_TURN: f64 = 1.0;

/// Shortest step along the curve, as a fraction of it: between two places this near, one allowed
/// and one not, is the first that is not.
const MIN_STEP: f64 = 1e-12;

/// Joints that turn by no more than this, in radians, and may still pass an end of a range: there
/// the rest is rounding.
const MIN_TURN: f64 = 1e-4;

impl Arm {
    /// The path of the joints that brings the tool along `curve` with one elbow.
    ///
    /// All of the curve is looked at before anything is handed out: at each place it goes on by no
    /// more than that place is from the edge of the workspace, so no dip over the edge is missed,
    /// and by no more than the joints are known to stay within their ranges for. They do where they
    /// cannot turn fast enough to reach an end, else where the cubics between both places stay
    /// within by more than the joints depart from them: that is bounded as [`ArmPath::departure`]
    /// is.
    ///
    /// # Errors
    /// [`ArmPathError`]; the place named is the first along the curve.
    pub fn path(&self, curve: Curve<2>, elbow: Elbow) -> Result<ArmPath, ArmPathError> {
        self.path_from(curve, elbow, self.limits().middle())
    }

    /// As [`path`](Self::path), each joint beginning at the whole turn nearest to `previous`: where
    /// the path before ended.
    ///
    /// # Errors
    /// [`ArmPathError`]; the place named is the first along the curve.
    pub fn path_from(
        &self,
        curve: Curve<2>,
        elbow: Elbow,
        previous: Joints,
    ) -> Result<ArmPath, ArmPathError> {
        let (length, max) = (curve.length(), self.reach() * LONGEST);
        if length > max {
            return Err(ArmPathError::TooLong { length, max });
        }
        let survey = Survey {
            arm: self,
            curve: &curve,
            elbow,
        };
        let start = survey.joints(0.0, previous)?;
        let mut path = ArmPath {
            arm: *self,
            curve,
            elbow,
            elbow_angle: start.elbow,
            shoulder: Turns::new(start.shoulder),
            corner: Path::corner(&curve).of_other_axes(),
        };
        let (mut s, mut joints) = (0.0, start);
        while s < curve.length() {
            (s, joints) = survey.advance(s, joints)?;
            if !path.shoulder.add(s, joints.shoulder) {
                return Err(ArmPathError::Turns { s });
            }
        }
        Ok(path)
    }
}

/// Walks along a curve before it is a path.
struct Survey<'a> {
    arm: &'a Arm,
    curve: &'a Curve<2>,
    elbow: Elbow,
}

impl Survey<'_> {
    /// The joints at a place, if the tool is within the workspace by more than [`EDGE`].
    fn joints(&self, s: f64, near: Joints) -> Result<Joints, ArmPathError> {
        let joints = joints_at(self.arm, self.curve, self.elbow, s, near)?;
        let distance = self.clearance(s);
        if distance > self.arm.reach() * EDGE {
            return Ok(joints);
        }
        let point = self.curve.at(s).point.into();
        Err(ArmPathError::Edge { s, point, distance })
    }

    fn distance(&self, s: f64) -> f64 {
        let [x, y] = self.curve.at(s).point;
        (Vector2::new(x, y) - self.arm.base().translation.vector).norm()
    }

    /// How far the tool is from the edge of the workspace.
    fn clearance(&self, s: f64) -> f64 {
        let distance = self.distance(s);
        (distance - self.arm.inner_reach()).min(self.arm.reach() - distance)
    }

    /// The next place of the survey, and the joints there. Shorter steps lead up to the first
    /// place that is refused.
    fn advance(&self, s: f64, joints: Joints) -> Result<(f64, Joints), ArmPathError> {
        let mut step = self.clearance(s) / (1.0 + self.curve.speed_error());
        loop {
            let next = (s + step).min(self.curve.length());
            let refused = match self.joints(next, joints) {
                Ok(there) if (there - joints).amax() <= MAX_TURN => {
                    let between = self.between([s, next]);
                    match self.check_between(&between, [joints, there]) {
                        Ok(()) => return Ok((next, there)),
                        Err(error) if between.turn() <= MIN_TURN => return Err(error),
                        Err(error) => error,
                    }
                }
                Ok(there) => self.jump(next, joints, there),
                Err(error) => error,
            };
            if step <= self.curve.length() * MIN_STEP {
                return Err(refused);
            }
            step *= 0.5;
        }
    }

    fn between(&self, s: [f64; 2]) -> Between {
        let [from, to] = s;
        let way = (to - from) * (1.0 + self.curve.speed_error());
        let sum = self.distance(from) + self.distance(to);
        Between::new(self.arm, s, [(sum - way) * 0.5, (sum + way) * 0.5], way)
    }

    /// Whether the joints stay within their ranges between two places.
    fn check_between(&self, between: &Between, joints: [Joints; 2]) -> Result<(), ArmPathError> {
        if between.holds(self.arm.limits(), joints) {
            return Ok(());
        }
        let ([from, to], [start, end]) = (between.s, joints);
        let ends = [self.turning(from, start)?, self.turning(to, end)?];
        let swing = Swing::new(between.s, ends, to - from);
        swing.check_curve(self.arm, self.curve, between.distances)
    }

    /// Joints and their slopes.
    fn turning(&self, s: f64, joints: Joints) -> Result<([f64; 2], [f64; 2]), ArmPathError> {
        let at = self.curve.at(s);
        let slopes = self.arm.joint_rates(joints, at.tangent.into());
        let slopes = slopes.map_err(|_| ArmPathError::Edge {
            s,
            point: at.point.into(),
            distance: self.clearance(s),
        })?;
        Ok(([joints.shoulder, joints.elbow], slopes.into()))
    }

    /// Why a joint turns by too much at once: the turn that it would go on with is out of range, or
    /// the arm is singular.
    fn jump(&self, s: f64, from: Joints, to: Joints) -> ArmPathError {
        let point = self.curve.at(s).point.into();
        match self.arm.forced_turn(self.elbow, from, to) {
            Some(reason) => ArmPathError::Unreachable { s, point, reason },
            None => ArmPathError::Edge {
                s,
                point,
                distance: self.clearance(s),
            },
        }
    }
}
