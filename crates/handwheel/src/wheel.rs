//! From wheel pulses to an even speed.

use core::num::{NonZeroU16, NonZeroU32, NonZeroU64};
use core::time::Duration;

use thiserror::Error;

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
    max: NonZeroU32,
    bins: NonZeroU16,
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
        match (NonZeroU32::new(max), NonZeroU16::new(bins)) {
            (None, _) => Err(WheelError::NoRange),
            (Some(most), Some(count)) if bins as u32 <= max => Ok(Self {
                max: most,
                bins: count,
            }),
            _ => Err(WheelError::Bins { bins, max }),
        }
    }

    /// Counts of full speed.
    #[must_use]
    pub const fn max(&self) -> u32 {
        self.max.get()
    }

    /// Bins between 0 and full speed.
    #[must_use]
    pub const fn bins(&self) -> u16 {
        self.bins.get()
    }

    /// `f(n)` in half bins: 0, an odd number of either sign, or `2 bins` at full speed.
    ///
    /// ```text
    /// level = 2 f(n) m / max
    /// ```
    #[must_use]
    pub fn level(&self, counts: i32) -> i64 {
        let bins = u64::from(self.bins());
        let level = match counts.unsigned_abs() {
            0 => 0,
            size if size >= self.max() => bins * 2,
            // The bin is below `bins`.
            size => u64::from(size) * bins / NonZeroU64::from(self.max) * 2 + 1,
        };
        signed(level, counts)
    }

    /// The speed that the counts ask for, in the unit of `full_speed`: to the nearest whole
    /// number, halves towards zero.
    ///
    /// ```text
    /// speed = full_speed f(n) / max
    /// ```
    #[must_use]
    pub fn speed(&self, counts: i32, full_speed: u32) -> i64 {
        let bins = NonZeroU64::from(self.bins);
        // At most 2^17 * 2^32.
        let half_bins = self.level(counts).unsigned_abs() * u64::from(full_speed);
        let nearest = (half_bins + bins.get() - 1) / bins / 2;
        signed(nearest, counts)
    }

    /// `f(n)` in counts, to the nearest whole one, halves towards zero. A second time it changes
    /// nothing.
    #[must_use]
    pub fn counts(&self, counts: i32) -> i64 {
        self.speed(counts, self.max())
    }
}

/// A magnitude of at most 33 bits with the sign of the counts.
const fn signed(magnitude: u64, counts: i32) -> i64 {
    let magnitude = magnitude.cast_signed();
    if counts < 0 { -magnitude } else { magnitude }
}

/// Makes samples of one [`PERIOD`](Self::PERIOD) out of a counter that is read whenever there is
/// time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelSampler {
    since: Duration,
    counter: u32,
}

impl WheelSampler {
    /// Time in which the pulses of one sample are counted [Alignment 2010].
    pub const PERIOD: Duration = Duration::from_millis(200);

    /// Begins with the counter as it stands.
    #[must_use]
    pub const fn new(now: Duration, counter: u32) -> Self {
        Self {
            since: now,
            counter,
        }
    }

    /// The counts per [`PERIOD`](Self::PERIOD) since the last sample; `None` while it is not over.
    ///
    /// `counter` is the quadrature counter, which may wrap. Read late, the counts are those of the
    /// mean speed since, to the nearest towards zero: a stall of the caller is no jump of the
    /// speed.
    #[must_use]
    pub fn sample(&mut self, now: Duration, counter: u32) -> Option<i32> {
        // In whole nanoseconds: `Duration`'s own subtraction can panic.
        let elapsed = now.as_nanos().saturating_sub(self.since.as_nanos());
        if elapsed < Self::PERIOD.as_nanos() {
            return None;
        }
        let moved = counter.wrapping_sub(self.counter).cast_signed();
        *self = Self::new(now, counter);
        let scaled = i64::from(moved).saturating_mul(Self::PERIOD.subsec_nanos().into());
        // After some 292 years nothing is left of any count.
        let elapsed = i64::try_from(elapsed).unwrap_or(i64::MAX);
        let mean = scaled.checked_div(elapsed)?;
        i32::try_from(mean).ok()
    }

    /// When the sample is over.
    #[must_use]
    pub fn due(&self) -> Duration {
        self.since.saturating_add(Self::PERIOD)
    }
}
