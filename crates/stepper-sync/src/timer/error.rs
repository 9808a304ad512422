//! Why a timer cannot do what is asked.

use crate::Rate;
use core::time::Duration;
use thiserror::Error;

/// Why a timer cannot do what is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TimerError {
    /// A clock of 0 Hz.
    #[error("the clock is 0 Hz")]
    ZeroClock,
    /// Clocks per tick out of range.
    #[error("{value} clocks per tick, out of 1..={limit}")]
    ClocksPerTick {
        /// Clocks per tick given.
        value: u32,
        /// Most clocks per tick.
        limit: u32,
    },
    /// An empty list of prescalers.
    #[error("no prescaler to choose from")]
    NoPrescaler,
    /// Shortest interval out of range.
    #[error("shortest interval of {value} ticks, out of 1..={limit}")]
    MinTicks {
        /// Ticks given.
        value: u64,
        /// Half of the longest interval, in ticks.
        limit: u64,
    },
    /// Half a period shorter than half a tick.
    #[error(
        "half a period of {}/{} Hz is less than half a tick",
        rate.numerator(),
        rate.denominator()
    )]
    RateTooHigh {
        /// The rate given.
        rate: Rate,
    },
    /// An interval shorter than the timer's shortest.
    #[error("{ticks} ticks, less than the shortest interval of {limit}")]
    IntervalTooShort {
        /// Ticks asked for.
        ticks: u64,
        /// Shortest interval, in ticks.
        limit: u64,
    },
    /// An interval longer than the counter holds.
    #[error("{ticks} ticks, more than the {limit} of one period")]
    IntervalTooLong {
        /// Ticks asked for.
        ticks: u64,
        /// Longest interval, in ticks.
        limit: u64,
    },
    /// More ticks than 64 bits hold.
    #[error("{duration:?} is more than 2^64 ticks")]
    DurationTooLong {
        /// The span given.
        duration: Duration,
    },
    /// A reload value wider than the counter.
    #[error("reload {reload:#x}, more than the largest count {limit:#x}")]
    ReloadTooLarge {
        /// Value given.
        reload: u32,
        /// Largest count.
        limit: u64,
    },
    /// A count wider than the counter.
    #[error("count {count:#x}, more than the largest count {limit:#x}")]
    CountTooLarge {
        /// Count given.
        count: u32,
        /// Largest count.
        limit: u64,
    },
    /// The interrupt came after the end of the interval that it should start.
    #[error("{elapsed} ticks have passed of an interval of {ticks}")]
    TooLate {
        /// Ticks since the overflow.
        elapsed: u64,
        /// Interval asked for, in ticks.
        ticks: u64,
    },
    /// A counter that starts again by itself loses no latency that could be made up for.
    #[error(
        "a counter that starts anew at its compare register loses no latency: `reload` is exact"
    )]
    StartsAgain,
}
