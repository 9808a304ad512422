//! Why a table cannot be made.

use crate::LimitError;
use crate::short::short;

/// Why a table cannot be made; nothing of it has been handed out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PtError {
    /// An axis would leave its stroke between two poses; the first such point.
    #[error("leg {leg}, point {point}: {reason}")]
    Limit {
        /// The leg, from 0.
        leg: usize,
        /// The point of the leg, or the end of the segment, from 0.
        point: u32,
        /// Locator, axis, value and by how much it is out.
        reason: LimitError,
    },
    /// A number of segments, a step or a distance error that is not positive and finite.
    #[error("segmentation by {}: not a positive finite number", short(.value))]
    Segmentation {
        /// The number given.
        value: f64,
    },
    /// A leg would have more segments than can be counted.
    #[error("leg {leg} would be divided into more than {max} segments")]
    TooFine {
        /// The leg, from 0.
        leg: usize,
        /// Largest number of segments of a leg.
        max: u32,
    },
    /// The memory given holds fewer points than the table has.
    #[error("the table needs {needed} points, there is room for {available}")]
    TooManyPoints {
        /// Points that are enough.
        needed: usize,
        /// Points for which there is memory.
        available: usize,
    },
    /// The allowed distance error is below what the positions are rounded to.
    #[error("distance error {} is below {}, what positions round off", short(.allowed), short(.min))]
    DistanceError {
        /// The distance error allowed.
        allowed: f64,
        /// The smallest distance error that can be asked for.
        min: f64,
    },
    /// Two points of a leg are not distinct: so near are they, or so late, that the float
    /// type has the same numbers for both.
    #[error("leg {leg}: point {point} and the one before have the same positions or times")]
    Indistinct {
        /// The leg, from 0.
        leg: usize,
        /// The point of the leg, from 0.
        point: u32,
    },
}
