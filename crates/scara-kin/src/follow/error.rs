//! Why a curve cannot be followed.

use core::fmt::{Display, Formatter};

use nalgebra::RealField;

use super::CurvePlace;
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
        /// The first such place.
        place: CurvePlace<T>,
        /// Why.
        reason: InverseError<T>,
    },
    /// A joint would have to turn at once by more than any number of waypoints can
    /// follow: the curve passes the base, or almost.
    Jump {
        /// The place from which no step is short enough.
        place: CurvePlace<T>,
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
            Self::Unreachable { place, reason } => write!(f, "{place}: {reason}"),
            Self::Jump { place } => write!(f, "{place}: a joint would have to jump"),
        }
    }
}

impl<T: RealField + Copy> core::error::Error for FollowError<T> {}
