//! Why speeds or forces do not follow from each other.

use nalgebra::RealField;

use crate::Arm;
use crate::rounded::Rounded;

/// Why speeds or forces do not follow from each other.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PoseError<T: RealField + Copy = f64> {
    /// A speed or force given, or what follows from it, is infinite or not a number.
    #[error("{name} ({}, {}, {}) is not finite", Rounded(*.x), Rounded(*.y), Rounded(*.z))]
    NotFinite {
        /// `velocity`, `rates`, `force`, `torques` or `rod forces`.
        name: &'static str,
        /// Its first component.
        x: T,
        /// Its second component.
        y: T,
        /// Its third component.
        z: T,
    },
    /// An arm is stretched or folded, its upper arm in line with the rods as seen perpendicular to
    /// its plane: turning it does not move the platform along the rods.
    #[error("{arm} is stretched or folded: its lever is {}", Rounded(*.lever))]
    Serial {
        /// The arm.
        arm: Arm,
        /// How far the platform moves along the rods, in length per radian.
        lever: T,
    },
    /// The three rods lie in a plane: the platform can move although no arm does.
    #[error("the three lower arms lie in a plane: the sine between them is {}", Rounded(*.sine))]
    Parallel {
        /// The sine of the smallest angle between a rod and the plane of the others, within
        /// rounding of zero.
        sine: T,
    },
}
