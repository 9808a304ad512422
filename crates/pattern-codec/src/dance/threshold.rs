//! The threshold of the accumulators that turn speeds into half steps.

use thiserror::Error;

/// What an accumulator adds up for one half step, at least 128: 600 in \[Dancer\].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Threshold(u16);

impl Threshold {
    /// That of \[Dancer\].
    pub const DEFAULT: Self = Self(600);

    /// The lowest threshold: a speed of -128 then makes one half step in every tick.
    pub const MIN: Self = Self(128);

    /// Checks a threshold.
    ///
    /// # Errors
    /// [`ThresholdTooLow`] below 128.
    pub const fn new(threshold: u16) -> Result<Self, ThresholdTooLow> {
        if threshold < Self::MIN.0 {
            return Err(ThresholdTooLow { threshold });
        }
        Ok(Self(threshold))
    }

    /// The number.
    #[must_use]
    pub const fn get(self) -> u16 {
        self.0
    }
}

impl Default for Threshold {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// A threshold at which the highest speed would need more than one half step per tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("a threshold of {threshold}, min {}", Threshold::MIN.0)]
#[non_exhaustive]
pub struct ThresholdTooLow {
    /// The threshold.
    pub threshold: u16,
}
