//! Rows that a driver cannot follow.

use thiserror::Error;

/// Why a row is refused. Nothing of it has been put out then, and another may follow in its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RowError {
    /// Steps of the row before are still to be taken.
    #[error("row {row}, axis {axis}: steps of the row before are still to be taken")]
    Busy {
        /// Number of the row, from 0.
        row: u64,
        /// Index of the axis.
        axis: usize,
    },
    /// A row of no ticks that moves.
    #[error("row {row}, axis {axis}: moves in 0 ticks")]
    NoTime {
        /// Number of the row, from 0.
        row: u64,
        /// Index of the axis.
        axis: usize,
    },
    /// Faster than the driver takes steps.
    #[error(
        "row {row}, axis {axis}, tick {ticks}: a step every {interval_ticks} ticks, \
         fewer than {min_ticks}"
    )]
    TooFast {
        /// Number of the row, from 0.
        row: u64,
        /// Index of the axis.
        axis: usize,
        /// Where, in ticks since the start.
        ticks: u64,
        /// Ticks of a step at that velocity, rounded down.
        interval_ticks: u64,
        /// [`MinIntervals::step_ticks`](crate::MinIntervals::step_ticks) and 2 ticks for the
        /// rounding of both steps, 3 in [`JoinedSegments`](crate::JoinedSegments).
        min_ticks: u64,
    },
    /// Two steps in opposite directions come too soon after each other.
    #[error("row {row}, axis {axis}, tick {ticks}: steps back in fewer than {min_ticks} ticks")]
    ReversalTooQuick {
        /// Number of the row, from 0.
        row: u64,
        /// Index of the axis.
        axis: usize,
        /// Where, in ticks since the start.
        ticks: u64,
        /// [`MinIntervals::reversal_ticks`](crate::MinIntervals::reversal_ticks), and 2 ticks in
        /// [`JoinedSegments`](crate::JoinedSegments).
        min_ticks: u64,
    },
}
