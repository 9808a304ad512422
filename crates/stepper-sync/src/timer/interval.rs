/// An interval in ticks as an exact ratio, before it is rounded to whole ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ExactInterval {
    numerator: u64,
    // Not zero, at most 2^53.
    denominator: u64,
}

impl ExactInterval {
    pub(super) const fn new(numerator: u64, denominator: u64) -> Self {
        Self {
            numerator,
            denominator,
        }
    }

    /// Numerator, in ticks; not in lowest terms.
    #[must_use]
    pub const fn numerator(&self) -> u64 {
        self.numerator
    }

    /// Denominator.
    #[must_use]
    pub const fn denominator(&self) -> u64 {
        self.denominator
    }

    /// Whole ticks, rounded down.
    #[must_use]
    pub fn floor(&self) -> u64 {
        self.numerator.checked_div(self.denominator).unwrap_or(0)
    }

    /// Whole ticks, to the nearest, halves up.
    #[must_use]
    pub fn nearest(&self) -> u64 {
        let remainder = self.numerator.checked_rem(self.denominator).unwrap_or(0);
        let up = remainder >= self.denominator.wrapping_sub(remainder);
        self.floor().saturating_add(u64::from(up))
    }

    /// By how much `ticks` is longer than the exact interval, in parts per million to the nearest.
    ///
    /// The 4096 ticks of [Engraver 2000] for 4085.1 are 2667 ppm long: the motor is 0.267 % slow.
    /// Saturates at the ends of `i64`.
    #[must_use]
    pub fn error_ppm(&self, ticks: u64) -> i64 {
        let exact = i128::from(self.numerator);
        let ratio_ppm = i128::from(ticks)
            .saturating_mul(i128::from(self.denominator))
            .saturating_sub(exact)
            .saturating_mul(2_000_000)
            .saturating_add(exact)
            .checked_div_euclid(exact.saturating_mul(2))
            .unwrap_or(0);
        i64::try_from(ratio_ppm).unwrap_or(if ratio_ppm > 0 { i64::MAX } else { i64::MIN })
    }
}
