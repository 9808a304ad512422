//! Why a curve is no path of the joints.

use core::fmt::{Display, Formatter};

use nalgebra::Point2;

use crate::digits::Digits;
use crate::{InverseError, Joint, TangentError};

/// Why a curve is no path of the joints; nothing of it has been handed out.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ArmPathError {
    /// The curve is longer than any within the workspace, so that it leaves it.
    TooLong {
        /// Length of the curve.
        length: f64,
        /// Largest length, 100 times the reach: that of an arc of 100 rad.
        max: f64,
    },
    /// The tool cannot be at a place of the curve.
    Unreachable {
        /// Arc length up to there.
        s: f64,
        /// The first such point.
        point: Point2<f64>,
        /// Why.
        reason: InverseError,
    },
    /// The tool comes nearer to the edge of the workspace than a millionth of the reach: there the
    /// arm is straight or folded, so that a joint would turn without end, or its keep-out disc
    /// begins.
    Edge {
        /// Arc length up to there.
        s: f64,
        /// The point.
        point: Point2<f64>,
        /// Distance from the edge, in the unit of length.
        distance: f64,
    },
    /// Between two places of the curve, as rows of a table are, a joint would leave its range.
    Limit {
        /// Arc length of both places.
        s: [f64; 2],
        /// The joint.
        joint: Joint,
        /// Where it is farthest beyond the range, in radians.
        angle: f64,
        /// Lower end of its range, in radians.
        min: f64,
        /// Upper end of its range, in radians.
        max: f64,
    },
    /// Between two rows of a table the tool would enter the keep-out disc.
    KeepOut {
        /// Arc length of both rows.
        s: [f64; 2],
        /// Where it is nearest to the base, in the unit of length.
        distance: f64,
        /// The radius of the disc.
        radius: f64,
    },
    /// The shoulder or the disc turns by more than three times on one curve.
    Turns {
        /// Arc length up to there.
        s: f64,
    },
    /// The disc has no angle.
    Disc {
        /// Arc length up to there.
        s: f64,
        /// Why.
        reason: TangentError,
    },
}

impl Display for ArmPathError {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::TooLong { length, max } => write!(
                f,
                "the curve is {} long, within the workspace at most {}",
                Digits(*length),
                Digits(*max)
            ),
            Self::Unreachable { s, point, reason } => write!(f, "{}: {reason}", At(*s, *point)),
            Self::Edge { s, point, distance } => write!(
                f,
                "{}: {} from the edge of the workspace, where the arm is straight or folded or its keep-out disc begins",
                At(*s, *point),
                Digits(*distance)
            ),
            Self::Limit {
                s,
                joint,
                angle,
                min,
                max,
            } => write!(
                f,
                "{}: {joint} turns to {} rad, outside its range {}..={} rad by {} rad",
                Between(*s),
                Digits(*angle),
                Digits(*min),
                Digits(*max),
                Digits((min - angle).max(angle - max))
            ),
            Self::KeepOut {
                s,
                distance,
                radius,
            } => write!(
                f,
                "{}: the tool comes to {} from the base, into the keep-out disc of radius {} by {}",
                Between(*s),
                Digits(*distance),
                Digits(*radius),
                Digits(radius - distance)
            ),
            Self::Turns { s } => write!(
                f,
                "at {} of the curve: a joint has turned more than three times",
                Digits(*s)
            ),
            Self::Disc { s, reason } => write!(f, "at {} of the curve: {reason}", Digits(*s)),
        }
    }
}

impl core::error::Error for ArmPathError {}

/// From one place of a curve to another.
struct Between([f64; 2]);

impl Display for Between {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        let [from, to] = self.0.map(Digits);
        write!(f, "from {from} to {to} of the curve")
    }
}

/// A place of a curve.
struct At(f64, Point2<f64>);

impl Display for At {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        let [s, x, y] = [self.0, self.1.x, self.1.y].map(Digits);
        write!(f, "at {s} of the curve, ({x}, {y})")
    }
}
