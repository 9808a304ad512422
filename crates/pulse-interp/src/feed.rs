//! Constant speed along the path.

/// A factor of the interval between steps, in 65536ths.
///
/// At a fixed pulse rate a path of single steps is slower along a diagonal: 41 % more steps than
/// length. With each interval multiplied by its factor, the path advances one step length per unit
/// interval, whatever its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Factor(u32);

impl Factor {
    /// The factor 1.
    pub const ONE: Self = Self(1 << 16);

    /// The factor in 65536ths.
    #[must_use]
    pub const fn to_q16(self) -> u32 {
        self.0
    }

    /// sqrt(square) / steps, within one 65536th; 1 where there are no steps. Below 2^16.
    pub(crate) fn ratio(square: u64, steps: u64) -> Self {
        Self::of_q16(length_q16(square), steps)
    }

    /// length / steps, with the length in 65536ths below 2^48.
    #[inline]
    pub(crate) fn of_q16(length_q16: u64, steps: u64) -> Self {
        let half = steps >> 1;
        match length_q16.wrapping_add(half).checked_div(steps) {
            Some(factor) => Self(u32::try_from(factor).unwrap_or(u32::MAX)),
            None => Self::ONE,
        }
    }
}

/// sqrt(square) in 65536ths, to the nearest, below 2^48.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the root of 96 bits has 48"
)]
pub(crate) const fn length_q16(square: u64) -> u64 {
    let square = (square as u128) << 32;
    let root = square.isqrt();
    // (root + 1/2)² has no whole number between root (root + 1) and itself.
    let up = square.wrapping_sub(root.wrapping_mul(root)) > root;
    (root as u64).wrapping_add(up as u64)
}

/// Intervals in whole ticks from factors; what is rounded off is carried to the next.
///
/// # Examples
/// ```
/// use pulse_interp::{Line, Rule, StepIntervals};
/// // 1000 ticks per step length, along a diagonal: 707 and 708 ticks a step.
/// let line = Line::new([5000, 5000])?;
/// let mut intervals = StepIntervals::new(1000);
/// let ticks: u64 = line
///     .steps(Rule::Nearest)
///     .map(|_| intervals.next(line.step_factor()))
///     .sum();
/// assert!(ticks.abs_diff(7_071_068) < 100);
/// # Ok::<(), pulse_interp::LineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StepIntervals {
    unit_ticks: u32,
    // Of a tick, in 65536ths, below 65536.
    fraction: u32,
}

impl StepIntervals {
    /// Intervals of `unit_ticks` ticks per step length of the path.
    #[must_use]
    pub const fn new(unit_ticks: u32) -> Self {
        Self {
            unit_ticks,
            fraction: 0,
        }
    }

    /// The ticks until the next step.
    ///
    /// ```text
    /// sum of n intervals = floor(unit_ticks * sum of n factors)
    /// ```
    #[must_use = "the fraction has been carried on"]
    #[inline]
    pub fn next(&mut self, factor: Factor) -> u64 {
        // (2^32 - 1)² + 2^16 is below 2^64.
        let exact = u64::from(self.unit_ticks)
            .wrapping_mul(u64::from(factor.0))
            .wrapping_add(u64::from(self.fraction));
        self.fraction = u32::from(u16::try_from(exact & 0xFFFF).unwrap_or(0));
        exact >> 16
    }
}
