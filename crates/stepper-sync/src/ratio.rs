//! Exact signed ratios.

use crate::rate::gcd;
use core::num::NonZeroU32;

/// A signed ratio of two integers in lowest terms: a mean speed, a relative error.
///
/// # Examples
/// ```
/// use stepper_sync::{Accumulation, Rate, SpeedLaw};
/// let paper = Accumulation::new(SpeedLaw::Reset, 600, Rate::from_hz(1000)?)?;
/// let mean = paper.steps_per_tick(-119);
/// assert_eq!((mean.numerator(), mean.denominator()), (-1, 6));
/// assert_eq!(mean.per_million(), -166_667);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ratio {
    numerator: i32,
    denominator: NonZeroU32,
}

impl Ratio {
    pub(crate) const ZERO: Self = Self {
        numerator: 0,
        denominator: NonZeroU32::MIN,
    };

    /// `numerator / denominator`; a denominator of 0, which no caller has, counts as 1.
    #[expect(
        clippy::arithmetic_side_effects,
        clippy::integer_division_remainder_used,
        reason = "the greatest common divisor with a number above zero is not zero"
    )]
    pub(crate) fn new(numerator: i32, denominator: u32) -> Self {
        let denominator = NonZeroU32::new(denominator).unwrap_or(NonZeroU32::MIN);
        let divisor = gcd(denominator.get(), numerator.unsigned_abs());
        let lowest = numerator.unsigned_abs() / divisor;
        // Only the magnitude 2^31 does not fit, and that is i32::MIN.
        let magnitude = i32::try_from(lowest).unwrap_or(i32::MIN);
        Self {
            numerator: if numerator < 0 {
                magnitude.wrapping_neg()
            } else {
                magnitude
            },
            denominator: NonZeroU32::new(denominator.get() / divisor).unwrap_or(NonZeroU32::MIN),
        }
    }

    /// Numerator in lowest terms, with the sign.
    #[must_use]
    pub const fn numerator(self) -> i32 {
        self.numerator
    }

    /// Denominator in lowest terms.
    #[must_use]
    pub const fn denominator(self) -> u32 {
        self.denominator.get()
    }

    /// The ratio in parts per million, to the nearest, halves up.
    #[must_use]
    pub fn per_million(self) -> i64 {
        // 2^31 * 2 * 10^6 + 2^32 fits 64 bits.
        let denominator = i64::from(self.denominator.get());
        i64::from(self.numerator)
            .wrapping_mul(2_000_000)
            .wrapping_add(denominator)
            .checked_div_euclid(denominator.wrapping_mul(2))
            .unwrap_or(0)
    }

    /// The ratio in floating point.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        f64::from(self.numerator) / f64::from(self.denominator.get())
    }
}
