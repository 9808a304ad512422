//! Ramps that cannot be made name the value and its limit.

use pvt_steps::{Ramp, RampEnds, RampError, RampLimits, Rate};

const fn limits(start_millihertz: u32, max_millihertz: u32, accel_steps_per_s2: u32) -> RampLimits {
    RampLimits {
        start_millihertz,
        max_millihertz,
        accel_steps_per_s2,
    }
}

const fn ends(entry_millihertz: u32, exit_millihertz: u32) -> RampEnds {
    RampEnds {
        entry_millihertz,
        exit_millihertz,
    }
}

/// 0.1 to 1000 steps/s at 1000 steps/s².
const GOOD: RampLimits = limits(100, 1_000_000, 1000);

fn hz(hz: u32) -> Rate {
    Rate::from_hz(hz).unwrap()
}

fn error(limits: RampLimits, steps: i32, rate: Rate) -> RampError {
    Ramp::new([0, steps], &limits, rate).unwrap_err()
}

#[test]
fn rates_and_accelerations_have_limits() {
    let (start_millihertz, max_millihertz) = (100, 99);
    let start_above_max = RampError::StartAboveMax {
        start_millihertz,
        max_millihertz,
    };
    let (max_millihertz, limit_millihertz) = (250_000_001, 250_000_000);
    let rate_too_high = RampError::RateTooHigh {
        max_millihertz,
        limit_millihertz,
    };
    // 168 MHz * 100 kHz / 2^31 = 7823 steps/s².
    let (fast, slow) = (hz(168_000_000), limits(100, 100_000_000, 7823));
    let too_slow = RampError::AccelerationTooLow {
        accel_steps_per_s2: 7823,
        limit_steps_per_s2: 7824,
        max_millihertz: 100_000_000,
    };
    let rate = hz(1_000_000);
    for (limits, rate, wanted) in [
        (limits(0, 0, 1000), rate, RampError::ZeroMaxRate),
        (limits(100, 1_000_000, 0), rate, RampError::ZeroAcceleration),
        (limits(100, 99, 1000), rate, start_above_max),
        (limits(100, 250_000_001, 1000), rate, rate_too_high),
        (slow, fast, too_slow),
    ] {
        assert_eq!(error(limits, 1, rate), wanted);
    }
    assert!(Ramp::new([1], &limits(100, 100_000_000, 7824), fast).is_ok());
    let odd = Rate::new(u32::MAX, 1 << 21).unwrap();
    let limit = 1 << 20;
    let tick_rate = RampError::TickRate { rate: odd, limit };
    assert_eq!(error(GOOD, 1, odd), tick_rate);
}

#[test]
fn ends_are_within_the_limits_and_reached() {
    let rate = hz(1_000_000);
    let (end_millihertz, max_millihertz) = (1_000_001, 1_000_000);
    let end_above_max = RampError::EndAboveMax {
        end_millihertz,
        max_millihertz,
    };
    let refused = Ramp::between([1], &GOOD, ends(0, 1_000_001), rate);
    assert_eq!(refused, Err(end_above_max));
    // (1000² - 200²) / 2000 = 480 steps.
    let change = ends(1_000_000, 200_000);
    let too_short = RampError::TooShort {
        steps: 479,
        ends: change,
        needed: 480,
    };
    let refused = Ramp::between([-479, 3], &GOOD, change, rate);
    assert_eq!(refused, Err(too_short));
    let just_enough = Ramp::between([-480, 3], &GOOD, change, rate).unwrap();
    // (1000 - 200) / 1000 s.
    assert_eq!(just_enough.end_ticks(), 800_000);
}

#[test]
fn steps_and_times_have_limits() {
    let too_many = RampError::TooManySteps {
        axis: 1,
        steps: i32::MIN,
        limit: i32::MAX,
    };
    let refused = error(GOOD, i32::MIN, hz(1_000_000));
    assert_eq!(refused, too_many);
    let (steps, bits) = (0x7FFF_FFFF, 61);
    let refused = error(limits(1, 1, 1000), i32::MAX, hz(u32::MAX));
    assert_eq!(refused, RampError::TooLong { steps, bits });
}
