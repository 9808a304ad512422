//! An arm of two links.

use core::fmt::{self, Display, Formatter};

use path_timing::{AxisLimits, Curve, Span};
use scara_kin::{
    Arm, ArmPathError, ArmPathF32, Elbow, GeometryError, InverseError, JointRange, Joints, Limits,
};

use super::reason::{Reasoned, out_of_range};
use super::{Joint, Kinematics, Unit, turned};
use crate::settings_error::SettingsError;

/// Segments of a line: so many, and others for what the joints turn, all added up. At a constant
/// feed a third of them would do; where a hold ends, the joints go straight from row to row.
const LEAST_SEGMENTS: f64 = 6.0;
const SEGMENTS_PER_RAD: f64 = 6.0;
/// Farthest that a line may begin from the joints, in radians: rounding.
const START_TOLERANCE: f64 = 1e-6;

/// What a person sets for an arm as a whole.
#[derive(Clone, Copy, Debug)]
pub struct ArmGeometry {
    /// Lengths of upper arm and forearm, in mm.
    pub links_mm: [f64; 2],
    /// The side that the elbow is on.
    pub elbow: Elbow,
}

/// An arm of two links, shoulder and elbow.
#[derive(Clone, Debug)]
pub struct TwoLinkArm {
    arm: Arm,
    elbow: Elbow,
}

/// Why a curve is no path of the arm.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ArmPathRefusal {
    /// The tool cannot be somewhere.
    #[error("{}", InWords(.0))]
    Path(#[from] ArmPathError),
    /// The elbow is on the other side.
    #[error("the elbow is on the other side, jog it over")]
    OtherSide,
    /// The arm is out of the range of `f32`.
    #[error(transparent)]
    Geometry(#[from] GeometryError<f32>),
}

struct InWords<'e>(&'e ArmPathError);

impl Display for InWords<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt_reason(f)
    }
}

impl Reasoned for ArmPathError {
    fn fmt_reason(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Unreachable { s, reason, .. } => match reason {
                InverseError::JointLimit {
                    joint,
                    angle,
                    min,
                    max,
                    ..
                } => out_of_range(f, s, joint, angle, [min, max], Unit::Degrees),
                reason => write!(f, "after {s:.3} mm {reason}"),
            },
            Self::Limit {
                s: [s, _],
                joint,
                angle,
                min,
                max,
            } => out_of_range(f, s, joint, angle, [min, max], Unit::Degrees),
            reason => reason.fmt(f),
        }
    }
}

impl Kinematics<2> for TwoLinkArm {
    const NAME: &'static str = "arm";
    const AXES: [&'static str; 2] = ["shoulder", "elbow"];
    const ONE_AXIS: &'static str = "`shoulder` or `elbow`";
    const HAS_ARCS: bool = false;
    const IS_CARTESIAN: bool = false;

    type Geometry = ArmGeometry;
    type Axis = Joint;
    type Path = ArmPathF32;
    type NoPath = ArmPathRefusal;
    type NoPlace = core::convert::Infallible;

    fn new(geometry: &ArmGeometry, ranges: [[f64; 2]; 2]) -> Result<Self, SettingsError> {
        let [upper, fore] = geometry.links_mm;
        let [shoulder, elbow] = ranges.map(|[min, max]| JointRange::new(min, max));
        let limits = Limits {
            shoulder: shoulder?,
            elbow: elbow?,
        };
        Ok(Self {
            arm: Arm::new(upper, fore)?.with_limits(limits),
            elbow: geometry.elbow,
        })
    }

    fn tool_mm(&self, [shoulder, elbow]: [f64; 2]) -> Result<[f64; 2], Self::NoPlace> {
        let tool = self.arm.forward(Joints::new(shoulder, elbow));
        Ok([tool.x, tool.y])
    }

    fn path(
        &self,
        line: Curve<2>,
        [shoulder, elbow]: [f64; 2],
        _: &[AxisLimits; 2],
    ) -> Result<(ArmPathF32, f64), ArmPathRefusal> {
        let joints = Joints::new(shoulder, elbow);
        let path = self.arm.path_from(line, self.elbow, joints)?;
        let start = path.joints(0.0)?;
        if (start - joints).amax() > START_TOLERANCE {
            return Err(ArmPathRefusal::OtherSide);
        }
        let turned = turned(path.curve().length(), |s| {
            path.joints(s).map(|at| [at.shoulder, at.elbow])
        });
        Ok((path.in_f32()?, LEAST_SEGMENTS + SEGMENTS_PER_RAD * turned))
    }

    fn departure(path: &ArmPathF32, span: &Span<[f64; 2]>) -> f64 {
        path.departure(span)
    }

    fn fmt_reach(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (inner, outer) = (self.arm.inner_reach(), self.arm.reach());
        write!(f, "reach {inner:.1} to {outer:.1} mm, ")
    }
}
