//! Why a table cannot be made.

use crate::LimitError;
use crate::pvt::Moving;
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
    /// Between two points of a PVT table an axis would leave its stroke.
    #[error("leg {leg}, at {} of it: {reason}", short(.part))]
    Stroke {
        /// The leg, from 0; of a blend the leg before it.
        leg: usize,
        /// The part of the leg, or of the blend, up to the first of both points, 0..=1.
        part: f64,
        /// Locator, axis, value and by how much it is out.
        reason: LimitError,
    },
    /// Whatever else the planner of `path-timing` refuses.
    #[error("{0}")]
    Timing(path_timing::PlanError<LimitError>),
}

impl PlanError {
    /// What `path-timing` refuses of legs and blends.
    pub(crate) fn of_timing<const N: usize>(
        error: path_timing::PlanError<LimitError>,
        moving: &Moving<'_, N>,
    ) -> Self {
        use path_timing::PlanError as Timing;

        match error {
            Timing::Path { leg, s, reason } => Self::Stroke {
                leg: moving.number(leg),
                part: moving.part(leg, s),
                reason,
            },
            Timing::TooFine { leg, max } => Self::TooFine {
                leg: moving.number(leg),
                max,
            },
            Timing::Memory { needed, available } => Self::TooManyPoints { needed, available },
            Timing::Indistinct { leg, knot } => Self::Indistinct {
                leg: moving.number(leg),
                point: knot,
            },
            other => Self::Timing(other),
        }
    }
}
