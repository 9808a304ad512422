//! Time as the caller counts it.

use core::{
    fmt,
    ops::{Add, Sub},
    time::Duration,
};

/// A point in time, in microseconds since an epoch that the caller chooses.
///
/// The crate owns no clock: every call that needs the time takes an `Instant`. Use the same epoch
/// for all calls to one object, and never let time run backwards. 64 bits of microseconds last
/// for more than half a million years, so nothing wraps.
///
/// There is no conversion from `std::time::Instant`: it has no epoch, so the conversion would
/// have to keep one in secret. Take `Instant::from_micros(start.elapsed().as_micros() as u64)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Instant(u64);

impl Instant {
    /// The epoch.
    pub const ZERO: Self = Self(0);
    /// Later than every time of day: "no deadline" inside the crate.
    pub(crate) const NEVER: Self = Self(u64::MAX);

    /// The instant `micros` microseconds after the epoch.
    #[must_use]
    pub const fn from_micros(micros: u64) -> Self {
        Self(micros)
    }

    /// The instant `millis` milliseconds after the epoch; stays at the largest value past the end.
    #[must_use]
    pub const fn from_millis(millis: u64) -> Self {
        Self(millis.saturating_mul(1000))
    }

    /// Microseconds since the epoch.
    #[must_use]
    pub const fn as_micros(self) -> u64 {
        self.0
    }

    /// The time from `earlier` to `self`, zero when `earlier` is later.
    #[must_use]
    pub const fn saturating_duration_since(self, earlier: Self) -> Duration {
        Duration::from_micros(self.0.saturating_sub(earlier.0))
    }

    pub(crate) fn plus_ms(self, ms: u16) -> Self {
        self.plus_us(u64::from(ms) * 1000)
    }

    pub(crate) const fn plus_us(self, us: u64) -> Self {
        Self(self.0.saturating_add(us))
    }

    /// [`plus_us`](Self::plus_us) for the short ways: two instructions less. 64 bits of
    /// microseconds do not come to their end.
    #[inline]
    pub(crate) const fn plus_us_unchecked_end(self, us: u64) -> Self {
        Self(self.0.wrapping_add(us))
    }

    pub(crate) fn minus_ms(self, ms: u16) -> Self {
        Self(self.0.saturating_sub(u64::from(ms) * 1000))
    }
}

/// Stays at the largest value past the end. Fractions of a microsecond are dropped.
impl Add<Duration> for Instant {
    type Output = Self;

    fn add(self, duration: Duration) -> Self {
        self.plus_us(u64::try_from(duration.as_micros()).unwrap_or(u64::MAX))
    }
}

/// Zero when the right side is later.
impl Sub for Instant {
    type Output = Duration;

    fn sub(self, earlier: Self) -> Duration {
        self.saturating_duration_since(earlier)
    }
}

/// Seconds with six decimals: `1.250000s`.
impl fmt::Display for Instant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{:06}s", self.0 / 1_000_000, self.0 % 1_000_000)
    }
}
