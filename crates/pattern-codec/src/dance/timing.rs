//! How long a frame is in force.

use core::num::NonZeroU32;

use thiserror::Error;

/// How long a frame is in force: ticks of a timer, and the period of that timer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Timing {
    pub(super) tick_us: NonZeroU32,
    pub(super) frame_ticks: NonZeroU32,
}

impl Timing {
    /// 200 ticks of 1 ms \[Dancer\].
    pub const DEFAULT: Self = match (NonZeroU32::new(1000), NonZeroU32::new(200)) {
        (Some(tick_us), Some(frame_ticks)) => Self {
            tick_us,
            frame_ticks,
        },
        // A constant: the compiler would stop here, never a program.
        _ => unreachable!(),
    };

    /// A tick in us, and the ticks of a frame.
    ///
    /// # Errors
    /// [`ZeroPeriod`] when one of them is 0.
    pub const fn new(tick_us: u32, frame_ticks: u32) -> Result<Self, ZeroPeriod> {
        match (NonZeroU32::new(tick_us), NonZeroU32::new(frame_ticks)) {
            (Some(tick_us), Some(frame_ticks)) => Ok(Self {
                tick_us,
                frame_ticks,
            }),
            _ => Err(ZeroPeriod {
                tick_us,
                frame_ticks,
            }),
        }
    }

    /// Period of the timer, in us.
    #[must_use]
    pub const fn tick_us(self) -> u32 {
        self.tick_us.get()
    }

    /// Ticks of a frame.
    #[must_use]
    pub const fn frame_ticks(self) -> u32 {
        self.frame_ticks.get()
    }

    /// Period of a frame, in us.
    #[must_use]
    pub fn frame_us(self) -> u64 {
        // Below 2^64.
        u64::from(self.tick_us()).saturating_mul(self.frame_ticks().into())
    }
}

impl Default for Timing {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// A frame without length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("a frame of {frame_ticks} ticks of {tick_us} us has no length")]
#[non_exhaustive]
pub struct ZeroPeriod {
    /// Period of the timer, in us.
    pub tick_us: u32,
    /// Ticks of a frame.
    pub frame_ticks: u32,
}
