//! Timer arithmetic: intervals, reload values, prescalers.

mod error;
mod interval;
mod periods;
mod register;
mod reloads;
mod width;

pub use error::TimerError;
pub use interval::ExactInterval;
pub use periods::Periods;
pub use reloads::{Reload, Reloads};
pub use width::CounterWidth;

use crate::Rate;
use core::num::{NonZeroU32, NonZeroU64, NonZeroU128};
use core::time::Duration;
use register::Register;

/// Edges of a pulse.
const TWO: NonZeroU64 = NonZeroU64::MIN.saturating_add(1);

const NS_PER_S: NonZeroU128 = NonZeroU128::MIN.saturating_add(999_999_999);

/// A hardware timer: its clock, the clocks per tick, its width, and what its register holds.
///
/// Each constructor is named after how the counter runs, and what its register holds for
/// an interval of T ticks:
///
/// | constructor | register | shortest T |
/// |---|---|---|
/// | [`up_to_overflow`](Self::up_to_overflow) | (2^w - T) mod 2^w: the count that the interval starts from | 1 |
/// | [`up_to_compare`](Self::up_to_compare) | T - 1: the last count before the counter starts again at 0 | 2 |
/// | [`down_to_zero`](Self::down_to_zero) | T - 1: the count that is loaded after 0 | 2 |
///
/// N is the prescaler:
///
/// | timer | register | constructor |
/// |---|---|---|
/// | MCS-51 timers 0 and 1, mode 1 | `THx`, `TLx` | [`mcs51_mode1(f_osc)`](Self::mcs51_mode1), the same as `up_to_overflow(f_osc, 12, Bits16)` |
/// | MCS-51 timers 0 and 1, mode 2 | `THx` | `up_to_overflow(f_osc, 12, Bits8)` |
/// | 8052 timer 2, auto-reload | `RCAP2H`, `RCAP2L` | `up_to_overflow(f_osc, 12, Bits16)` |
/// | AVR, normal mode | `TCNTn` | `up_to_overflow(f_clk, N, Bits8)`, timer 1 `Bits16` |
/// | AVR, CTC mode | `OCRnA` | `up_to_compare(f_clk, N, Bits8)`, timer 1 `Bits16` |
/// | PIC16 timer 0, timer 1 | `TMR0`, `TMR1` | `up_to_overflow(f_osc, 4 * N, Bits8)`, timer 1 `Bits16` |
/// | PIC16 timer 2 | `PR2` | `up_to_compare(f_osc, 4 * N, Bits8)` |
/// | STM32, edge-aligned, counting up or down | `ARR` | `up_to_compare(f_tim, PSC + 1, Bits16)`, timers of 32 bits `Bits32` |
/// | RP2040 PWM slice, not phase-correct | `TOP` | `up_to_compare(f_sys, DIV_INT, Bits16)` |
/// | MSP430 `Timer_A`, up mode | `TAxCCR0` | `up_to_compare(f, N, Bits16)` |
/// | SAM D21 TC, match frequency | `CC0` | `up_to_compare(f_gclk, N, Bits16)` |
/// | Cortex-M `SysTick` | `SYST_RVR` | `down_to_zero(f_cpu, 1, Bits24)` |
/// | Arm CMSDK APB timer | `RELOAD` | `down_to_zero(f_pclk, 1, Bits32)` |
///
/// A counter that runs free under a compare register which the interrupt moves on, as STM32 output
/// compare and the alarms of the RP2040, needs no reload: it takes the interval itself,
/// `compare += ticks`.
///
/// # Examples
/// ```
/// use stepper_sync::{CounterWidth::{Bits16, Bits24}, Rate, Timer};
/// let rate = Rate::from_hz(500)?;
/// let mcs51 = Timer::mcs51_mode1(12_000_000)?;
/// let stm32 = Timer::up_to_compare(72_000_000, 72, Bits16)?;
/// let systick = Timer::down_to_zero(168_000_000, 1, Bits24)?;
/// // 1000 us each.
/// let reload = |timer: Timer| timer.reload(timer.half_period(rate)?.nearest());
/// assert_eq!(reload(mcs51)?, 65_536 - 1000);
/// assert_eq!(reload(stm32)?, 999);
/// assert_eq!(reload(systick)?, 167_999);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Timer {
    clock_hz: NonZeroU32,
    clocks_per_tick: NonZeroU32,
    width: CounterWidth,
    register: Register,
    min_ticks: u64,
}

impl Timer {
    /// Most clocks per tick, 2^20: a 16-bit prescaler after a fixed divider of 16.
    pub const MAX_CLOCKS_PER_TICK: u32 = 1 << 20;

    /// A counter that counts up from what is written into it, or into its reload register, and
    /// ends the interval when it overflows to 0.
    ///
    /// ```text
    /// reload = (2^w - T) mod 2^w        0 is the full 2^w ticks
    /// ```
    /// One tick every `clocks_per_tick` clocks of `clock_hz`: the prescaler times any fixed
    /// divider, 1 to 2^20.
    ///
    /// # Errors
    /// [`TimerError::ZeroClock`], [`TimerError::ClocksPerTick`].
    pub const fn up_to_overflow(
        clock_hz: u32,
        clocks_per_tick: u32,
        width: CounterWidth,
    ) -> Result<Self, TimerError> {
        Self::new(clock_hz, clocks_per_tick, width, Register::Overflow)
    }

    /// A counter that counts up from 0 to its auto-reload, compare or period register, and starts
    /// again at the tick after.
    ///
    /// ```text
    /// reload = T - 1
    /// ```
    /// The shortest interval is 2 ticks, because an auto-reload register of 0 stops the counter of
    /// an STM32; [`with_min_ticks`](Self::with_min_ticks) allows 1. Clock and clocks per tick as in
    /// [`up_to_overflow`](Self::up_to_overflow).
    ///
    /// # Errors
    /// [`TimerError::ZeroClock`], [`TimerError::ClocksPerTick`].
    pub const fn up_to_compare(
        clock_hz: u32,
        clocks_per_tick: u32,
        width: CounterWidth,
    ) -> Result<Self, TimerError> {
        Self::new(clock_hz, clocks_per_tick, width, Register::Compare)
    }

    /// A counter that counts down from its reload register to 0, and is loaded at the tick after.
    ///
    /// ```text
    /// reload = T - 1
    /// ```
    /// The shortest interval is 2 ticks, because a reload value of 0 stops `SysTick`;
    /// [`with_min_ticks`](Self::with_min_ticks) allows 1. Clock and clocks per tick as in
    /// [`up_to_overflow`](Self::up_to_overflow).
    ///
    /// # Errors
    /// [`TimerError::ZeroClock`], [`TimerError::ClocksPerTick`].
    pub const fn down_to_zero(
        clock_hz: u32,
        clocks_per_tick: u32,
        width: CounterWidth,
    ) -> Result<Self, TimerError> {
        Self::new(clock_hz, clocks_per_tick, width, Register::Down)
    }

    /// Timer 0 or 1 of an MCS-51 in mode 1: 12 clocks per machine cycle, 16 bits, up to the
    /// overflow.
    ///
    /// # Errors
    /// [`TimerError::ZeroClock`].
    pub const fn mcs51_mode1(oscillator_hz: u32) -> Result<Self, TimerError> {
        Self::up_to_overflow(oscillator_hz, 12, CounterWidth::Bits16)
    }

    const fn new(
        clock_hz: u32,
        clocks_per_tick: u32,
        width: CounterWidth,
        register: Register,
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
                register,
                min_ticks: register.min_ticks(),
            }),
            _ => Err(TimerError::ClocksPerTick {
                value,
                limit: Self::MAX_CLOCKS_PER_TICK,
            }),
        }
    }

    /// The same timer with the smallest of `prescalers` with which half a period of `rate` fits
    /// one count: the finest.
    ///
    /// `prescalers` is the list of the data sheet in any order. Each is multiplied with the clocks
    /// per tick that the timer has without it, such as the 4 of a PIC.
    ///
    /// # Errors
    /// [`TimerError::NoPrescaler`] for an empty list; [`TimerError::ClocksPerTick`]; those of
    /// [`half_period`](Self::half_period) and [`reload`](Self::reload) for the prescaler that comes
    /// nearest.
    ///
    /// # Examples
    /// ```
    /// use stepper_sync::{CounterWidth::Bits16, Rate, Timer};
    /// let timer1 = Timer::up_to_compare(16_000_000, 1, Bits16)?;
    /// // 70,922 clocks do not fit 16 bits; divided by 8 they are 8865 ticks.
    /// let rate = Rate::from_millihertz(112_800)?;
    /// let timer1 = timer1.with_finest_prescaler(&[1, 8, 64, 256, 1024], rate)?;
    /// assert_eq!(timer1.clocks_per_tick(), 8);
    /// assert_eq!(timer1.reload(timer1.half_period(rate)?.nearest())?, 8864);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn with_finest_prescaler(self, prescalers: &[u32], rate: Rate) -> Result<Self, TimerError> {
        let mut finest: Option<Self> = None;
        let mut refusal = TimerError::NoPrescaler;
        for &prescaler in prescalers {
            let timer = self.with_prescaler(prescaler)?;
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

    fn with_prescaler(self, prescaler: u32) -> Result<Self, TimerError> {
        let value = self.clocks_per_tick.get().saturating_mul(prescaler);
        match NonZeroU32::new(value) {
            Some(clocks_per_tick) if value <= Self::MAX_CLOCKS_PER_TICK => Ok(Self {
                clocks_per_tick,
                ..self
            }),
            _ => Err(TimerError::ClocksPerTick {
                value,
                limit: Self::MAX_CLOCKS_PER_TICK,
            }),
        }
    }

    /// The same timer with another shortest interval, in ticks: what the interrupt handler needs.
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
    pub fn half_period(&self, rate: Rate) -> Result<ExactInterval, TimerError> {
        // 2^32 * 2^32 and 2^20 * 2^32 * 2 fit: nothing saturates.
        let (rate_numerator, rate_denominator) = rate.parts();
        let numerator = NonZeroU64::from(self.clock_hz).saturating_mul(rate_denominator.into());
        let denominator = NonZeroU64::from(self.clocks_per_tick)
            .saturating_mul(rate_numerator.into())
            .saturating_mul(TWO);
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
        let Some(ticks) = NonZeroU64::new(ticks) else {
            return Err(TimerError::IntervalTooShort { ticks, limit: 1 });
        };
        let millihertz = u64::from(self.clock_hz.get()).saturating_mul(1000);
        // Saturated as unsaturated, the divisor leaves less than half a millihertz.
        let divisor = NonZeroU64::from(self.clocks_per_tick)
            .saturating_mul(TWO)
            .saturating_mul(ticks);
        Ok(interval::nearest(millihertz, divisor))
    }

    /// Ticks in a span of time, to the nearest.
    ///
    /// # Errors
    /// [`TimerError::DurationTooLong`] past 2^64 ticks.
    pub fn ticks_in(&self, duration: Duration) -> Result<u64, TimerError> {
        // 2^94 ns * 2^32 fits 128 bits.
        let clocks = duration
            .as_nanos()
            .saturating_mul(u128::from(self.clock_hz.get()));
        let per_tick = NonZeroU128::from(self.clocks_per_tick).saturating_mul(NS_PER_S);
        u64::try_from(rounded(clocks, per_tick))
            .map_err(|_| TimerError::DurationTooLong { duration })
    }

    /// The time that `ticks` take, in nanoseconds to the nearest.
    ///
    /// A tick of an MCS-51 at 11.0592 MHz is 1.085 us.
    #[must_use]
    pub fn ticks_to_ns(&self, ticks: u64) -> u128 {
        // 2^64 * 2^20 * 2^30 fits 128 bits.
        let clocks = u128::from(ticks).saturating_mul(u128::from(self.clocks_per_tick.get()));
        rounded(clocks.saturating_mul(NS_PER_S.get()), self.clock_hz.into())
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
}

/// The quotient to the nearest, halves up, of a numerator below 2^127.
#[expect(
    clippy::arithmetic_side_effects,
    clippy::integer_division_remainder_used,
    reason = "the sum fits; the divisor is not zero"
)]
fn rounded(numerator: u128, denominator: NonZeroU128) -> u128 {
    (numerator + denominator.get() / 2) / denominator
}

#[cfg(test)]
#[expect(
    clippy::arithmetic_side_effects,
    clippy::integer_division_remainder_used,
    reason = "small numbers of the tests' own"
)]
mod tests;
