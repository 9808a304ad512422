//! Curves of the tool as paths of both joints, to be timed by `path-timing`.

mod disc;
mod error;
mod turns;

use core::f64::consts::PI;

use nalgebra::{Point2, Vector2};
use path_timing::{
    Corner, Cubic, Curve, CurveMotion, Path, PathPoint, Span, ToolLimits, TurnMotion,
};
use trig_kernels::sin_cos;

pub use disc::DiscPath;
pub use error::ArmPathError;

use crate::{Arm, Elbow, JointRange, Joints};
use turns::Turns;

/// A curve of the tool as a path of shoulder and elbow, in radians, by the curve's arc length: what
/// [`path_timing::Table`] plans.
///
/// It is made by [`Arm::path`], which has looked at all of it. The next one goes on from it without a
/// stop where the directions of their curves agree, as those of a line and a blend do.
///
/// ```
/// use path_timing::{AxisLimits, Curve, Knot, Table};
/// use scara_kin::{Arm, ArmPath, Elbow};
///
/// let arm = Arm::new(132.0, 132.0)?; // mm
/// let line = Curve::line([-80.0, 100.0], [80.0, 100.0])?;
/// let path = arm.path(line, Elbow::Right)?;
/// let joint = AxisLimits { speed: 3.0, acceleration: 30.0, jerk: None }; // rad, s
/// let mut knots = [Knot::default(); 100];
/// let table = Table::plan_within([path], [joint; 2], 8, 0.01, ArmPath::departure, &mut knots)?;
/// for row in table.rows() {
///     let row = row?;
///     println!("{:?} rad after {} s", row.position, row.duration_s);
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmPath {
    arm: Arm,
    curve: Curve<2>,
    elbow: Elbow,
    /// An elbow angle that all of the path is within half a turn of.
    elbow_angle: f64,
    shoulder: Turns,
}

/// Nearest to the edge of the workspace, as a fraction of the reach, that a path may come.
const EDGE: f64 = 1e-6;

/// Longest curve that stays within the workspace, in reaches: an arc of 100 rad. A Bézier curve of
/// degree 5 in a disc of radius 1 is at most 71 long, by Markov's inequality. Beyond, the arm may be
/// too small for the digits of the curve, and would be walked on without end.
const LONGEST: f64 = 100.0;

/// Most that a joint turns from one look at the path to the next, in radians.
const LOOK: f64 = 1.0;

/// Shortest step along the curve, as a fraction of it: between two places this near, one allowed and
/// one not, is the first that is not.
const LEAST_STEP: f64 = 1e-12;

/// By how much a joint may pass an end of its range between two rows, in radians: rounding, and a
/// path that touches it.
const TOUCH: f64 = 1e-9;

impl Arm {
    /// The path of the joints that brings the tool along `curve` with one elbow.
    ///
    /// All of the curve is looked at before anything is handed out: at each place it goes on by no
    /// more than that place is from the edge of the workspace, so no dip over the edge is missed.
    /// Joint limits are looked at in those places, each turned by at most a radian from the one
    /// before, and at each row that is planned; [`ArmPath::departure`] refuses a segment that passes
    /// them in between.
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
        let looker = Looker {
            arm: self,
            curve: &curve,
            elbow,
        };
        let start = looker.joints(0.0, previous)?;
        let mut path = ArmPath {
            arm: *self,
            curve,
            elbow,
            elbow_angle: start.elbow,
            shoulder: Turns::new(start.shoulder),
        };
        let (mut s, mut joints) = (0.0, start);
        while s < curve.length() {
            (s, joints) = looker.go_on(s, joints)?;
            if !path.shoulder.add(s, joints.shoulder) {
                return Err(ArmPathError::Turns { s });
            }
        }
        Ok(path)
    }
}

/// Walks along a curve before it is a path.
struct Looker<'a> {
    arm: &'a Arm,
    curve: &'a Curve<2>,
    elbow: Elbow,
}

impl Looker<'_> {
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

    /// How far the tool is from the edge of the workspace.
    fn clearance(&self, s: f64) -> f64 {
        let [x, y] = self.curve.at(s).point;
        let distance = (Vector2::new(x, y) - self.arm.base().translation.vector).norm();
        (distance - self.arm.inner_reach()).min(self.arm.reach() - distance)
    }

    /// The next place to be looked at, and the joints there. Shorter steps lead up to the first
    /// place that is refused.
    fn go_on(&self, s: f64, joints: Joints) -> Result<(f64, Joints), ArmPathError> {
        let mut step = self.clearance(s) / (1.0 + self.curve.speed_error());
        loop {
            let next = (s + step).min(self.curve.length());
            let refused = match self.joints(next, joints) {
                Ok(there) if (there - joints).amax() <= LOOK => return Ok((next, there)),
                Ok(there) => self.jump(next, joints, there),
                Err(error) => error,
            };
            if step <= self.curve.length() * LEAST_STEP {
                return Err(refused);
            }
            step *= 0.5;
        }
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

/// The joints at a place, each at the whole turn nearest to `near`.
fn joints_at(
    arm: &Arm,
    curve: &Curve<2>,
    elbow: Elbow,
    s: f64,
    near: Joints,
) -> Result<Joints, ArmPathError> {
    let point = curve.at(s).point.into();
    arm.inverse_elbow_near(point, elbow, near)
        .map_err(|reason| ArmPathError::Unreachable { s, point, reason })
}

impl ArmPath {
    /// The curve of the tool.
    #[must_use]
    pub const fn curve(&self) -> &Curve<2> {
        &self.curve
    }

    /// The joints at the arc length `s`.
    ///
    /// # Errors
    /// [`ArmPathError::Unreachable`] where a joint limit is passed between two places that
    /// [`Arm::path`] looked at.
    pub fn joints(&self, s: f64) -> Result<Joints, ArmPathError> {
        let near = Joints::new(self.shoulder.near(s), self.elbow_angle);
        joints_at(&self.arm, &self.curve, self.elbow, s, near)
    }

    /// Joints and their slopes.
    fn turning(&self, s: f64) -> Result<(Joints, Vector2<f64>), ArmPathError> {
        let joints = self.joints(s)?;
        let at = self.curve.at(s);
        let slopes = self.arm.joint_rates(joints, at.tangent.into());
        slopes
            .map(|slopes| (joints, slopes))
            .map_err(|_| ArmPathError::Edge {
                s,
                point: at.point.into(),
                distance: 0.0,
            })
    }

    /// The most by which the tool leaves the curve on a segment of a table, in the unit of length;
    /// infinite where a joint passes its limits there. For
    /// [`Table::plan_within`](path_timing::Table::plan_within).
    ///
    /// Proof. Both joints run cubics, so the absolute angles a of both links do. The fourth
    /// derivative of each link is bounded by the largest of those of its angle, all at the ends or at
    /// the vertex:
    ///
    /// ```text
    /// d⁴/dt⁴ l·e^{ia} = l·e^{ia} (a'⁴ - 3a"² - 4a'a‴ - 6i a'²a")
    /// ```
    ///
    /// At both ends the tool is on the curve with a velocity along it; the rest is
    /// [`CurveMotion`].
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; 2]>) -> f64 {
        let [from, to] = &span.rows;
        let ends = [from, to].map(|row| (row.position, row.velocity));
        self.departure_of(span.s, ends, to.duration_s)
    }

    fn departure_of(&self, s: [f64; 2], ends: [([f64; 2], [f64; 2]); 2], duration_s: f64) -> f64 {
        let arm = &self.arm;
        let [[q0, q1], [v0, v1]] = [ends.map(|end| end.0), ends.map(|end| end.1)];
        let cubic = |joints: fn([f64; 2]) -> f64| Cubic {
            q0: joints(q0),
            q1: joints(q1),
            v0: joints(v0),
            v1: joints(v1),
            duration_s,
        };
        let (shoulder, elbow) = (cubic(|[shoulder, _]| shoulder), cubic(|[_, elbow]| elbow));
        let limits = arm.limits();
        if passes(&limits.shoulder, &shoulder) || passes(&limits.elbow, &elbow) {
            return f64::INFINITY;
        }
        let velocities = ends.map(|([shoulder, elbow], rates)| {
            let velocity = arm.tool_velocity(Joints::new(shoulder, elbow), rates.into());
            <[f64; 2]>::from(velocity)
        });
        let [before, after] = &velocities;
        let reference = CurveMotion::new(&self.curve, s, [before, after], duration_s);
        let forearm = cubic(|[shoulder, elbow]| shoulder + elbow);
        let links = [(arm.upper(), shoulder), (arm.fore(), forearm)]
            .map(|(length, angle)| (length, TurnMotion::new(&angle)));
        let tool = |tau| {
            let tip = links.iter().fold(Vector2::zeros(), |tip, (length, link)| {
                tip + Vector2::from(link.at(tau)) * *length
            });
            (arm.base() * Point2::from(tip)).coords.into()
        };
        let [start, end] = [q0, q1].map(|[shoulder, elbow]| Joints::new(shoulder, elbow));
        let rounding = arm.rounding(start).max(arm.rounding(end));
        reference.departure(tool, self.longest_fourth(&links, &elbow)) + rounding
    }
}

/// Leibniz' weights of the fourth derivative of a product.
const LEIBNIZ: [f64; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];

impl ArmPath {
    /// The longest that the tool's fourth derivative can be: the sum of both links', or, where they
    /// nearly cancel, that of the product of the upper arm's direction and the tool as the upper arm
    /// sees it.
    fn longest_fourth(&self, links: &[(f64, TurnMotion); 2], elbow: &Cubic) -> f64 {
        let [(upper, upper_arm), (fore, forearm)] = links;
        let [.., fourth] = upper_arm.longest();
        let [.., fore_fourth] = forearm.longest();
        let sum = upper * fourth + fore * fore_fourth;
        let [low, high] = elbow.extent();
        // From straight to folded the tool's distance is monotonic.
        let distances = [low, high].map(|angle| self.arm.tip(Joints::new(0.0, angle)).norm());
        let is_one_side = sin_cos(low).0 * sin_cos(high).0 > 0.0 && high - low < PI;
        let distance = if is_one_side {
            let [near, far] = distances;
            near.max(far)
        } else {
            self.arm.reach()
        };
        let [u1, u2, u3, u4] = upper_arm.longest();
        let [g1, g2, g3, g4] = TurnMotion::new(elbow).longest().map(|turn| turn * fore);
        let upper_arm = [1.0, u1, u2, u3, u4]
            .into_iter()
            .zip([g4, g3, g2, g1, distance]);
        let terms = upper_arm.zip(LEIBNIZ);
        let product = terms.map(|((a, b), weight)| a * b * weight).sum();
        sum.min(product)
    }
}

/// Whether a joint passes an end of its range on the way.
fn passes(range: &JointRange, cubic: &Cubic) -> bool {
    let [low, high] = cubic.extent();
    low < range.min() - TOUCH || high > range.max() + TOUCH
}

impl Path for ArmPath {
    type Axes = [f64; 2];
    type Error = ArmPathError;

    fn length(&self) -> f64 {
        self.curve.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, ArmPathError> {
        let (joints, slopes) = self.turning(s)?;
        Ok(PathPoint {
            position: [joints.shoulder, joints.elbow],
            slope: slopes.into(),
        })
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.curve.tool()
    }

    fn corner(&self) -> Corner<[f64; 2]> {
        Corner::Smooth
    }
}
