//! Timer arithmetic: intervals, reload values, prescalers.

mod error;
mod interval;
mod periods;
mod reloads;

pub use error::TimerError;
pub use interval::ExactInterval;
pub use periods::Periods;
pub use reloads::{Reload, Reloads};

use crate::Rate;
use core::num::NonZeroU32;
use core::time::Duration;

/// Number of bits of a counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the widths that timers have")]
pub enum CounterWidth {
    /// 8 bits: MCS-51 mode 2, AVR timer 0.
    Bits8,
    /// 16 bits: MCS-51 mode 1, AVR timer 1, most STM32 timers.
    Bits16,
    /// 24 bits: `SysTick` of the Cortex-M.
    Bits24,
    /// 32 bits: STM32 timer 2, nRF timers.
    Bits32,
}

impl CounterWidth {
    /// Longest period, 2^width ticks.
    #[must_use]
    pub const fn max_ticks(self) -> u64 {
        self.max_value().wrapping_add(1)
    }

    /// Largest count, 2^width - 1.
    #[must_use]
    pub const fn max_value(self) -> u64 {
        match self {
            Self::Bits8 => 0xFF,
            Self::Bits16 => 0xFFFF,
            Self::Bits24 => 0xFF_FFFF,
            Self::Bits32 => 0xFFFF_FFFF,
        }
    }

    /// log2 of [`max_ticks`](Self::max_ticks).
    pub(crate) const fn bits(self) -> u32 {
        match self {
            Self::Bits8 => 8,
            Self::Bits16 => 16,
            Self::Bits24 => 24,
            Self::Bits32 => 32,
        }
    }
}

/// How a counter is loaded for an interval of T ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a counter counts up or down")]
pub enum Counting {
    /// Up to the overflow: the reload is (2^w - T) mod 2^w, and 0 is the full 2^w ticks.
    Up,
    /// Down to zero, or up to a compare value, with the zero counted: the reload is T - 1.
    Down,
}

/// A hardware timer: its clock, the clocks per tick, its width and the way it counts.
///
/// # Examples
/// ```
/// use stepper_sync::{Rate, Timer};
/// let timer = Timer::mcs51_mode1(11_059_200)?;
/// let exact = timer.half_period(Rate::from_millihertz(112_800)?)?;
/// assert_eq!(exact.nearest(), 4085);
/// assert_eq!(timer.reload(exact.nearest())?, 0xF00B);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Timer {
    clock_hz: NonZeroU32,
    clocks_per_tick: NonZeroU32,
    width: CounterWidth,
    counting: Counting,
    min_ticks: u64,
}

impl Timer {
    /// Most clocks per tick, 2^20: a 16-bit prescaler behind a fixed divider of 16.
    pub const MAX_CLOCKS_PER_TICK: u32 = 1 << 20;

    /// A timer that counts one tick every `clocks_per_tick` clocks of `clock_hz`.
    ///
    /// `clocks_per_tick` is the prescaler times any fixed divider, 1 to 2^20.
    ///
    /// # Errors
    /// [`TimerError::ZeroClock`], [`TimerError::ClocksPerTick`].
    pub const fn new(
        clock_hz: u32,
        clocks_per_tick: u32,
        width: CounterWidth,
        counting: Counting,
    ) -> Result<Self, TimerError> {
        let Some(clock_hz) = NonZeroU32::new(clock_hz) else {
            return Err(TimerError::ZeroClock);
        };
        let value = clocks_per_tick;
        match NonZeroU32::new(value) {
            Some(clocks_per_tick) if value <= Self::MAX_CLOCKS_PER_TICK => Ok(Self {
                clock_hz,
                clocks_per_tick,
                width,
                counting,
                min_ticks: 1,
            }),
            _ => Err(TimerError::ClocksPerTick {
                value,
                limit: Self::MAX_CLOCKS_PER_TICK,
            }),
        }
    }

    /// Timer 0 or 1 of an MCS-51 in mode 1: 12 clocks per machine cycle, 16 bits, counting up.
    ///
    /// ```text
    /// reload = (65536 - T) mod 65536        T = 65536 loads 0000h
    /// ```
    ///
    /// # Errors
    /// [`TimerError::ZeroClock`].
    pub const fn mcs51_mode1(oscillator_hz: u32) -> Result<Self, TimerError> {
        Self::new(oscillator_hz, 12, CounterWidth::Bits16, Counting::Up)
    }

    /// The timer with the fewest clocks per tick of `prescalers` that holds half a period of
    /// `rate` in one count: the finest that fits.
    ///
    /// `prescalers` is the list of the data sheet in any order, each times the fixed divider.
    ///
    /// # Errors
    /// Those of [`new`](Self::new) and [`half_period`](Self::half_period);
    /// [`TimerError::NoPrescaler`] for an empty list; [`TimerError::IntervalTooLong`] with the
    /// ticks of the nearest miss when even the largest prescaler is too small.
    pub fn choose(
        clock_hz: u32,
        prescalers: &[u32],
        width: CounterWidth,
        counting: Counting,
        rate: Rate,
    ) -> Result<Self, TimerError> {
        let mut finest: Option<Self> = None;
        let mut refusal = TimerError::NoPrescaler;
        for &prescaler in prescalers {
            let timer = Self::new(clock_hz, prescaler, width, counting)?;
            let fits = timer
                .half_period(rate)
                .and_then(|exact| timer.check(exact.nearest()));
            match (fits, refusal) {
                (Ok(()), _) => {
                    let coarser = |best: Self| best.clocks_per_tick > timer.clocks_per_tick;
                    if finest.is_none_or(coarser) {
                        finest = Some(timer);
                    }
                }
                // The nearest miss.
                (
                    Err(TimerError::IntervalTooLong { ticks, .. }),
                    TimerError::IntervalTooLong { ticks: fewer, .. },
                ) if ticks >= fewer => {}
                (Err(TimerError::RateTooHigh { .. }), TimerError::IntervalTooLong { .. }) => {}
                (Err(error), _) => refusal = error,
            }
        }
        finest.ok_or(refusal)
    }

    /// The same timer with a shortest interval, in ticks: what the interrupt handler needs.
    ///
    /// # Errors
    /// [`TimerError::MinTicks`] when it is 0 or more than half of the longest: a longer interval
    /// could then not be cut into legal ones.
    pub const fn with_min_ticks(self, min_ticks: u64) -> Result<Self, TimerError> {
        let limit = self.max_ticks() >> 1;
        if min_ticks == 0 || min_ticks > limit {
            return Err(TimerError::MinTicks {
                value: min_ticks,
                limit,
            });
        }
        Ok(Self { min_ticks, ..self })
    }

    /// Clocks per tick.
    #[must_use]
    pub const fn clocks_per_tick(&self) -> u32 {
        self.clocks_per_tick.get()
    }

    /// Width of the counter.
    #[must_use]
    pub const fn width(&self) -> CounterWidth {
        self.width
    }

    /// Shortest interval of one period, in ticks.
    #[must_use]
    pub const fn min_ticks(&self) -> u64 {
        self.min_ticks
    }

    /// Longest interval of one period, 2^width ticks.
    #[must_use]
    pub const fn max_ticks(&self) -> u64 {
        self.width.max_ticks()
    }

    /// Ticks per second.
    #[must_use]
    pub const fn tick_rate(&self) -> Rate {
        Rate::of_nonzero(self.clock_hz, self.clocks_per_tick)
    }

    /// Exact ticks between two edges of a pulse train: half of its period.
    ///
    /// ```text
    /// T = f_clock / (2 · clocks_per_tick · f)
    /// ```
    /// At 11.0592 MHz and 12 clocks, 112.8 Hz takes 4085.1 ticks [Engraver 2000].
    ///
    /// # Errors
    /// [`TimerError::RateTooHigh`] when it is less than half a tick.
    #[expect(
        clippy::arithmetic_side_effects,
        reason = "2^32 * 2^32 and 2 * 2^20 * 2^32 fit 64 bits"
    )]
    pub fn half_period(&self, rate: Rate) -> Result<ExactInterval, TimerError> {
        let numerator = u64::from(self.clock_hz.get()) * u64::from(rate.denominator());
        let denominator = u64::from(self.clocks_per_tick.get()) * u64::from(rate.numerator()) * 2;
        let exact = ExactInterval::new(numerator, denominator);
        if exact.nearest() == 0 {
            return Err(TimerError::RateTooHigh { rate });
        }
        Ok(exact)
    }

    /// The rate, in millihertz to the nearest, of pulses whose edges are `ticks` apart.
    ///
    /// 4096 ticks at 11.0592 MHz and 12 clocks give 112.5 Hz.
    ///
    /// # Errors
    /// [`TimerError::IntervalTooShort`] for 0 ticks.
    pub fn half_period_to_millihertz(&self, ticks: u64) -> Result<u64, TimerError> {
        let clocks = u128::from(self.clock_hz.get()).saturating_mul(1000);
        let divisor = u128::from(self.clocks_per_tick.get())
            .saturating_mul(2)
            .saturating_mul(u128::from(ticks));
        clocks
            .saturating_add(divisor >> 1)
            .checked_div(divisor)
            .and_then(|millihertz| u64::try_from(millihertz).ok())
            .ok_or(TimerError::IntervalTooShort { ticks, limit: 1 })
    }

    /// Ticks in a span of time, to the nearest.
    ///
    /// # Errors
    /// [`TimerError::DurationTooLong`] past 2^64 ticks.
    pub fn ticks_in(&self, duration: Duration) -> Result<u64, TimerError> {
        // 2^94 ns * 2^32 fits 128 bits; 10^9 * 2^20 is not zero.
        let clocks = duration
            .as_nanos()
            .saturating_mul(u128::from(self.clock_hz.get()));
        let per_tick = u128::from(self.clocks_per_tick.get()).saturating_mul(1_000_000_000);
        clocks
            .saturating_add(per_tick >> 1)
            .checked_div(per_tick)
            .and_then(|ticks| u64::try_from(ticks).ok())
            .ok_or(TimerError::DurationTooLong { duration })
    }

    /// The time that `ticks` take, in nanoseconds to the nearest.
    ///
    /// A tick of an MCS-51 at 11.0592 MHz is 1.085 us.
    #[must_use]
    pub fn ticks_to_ns(&self, ticks: u64) -> u128 {
        let clock_hz = u128::from(self.clock_hz.get());
        u128::from(ticks)
            .saturating_mul(u128::from(self.clocks_per_tick.get()))
            .saturating_mul(1_000_000_000)
            .saturating_add(clock_hz >> 1)
            .checked_div(clock_hz)
            .unwrap_or(0)
    }

    /// The reload value of an interval, for a handler that writes it, or hardware that reloads
    /// itself.
    ///
    /// Where the interrupt writes the counter of a timer that runs on, the ticks since the overflow
    /// are lost and every interval is longer by that latency: the plain reload of
    /// [Engraver 2000]. Trains of n1 and n2 pulses then end 2 · latency · (n1 - n2) ticks apart,
    /// for a small C handler 16 ticks each time. [`compensated_reload`](Self::compensated_reload)
    /// keeps them together.
    ///
    /// # Errors
    /// [`TimerError::IntervalTooShort`], [`TimerError::IntervalTooLong`]; longer ones are cut by
    /// [`periods`](Self::periods).
    pub fn reload(&self, ticks: u64) -> Result<u32, TimerError> {
        self.check(ticks)?;
        let just_wrapped = match self.counting {
            Counting::Up => 0,
            Counting::Down => self.width.max_value(),
        };
        Ok(self.load(just_wrapped, ticks, 0))
    }

    /// The interval of a reload value, in ticks.
    ///
    /// # Errors
    /// [`TimerError::ReloadTooLarge`] when the value does not fit the counter.
    pub fn ticks_of_reload(&self, reload: u32) -> Result<u64, TimerError> {
        let limit = self.width.max_value();
        let value = u64::from(reload);
        if value > limit {
            return Err(TimerError::ReloadTooLarge { reload, limit });
        }
        Ok(match self.counting {
            Counting::Up => self.max_ticks().wrapping_sub(value),
            Counting::Down => value.wrapping_add(1),
        })
    }

    /// What to write into a counter that ran on after its overflow, so that the latency of the
    /// interrupt is not lost: stop, add, start.
    ///
    /// ```text
    /// up    count' = (count - T + stopped) mod 2^w
    /// down  count' = (count + T - stopped) mod 2^w
    /// ```
    /// `count` is read from the stopped counter, which wrapped and went on counting; `stopped_ticks`
    /// are the ticks from stop to start, a constant of the program. The mean interval is then
    /// exactly T, where [`reload`](Self::reload) gives T plus the latency.
    ///
    /// # Errors
    /// Those of [`reload`](Self::reload); [`TimerError::CountTooLarge`]; [`TimerError::TooLate`]
    /// when the interval is over already.
    pub fn compensated_reload(
        &self,
        count: u32,
        ticks: u64,
        stopped_ticks: u32,
    ) -> Result<u32, TimerError> {
        self.check(ticks)?;
        let limit = self.width.max_value();
        let value = u64::from(count);
        if value > limit {
            return Err(TimerError::CountTooLarge { count, limit });
        }
        let since_overflow = match self.counting {
            Counting::Up => value,
            Counting::Down => limit.wrapping_sub(value),
        };
        let stopped = u64::from(stopped_ticks);
        let elapsed = since_overflow.saturating_add(stopped);
        if elapsed >= ticks {
            return Err(TimerError::TooLate { elapsed, ticks });
        }
        Ok(self.load(value, ticks, stopped))
    }

    /// Cuts a long interval into periods of this timer that sum exactly: as few as possible, each
    /// legal.
    ///
    /// # Errors
    /// [`TimerError::IntervalTooShort`].
    pub fn periods(&self, ticks: u64) -> Result<Periods, TimerError> {
        if ticks < self.min_ticks {
            return Err(self.too_short(ticks));
        }
        Ok(Periods::new(ticks, self.width))
    }

    /// Counter value from which `ticks` are left, less those that went by since the wrap.
    fn load(&self, count: u64, ticks: u64, stopped: u64) -> u32 {
        let value = match self.counting {
            Counting::Up => count.wrapping_sub(ticks).wrapping_add(stopped),
            Counting::Down => count.wrapping_add(ticks).wrapping_sub(stopped),
        };
        u32::try_from(value & self.width.max_value()).unwrap_or(u32::MAX)
    }

    const fn too_short(&self, ticks: u64) -> TimerError {
        TimerError::IntervalTooShort {
            ticks,
            limit: self.min_ticks,
        }
    }

    fn check(&self, ticks: u64) -> Result<(), TimerError> {
        if ticks < self.min_ticks {
            return Err(self.too_short(ticks));
        }
        let limit = self.max_ticks();
        if ticks > limit {
            return Err(TimerError::IntervalTooLong { ticks, limit });
        }
        Ok(())
    }
}

#[cfg(test)]
#[expect(
    clippy::arithmetic_side_effects,
    clippy::integer_division_remainder_used,
    reason = "small numbers of the tests' own"
)]
mod tests;
