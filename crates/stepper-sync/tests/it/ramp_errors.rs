//! Ramps that cannot be made name the value and its limit.

use stepper_sync::{Ramp, RampEnds, RampError, RampLimits, Rate, TrainError};

#[test]
fn errors_name_value_and_limit() {
    let rate = Rate::from_hz(1_000_000).unwrap();
    let limits = RampLimits {
        start_millihertz: 100,
        max_millihertz: 1_000_000,
        accel_steps_per_s2: 1000,
    };
    let error = |limits: RampLimits, steps, rate| Ramp::new([0, steps], &limits, rate).unwrap_err();
    assert_eq!(
        error(
            RampLimits {
                max_millihertz: 0,
                start_millihertz: 0,
                ..limits
            },
            1,
            rate
        ),
        RampError::ZeroMaxRate
    );
    assert_eq!(
        error(
            RampLimits {
                accel_steps_per_s2: 0,
                ..limits
            },
            1,
            rate
        ),
        RampError::ZeroAcceleration
    );
    assert_eq!(
        error(
            RampLimits {
                max_millihertz: 99,
                ..limits
            },
            1,
            rate
        ),
        RampError::StartAboveMax {
            start_millihertz: 100,
            max_millihertz: 99
        }
    );
    let ends = |entry_millihertz, exit_millihertz| RampEnds {
        entry_millihertz,
        exit_millihertz,
    };
    assert_eq!(
        Ramp::between([1], &limits, ends(0, 1_000_001), rate),
        Err(RampError::EndAboveMax {
            end_millihertz: 1_000_001,
            max_millihertz: 1_000_000
        })
    );
    // (1000² - 200²) / 2000 = 480 steps.
    let change = ends(1_000_000, 200_000);
    assert_eq!(
        Ramp::between([-479, 3], &limits, change, rate),
        Err(RampError::TooShort {
            steps: 479,
            ends: change,
            needed: 480
        })
    );
    let just_enough = Ramp::between([-480, 3], &limits, change, rate).unwrap();
    // (1000 - 200) / 1000 s.
    assert_eq!(just_enough.end_ticks(), 800_000);
    assert_eq!(
        error(
            RampLimits {
                max_millihertz: 250_000_001,
                ..limits
            },
            1,
            rate
        ),
        RampError::RateTooHigh {
            max_millihertz: 250_000_001,
            limit_millihertz: 250_000_000
        }
    );
    // 168 MHz * 100 kHz / 2^31 = 7823 steps/s².
    let fast = Rate::from_hz(168_000_000).unwrap();
    let slow = RampLimits {
        max_millihertz: 100_000_000,
        accel_steps_per_s2: 7823,
        ..limits
    };
    assert_eq!(
        error(slow, 1, fast),
        RampError::AccelerationTooLow {
            accel_steps_per_s2: 7823,
            limit_steps_per_s2: 7824,
            max_millihertz: 100_000_000
        }
    );
    assert!(
        Ramp::new(
            [1],
            &RampLimits {
                accel_steps_per_s2: 7824,
                ..slow
            },
            fast
        )
        .is_ok()
    );
    assert_eq!(
        error(limits, i32::MIN, rate),
        RampError::Steps(TrainError::TooManySteps {
            axis: 1,
            steps: i32::MIN,
            limit: i32::MAX
        })
    );
    let odd = Rate::new(u32::MAX, 1 << 21).unwrap();
    assert_eq!(
        error(limits, 1, odd),
        RampError::TickRate {
            rate: odd,
            limit: 1 << 20
        }
    );
    let crawl = RampLimits {
        start_millihertz: 1,
        max_millihertz: 1,
        ..limits
    };
    let fastest = Rate::from_hz(u32::MAX).unwrap();
    assert_eq!(
        error(crawl, i32::MAX, fastest),
        RampError::TooLong {
            steps: 0x7FFF_FFFF,
            bits: 61
        }
    );
}
