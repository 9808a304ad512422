//! A disc that is turned with the curve, as a third axis with limits of its own.

use nalgebra::Vector2;
use path_timing::{Corner, Path, PathPoint, Span, ToolLimits};
use trig_kernels::atan2;

use super::swing::{RANGE_SLACK, Swing};
use super::turns::Turns;
use super::{ArmPath, ArmPathError};
use crate::limits::half_turn;
use crate::{Joints, TangentError};

/// A path of shoulder, elbow and a disc on the forearm that stays tangent to the curve, in radians;
/// see [`TangentTool`](crate::TangentTool) for its angle.
///
/// ```text
/// θ3 = heading - (base rotation + shoulder + elbow)
/// θ3' = κ - shoulder' - elbow'
/// ```
///
/// κ is the curvature, signed. The disc is an axis like others: where the curve bends more than the
/// disc can follow, all slow down. A corner has no heading: it is smoothed
/// ([`Smoothed`](path_timing::Smoothed)), or the end of a path, where the disc is lifted and turned
/// to the start of the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscPath {
    arm_path: ArmPath,
    heading: Turns,
    /// From the heading against the forearm to the angle of the disc: the base's rotation, and
    /// whole turns.
    offset: f64,
    /// Its angle at the start.
    start: f64,
}

/// How far the disc may stand from its first angle, in radians, to begin with its own: what
/// rounding leaves between the end of one curve and the start of the next.
const SAME: f64 = 1e-9;

/// Shortest walk along a curve whose headings are noted, in steps; more where it bends.
const STEPS: f64 = 128.0;

/// Most that the heading turns in a step, in radians.
const STEP: f64 = 0.5;

/// Shortest step, as a fraction of the curve: next to a cusp the curvature knows no bound.
const MIN_STEP: f64 = 1e-12;

impl ArmPath {
    /// The path with a disc that stands at the angle `tool_angle` before, in radians: it begins at
    /// the nearest whole turn to that, or there to the last bit where only rounding is between.
    ///
    /// # Errors
    /// [`ArmPathError::Turns`], [`ArmPathError::Disc`] for an angle that is not finite.
    pub fn with_disc(self, tool_angle: f64) -> Result<DiscPath, ArmPathError> {
        let start = self.joints(0.0)?;
        let heading = direction(self.curve.at(0.0).tangent);
        let base = self.arm.base().rotation;
        let raw = heading - atan2(base.im, base.re) - start.shoulder - start.elbow;
        // What the disc turns by at the start: at most half a turn.
        let turned = half_turn(raw - tool_angle);
        let offset = turned + tool_angle - raw;
        if !offset.is_finite() {
            let reason = TangentError::OutOfRange {
                name: "starting angle",
                value: tool_angle,
                largest: crate::range::largest_angle(),
            };
            return Err(ArmPathError::Disc { s: 0.0, reason });
        }
        let offset = offset - atan2(base.im, base.re);
        Ok(DiscPath {
            heading: headings(&self, heading)?,
            arm_path: self,
            offset,
            start: if turned.abs() <= SAME {
                tool_angle
            } else {
                tool_angle + turned
            },
        })
    }
}

/// The heading of the curve all along, from that at its start.
fn headings(path: &ArmPath, start: f64) -> Result<Turns, ArmPathError> {
    let (curve, mut heading, mut s) = (&path.curve, Turns::new(start), 0.0);
    let mut last = start;
    while s < curve.length() {
        let at = curve.at(s);
        let (first, second) = (Vector2::from(at.tangent), Vector2::from(at.curvature));
        let (most, least) = (curve.length() / STEPS, curve.length() * MIN_STEP);
        let step = (STEP * first.norm() / second.norm()).max(least).min(most);
        s = (s + step).min(curve.length());
        last += half_turn(direction(curve.at(s).tangent) - last);
        if !heading.add(s, last) {
            return Err(ArmPathError::Turns { s });
        }
    }
    Ok(heading)
}

/// The angle of a direction, in -π..=π.
fn direction([x, y]: [f64; 2]) -> f64 {
    atan2(y, x)
}

impl DiscPath {
    /// The path of the arm alone.
    #[must_use]
    pub const fn arm_path(&self) -> &ArmPath {
        &self.arm_path
    }

    /// As [`ArmPath::departure`]: the disc's angle has no part in where the tool is.
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; 3]>) -> f64 {
        let path = &self.arm_path;
        arm_swing(span).departure(&path.arm, &path.curve)
    }
}

/// The arm on a segment of a table with the disc.
fn arm_swing(span: &Span<[f64; 3]>) -> Swing {
    Swing::of(span, |[shoulder, elbow, _]| [shoulder, elbow])
}

impl Path for DiscPath {
    type Axes = [f64; 3];
    type Error = ArmPathError;

    fn length(&self) -> f64 {
        self.arm_path.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 3]>, ArmPathError> {
        let (Joints { shoulder, elbow }, slopes) = self.arm_path.turning(s)?;
        let at = self.arm_path.curve.at(s);
        let near = self.heading.near(s);
        let heading = near + half_turn(direction(at.tangent) - near);
        let (first, second) = (Vector2::from(at.tangent), Vector2::from(at.curvature));
        let bend = first.perp(&second) / first.norm_squared();
        let tool_angle = if s <= 0.0 {
            self.start
        } else {
            heading + self.offset - shoulder - elbow
        };
        Ok(PathPoint {
            position: [shoulder, elbow, tool_angle],
            slope: [slopes.x, slopes.y, bend - slopes.x - slopes.y],
        })
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.arm_path.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        self.arm_path.tool_rate(s)
    }

    fn corner(&self) -> Corner<[f64; 3]> {
        self.arm_path.corner().of_other_axes()
    }

    fn check(&self, span: &Span<[f64; 3]>) -> Result<(), ArmPathError> {
        arm_swing(span).check(&self.arm_path.arm, RANGE_SLACK)
    }
}
