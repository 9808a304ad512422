//! Curves of the tool as paths of both joints, to be timed by `path-timing`.

mod disc;
mod error;
mod single;
mod swing;
mod turns;
mod walk;

use nalgebra::Vector2;
use path_timing::{Corner, Curve, Path, PathPoint, Span, ToolLimits};

pub use disc::DiscPath;
pub use error::ArmPathError;
pub use single::ArmPathF32;

use crate::{Arm, Elbow, Joints};
use swing::{RANGE_SLACK, Swing};
use turns::Turns;

/// A curve of the tool as a path of shoulder and elbow, in radians, by the curve's arc length: what
/// [`path_timing::Table`] plans.
///
/// It is made by [`Arm::path`], which has looked at all of it. The next one goes on from it without
/// a stop where the directions of their curves agree, as those of a line and a blend do, unless the
/// curve's own corner is a stop; by how much a joint may jump [`with_corner`](Self::with_corner)
/// says.
///
/// ```
/// use path_timing::{Accuracy, AxisLimits, Curve, Knot, Table};
/// use scara_kin::{Arm, ArmPath, Elbow};
///
/// let arm = Arm::new(132.0, 132.0)?; // mm
/// let line = Curve::line([-80.0, 100.0], [80.0, 100.0])?;
/// let path = arm.path(line, Elbow::Right)?;
/// let joint = AxisLimits { speed: 3.0, acceleration: 30.0, jerk: None }; // rad, s
/// let accuracy = Accuracy { min_segments: 8, max_departure: 0.01, max_time_ratio: f64::INFINITY };
/// let mut knots = [Knot::default(); 100];
/// let table = Table::plan_within([path], [joint; 2], accuracy, ArmPath::departure, &mut knots)?;
/// for row in table.rows() {
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
    corner: Corner<[f64; 2]>,
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

    /// The path with another corner at its end, such as the start-stop speeds of its motors in
    /// rad/s. At first it is smooth, or a stop where that of the curve is one.
    #[must_use]
    pub const fn with_corner(mut self, corner: Corner<[f64; 2]>) -> Self {
        self.corner = corner;
        self
    }

    /// The joints at the arc length `s`.
    ///
    /// # Errors
    /// [`ArmPathError::Unreachable`] where a joint passes an end of its range by what [`Arm::path`]
    /// leaves it, at most 1e-9 rad.
    pub fn joints(&self, s: f64) -> Result<Joints, ArmPathError> {
        let near = Joints::new(self.shoulder.near(s), self.elbow_angle);
        joints_at(&self.arm, &self.curve, self.elbow, s, near)
    }

    /// Joints and their slopes.
    fn turning(&self, s: f64) -> Result<(Joints, Vector2<f64>), ArmPathError> {
        let near = Joints::new(self.shoulder.near(s), self.elbow_angle);
        let at = self.curve.at(s);
        let point = at.point.into();
        let found = self
            .arm
            .inverse_with_slopes(point, at.tangent.into(), self.elbow, near);
        let (joints, slopes) =
            found.map_err(|reason| ArmPathError::Unreachable { s, point, reason })?;
        let slopes = slopes.ok_or(ArmPathError::Edge {
            s,
            point,
            distance: 0.0,
        })?;
        Ok((joints, slopes))
    }

    /// The most by which the tool leaves the curve on a segment of a table, in the unit of length.
    /// For [`Table::plan_within`](path_timing::Table::plan_within).
    ///
    /// Proof. Both joints run cubics, so the absolute angles a of both links do. The fourth
    /// derivative of each link is bounded by the largest of those of its angle, all at the ends or
    /// at the vertex:
    ///
    /// ```text
    /// d⁴/dt⁴ l·e^{ia} = l·e^{ia} (a'⁴ - 3a"² - 4a'a‴ - 6i a'²a")
    /// ```
    ///
    /// At both ends the tool is on the curve with a velocity along it; the rest is
    /// [`CurveMotion`](path_timing::CurveMotion).
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; 2]>) -> f64 {
        Swing::of(span, |joints| joints).departure(&self.arm, &self.curve)
    }
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

    fn tool_rate(&self, s: f64) -> f64 {
        self.curve.tool_rate(s)
    }

    fn corner(&self) -> Corner<[f64; 2]> {
        self.corner
    }

    fn check(&self, span: &Span<[f64; 2]>) -> Result<(), ArmPathError> {
        Swing::of(span, |joints| joints).check(&self.arm, RANGE_SLACK)
    }
}
