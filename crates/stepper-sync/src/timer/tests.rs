//! Timers by the vendors' formulas.

use super::*;

const CRYSTAL_HZ: u32 = 11_059_200;

fn engraver() -> (Timer, Rate) {
    let timer = Timer::mcs51_mode1(CRYSTAL_HZ).unwrap();
    // 84.6 deg/s at 0.75 deg a step.
    (timer, Rate::new(8460, 75).unwrap())
}

#[test]
fn engraver_motor_112_8_hz_half_period_4_4326_ms() {
    let (_, rate) = engraver();
    assert_eq!(rate.to_millihertz(), 112_800);
    assert_eq!(rate.half_period_ns(), 4_432_624);
}

#[test]
fn engraver_machine_cycle_1_0850694_us() {
    let (timer, _) = engraver();
    assert_eq!(timer.ticks_to_ns(10_000_000), 10_850_694_444);
    assert_eq!(
        timer.ticks_in(Duration::from_nanos(10_850_694_444)),
        Ok(10_000_000)
    );
}

#[test]
fn engraver_exact_count_4085_1_is_0ff5h_reload_f00bh() {
    let (timer, rate) = engraver();
    let exact = timer.half_period(rate).unwrap();
    let tenths = (exact.numerator() * 10 + exact.denominator() / 2) / exact.denominator();
    assert_eq!(tenths, 40_851);
    assert_eq!((exact.floor(), exact.nearest()), (0x0FF5, 0x0FF5));
    assert_eq!(timer.reload(0x0FF5), Ok(0xF00B));
    assert_eq!(timer.ticks_of_reload(0xF00B), Ok(0x0FF5));
}

#[test]
fn engraver_rounding_4096_is_reload_f000h_112_5_hz_0_267_percent_slow() {
    let (timer, rate) = engraver();
    assert_eq!(timer.reload(4096), Ok(0xF000));
    assert_eq!(timer.half_period_to_millihertz(4096), Ok(112_500));
    assert_eq!(timer.half_period(rate).unwrap().error_ppm(4096), 2667);
}

#[test]
fn reload_0000h_is_65536() {
    let (timer, _) = engraver();
    assert_eq!(timer.reload(65_536), Ok(0));
    assert_eq!(timer.ticks_of_reload(0), Ok(65_536));
    assert_eq!(
        timer.reload(65_537),
        Err(TimerError::IntervalTooLong {
            ticks: 65_537,
            limit: 65_536
        })
    );
    assert_eq!(
        timer.reload(0),
        Err(TimerError::IntervalTooShort { ticks: 0, limit: 1 })
    );
    assert_eq!(
        timer.ticks_of_reload(0x1_0000),
        Err(TimerError::ReloadTooLarge {
            reload: 0x1_0000,
            limit: 0xFFFF
        })
    );
}

#[test]
fn every_width_and_register_reloads_and_comes_back() {
    use CounterWidth::{Bits8, Bits16, Bits24, Bits32};
    for width in [Bits8, Bits16, Bits24, Bits32] {
        for constructor in [
            Timer::up_to_overflow,
            Timer::up_to_compare,
            Timer::down_to_zero,
        ] {
            let timer = constructor(1_000_000, 1, width)
                .and_then(|timer| timer.with_min_ticks(1))
                .unwrap();
            let max = timer.max_ticks();
            assert_eq!(max, 1 << width.bits());
            for ticks in [1, 2, max / 3, max - 1, max] {
                let reload = timer.reload(ticks).unwrap();
                assert_eq!(timer.ticks_of_reload(reload), Ok(ticks), "{timer:?}");
            }
            assert!(timer.reload(max + 1).is_err());
        }
    }
}

#[test]
fn finest_prescaler_that_fits() {
    let avr = [1024, 256, 64, 8, 1];
    let choose = |millihertz| {
        let rate = Rate::from_millihertz(millihertz).unwrap();
        let timer1 = Timer::up_to_compare(16_000_000, 1, CounterWidth::Bits16)?;
        timer1.with_finest_prescaler(&avr, rate)
    };
    // 16 MHz / (2 * 112.8 Hz) = 70,922 ticks: too long by itself, 8865 with the prescaler 8.
    assert_eq!(choose(112_800).map(|t| t.clocks_per_tick()), Ok(8));
    // 16 MHz / (2 * 65536) = 122.07 Hz.
    assert_eq!(choose(123_000).map(|t| t.clocks_per_tick()), Ok(1));
    assert_eq!(choose(122_000).map(|t| t.clocks_per_tick()), Ok(8));
    // 16 MHz / 1024 / (2 * 0.1 Hz) = 78,125.
    assert_eq!(
        choose(100),
        Err(TimerError::IntervalTooLong {
            ticks: 78_125,
            limit: 65_536
        })
    );
    let rate = Rate::from_hz(1).unwrap();
    assert_eq!(
        engraver().0.with_finest_prescaler(&[], rate),
        Err(TimerError::NoPrescaler)
    );
    // The fixed divider stays: a PIC at 20 MHz, whose ticks are 4 clocks long.
    let pic = Timer::up_to_overflow(20_000_000, 4, CounterWidth::Bits16).unwrap();
    let behind = pic.with_finest_prescaler(&[1, 2, 4, 8], Rate::from_hz(20).unwrap());
    assert_eq!(behind.map(|t| t.clocks_per_tick()), Ok(8));
    for prescaler in [0, 1 << 19, u32::MAX] {
        assert_eq!(
            pic.with_finest_prescaler(&[1, prescaler], rate),
            Err(TimerError::ClocksPerTick {
                value: prescaler.saturating_mul(4),
                limit: Timer::MAX_CLOCKS_PER_TICK
            })
        );
    }
}

#[test]
fn wrong_settings_are_named() {
    let new = |hz, clocks| Timer::up_to_overflow(hz, clocks, CounterWidth::Bits16);
    assert_eq!(new(0, 1), Err(TimerError::ZeroClock));
    let limit = Timer::MAX_CLOCKS_PER_TICK;
    for value in [0, limit + 1] {
        assert_eq!(
            new(1, value),
            Err(TimerError::ClocksPerTick { value, limit })
        );
    }
    let timer = new(1000, 1).unwrap();
    for value in [0, 32_769] {
        assert_eq!(
            timer.with_min_ticks(value),
            Err(TimerError::MinTicks {
                value,
                limit: 32_768
            })
        );
    }
    let rate = Rate::from_hz(1001).unwrap();
    assert_eq!(
        timer.half_period(rate),
        Err(TimerError::RateTooHigh { rate })
    );
    assert_eq!(
        timer.ticks_in(Duration::MAX),
        Err(TimerError::DurationTooLong {
            duration: Duration::MAX
        })
    );
    let limited = timer.with_min_ticks(100).unwrap();
    assert_eq!(
        limited.reload(99),
        Err(TimerError::IntervalTooShort {
            ticks: 99,
            limit: 100
        })
    );
    assert!(limited.periods(99).is_err());
}

/// A free-running up or down counter with an interrupt that takes `latency` ticks to its reload.
fn mean_interval(timer: Timer, ticks: u64, latency: u32, compensated: bool) -> u64 {
    const STOPPED: u32 = 5;
    const INTERVALS: u64 = 1000;
    let mut now = 0;
    for _ in 0..INTERVALS {
        // The counter has just wrapped; the handler runs `latency` ticks later.
        now += u64::from(latency);
        let written = if compensated {
            let count = match timer.register {
                Register::Down => u32::try_from(timer.width.max_value()).unwrap() - latency,
                _ => latency,
            };
            now += u64::from(STOPPED);
            timer.compensated_reload(count, ticks, STOPPED).unwrap()
        } else {
            timer.reload(ticks).unwrap()
        };
        now += timer.ticks_of_reload(written).unwrap();
    }
    now / INTERVALS
}

#[test]
fn latency_is_lost_by_the_plain_reload_and_kept_by_the_compensated_one() {
    let (mcs51, _) = engraver();
    let down = Timer::down_to_zero(1_000_000, 1, CounterWidth::Bits16).unwrap();
    for timer in [mcs51, down] {
        for latency in [0, 7, 16] {
            assert_eq!(
                mean_interval(timer, 4096, latency, false),
                4096 + u64::from(latency)
            );
            assert_eq!(mean_interval(timer, 4096, latency, true), 4096);
        }
        // The full count as well.
        assert_eq!(mean_interval(timer, 65_536, 16, true), 65_536);
    }
    assert_eq!(
        mcs51.compensated_reload(15, 20, 5),
        Err(TimerError::TooLate {
            elapsed: 20,
            ticks: 20
        })
    );
    assert_eq!(
        mcs51.compensated_reload(0x1_0000, 20, 5),
        Err(TimerError::CountTooLarge {
            count: 0x1_0000,
            limit: 0xFFFF
        })
    );
    let stm32 = Timer::up_to_compare(1_000_000, 1, CounterWidth::Bits16).unwrap();
    assert_eq!(
        stm32.compensated_reload(15, 20, 5),
        Err(TimerError::StartsAgain)
    );
}

#[test]
fn errors_of_extreme_intervals_are_exact() {
    // The slowest clock that divides the slowest rate: 2^32 - 1 ticks.
    let timer = Timer::up_to_overflow(1, 1, CounterWidth::Bits32).unwrap();
    let slow = timer.half_period(Rate::new(1, u32::MAX).unwrap()).unwrap();
    assert_eq!(slow.nearest(), 1 << 31);
    assert_eq!(slow.error_ppm(0), -1_000_000);
    // 2^64 - 1 ticks for (2^32 - 1) / 2: 2^33 - 2^-32 times as many.
    let times = 8_589_934_594_i64;
    assert_eq!(slow.error_ppm(u64::MAX), (times - 1) * 1_000_000);
    let fast = Timer::up_to_overflow(u32::MAX, 1, CounterWidth::Bits32).unwrap();
    let fast = fast.half_period(Rate::from_hz(u32::MAX).unwrap()).unwrap();
    assert_eq!((fast.floor(), fast.nearest()), (0, 1));
    assert_eq!(fast.error_ppm(u64::MAX), i64::MAX);
}

#[test]
fn long_intervals_are_cut_into_the_fewest_legal_periods() {
    let timer = Timer::mcs51_mode1(CRYSTAL_HZ)
        .and_then(|timer| timer.with_min_ticks(32_768))
        .unwrap();
    for ticks in [
        32_768,
        65_536,
        65_537,
        122_880,
        131_072,
        131_073,
        268_431_360,
    ] {
        let periods = timer.periods(ticks).unwrap();
        assert_eq!(periods.remaining(), ticks.div_ceil(65_536));
        assert_eq!(periods.clone().count() as u64, periods.remaining());
        assert_eq!(periods.clone().sum::<u64>(), ticks);
        assert!(periods.clone().all(|period| timer.reload(period).is_ok()));
    }
}

#[test]
fn reloads_refuse_a_short_interval_and_go_on() {
    let timer = Timer::mcs51_mode1(CRYSTAL_HZ)
        .and_then(|timer| timer.with_min_ticks(100))
        .unwrap();
    let mut reloads = timer.reloads([99, 100].into_iter());
    assert_eq!(
        reloads.next(),
        Some(Err(TimerError::IntervalTooShort {
            ticks: 99,
            limit: 100
        }))
    );
    assert_eq!(
        reloads.next(),
        Some(Ok(Reload {
            value: 0xFF9C,
            ticks: 100,
            toggles: true
        }))
    );
    assert_eq!(reloads.next(), None);
}
