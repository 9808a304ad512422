//! Why there is no shaper, and why a shaped motion ends.

use trig_kernels::SixDigits;

/// Why impulses are no shaper.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ShaperError {
    /// A mode whose numbers are not within their range.
    #[error("a mode's {name} of {} is not within {}..={}", SixDigits(*.value), SixDigits(*.min), SixDigits(*.max))]
    Mode {
        /// Which: `frequency` or `damping`.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// No impulse, or more than a shaper has.
    #[error("{count} impulses are not within 1..={max}")]
    Count {
        /// Impulses given.
        count: usize,
        /// The most.
        max: usize,
    },
    /// An amplitude that is not above 0: with it limits would not be kept.
    #[error("impulse {index}: an amplitude of {} is not above 0", SixDigits(*.amplitude))]
    Amplitude {
        /// The impulse, from 0.
        index: usize,
        /// Its amplitude.
        amplitude: f64,
    },
    /// A time that is not above the one before, or below 0.
    #[error("impulse {index}: a time of {} s does not rise from 0 on", SixDigits(*.time_s))]
    Time {
        /// The impulse, from 0.
        index: usize,
        /// Its time, in seconds.
        time_s: f64,
    },
}

/// Why a shaped motion has no next row. `E` is the error of the rows that are shaped.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ShapedError<E> {
    /// The motion has more rows within the longest delay than there is memory for. No row follows,
    /// and the machine may be moving: see [`Shaped::memory_for`](crate::Shaped::memory_for).
    #[error(
        "there are more rows within the longest delay than there is memory for, which is {available}"
    )]
    Memory {
        /// Rows for which there is memory.
        available: usize,
    },
    /// What the rows to be shaped say.
    #[error(transparent)]
    Rows(E),
}
