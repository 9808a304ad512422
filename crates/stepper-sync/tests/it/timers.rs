//! Register values of well-known timers, against their makers' formulas and counters run tick by
//! tick.

use stepper_sync::CounterWidth::{Bits8, Bits16, Bits24, Bits32};
use stepper_sync::{Rate, Timer, TimerError, Trains};

/// The register value for half a period of `hz`.
fn register(timer: Timer, hz: u32) -> u32 {
    let exact = timer.half_period(Rate::from_hz(hz).unwrap()).unwrap();
    timer.reload(exact.nearest()).unwrap()
}

#[test]
fn mcs51_counts_up_to_its_overflow() {
    // Mode 1: 65536 - t f_osc / 12. 50 ms at 11.0592 MHz are 4C00h.
    assert_eq!(
        register(Timer::mcs51_mode1(11_059_200).unwrap(), 10),
        0x4C00
    );
    // Mode 2: f_osc / (12 (256 - TH1)) overflows a second. FDh are 32 times 9600 baud.
    let mode2 = Timer::up_to_overflow(11_059_200, 12, Bits8).unwrap();
    assert_eq!(register(mode2, 32 * 9600 / 2), 0xFD);
    // 8052 timer 2: f_osc / (12 (65536 - RCAP2)), 1 ms at 12 MHz is FC18h.
    let timer2 = Timer::up_to_overflow(12_000_000, 12, Bits16).unwrap();
    assert_eq!(register(timer2, 500), 0xFC18);
}

#[test]
fn avr_normal_mode_counts_up_to_its_overflow() {
    // f_clk / (N (256 - TCNT0)) overflows a second: 1 ms at 16 MHz / 64 is 6.
    let timer0 = Timer::up_to_overflow(16_000_000, 64, Bits8).unwrap();
    assert_eq!(register(timer0, 500), 6);
    // f_clk / (N (65536 - TCNT1)): 1 s at 16 MHz / 256 is 3036.
    let timer1 = Timer::up_to_overflow(16_000_000, 256, Bits16).unwrap();
    assert_eq!(timer1.reload(62_500), Ok(3036));
}

#[test]
fn avr_ctc_starts_anew_at_its_compare_register() {
    // ATmega328P: f_OCnx = f_clk / (2 N (1 + OCRnx)), the pin toggling at each match.
    let timer0 = Timer::up_to_compare(16_000_000, 8, Bits8).unwrap();
    let timer1 = Timer::up_to_compare(16_000_000, 8, Bits16).unwrap();
    for ocr in [1, 99, 124, 199, 249] {
        let hz = 16_000_000 / (2 * 8 * (1 + ocr));
        assert_eq!(2 * 8 * (1 + ocr) * hz, 16_000_000);
        assert_eq!(register(timer0, hz), ocr);
        assert_eq!(register(timer1, hz), ocr);
    }
    assert_eq!(register(timer1, 50), 19_999);
}

#[test]
fn pic_timers() {
    // Timer 0: T = (256 - TMR0) 4 N / f_osc. 10 ms at 4 MHz and N = 64: 156.25, so 100.
    let timer0 = Timer::up_to_overflow(4_000_000, 4 * 64, Bits8).unwrap();
    assert_eq!(register(timer0, 50), 100);
    // Timer 2: T = (PR2 + 1) 4 N / f_osc. 250 us at 4 MHz and N = 1.
    let timer2 = Timer::up_to_compare(4_000_000, 4, Bits8).unwrap();
    assert_eq!(register(timer2, 2000), 249);
}

#[test]
fn stm32_auto_reload() {
    // f_update = f_tim / ((PSC + 1) (ARR + 1)): 1 kHz at 72 MHz and PSC = 71.
    let psc = 71;
    let tim3 = Timer::up_to_compare(72_000_000, psc + 1, Bits16).unwrap();
    assert_eq!(tim3.reload(1000), Ok(999));
    assert_eq!(register(tim3, 500), 999);
    let tim2 = Timer::up_to_compare(84_000_000, 1, Bits32).unwrap();
    assert_eq!(register(tim2, 1), 41_999_999);
    // The counter is blocked while the auto-reload value is 0.
    let too_short = TimerError::IntervalTooShort { ticks: 1, limit: 2 };
    assert_eq!(tim3.reload(1), Err(too_short));
    assert_eq!(tim3.ticks_of_reload(0), Err(too_short));
    assert_eq!(tim3.reload(2), Ok(1));
}

#[test]
fn rp2040_pwm_wrap() {
    // period = (TOP + 1) (CSR_PH_CORRECT + 1) (DIV_INT + DIV_FRAC / 16) clocks.
    for (div_int, top) in [(1, 62_499_u32), (125, 499), (250, 249)] {
        let period_clocks = (top + 1) * div_int;
        let slice = Timer::up_to_compare(125_000_000, div_int, Bits16).unwrap();
        assert_eq!(register(slice, 125_000_000 / period_clocks / 2), top);
    }
}

#[test]
fn msp430_and_sam_d() {
    // Timer_A in up mode: TAxCCR0 + 1 counts a period.
    let timer_a = Timer::up_to_compare(1_000_000, 1, Bits16).unwrap();
    assert_eq!(timer_a.reload(1000), Ok(999));
    // TC in match frequency mode: f = f_GCLK / (2 N (CC0 + 1)).
    let tc = Timer::up_to_compare(48_000_000, 64, Bits16).unwrap();
    assert_eq!(48_000_000 / (2 * 64 * (374 + 1)), 1000);
    assert_eq!(register(tc, 1000), 374);
}

#[test]
fn cortex_m_systick_and_cmsdk_count_down() {
    // Armv7-M: a period of N clocks needs a reload value of N - 1.
    let systick = Timer::down_to_zero(168_000_000, 1, Bits24).unwrap();
    assert_eq!(register(systick, 500), 168_000 - 1);
    // A reload value of 0 stops the counter.
    assert!(systick.reload(1).is_err());
    assert_eq!(systick.reload(1 << 24), Ok(0x00FF_FFFF));
    // The APB timer of the MPS2 boards: RELOAD + 1 clocks.
    let cmsdk = Timer::down_to_zero(25_000_000, 1, Bits32).unwrap();
    assert_eq!(register(cmsdk, 1000), 12_499);
}

/// Ticks between two events of a counter that runs by itself.
fn measured(register: u32, next: impl Fn(u32, u32) -> (u32, bool)) -> u64 {
    let mut count = register;
    let until_event = |count: &mut u32| {
        let mut ticks = 0;
        loop {
            let event;
            (*count, event) = next(*count, register);
            ticks += 1;
            if event {
                return ticks;
            }
        }
    };
    // The first interval begins anywhere.
    until_event(&mut count);
    until_event(&mut count)
}

#[test]
fn counters_run_tick_by_tick_take_the_interval() {
    let overflow = |count: u32, reload| match count + 1 {
        256 => (reload, true),
        count => (count, false),
    };
    let compare = |count, top| {
        if count == top {
            (0, true)
        } else {
            (count + 1, false)
        }
    };
    let down = |count, reload| {
        if count == 0 {
            (reload, true)
        } else {
            (count - 1, false)
        }
    };
    let clock = 1_000_000;
    let up_to_overflow = Timer::up_to_overflow(clock, 1, Bits8).unwrap();
    let up_to_compare = Timer::up_to_compare(clock, 1, Bits8).unwrap();
    let down_to_zero = Timer::down_to_zero(clock, 1, Bits8).unwrap();
    for ticks in 2..=256 {
        assert_eq!(
            measured(up_to_overflow.reload(ticks).unwrap(), overflow),
            ticks
        );
        assert_eq!(
            measured(up_to_compare.reload(ticks).unwrap(), compare),
            ticks
        );
        assert_eq!(measured(down_to_zero.reload(ticks).unwrap(), down), ticks);
    }
}

#[test]
fn from_a_timer_to_trains_without_a_conversion() {
    let timer = Timer::up_to_compare(72_000_000, 72, Bits16).unwrap();
    let half_period = timer.half_period(Rate::from_hz(500).unwrap()).unwrap();
    let [fast, slow] = Trains::new([3, 1], half_period.nearest()).unwrap().axes();
    let values = timer.reloads(fast).map(|reload| reload.unwrap().value);
    assert_eq!(values.collect::<Vec<_>>(), [999; 6]);
    let values = timer.reloads(slow).map(|reload| reload.unwrap().value);
    assert_eq!(values.collect::<Vec<_>>(), [2999; 2]);
}
