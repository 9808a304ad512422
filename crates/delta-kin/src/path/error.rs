//! Why a curve is no path of the arms.

use core::fmt;

use nalgebra::Point3;
use path_timing::CurveError;

use crate::rounded::Rounded;
use crate::{Arm, InverseError, PoseError};

/// Why a curve is no path of the arms; nothing of it has been handed out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DeltaPathError {
    /// There is no such curve.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The curve is longer than any within the workspace, so that it leaves it.
    #[error("the curve is {} long, within the workspace at most {}", Rounded(*.length), Rounded(*.max))]
    TooLong {
        /// Length of the curve.
        length: f64,
        /// Largest length, 100 times the span: that of an arc of 100 rad.
        max: f64,
    },
    /// The platform cannot be at a place of the curve.
    #[error("{}: {reason}", At(*.s, *.point))]
    Unreachable {
        /// Arc length up to there.
        s: f64,
        /// The first such point.
        point: Point3<f64>,
        /// Why.
        reason: InverseError,
    },
    /// The platform comes nearer to the edge of the workspace or to a singularity than a millionth
    /// of the machine's span.
    #[error("{}: clearance {}", At(*.s, *.point), Rounded(*.clearance))]
    Edge {
        /// Arc length up to there.
        s: f64,
        /// The first such point.
        point: Point3<f64>,
        /// The clearance there, in the unit of length.
        clearance: f64,
    },
    /// An arm would have to jump by a whole turn: at π from straight down, or from one end of a
    /// range of a whole turn to the other.
    #[error("{}: {arm} would have to jump by a whole turn", At(*.s, *.point))]
    Turn {
        /// Arc length up to there.
        s: f64,
        /// The point.
        point: Point3<f64>,
        /// The arm.
        arm: Arm,
    },
    /// Between two rows of a table an arm would leave its range.
    #[error(
        "{}: {arm} turns to {} rad, outside its range {}..={} rad by {} rad",
        Between(*.s), Rounded(*.angle), Rounded(*.min), Rounded(*.max),
        Rounded((.min - .angle).max(.angle - .max))
    )]
    Range {
        /// Arc length of both rows.
        s: [f64; 2],
        /// The arm.
        arm: Arm,
        /// Where it is farthest beyond the range, as it reads, in radians.
        angle: f64,
        /// Lower end of its range, in radians.
        min: f64,
        /// Upper end of its range, in radians.
        max: f64,
    },
    /// Between two rows of a table rods could swivel too far for their ball joints.
    #[error(
        "{}: {arm} could swivel by {} rad at its ball joints, more than {} rad",
        Between(*.s), Rounded(*.swivel), Rounded(*.max)
    )]
    BallJoint {
        /// Arc length of both rows.
        s: [f64; 2],
        /// The arm.
        arm: Arm,
        /// How far the rods could swivel out of the arm's plane, in radians.
        swivel: f64,
        /// How far they may, in radians.
        max: f64,
    },
    /// Two rows of a table are too far apart to know where the platform is between them, and
    /// whether the ball joints let it: more segments are needed.
    #[error("{}: too long a segment to tell whether ball joints hold; use more segments", Between(*.s))]
    TooCoarse {
        /// Arc length of both rows.
        s: [f64; 2],
    },
    /// The arms' rates do not follow from the platform's.
    #[error("at {} of the curve: {reason}", Rounded(*.s))]
    Singular {
        /// Arc length up to there.
        s: f64,
        /// Why.
        reason: PoseError,
    },
}

/// From one place of a curve to another.
struct Between([f64; 2]);

impl fmt::Display for Between {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [from, to] = self.0.map(Rounded);
        write!(f, "from {from} to {to} of the curve")
    }
}

/// A place of a curve.
struct At(f64, Point3<f64>);

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.1.coords.into();
        let [s, x, y, z] = [self.0, x, y, z].map(Rounded);
        write!(f, "at {s} of the curve, ({x}, {y}, {z})")
    }
}
