//! Why a table cannot be made.

use core::convert::Infallible;

use crate::LimitError;
use crate::short::short;

/// Why a table cannot be made; nothing of it has been handed out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PlanError {
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
    /// Two points of a leg cannot be told apart: so near are they, or so late, that the float
    /// type has the same numbers for both.
    #[error("leg {leg}: point {point} and the one before have the same positions or times")]
    Indistinct {
        /// The leg, from 0.
        leg: usize,
        /// The point of the leg, from 0.
        point: u32,
    },
    /// A speed scale that is above 1, or so low that times leave the range of the crate.
    #[error("a speed scale of {} is not within {}..=1", short(.scale), short(.min))]
    SpeedScale {
        /// The speed scale given.
        scale: f64,
        /// The lowest speed scale.
        min: f64,
    },
    /// A highest feed that is beyond the range of the crate.
    #[error("a highest feed of {} is not within {}..={}", short(.feed), short(.min), short(.max))]
    Feed {
        /// The feed given.
        feed: f64,
        /// The lowest.
        min: f64,
        /// The highest.
        max: f64,
    },
    /// Whatever else the planner of `path-timing` refuses.
    #[error("{0}")]
    Timing(path_timing::PlanError<Infallible>),
}

impl PlanError {
    /// What `path-timing` refuses, as an error of a platform; `number` is that of a leg
    /// that it was given.
    pub(crate) fn of_timing(
        error: path_timing::PlanError<Infallible>,
        number: impl Fn(usize) -> usize,
    ) -> Self {
        use path_timing::PlanError as Timing;

        match error {
            Timing::TooFine { leg, max } => Self::TooFine {
                leg: number(leg),
                max,
            },
            Timing::Memory { needed, available } => Self::TooManyPoints { needed, available },
            Timing::Indistinct { leg, knot } => Self::Indistinct {
                leg: number(leg),
                point: knot,
            },
            Timing::SpeedScale { scale, min } => Self::SpeedScale { scale, min },
            Timing::Feed { feed, min, max } => Self::Feed { feed, min, max },
            other => Self::Timing(other),
        }
    }
}
