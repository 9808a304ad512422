//! Why a table cannot be made.

use crate::LimitError;

/// Why a table cannot be made; nothing of it has been handed out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PlanError<T = f64> {
    /// An axis would leave its stroke on the way; the first such point.
    #[error("leg {leg}, point {point}: {reason}")]
    Limit {
        /// The leg, from 0.
        leg: usize,
        /// The point of the leg, or the end of the segment, from 0.
        point: u32,
        /// Locator, axis, value and by how much it is out.
        reason: LimitError<T>,
    },
    /// A number of parts, a step or a strain that is not positive and finite.
    #[error("cut by {value}: not a positive finite number")]
    Cut {
        /// The number given.
        value: T,
    },
    /// A leg would have more parts than can be counted.
    #[error("leg {leg} would be cut into more than {max} parts")]
    TooFine {
        /// The leg, from 0.
        leg: usize,
        /// Most parts of a leg.
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
    /// The allowed strain is below what the positions are rounded to.
    #[error("strain {allowed} is below {least}, what positions round off")]
    Strain {
        /// The strain allowed.
        allowed: T,
        /// The least strain that can be asked for.
        least: T,
    },
    /// A pace that is not above 0 and at most 1.
    #[error("a pace of {pace} is not above 0 and at most 1")]
    Pace {
        /// The pace given.
        pace: T,
    },
    /// A highest feed that is not positive and finite.
    #[error("a highest feed of {max} is not a positive finite number")]
    Feed {
        /// The feed given.
        max: T,
    },
}
