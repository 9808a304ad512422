//! The reloads of one axis, for its interrupt handler.

use super::{Periods, Timer, TimerError};
use core::iter::FusedIterator;

/// One period of a timer, of those up to an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Reload {
    /// What to write into the timer: [`Timer::reload`] of `ticks`.
    pub value: u32,
    /// Length of the period, for [`Timer::compensated_reload`].
    pub ticks: u64,
    /// Whether the pin toggles when this period ends; only the last one of an interval does.
    pub toggles: bool,
}

/// The reloads of one axis: an iterator for the interrupt handler of its timer.
///
/// Intervals past the width of the counter are cut into [`Periods`]. An interval below the timer's
/// shortest yields [`TimerError::IntervalTooShort`]. The size hint is a lower bound: how many
/// periods the coming intervals need is not known.
#[derive(Clone, Debug)]
#[must_use = "iterators are lazy"]
pub struct Reloads<A> {
    timer: Timer,
    axis: A,
    periods: Periods,
}

impl Timer {
    /// The reloads of an axis on this timer, from its intervals: an
    /// [`AxisTrain`](crate::AxisTrain), or a ramp of `pvt-steps`.
    ///
    /// A value that the handler writes into the counter, or into a compare register without a
    /// buffer, is for the period that has just begun. A register from which hardware has reloaded
    /// already when the handler comes (`SysTick`, CMSDK, 8052 timer 2, MCS-51 mode 2, STM32 with
    /// preload, RP2040 PWM) is for the period after: write the first value before the start, the
    /// second right after it, and go on one ahead.
    ///
    /// # Examples
    /// ```
    /// use stepper_sync::{Timer, Trains};
    /// let timer = Timer::mcs51_mode1(11_059_200)?;
    /// // 30:1 at 4096 ticks: 122,880 ticks an edge, two periods of 61,440.
    /// let [_, slow] = Trains::new([30, 1], 4096)?.axes();
    /// for (reload, toggles) in timer.reloads(slow).zip([false, true, false, true]) {
    ///     let reload = reload?;
    ///     assert_eq!((reload.value, reload.toggles), (0x1000, toggles));
    /// }
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub const fn reloads<A: Iterator<Item = u64>>(self, axis: A) -> Reloads<A> {
        Reloads {
            timer: self,
            axis,
            periods: Periods::new(0, self.width),
        }
    }
}

impl<A: Iterator<Item = u64>> Iterator for Reloads<A> {
    type Item = Result<Reload, TimerError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if self.periods.is_over() {
            match self.timer.periods(self.axis.next()?) {
                Ok(periods) => self.periods = periods,
                Err(error) => return Some(Err(error)),
            }
        }
        let ticks = self.periods.next()?;
        let toggles = self.periods.is_over();
        Some(self.timer.reload(ticks).map(|value| Reload {
            value,
            ticks,
            toggles,
        }))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let begun = self.periods.size_hint().0;
        (self.axis.size_hint().0.saturating_add(begun), None)
    }
}

impl<A: FusedIterator<Item = u64>> FusedIterator for Reloads<A> {}
