//! Speed accumulators against the published figures, the reference table and their invariants.

use std::collections::HashSet;

use motor_phases::{Accumulation, AccumulatorError, Accumulators, Rate, SpeedLaw};
use proptest::prelude::*;

const LAWS: [SpeedLaw; 3] = [
    SpeedLaw::Reset,
    SpeedLaw::CarryMagnitude,
    SpeedLaw::CarrySigned,
];

/// [Dancer]: threshold 600, a tick of 1 ms, frames of 200 ms.
fn dancer(law: SpeedLaw) -> Accumulation {
    Accumulation::new(law, 600, Rate::from_hz(1000).unwrap()).unwrap()
}

const FRAME_TICKS: u32 = 200;

/// Steps of all motors over some ticks.
fn run<const N: usize>(motors: &mut Accumulators<N>, ticks: u32) -> [i64; N] {
    let mut positions = [0; N];
    for _ in 0..ticks {
        for (position, step) in positions.iter_mut().zip(motors.tick()) {
            *position += i64::from(step);
        }
    }
    positions
}

/// Whether a number is the `f64` nearest to a ratio: no other one of these ratios has the same.
#[expect(clippy::cast_precision_loss, reason = "below 2^53")]
fn is(number: f64, numerator: i64, denominator: i64) -> bool {
    number.to_bits() == (numerator as f64 / denominator as f64).to_bits()
}

/// Each row of the reference table.
#[test]
fn accum_table() {
    const TICKS: u32 = 1_000_000;
    /// Half of the last printed digit of `rel_err`.
    const PRINTED: f64 = 5.1e-10;
    let table = include_str!("../data/accum.csv");
    let mut rows = 0;
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |column: usize| cells[column].parse::<i64>().unwrap();
        let speed = i8::try_from(number(0)).unwrap();
        let reset = dancer(SpeedLaw::Reset);
        assert!(is(reset.steps_per_tick(speed), 1, number(1)), "{line}");
        assert!((reset.error(speed) - cells[6].parse::<f64>().unwrap()).abs() < PRINTED);
        // V0 is a step in 5 ticks.
        assert!(
            is(reset.steps_per_tick(speed), number(7), 5 * number(8)),
            "{line}"
        );
        let [_, carry, signed] = LAWS.map(dancer);
        for law in [carry, signed] {
            assert!(
                is(law.steps_per_tick(speed), number(9), 5 * number(10)),
                "{line}"
            );
            assert!(is(law.error(speed), 0, 1));
        }
        for (law, steps, sum) in [
            (reset, number(2), number(4)),
            (carry, number(3), number(5)),
            (signed, number(3), number(5)),
        ] {
            let mut motors = law.motors();
            motors.set_speeds([speed, -speed]);
            assert_eq!(run(&mut motors, TICKS), [steps, -steps], "{line}");
            let [forward, back] = motors.sums().map(i64::from);
            let mirrored = if law == signed { -sum } else { sum };
            assert_eq!((forward, back), (sum, mirrored), "{line}");
        }
        rows += 1;
    }
    assert_eq!(rows, 43);
}

/// [Dancer] divides by what does not always divide: both of its formulas are one.
#[test]
fn the_two_formulas_of_the_article_are_one() {
    for speed in 1..=127_i8 {
        let n = i64::from(speed);
        let mean = dancer(SpeedLaw::Reset).steps_per_tick(speed);
        // V = V0 n/120, else V0 5/([600/n] + 1); V0 is 1/5 step per tick.
        if 600 % n == 0 {
            assert!(is(mean, n, 5 * 120));
        } else {
            assert!(is(mean, 1, 600 / n + 1));
        }
    }
}

#[test]
fn worst_error_is_15_97_percent_at_119_and_the_mean_4_44() {
    /// Half of the last digit.
    const PRINTED: f64 = 0.5e-4;
    let law = dancer(SpeedLaw::Reset);
    let errors: Vec<f64> = (1..=127).map(|n| law.error(n)).collect();
    let (worst, error) = (1..=127_i8)
        .zip(&errors)
        .min_by(|a, b| a.1.total_cmp(b.1))
        .unwrap();
    assert_eq!(worst, 119);
    assert!(is(law.error(119), -19, 119));
    assert!((error + 0.1597).abs() < PRINTED);
    let mean = errors.iter().sum::<f64>() / 127.0;
    assert!((mean + 0.0444).abs() < PRINTED);
}

#[test]
fn the_reset_law_has_44_speeds_and_the_others_127() {
    let distinct = LAWS.map(|law| {
        let means = (1..=127).map(|n| dancer(law).steps_per_tick(n).to_bits());
        means.collect::<HashSet<_>>().len()
    });
    assert_eq!(distinct, [44, 127, 127]);
}

#[test]
fn wheels_at_60_turn_on_the_spot_at_half_v0_for_5000_ms() {
    for law in LAWS.map(dancer) {
        let mut wheels = law.motors();
        wheels.set_speeds([60, -60]);
        // 25 frames at 0.5 · 1/5 step per tick.
        assert_eq!(run(&mut wheels, 25 * FRAME_TICKS), [500, -500]);
        assert_eq!(law.millihertz(60), 100_000);
    }
}

#[test]
fn a_change_of_frame_keeps_what_was_gathered() {
    for law in LAWS.map(dancer) {
        let mut motors = law.motors();
        motors.set_speeds([100, -100]);
        assert_eq!(run(&mut motors, 5), [0, 0]);
        motors.set_speeds([99, -99]);
        // 500 + 99 is one short.
        assert_eq!(run(&mut motors, 1), [0, 0]);
        motors.set_speeds([1, -1]);
        assert_eq!(run(&mut motors, 1), [1, -1]);
    }
}

#[test]
fn a_reversal_is_exact_with_the_sign_alone() {
    // 599 forth and 599 back, over and over: on the spot.
    let drift = LAWS.map(|law| {
        let mut motors = dancer(law).motors();
        let mut position = 0;
        for speed in [1, -1].repeat(10) {
            motors.set_speeds([speed]);
            let [moved] = run(&mut motors, 599);
            position += moved;
        }
        (position, motors.sums())
    });
    // The magnitudes of 20 times 599 make 19 steps, the first of them back.
    assert_eq!(drift, [(-1, [580]), (-1, [580]), (0, [0])]);
}

#[test]
fn rest_is_rest() {
    for law in LAWS.map(dancer) {
        let mut motors = law.motors();
        motors.set_speeds([0, 127]);
        assert_eq!(run(&mut motors, 600)[0], 0);
        assert!(is(law.steps_per_tick(0), 0, 1) && is(law.error(0), 0, 1));
        assert_eq!(law.millihertz(0), 0);
    }
}

#[test]
fn thresholds_below_a_step_per_tick_are_refused() {
    let tick = Rate::from_hz(1000).unwrap();
    let error = Accumulation::new(SpeedLaw::Reset, 127, tick).unwrap_err();
    assert_eq!(
        error,
        AccumulatorError::ThresholdTooLow {
            threshold: 127,
            limit: 128
        }
    );
    assert_eq!(
        error.to_string(),
        "a threshold of 127 would need more than one step per tick at a speed of -128; the least \
         is 128"
    );
    assert_eq!(
        Accumulation::new(SpeedLaw::Reset, 32_640, tick),
        Err(AccumulatorError::ThresholdTooHigh {
            threshold: 32_640,
            limit: 32_639
        })
    );
    // At the least, the highest speed steps every tick.
    for law in LAWS {
        let mut motors = Accumulation::new(law, 128, tick).unwrap().motors();
        motors.set_speeds([-128, 127]);
        assert_eq!(run(&mut motors, 1000)[0], -1000);
    }
}

#[test]
fn mean_speeds_at_any_tick_rate() {
    // 11.0592 MHz / 12 / 1000: 921.6 ticks a second.
    let tick = Rate::from_millihertz(921_600).unwrap();
    let law = Accumulation::new(SpeedLaw::CarrySigned, 600, tick).unwrap();
    assert_eq!(law.millihertz(-119), -182_784);
    let fastest = Rate::from_hz(u32::MAX).unwrap();
    let law = Accumulation::new(SpeedLaw::CarrySigned, 128, fastest).unwrap();
    assert_eq!(law.millihertz(-128), -i64::from(u32::MAX) * 1000);
    assert_eq!((law.law(), law.threshold()), (SpeedLaw::CarrySigned, 128));
    assert_eq!(law.tick_rate(), fastest);
}

#[cfg(target_arch = "x86_64")]
#[test]
fn memory_is_what_the_readme_says() {
    assert_eq!(size_of::<Accumulators<8>>(), 52);
}

fn thresholds() -> impl Strategy<Value = u16> {
    prop_oneof![Just(128), Just(600), Just(32_639), 128..=32_639_u16]
}

proptest! {
    #[test]
    fn every_law_is_its_definition(
        threshold in thresholds(),
        frames in prop::collection::vec((any::<[i8; 3]>(), 0..400_u32), 1..20),
    ) {
        let tick = Rate::from_hz(1000).unwrap();
        let limit = i64::from(threshold);
        for law in LAWS {
            let mut motors = Accumulation::new(law, threshold, tick).unwrap().motors();
            let mut sums = [0_i64; 3];
            for &(speeds, ticks) in &frames {
                motors.set_speeds(speeds);
                for _ in 0..ticks {
                    let expected = [0, 1, 2].map(|m| {
                        let speed = i64::from(speeds[m]);
                        sums[m] += if law == SpeedLaw::CarrySigned { speed } else { speed.abs() };
                        if sums[m].abs() < limit {
                            return 0;
                        }
                        sums[m] = match law {
                            SpeedLaw::Reset => 0,
                            _ => sums[m] - sums[m].signum() * limit,
                        };
                        i32::from(speeds[m].signum())
                    });
                    prop_assert_eq!(motors.tick(), expected);
                    prop_assert_eq!(motors.sums().map(i64::from), sums);
                }
            }
        }
    }

    #[test]
    fn with_the_sign_position_and_rest_are_the_sum_of_all_speeds(
        threshold in thresholds(),
        frames in prop::collection::vec((any::<i8>(), 0..2000_u32), 1..20),
    ) {
        let tick = Rate::from_hz(1000).unwrap();
        let mut motors = Accumulation::new(SpeedLaw::CarrySigned, threshold, tick).unwrap().motors();
        let (mut position, mut total) = (0, 0);
        for (speed, ticks) in frames {
            motors.set_speeds([speed]);
            position += run(&mut motors, ticks)[0];
            total += i64::from(speed) * i64::from(ticks);
        }
        prop_assert_eq!(position * i64::from(threshold) + i64::from(motors.sums()[0]), total);
    }

    #[test]
    fn the_mean_is_what_many_ticks_make(
        threshold in thresholds(),
        speed in any::<i8>(),
    ) {
        const TICKS: u32 = 100_000;
        let tick = Rate::from_hz(1000).unwrap();
        for law in LAWS {
            let law = Accumulation::new(law, threshold, tick).unwrap();
            let mut motors = law.motors();
            motors.set_speeds([speed]);
            let (speed_units, step_units) = (i64::from(speed), i64::from(threshold));
            let (steps, ticks) = if law.law() == SpeedLaw::Reset && speed != 0 {
                let least = speed_units.abs();
                (speed_units.signum(), (step_units + least - 1) / least)
            } else {
                (speed_units, step_units)
            };
            let mean = law.steps_per_tick(speed);
            prop_assert!(is(mean, steps, ticks));
            // Whole steps, towards zero.
            prop_assert_eq!(run(&mut motors, TICKS)[0], steps * i64::from(TICKS) / ticks);
            let nominal = f64::from(speed) / f64::from(threshold);
            prop_assert!((nominal * (1.0 + law.error(speed)) - mean).abs() < 1e-12);
        }
    }
}
