//! How rows break a promise.

use trig_kernels::SixDigits;

/// A promise that rows break. `E` is the path's own error.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Violation<E> {
    /// A limit of an axis is passed in the segment up to a time.
    #[error("axis {axis}, up to {} s: {name} reaches {}, the limit is {}", SixDigits(*.time_s), SixDigits(*.value), SixDigits(*.limit))]
    Limit {
        /// The axis, from 0.
        axis: usize,
        /// Which: `speed`, `acceleration`, `jerk` or `velocity jump`.
        name: &'static str,
        /// Time of the row at the end of the segment.
        time_s: f64,
        /// The largest value.
        value: f64,
        /// The limit.
        limit: f64,
    },
    /// A limit of the tool is passed at a row, or by its mean acceleration from the row before.
    #[error("tool, up to {} s: {name} reaches {}, the limit is {}", SixDigits(*.time_s), SixDigits(*.value), SixDigits(*.limit))]
    Tool {
        /// Which: `feed` or `acceleration`.
        name: &'static str,
        /// Time of the row.
        time_s: f64,
        /// The largest value.
        value: f64,
        /// The limit.
        limit: f64,
    },
    /// A position or a velocity is not that of the path at the place that the row names.
    #[error("axis {axis}, at {} s: {name} is {} off the path", SixDigits(*.time_s), SixDigits(*.by))]
    OffPath {
        /// The axis, from 0.
        axis: usize,
        /// Which: `position` or `velocity`.
        name: &'static str,
        /// Time of the row.
        time_s: f64,
        /// By how much.
        by: f64,
    },
    /// The parameter of the path turns back on a segment: its speed at an end times the duration is
    /// negative or more than three times the length.
    #[error("up to {} s: the path turns back; {} times the length", SixDigits(*.time_s), SixDigits(*.times))]
    TurnsBack {
        /// Time of the row at the end of the segment.
        time_s: f64,
        /// The speed at an end times the duration, over the length.
        times: f64,
    },
    /// The tool departs by more than was promised.
    #[error("up to {} s: a departure of {}, {} is promised", SixDigits(*.time_s), SixDigits(*.departure), SixDigits(*.promised))]
    Departure {
        /// Time of the row at the end of the segment.
        time_s: f64,
        /// The departure's bound.
        departure: f64,
        /// The largest one promised.
        promised: f64,
    },
    /// A time is not after the one before by the duration of the segment.
    #[error("at {} s: the row does not follow the one before", SixDigits(*.time_s))]
    Time {
        /// Time of the row.
        time_s: f64,
    },
    /// Paths are not in their order, a parameter does not rise, or there is no such path.
    #[error("leg {leg}, at {}: the row does not follow the one before", SixDigits(*.s))]
    Order {
        /// The leg of the row.
        leg: usize,
        /// Its parameter.
        s: f64,
    },
    /// A motion between two rests is slower than it is promised to be.
    #[error("up to {} s: all limits allow {} times the speed", SixDigits(*.time_s), SixDigits(*.times))]
    Slow {
        /// Time of the rest.
        time_s: f64,
        /// How many times as fast it might be.
        times: f64,
    },
    /// The machine may not be there.
    #[error("leg {leg}, up to {}: {reason}", SixDigits(*.s))]
    Path {
        /// The leg.
        leg: usize,
        /// The parameter of the row.
        s: f64,
        /// What the path said.
        reason: E,
    },
}
