//! Why axes cannot run a path.

use crate::LimitError;
use crate::short::short;

/// Why the axes cannot run a path between two poses.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BodyPathError {
    /// On a leg an axis would leave its stroke.
    #[error("from pose {leg} to the next, at {} of the way: {reason}", short(.part))]
    Leg {
        /// The leg, from 0, which begins at the pose of the same number.
        leg: usize,
        /// The fraction of the leg where the segment begins, 0..=1.
        part: f64,
        /// Locator, axis, value and by how much it is out.
        reason: LimitError,
    },
    /// Where a pose is rounded an axis would leave its stroke.
    #[error("where pose {pose} is rounded, at {} of the rounding: {reason}", short(.part))]
    Blend {
        /// The pose, from 0.
        pose: usize,
        /// The fraction of the rounding where the segment begins, 0..=1.
        part: f64,
        /// Locator, axis, value and by how much it is out.
        reason: LimitError,
    },
}
