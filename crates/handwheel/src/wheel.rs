//! From wheel pulses to an even speed.

use core::time::Duration;

use thiserror::Error;

/// Time in which the pulses of one sample are counted [Alignment 2010].
pub const SAMPLE: Duration = Duration::from_millis(200);

/// Bins for the counts of a sample: whoever turns the wheel about evenly gets an even speed.
///
/// The range between 0 and `max` is cut into `bins` equal bins, and every count in a bin stands
/// for the bin's middle [Alignment 2010]:
///
/// ```text
///        0                                            n = 0
/// f(n) = sign(n) (max/2m + floor(|n| m / max) max/m)  0 < |n| < max      m bins
///        sign(n) max                                  |n| >= max
/// ```
/// The printed formula leaves `|n| = max` open and takes the floor of the signed count, so that
/// `f(-5)` is not `-f(5)`; both are corrected here. `f` is odd, monotone and never above `max`,
/// and a count in the middle of a bin stays what it is. Everything is exact in integers: `f(n)`
/// is [`level`](Self::level) half bins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WheelQuantiser {
    max: u32,
    bins: u16,
}

/// Why a quantiser cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WheelError {
    /// No count is below a maximum of 0.
    #[error("the maximum is 0 counts")]
    NoRange,
    /// Bins without a count, or no bin at all.
    #[error("{bins} bins for {max} counts; 1 to {max} are possible")]
    Bins {
        /// Bins asked for.
        bins: u16,
        /// Counts from 0 to the end of the range.
        max: u32,
    },
}

impl WheelQuantiser {
    /// `max` counts per sample, and all above, are full speed; below it there are `bins` bins.
    ///
    /// # Errors
    /// [`WheelError`] unless `1 <= bins <= max`.
    pub const fn new(max: u32, bins: u16) -> Result<Self, WheelError> {
        if max == 0 {
            return Err(WheelError::NoRange);
        }
        if bins == 0 || bins as u32 > max {
            return Err(WheelError::Bins { bins, max });
        }
        Ok(Self { max, bins })
    }

    /// Counts of full speed.
    #[must_use]
    pub const fn max(&self) -> u32 {
        self.max
    }

    /// Bins between 0 and full speed.
    #[must_use]
    pub const fn bins(&self) -> u16 {
        self.bins
    }

    /// `f(n)` in half bins: 0, an odd number of either sign, or `2 bins` at full speed.
    ///
    /// ```text
    /// level = 2 f(n) m / max
    /// ```
    #[must_use]
    pub fn level(&self, counts: i32) -> i32 {
        let size = counts.unsigned_abs();
        if size == 0 {
            return 0;
        }
        let full = i32::from(self.bins).saturating_mul(2);
        let level = if size >= self.max {
            full
        } else {
            let scaled = u64::from(size).saturating_mul(self.bins.into());
            let bin = scaled.checked_div(self.max.into()).unwrap_or_default();
            // Below `bins`, which has 16 bits.
            i32::try_from(bin)
                .unwrap_or(full)
                .saturating_mul(2)
                .saturating_add(1)
        };
        if counts < 0 {
            level.saturating_neg()
        } else {
            level
        }
    }

    /// The part of `full` that the counts stand for, `full f(n) / max`, to the nearest unit,
    /// halves towards zero. In whatever unit `full` is.
    #[must_use]
    pub fn share(&self, counts: i32, full: u32) -> i64 {
        let level = self.level(counts);
        let halves = u64::from(self.bins).saturating_mul(2);
        // At most 2^17 * 2^32.
        let scaled = u64::from(level.unsigned_abs()).saturating_mul(full.into());
        let rounding = u64::from(self.bins).saturating_sub(1);
        let nearest = scaled
            .saturating_add(rounding)
            .checked_div(halves)
            .unwrap_or_default();
        // At most `full`.
        let share = i64::try_from(nearest).unwrap_or(i64::MAX);
        if counts < 0 {
            share.saturating_neg()
        } else {
            share
        }
    }

    /// `f(n)` in counts, to the nearest whole one, halves towards zero. A second time it changes
    /// nothing.
    #[must_use]
    pub fn counts(&self, counts: i32) -> i64 {
        self.share(counts, self.max)
    }
}

/// Makes samples of [`SAMPLE`] out of a counter that is read whenever there is time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelSampler {
    since: Duration,
    counter: u32,
}

impl WheelSampler {
    /// Begins with the counter as it stands.
    #[must_use]
    pub const fn new(now: Duration, counter: u32) -> Self {
        Self {
            since: now,
            counter,
        }
    }

    /// The counts per [`SAMPLE`] since the last sample; `None` while it is not over.
    ///
    /// `counter` is the quadrature counter, which may wrap. Read late, the counts are those of the
    /// mean speed since, to the nearest towards zero: a stall of the caller is no jump of the
    /// speed.
    #[must_use]
    pub fn sample(&mut self, now: Duration, counter: u32) -> Option<i32> {
        // In whole nanoseconds: `Duration`'s own subtraction has a way to a panic.
        let elapsed = now.as_nanos().saturating_sub(self.since.as_nanos());
        if elapsed < SAMPLE.as_nanos() {
            return None;
        }
        let moved = counter.wrapping_sub(self.counter).cast_signed();
        *self = Self::new(now, counter);
        let scaled = i64::from(moved).saturating_mul(SAMPLE.subsec_nanos().into());
        // After some 292 years nothing is left of any count.
        let elapsed = i64::try_from(elapsed).unwrap_or(i64::MAX);
        let mean = scaled.checked_div(elapsed)?;
        i32::try_from(mean).ok()
    }

    /// When the sample is over.
    #[must_use]
    pub fn due(&self) -> Duration {
        self.since.saturating_add(SAMPLE)
    }
}
