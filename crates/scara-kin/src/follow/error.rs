//! Why a curve cannot be followed.

use core::fmt::{Display, Formatter};

use nalgebra::{Point2, RealField};

use crate::InverseError;
use crate::digits::Digits;

/// Why a curve cannot be followed; nothing of it has been handed out.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FollowError<T: RealField = f64> {
    /// The tolerance is not a length above the rounding: [`Arm::tolerance`](crate::Arm::tolerance)
    /// or, many turns from zero, that of the angles.
    Tolerance {
        /// The tolerance given.
        tolerance: T,
        /// What the tolerance must be above.
        rounding: T,
    },
    /// The curve has no point.
    Empty,
    /// The tool cannot be at a point of the curve.
    Unreachable {
        /// Number of the line, counted from 0.
        line: usize,
        /// The fraction of the line up to there.
        fraction: T,
        /// The first such point.
        point: Point2<T>,
        /// Why.
        reason: InverseError<T>,
    },
    /// No step is short enough: a joint would have to turn at once, since the curve passes the
    /// base, or almost.
    Singular {
        /// Number of the line, counted from 0.
        line: usize,
        /// The fraction of the line up to there.
        fraction: T,
        /// The point.
        point: Point2<T>,
    },
}

impl<T: RealField + Copy> Display for FollowError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Tolerance {
                tolerance,
                rounding,
            } => write!(
                f,
                "chord tolerance {} is not above the rounding {}",
                Digits(*tolerance),
                Digits(*rounding)
            ),
            Self::Empty => f.write_str("the curve has no point"),
            Self::Unreachable {
                line,
                fraction,
                point,
                reason,
            } => write!(f, "{}: {reason}", At(*line, *fraction, *point)),
            Self::Singular {
                line,
                fraction,
                point,
            } => write!(f, "{}: singular", At(*line, *fraction, *point)),
        }
    }
}

impl<T: RealField + Copy> core::error::Error for FollowError<T> {}

/// A point of a curve.
struct At<T: RealField>(usize, T, Point2<T>);

impl<T: RealField + Copy> Display for At<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        let [fraction, x, y] = [self.1, self.2.x, self.2.y].map(Digits);
        write!(f, "at {fraction} of line {}, ({x}, {y})", self.0)
    }
}
