//! Motors, turns and easings with anything: the answer is right, against its definition in 128
//! bits, or an error.

use dancer::{Easing, Law, Motor, TurnError};
use pattern_codec::dance::{Threshold, Timing};
use proptest::prelude::*;
use test_support::{any_i32, any_u32};

use crate::{easings, laws};

/// A frame of 0 ticks is one of 1.
fn motor(law: Law, threshold: u16, frame_ticks: u32) -> Motor {
    let timing = Timing::new(1, frame_ticks.max(1)).unwrap();
    Motor::new(law, Threshold::new(threshold).unwrap(), timing)
}

/// Half steps of frames at a speed, by the definition of the law, in closed form.
fn half_steps(law: Law, threshold: u16, ticks: u64, speed: i8) -> i128 {
    let (threshold, ticks) = (i128::from(threshold), i128::from(ticks));
    let magnitude = i128::from(speed).abs();
    let steps = match law {
        _ if magnitude == 0 => 0,
        Law::Reset => ticks / ((threshold + magnitude - 1) / magnitude),
        _ => ticks * magnitude / threshold,
    };
    steps * i128::from(speed.signum())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn motors_run(
        frame_ticks in any_u32(),
        threshold in 128..=u16::MAX,
        speed: i8,
        law in laws(),
    ) {
        let mut motor = motor(law, threshold, frame_ticks);
        for frames in 1..4 {
            motor.run(speed);
            let ticks = frames * u64::from(frame_ticks.max(1));
            let wanted = half_steps(law, threshold, ticks, speed);
            prop_assert_eq!(i128::from(motor.position()), wanted);
        }
    }

    #[test]
    fn turns_end_or_say_why(
        frame_ticks in any_u32(),
        threshold in 128..=u16::MAX,
        law in laws(),
        easing in easings(),
        before: i8,
        max_speed: u8,
        half_steps in any_i32(),
        frames in prop_oneof![0..9_u16, 0..300_u16],
    ) {
        let mut motor = motor(law, threshold, frame_ticks).with_max_speed(max_speed);
        motor.run(before);
        let start = motor.position();
        let wanted = i64::from(half_steps);
        match motor.turn(half_steps, frames, easing) {
            Ok(turn) => {
                prop_assert_eq!(turn.len(), usize::from(frames));
                for speed in turn {
                    prop_assert!(speed.unsigned_abs() <= motor.max_speed());
                    prop_assert!(i64::from(speed) * wanted >= 0);
                    motor.run(speed);
                }
                prop_assert!((motor.position() - start).abs_diff(wanted) <= 1);
            }
            Err(TurnError::TooFast { speed, max, .. }) => prop_assert!(speed > max.into()),
            Err(TurnError::Unreachable { nearest, .. }) => {
                prop_assert!(nearest.abs_diff(wanted) > u64::from(frames > 0));
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn eased_speeds(highest: i8, frames in prop_oneof![0..9_u16, any::<u16>(), Just(u16::MAX)], easing in easings()) {
        let speeds = easing.speeds(highest, frames);
        prop_assert_eq!(speeds.len(), usize::from(frames));
        for (k, speed) in (0_u16..).zip(speeds).take(400) {
            // At the middle of the frame.
            let t = (f64::from(k) + 0.5) / f64::from(frames);
            let part = match easing {
                Easing::In => t,
                Easing::Out => 1.0 - t,
                Easing::Smooth => 4.0 * t * (1.0 - t),
                Easing::Linear => 1.0,
            };
            prop_assert!((f64::from(speed) - f64::from(highest) * part).abs() <= 0.5 + 1e-9);
        }
    }
}
