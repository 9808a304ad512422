//! A rotary Delta.

use core::fmt::{self, Display, Formatter};

use delta_kin::{
    Arm, ArmRange, Delta, DeltaPath, DeltaPathError, Dimensions, ForwardError, InverseError,
};
use path_timing::{AxisLimits, Curve, Path, Span};

use super::reason::{Reasoned, out_of_range};
use super::{Joint, Kinematics, Unit, turned};
use crate::settings_error::SettingsError;

/// Segments of a line: so many, and others for what the arms turn, all three added up. Each takes
/// an RP2040 30 ms: as few as a hold allows, where the arms go straight from row to row.
const LEAST_SEGMENTS: f64 = 5.0;
const SEGMENTS_PER_RAD: f64 = 3.0;
/// Farthest that angles may be from those of their own point, in radians: rounding.
const SAME_ANGLES: f64 = 1e-6;

/// What a person sets for a Delta as a whole.
#[derive(Clone, Copy, Debug)]
pub struct DeltaGeometry {
    /// From the axis of the base to a motor, in mm.
    pub base_mm: f64,
    /// From the platform's centre to a ball joint, in mm.
    pub platform_mm: f64,
    /// Length of the upper arms, in mm.
    pub upper_mm: f64,
    /// Length of the lower arms, in mm.
    pub lower_mm: f64,
    /// How far the rods may swivel out of the plane of their arm, in degrees.
    pub max_swivel_deg: f64,
}

/// A rotary Delta: three arms, their angles from straight down, outward and up positive.
#[derive(Clone, Debug)]
pub struct RotaryDelta {
    delta: Delta,
    geometry: DeltaGeometry,
}

/// Why the platform is nowhere with some angles, or elsewhere.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DeltaPlaceError {
    /// The arms do not meet.
    #[error(transparent)]
    Apart(#[from] ForwardError),
    /// The platform may not be there.
    #[error("{}", InWords(.0))]
    Place(InverseError),
    /// Other angles belong to that place: an arm has been turned through where it is stretched.
    #[error("{arm} would have its elbow on the other side")]
    OtherSide {
        /// The first such arm.
        arm: Arm,
    },
}

/// Why the platform cannot be at a place, in degrees.
struct InWords<'e>(&'e InverseError);

impl Display for InWords<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self.0 {
            InverseError::BallJoint { arm, swivel, max } => {
                let [swivel, max] = [swivel, max].map(f64::to_degrees);
                write!(
                    f,
                    "{arm} would swivel by {swivel:.3} degrees at its ball joints, more than {max:.3}"
                )
            }
            reason => reason.fmt(f),
        }
    }
}

impl Reasoned for DeltaPathError {
    fn fmt_reason(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Unreachable { s, reason, .. } => match reason {
                InverseError::JointLimit {
                    arm,
                    angle,
                    min,
                    max,
                } => out_of_range(f, s, arm, angle, [min, max], Unit::Degrees),
                reason => write!(f, "after {s:.3} mm {}", InWords(&reason)),
            },
            Self::Range {
                s: [s, _],
                arm,
                angle,
                min,
                max,
            } => out_of_range(f, s, arm, angle, [min, max], Unit::Degrees),
            Self::Edge { s, clearance, .. } => write!(
                f,
                "after {s:.3} mm the platform is {clearance:.4} mm from the edge of the workspace"
            ),
            reason => reason.fmt(f),
        }
    }
}

/// Why a curve is no path of the Delta.
#[derive(Debug, thiserror::Error)]
#[error("{}", PathInWords(.0))]
pub struct DeltaPathRefusal(#[from] DeltaPathError);

struct PathInWords<'e>(&'e DeltaPathError);

impl Display for PathInWords<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt_reason(f)
    }
}

impl Kinematics<3> for RotaryDelta {
    const NAME: &'static str = "delta";
    const AXES: [&'static str; 3] = ["arm1", "arm2", "arm3"];
    const ONE_AXIS: &'static str = "`arm1`, `arm2` or `arm3`";
    const HAS_ARCS: bool = false;
    const IS_CARTESIAN: bool = false;

    type Geometry = DeltaGeometry;
    type Axis = Joint;
    type Path = DeltaPath;
    type NoPath = DeltaPathRefusal;
    type NoPlace = DeltaPlaceError;

    fn new(geometry: &DeltaGeometry, ranges: [[f64; 2]; 3]) -> Result<Self, SettingsError> {
        let delta = Delta::new(Dimensions {
            base: geometry.base_mm,
            platform: geometry.platform_mm,
            upper: geometry.upper_mm,
            lower: geometry.lower_mm,
        })?;
        let [first, second, third] = ranges.map(|[min, max]| ArmRange::new(min, max));
        let delta = delta.with_ranges([first?, second?, third?]);
        Ok(Self {
            delta: delta.with_ball_joints(geometry.max_swivel_deg.to_radians())?,
            geometry: *geometry,
        })
    }

    fn tool_mm(&self, angles: [f64; 3]) -> Result<[f64; 3], DeltaPlaceError> {
        Ok(self.delta.forward(angles)?.coords.into())
    }

    fn check(&self, angles: [f64; 3]) -> Result<(), DeltaPlaceError> {
        let point = self.delta.forward(angles)?;
        let found = self.delta.inverse(point).map_err(DeltaPlaceError::Place)?;
        let mut pairs = Arm::ALL.into_iter().zip(angles.into_iter().zip(&found));
        // Written so that NaN is elsewhere.
        match pairs.find(|(_, (angle, found))| {
            let is_same = (angle - *found).abs() <= SAME_ANGLES;
            !is_same
        }) {
            None => Ok(()),
            Some((arm, _)) => Err(DeltaPlaceError::OtherSide { arm }),
        }
    }

    fn path(
        &self,
        curve: Curve<3>,
        _: [f64; 3],
        _: &[AxisLimits; 3],
    ) -> Result<(DeltaPath, f64), DeltaPathRefusal> {
        let path = self.delta.path(curve)?;
        let turned = turned(curve.length(), |s| path.point(s).map(|at| at.position));
        Ok((path, LEAST_SEGMENTS + SEGMENTS_PER_RAD * turned))
    }

    fn departure(path: &DeltaPath, span: &Span<[f64; 3]>) -> f64 {
        path.departure(span)
    }

    fn fmt_reach(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let DeltaGeometry {
            base_mm,
            platform_mm,
            upper_mm,
            lower_mm,
            ..
        } = self.geometry;
        write!(
            f,
            "radii {base_mm:.1} and {platform_mm:.1}, arms {upper_mm:.1} and {lower_mm:.1} mm, "
        )
    }
}
