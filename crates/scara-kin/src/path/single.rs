//! A path whose points are found in single precision.
//!
//! Goal: a path that a microcontroller without instructions for `f64` plans in a tenth of the time.
//! Method: the curve, the whole turns and the ranges stay in `f64`; joints and slopes come from an
//! arm in `f32`, and what that rounds off, some 1e-7 rad, is in the bound of the departure.

use nalgebra::{Point2, Vector3};
use path_timing::{Corner, Path, PathPoint, Span, ToolLimits};

use super::swing::Swing;
use super::{ArmPath, ArmPathError};
use crate::{Arm, GeometryError, Joint, Joints};

/// An [`ArmPath`] whose joints and slopes are found in single precision: for
/// [`Table::plan_in_f32`](path_timing::Table::plan_in_f32) on a processor that has no instructions
/// for `f64`. The tool is off its curve by as much as `f32` rounds, 2e-6 of the reach, besides.
///
/// ```
/// use path_timing::{AxisLimits, Curve, Knot, Table};
/// use scara_kin::{Arm, Elbow};
///
/// let arm = Arm::new(132.0, 132.0)?; // mm
/// let line = Curve::line([-80.0, 100.0], [80.0, 100.0])?;
/// let path = arm.path(line, Elbow::Right)?.in_f32()?;
/// let joint = AxisLimits { speed: 3.0, acceleration: 30.0, jerk: None }; // rad, s
/// let mut knots = [Knot::default(); 51];
/// let table = Table::plan_in_f32([path], [joint; 2], |_| 50, &mut knots)?;
/// let departures = table.spans().map(|span| path.departure(&span));
/// assert!(departures.fold(0.0, f64::max) < 0.01);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmPathF32 {
    path: ArmPath,
    arm: Arm<f32>,
    /// The direction of the curve where it is a line.
    line: Option<[f64; 2]>,
}

/// Relative difference of a line's length and the distance of its ends.
const STRAIGHT: f64 = 1e-12;

/// What the terms of a bound in `f32` round off.
const ROUNDED_UP: f32 = 1.0 + 64.0 * f32::EPSILON;

/// What is left to the ends of a range, in radians, where `f32` is enough to see that they are not
/// passed.
const CLEAR: f32 = 1e-3;

/// By how much a joint may pass an end of its range between two rows, in radians: rounding.
const RANGE_SLACK: f64 = 4e-6;

impl ArmPath {
    /// The path with its points found in single precision.
    ///
    /// # Errors
    /// [`GeometryError`] where the arm's lengths or base are out of the range of `f32`.
    pub fn in_f32(self) -> Result<ArmPathF32, GeometryError<f32>> {
        let arm = Arm::new(single(self.arm.upper()), single(self.arm.fore()))?;
        let arm = arm.with_base(self.arm.base().cast())?;
        let (start, end) = (self.curve.start(), self.curve.end());
        let chord = (Point2::from(end) - Point2::from(start)).norm();
        let is_line = self.curve.length() - chord <= chord * STRAIGHT;
        Ok(ArmPathF32 {
            line: is_line.then(|| self.curve.at(0.0).tangent),
            path: self,
            arm,
        })
    }
}

impl ArmPathF32 {
    /// The path in `f64`.
    #[must_use]
    pub const fn exact(&self) -> &ArmPath {
        &self.path
    }

    /// The most by which the tool leaves the curve on a segment of a table, in the unit of length:
    /// on a line in closed form, else as [`ArmPath::departure`] has it.
    ///
    /// Both ends are on the line with a velocity along it, so the distance from it is at most 1/384
    /// of its largest fourth derivative by the fraction of the segment. With u1, u2, u3 the largest
    /// that the derivatives of a link's angle are, that is for both links together
    ///
    /// ```text
    /// |d| <= Σ l (u1⁴ + 6 u1² u2 + 3 u2² + 4 u1 u3) / 384
    /// ```
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; 2]>) -> f64 {
        let [from, to] = &span.rows;
        let rounding = [from, to].map(|row| self.rounding(row.position));
        let rounding = rounding.into_iter().fold(0.0, f64::max);
        if self.line.is_none() {
            return self.path.departure(span) + rounding;
        }
        let duration = single(to.duration_s);
        let ([q0, r0], [q1, r1]) = (from.position, to.position);
        let ([v0, w0], [v1, w1]) = (from.velocity, to.velocity);
        let [shoulder, elbow] = [([q0, q1], [v0, v1]), ([r0, r1], [w0, w1])].map(|(q, v)| {
            let ([q0, q1], [v0, v1]) = (q, v.map(single));
            Vector3::new(single(q1 - q0), v0 * duration, v1 * duration)
        });
        let forearm = shoulder + elbow;
        let links = [(self.arm.upper(), shoulder), (self.arm.fore(), forearm)];
        let fourth: f32 = links
            .into_iter()
            .map(|(length, angle)| length * longest_fourth(angle))
            .sum();
        f64::from(fourth * ROUNDED_UP / 384.0) + rounding
    }

    /// The place on the curve, and its direction there.
    fn place(&self, s: f64) -> ([f64; 2], [f64; 2]) {
        match self.line {
            Some([x, y]) => {
                let [from_x, from_y] = self.path.curve.start();
                ([from_x + x * s, from_y + y * s], [x, y])
            }
            None => {
                let at = self.path.curve.at(s);
                (at.point, at.tangent)
            }
        }
    }

    /// Whether the control points in `f32` alone say that the arm may run a segment.
    fn is_clear(&self, span: &Span<[f64; 2]>) -> bool {
        let (arm, [from, to]) = (&self.path.arm, &span.rows);
        let third = single(to.duration_s) * (1.0 / 3.0);
        let ends = [
            (
                Joint::Shoulder,
                from.position[0],
                from.velocity[0],
                to.position[0],
                to.velocity[0],
            ),
            (
                Joint::Elbow,
                from.position[1],
                from.velocity[1],
                to.position[1],
                to.velocity[1],
            ),
        ];
        arm.keep_out() <= (arm.upper() - arm.fore()).abs()
            && ends.into_iter().all(|(joint, q0, v0, q1, v1)| {
                let range = arm.limits().range(joint);
                let [q0, v0, q1, v1] = [q0, v0, q1, v1].map(single);
                let (min, max) = (single(range.min()), single(range.max()));
                let points = [q0, q0 + v0 * third, q1 - v1 * third, q1];
                points.into_iter().all(|point| {
                    let off = CLEAR + point.abs() * (16.0 * f32::EPSILON);
                    min < point - off && point + off < max
                })
            })
    }

    /// How far `f32` may put the tool off, with the direction in which it leaves a row.
    fn rounding(&self, [shoulder, elbow]: [f64; 2]) -> f64 {
        let joints = Joints::new(single(shoulder), single(elbow));
        2.0 * f64::from(self.arm.rounding(joints))
    }
}

/// The longest that the fourth derivative of a unit vector can be while its angle runs a cubic,
/// from the change of the angle and its slopes at both ends, by the fraction of the segment.
fn longest_fourth(angle: Vector3<f32>) -> f32 {
    let (change, a, b) = (angle.x, angle.y, angle.z);
    let (c2, c3) = (3.0 * change - 2.0 * a - b, a + b - 2.0 * change);
    let u1 = a.abs().max(b.abs()).max((3.0 * change - a - b).abs());
    let u2 = (2.0 * c2).abs().max((2.0 * c2 + 6.0 * c3).abs());
    let u3 = (6.0 * c3).abs();
    let square = u1 * u1;
    square * square + 6.0 * square * u2 + 3.0 * u2 * u2 + 4.0 * u1 * u3
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the nearest number is wanted"
)]
const fn single(x: f64) -> f32 {
    x as f32
}

impl Path for ArmPathF32 {
    type Axes = [f64; 2];
    type Error = ArmPathError;

    fn length(&self) -> f64 {
        self.path.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, ArmPathError> {
        let path = &self.path;
        let (point, along) = self.place(s);
        let near = Joints::new(single(path.shoulder.near(s)), single(path.elbow_angle));
        let [x, y] = point.map(single);
        let along = along.map(single).into();
        let found = (self.arm)
            .inverse_with_slopes(Point2::new(x, y), along, path.elbow, near)
            .ok();
        // Out of reach by rounding, or straight within it.
        let (joints, slopes) = found
            .and_then(|(joints, slopes)| Some((joints, slopes?)))
            .ok_or(ArmPathError::Edge {
                s,
                point: point.into(),
                distance: 0.0,
            })?;
        Ok(PathPoint {
            position: [joints.shoulder, joints.elbow].map(f64::from),
            slope: <[f32; 2]>::from(slopes).map(f64::from),
        })
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.path.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        self.path.tool_rate(s)
    }

    fn corner(&self) -> Corner<[f64; 2]> {
        self.path.corner()
    }

    fn check(&self, span: &Span<[f64; 2]>) -> Result<(), ArmPathError> {
        if self.is_clear(span) {
            return Ok(());
        }
        Swing::of(span, |joints| joints).check(&self.path.arm, RANGE_SLACK)
    }
}
