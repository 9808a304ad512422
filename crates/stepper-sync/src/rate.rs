//! Exact rates.

use core::num::NonZeroU32;
use thiserror::Error;

/// Why a rate is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RateError {
    /// A rate of 0 Hz has no interval.
    #[error("a rate of 0/{denominator} Hz has no interval")]
    Zero {
        /// The denominator given.
        denominator: u32,
    },
    /// The denominator is 0.
    #[error("a rate of {numerator}/0 Hz")]
    ZeroDenominator {
        /// The numerator given.
        numerator: u32,
    },
}

/// A rate in hertz as a ratio of two integers, so that nothing is rounded before the timer.
///
/// # Examples
/// ```
/// use stepper_sync::Rate;
/// // 84.6 deg/s at 0.75 deg a step: 112.8 steps/s.
/// let rate = Rate::new(8460, 75)?;
/// assert_eq!(rate, Rate::from_millihertz(112_800)?);
/// # Ok::<(), stepper_sync::RateError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "(u32, u32)", into = "(u32, u32)")
)]
pub struct Rate {
    numerator: NonZeroU32,
    denominator: NonZeroU32,
}

impl Rate {
    /// `numerator / denominator` hertz, kept in lowest terms.
    ///
    /// # Errors
    /// [`RateError`] when either is 0.
    pub const fn new(numerator: u32, denominator: u32) -> Result<Self, RateError> {
        match (NonZeroU32::new(numerator), NonZeroU32::new(denominator)) {
            (_, None) => Err(RateError::ZeroDenominator { numerator }),
            (None, _) => Err(RateError::Zero { denominator }),
            (Some(numerator), Some(denominator)) => Ok(Self::of_nonzero(numerator, denominator)),
        }
    }

    /// In lowest terms.
    #[expect(
        clippy::arithmetic_side_effects,
        clippy::integer_division_remainder_used,
        reason = "the greatest common divisor of two numbers above zero is not zero"
    )]
    pub(crate) const fn of_nonzero(numerator: NonZeroU32, denominator: NonZeroU32) -> Self {
        let divisor = gcd(numerator.get(), denominator.get());
        match (
            NonZeroU32::new(numerator.get() / divisor),
            NonZeroU32::new(denominator.get() / divisor),
        ) {
            (Some(numerator), Some(denominator)) => Self {
                numerator,
                denominator,
            },
            // Never: the divisor divides both.
            _ => Self {
                numerator,
                denominator,
            },
        }
    }

    /// A whole number of hertz.
    ///
    /// # Errors
    /// [`RateError::Zero`].
    pub const fn from_hz(hz: u32) -> Result<Self, RateError> {
        Self::new(hz, 1)
    }

    /// A whole number of millihertz: 112.8 Hz is 112,800 mHz.
    ///
    /// # Errors
    /// [`RateError::Zero`].
    pub const fn from_millihertz(millihertz: u32) -> Result<Self, RateError> {
        Self::new(millihertz, 1000)
    }

    /// Numerator in lowest terms, in hertz.
    #[must_use]
    pub const fn numerator(self) -> u32 {
        self.numerator.get()
    }

    /// Denominator in lowest terms.
    #[must_use]
    pub const fn denominator(self) -> u32 {
        self.denominator.get()
    }

    /// Numerator and denominator.
    pub(crate) const fn parts(self) -> (NonZeroU32, NonZeroU32) {
        (self.numerator, self.denominator)
    }

    /// The rate in millihertz, rounded to the nearest, halves up.
    #[must_use]
    #[expect(
        clippy::arithmetic_side_effects,
        clippy::integer_division_remainder_used,
        reason = "1000 * 2^32 + 2^31 fits 64 bits; the divisor is not zero"
    )]
    pub fn to_millihertz(self) -> u64 {
        let denominator = u64::from(self.denominator.get());
        (u64::from(self.numerator.get()) * 1000 + denominator / 2) / denominator
    }

    /// Half of the period, 1 / (2 f), in nanoseconds, rounded to the nearest.
    ///
    /// 112.8 Hz has a half period of 4.4326 ms.
    #[must_use]
    #[expect(
        clippy::arithmetic_side_effects,
        clippy::integer_division_remainder_used,
        reason = "5e8 * 2^32 + 2^32 fits 64 bits; the divisor is not zero"
    )]
    pub fn half_period_ns(self) -> u64 {
        let numerator = u64::from(self.numerator.get());
        (u64::from(self.denominator.get()) * 500_000_000 + numerator / 2) / numerator
    }
}

impl TryFrom<(u32, u32)> for Rate {
    type Error = RateError;

    fn try_from((numerator, denominator): (u32, u32)) -> Result<Self, RateError> {
        Self::new(numerator, denominator)
    }
}

impl From<Rate> for (u32, u32) {
    fn from(rate: Rate) -> Self {
        (rate.numerator(), rate.denominator())
    }
}

/// Greatest common divisor; the other number when one is zero.
#[expect(
    clippy::arithmetic_side_effects,
    clippy::integer_division_remainder_used,
    reason = "the loop ends before the divisor is zero"
)]
const fn gcd(mut a: u32, mut b: u32) -> u32 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(feature = "defmt")]
impl defmt::Format for Rate {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}/{} Hz", self.numerator(), self.denominator());
    }
}
