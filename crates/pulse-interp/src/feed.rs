//! Speed along the path: constant, or by a profile.

use core::iter::{Repeat, repeat};

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
        let dividend = length_q16.wrapping_add(steps >> 1);
        // Up to 65535 steps long: a third of the instructions where words have 32 bits.
        if let (Ok(dividend), Ok(steps)) = (u32::try_from(dividend), u32::try_from(steps)) {
            return dividend.checked_div(steps).map_or(Self::ONE, Self);
        }
        match dividend.checked_div(steps) {
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

/// Intervals in whole ticks from factors, at a constant speed or along a speed profile; what is
/// rounded off is carried to the next.
///
/// A unit is the time in which the path advances one step length. Within each the speed is
/// constant, so that
/// ```text
/// sum of n intervals = floor(T(sum of n factors))
/// T(p) = sum of the first floor(p) units + (p - floor(p)) * the next one
/// ```
///
/// # Examples
/// ```
/// use pulse_interp::{Line, Rule, StepIntervals};
/// // 1000 ticks per step length, along a diagonal: 707 and 708 ticks a step.
/// let line = Line::new([5000, 5000])?;
/// let mut intervals = StepIntervals::new(1000);
/// let ticks = line
///     .steps(Rule::Nearest)
///     .try_fold(0, |sum, _| Some(sum + intervals.next(line.step_factor())?));
/// assert!(ticks.is_some_and(|ticks| ticks.abs_diff(7_071_068) < 100));
/// # Ok::<(), pulse_interp::LineError>(())
/// ```
/// Faster and faster, by units that a ramp of the path's length would have:
/// ```
/// use pulse_interp::{Line, Rule, StepIntervals};
/// let line = Line::new([2, 2])?;
/// let mut intervals = StepIntervals::from_units([900, 500, 300]);
/// let ticks = line.steps(Rule::Nearest).map(|_| intervals.next(line.step_factor()));
/// // At 0.707, 1.414, 2.121 and 2.828 step lengths.
/// assert!(ticks.eq([Some(636), Some(471), Some(329), Some(212)]));
/// # Ok::<(), pulse_interp::LineError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StepIntervals<U = Repeat<u32>> {
    units: U,
    unit_ticks: u32,
    /// What the path has not gone of the unit in hand, in 65536ths of a step length.
    left_q16: u32,
    /// The fraction of a tick, in 65536ths, below 65536.
    fraction: u32,
}

impl StepIntervals {
    /// Intervals of `unit_ticks` ticks per step length of the path: a constant speed.
    #[must_use]
    pub fn new(unit_ticks: u32) -> Self {
        Self::from_units(repeat(unit_ticks))
    }
}

impl<U: Iterator<Item = u32>> StepIntervals<U> {
    /// Intervals of the ticks that each step length of the path takes, one after the other: those
    /// between the steps of an axis that goes as far as the path is long.
    pub fn from_units(units: impl IntoIterator<IntoIter = U>) -> Self {
        Self {
            units: units.into_iter(),
            unit_ticks: 0,
            left_q16: 0,
            fraction: 0,
        }
    }

    /// The ticks until the next step; `None` where the units end before it.
    #[must_use = "the fraction has been carried on"]
    #[inline]
    pub fn next(&mut self, factor: Factor) -> Option<u64> {
        // In 65536ths of a tick, in all below (2^32 - 1)² + 2^16.
        let mut exact = u64::from(self.fraction);
        let mut length = factor.0;
        while length > self.left_q16 {
            exact = exact.wrapping_add(self.ticks_q16(self.left_q16));
            length = length.wrapping_sub(self.left_q16);
            self.unit_ticks = self.units.next()?;
            self.left_q16 = Factor::ONE.0;
        }
        exact = exact.wrapping_add(self.ticks_q16(length));
        self.left_q16 = self.left_q16.wrapping_sub(length);
        self.fraction = (exact & 0xFFFF) as u32;
        Some(exact >> 16)
    }

    /// The time of a part of the unit in hand, in 65536ths of a tick.
    fn ticks_q16(&self, length_q16: u32) -> u64 {
        u64::from(self.unit_ticks).wrapping_mul(u64::from(length_q16))
    }
}
