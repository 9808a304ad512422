//! An interval before it is rounded to whole ticks.

use core::num::{NonZeroU64, NonZeroU128};

/// An interval in ticks as an exact ratio, before it is rounded to whole ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ExactInterval {
    numerator: NonZeroU64,
    // At most 2^53.
    denominator: NonZeroU64,
}

impl ExactInterval {
    pub(super) const fn new(numerator: NonZeroU64, denominator: NonZeroU64) -> Self {
        Self {
            numerator,
            denominator,
        }
    }

    /// Numerator, in ticks; not in lowest terms.
    #[must_use]
    pub const fn numerator(&self) -> u64 {
        self.numerator.get()
    }

    /// Denominator.
    #[must_use]
    pub const fn denominator(&self) -> u64 {
        self.denominator.get()
    }

    /// Whole ticks, rounded down.
    #[must_use]
    pub fn floor(&self) -> u64 {
        self.numerator() / self.denominator
    }

    /// Whole ticks, to the nearest, halves up.
    #[must_use]
    pub fn nearest(&self) -> u64 {
        nearest(self.numerator(), self.denominator)
    }

    /// By how much `ticks` is longer than the exact interval, in parts per million to the nearest.
    ///
    /// ```text
    /// 10^6 (ticks / exact - 1)
    /// ```
    /// The 4096 ticks of [Engraver 2000] for 4085.1 are 2667 ppm long: the motor is 0.267 % slow.
    /// Saturates at `i64::MAX`.
    #[must_use]
    #[expect(
        clippy::arithmetic_side_effects,
        clippy::integer_division_remainder_used,
        reason = "2^64 * 2^53 and 2^64 * 2 * 10^6 fit 128 bits; the divisors are not zero"
    )]
    pub fn error_ppm(&self, ticks: u64) -> i64 {
        const MILLION: u128 = 1_000_000;
        let exact = NonZeroU128::from(self.numerator);
        let product = u128::from(ticks) * u128::from(self.denominator());
        // Apart, so that neither overflows.
        let (whole, rest) = (product / exact, product % exact);
        let rest_ppm = (rest * MILLION + exact.get() / 2) / exact;
        let ratio_ppm = whole.saturating_mul(MILLION).saturating_add(rest_ppm);
        // Saturated: i64::MAX + 10^6 and more come to the same.
        let ratio_ppm = i128::try_from(ratio_ppm).unwrap_or(i128::MAX);
        i64::try_from(ratio_ppm - 1_000_000).unwrap_or(i64::MAX)
    }
}

/// The quotient to the nearest, halves up.
pub(super) fn nearest(numerator: u64, denominator: NonZeroU64) -> u64 {
    let (whole, rest) = (numerator / denominator, numerator % denominator);
    let up = rest >= denominator.get().wrapping_sub(rest);
    // Only a denominator above 1 leaves a rest: the sum fits.
    whole.wrapping_add(u64::from(up))
}
