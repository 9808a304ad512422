//! Planned turns: where the firmware's accumulators, counted tick by tick, bring a motor.

use std::collections::{HashMap, HashSet};

use dancer::{Easing, Law, Motor, TurnError};
use pattern_codec::dance::{Threshold, Timing};
use proptest::prelude::*;

use crate::{easings, laws};

/// The firmware: one addition and one comparison per tick.
struct Firmware {
    law: Law,
    threshold: i64,
    accumulator: i64,
    position: i64,
}

impl Firmware {
    fn new(law: Law) -> Self {
        Self {
            law,
            threshold: 600,
            accumulator: 0,
            position: 0,
        }
    }

    fn ticks(&mut self, speed: i8, ticks: u32) {
        let speed = i64::from(speed);
        for _ in 0..ticks {
            self.accumulator += if self.law == Law::CarrySigned {
                speed
            } else {
                speed.abs()
            };
            if self.accumulator.abs() >= self.threshold {
                let step = if self.law == Law::CarrySigned {
                    self.accumulator.signum()
                } else {
                    speed.signum()
                };
                self.position += step;
                self.accumulator = match self.law {
                    Law::Reset => 0,
                    Law::CarryMagnitude => self.accumulator - self.threshold,
                    _ => self.accumulator - step * self.threshold,
                };
            }
        }
    }
}

fn motor(law: Law) -> Motor {
    Motor::new(law, Threshold::DEFAULT, Timing::DEFAULT)
}

proptest! {
    #[test]
    fn a_motor_is_where_the_ticks_bring_it(law in laws(), frame_ticks in 1_u32..700, threshold in 128_u16..2000, speeds in prop::collection::vec(any::<i8>(), 0..40)) {
        let mut motor = Motor::new(law, Threshold::new(threshold).unwrap(), Timing::new(1000, frame_ticks).unwrap());
        let mut firmware = Firmware { threshold: threshold.into(), ..Firmware::new(law) };
        for speed in speeds {
            motor.run(speed);
            firmware.ticks(speed, frame_ticks);
            prop_assert_eq!(motor.position(), firmware.position);
        }
    }

    #[test]
    fn turns_end_where_they_should(law in laws(), turns in prop::collection::vec((-100_i32..=100, 1_u16..60, easings()), 1..8)) {
        let mut planned = motor(law);
        let mut firmware = Firmware::new(law);
        let mut wanted = 0;
        for (percent, frames, easing) in turns {
            // Up to half of the highest speed, which leaves room for every easing.
            let half_steps = percent * i32::from(frames) * 20 / 100;
            wanted += i64::from(half_steps);
            // The error of one turn is made up for by the next.
            let travel = i32::try_from(wanted - planned.position()).unwrap();
            match planned.turn(travel, frames, easing) {
                Ok(turn) => {
                    prop_assert_eq!(turn.len(), usize::from(frames));
                    for speed in turn {
                        prop_assert!(i32::from(speed) * travel >= 0 && speed > -128);
                        planned.run(speed);
                        firmware.ticks(speed, 200);
                    }
                }
                Err(error) => {
                    // One frame of the reset law makes 20, 22, 25, 28, 33 or 40 half steps.
                    let coarse = law == Law::Reset && frames < 4;
                    prop_assert!(coarse, "{error}");
                    wanted = planned.position();
                }
            }
            prop_assert_eq!(firmware.position, planned.position());
            let most = i64::from(law == Law::Reset);
            prop_assert!((firmware.position - wanted).abs() <= most);
        }
    }
}

/// Every number of half steps that some speeds make in a number of frames, tick by tick.
fn makeable(threshold: u16, frame_ticks: u32, frames: u16) -> HashSet<i64> {
    // What a frame makes does not depend on the position.
    let mut frame_after = HashMap::new();
    let mut reached = HashSet::from([(0, 0)]);
    for _ in 0..frames {
        let before = core::mem::take(&mut reached);
        for (position, accumulator) in before {
            let after = frame_after.entry(accumulator).or_insert_with(|| {
                let frame = |speed| {
                    let mut firmware = Firmware {
                        law: Law::Reset,
                        threshold: threshold.into(),
                        accumulator,
                        position: 0,
                    };
                    firmware.ticks(speed, frame_ticks);
                    (firmware.position, firmware.accumulator)
                };
                (0..=127).map(frame).collect::<HashSet<_>>()
            });
            reached.extend(after.iter().map(|(by, left)| (position + by, *left)));
        }
    }
    reached.into_iter().map(|(position, _)| position).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// A frame may be shorter than a step: then it is the accumulator that the speeds fill.
    #[test]
    fn what_short_frames_can_make_is_found(
        threshold in 128_u16..700,
        frame_ticks in 1_u32..=4,
        frames in 1_u16..10,
        negative: bool,
    ) {
        let timing = Timing::new(1000, frame_ticks).unwrap();
        let motor = Motor::new(Law::Reset, Threshold::new(threshold).unwrap(), timing);
        for half_steps in makeable(threshold, frame_ticks, frames) {
            let travel = i32::try_from(half_steps).unwrap() * if negative { -1 } else { 1 };
            let turn = motor.turn(travel, frames, Easing::Linear);
            prop_assert!(turn.is_ok(), "{travel} in {frames} frames: {turn:?}");
            let mut firmware = Firmware { threshold: threshold.into(), ..Firmware::new(Law::Reset) };
            turn.unwrap().into_iter().for_each(|speed| firmware.ticks(speed, frame_ticks));
            prop_assert!(firmware.position.abs_diff(travel.into()) <= 1);
        }
    }
}

/// Plans every turn that brute force can make, runs it tick by tick, and counts them.
fn check_makeable(threshold: u16, frame_ticks: u32, frames: u16, easing: Easing) -> u32 {
    let timing = Timing::new(1000, frame_ticks).unwrap();
    let motor = Motor::new(Law::Reset, Threshold::new(threshold).unwrap(), timing);
    let mut planned = 0;
    for half_steps in makeable(threshold, frame_ticks, frames) {
        let half_steps = i32::try_from(half_steps).unwrap();
        let turn = match motor.turn(half_steps, frames, easing) {
            // The easing alone, without what the law loses, needs more than the highest speed.
            Err(TurnError::TooFast { .. }) => continue,
            turn => turn.unwrap_or_else(|error| panic!("{threshold}, {frame_ticks}: {error}")),
        };
        let mut firmware = Firmware {
            threshold: threshold.into(),
            ..Firmware::new(Law::Reset)
        };
        turn.iter()
            .for_each(|speed| firmware.ticks(*speed, frame_ticks));
        let off = firmware.position.abs_diff(half_steps.into());
        assert!(
            off <= 1,
            "{threshold}, {frame_ticks}: {}",
            firmware.position
        );
        planned += 1;
    }
    planned
}

/// The easing leaves too much to the last frames, or only a speed that loses more meets the end.
#[test]
fn what_any_speeds_can_make_is_not_refused() {
    for (threshold, frame_ticks, frames, easing) in [
        (137, 22, 4, Easing::In),
        (277, 27, 4, Easing::Smooth),
        (153, 28, 4, Easing::In),
        (165, 38, 4, Easing::Smooth),
        (134, 32, 5, Easing::Smooth),
        (150, 12, 5, Easing::Smooth),
        (133, 22, 5, Easing::Smooth),
        (257, 28, 6, Easing::In),
    ] {
        assert!(check_makeable(threshold, frame_ticks, frames, easing) > 9);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn no_turn_of_few_frames_is_refused_that_any_speeds_can_make(
        threshold in 128_u16..1000,
        frame_ticks in 1_u32..40,
        frames in 1_u16..6,
        easing in easings(),
    ) {
        check_makeable(threshold, frame_ticks, frames, easing);
    }
}

#[test]
fn frames_shorter_than_a_step_follow_the_way() {
    // At 127 a step of 600 takes 5 ticks.
    for frame_ticks in [1, 2, 4] {
        let timing = Timing::new(1000, frame_ticks).unwrap();
        let mut motor = Motor::new(Law::Reset, Threshold::DEFAULT, timing);
        let mut firmware = Firmware::new(Law::Reset);
        let (mut made, mut worst) = (0.0, 0.0_f64);
        for speed in motor.turn(-40, 1200, Easing::Linear).unwrap() {
            motor.run(speed);
            firmware.ticks(speed, frame_ticks);
            assert_eq!(motor.position(), firmware.position);
            made += 1.0;
            let travel = -40.0 * made / 1200.0;
            worst = worst.max((f64::from(i32::try_from(motor.position()).unwrap()) - travel).abs());
        }
        assert_eq!(motor.position(), -40);
        // Whole steps lag by up to one.
        assert!(
            worst < 1.1,
            "{worst} half steps off the course with {frame_ticks} ticks"
        );
    }
}

#[test]
fn a_million_ticks_are_those_of_the_reference() {
    let cases = include_str!("../data/accum.csv");
    let mut rows = 0;
    for row in cases.lines().skip(1) {
        let fields: Vec<&str> = row.split(',').collect();
        let speed: i8 = fields[0].parse().unwrap();
        let timing = Timing::new(1000, 1_000_000).unwrap();
        for (law, steps) in [
            (Law::Reset, fields[2]),
            (Law::CarryMagnitude, fields[3]),
            (Law::CarrySigned, fields[3]),
        ] {
            for (speed, sign) in [(speed, 1), (speed.wrapping_neg(), -1)] {
                let mut motor = Motor::new(law, Threshold::DEFAULT, timing);
                motor.run(speed);
                let wanted: i64 = steps.parse().unwrap();
                assert_eq!(motor.position(), sign * wanted, "{law:?} {speed}");
            }
        }
        rows += 1;
    }
    assert!(rows > 40, "{rows}");
}

#[test]
fn the_reset_law_has_44_speeds() {
    let timing = Timing::new(1000, 100_000_000).unwrap();
    let mut positions: Vec<_> = (1..=127)
        .map(|speed| {
            let mut motor = Motor::new(Law::Reset, Threshold::DEFAULT, timing);
            motor.run(speed);
            motor.position()
        })
        .collect();
    positions.dedup();
    assert_eq!(positions.len(), 44);
}

#[test]
fn what_no_motor_makes_is_refused() {
    let turn = |law, half_steps, frames| {
        motor(law)
            .turn(half_steps, frames, Easing::Linear)
            .map(|_| ())
    };
    for law in Law::ALL {
        assert_eq!(turn(law, 0, 0), Ok(()));
        let frames = 10;
        let error = turn(law, 430, frames).unwrap_err();
        assert!(
            matches!(
                error,
                TurnError::TooFast {
                    frame: 1,
                    frames: 10,
                    speed: 129,
                    max: 127
                }
            ),
            "{error}"
        );
        assert!(turn(law, 400, frames).is_ok());
        assert!(turn(law, 2, 0).is_err() && turn(law, -1, 0).is_err());
    }
    // Nine frames of 40 and one of 33 are the next.
    let error = turn(Law::Reset, 397, 10).unwrap_err().to_string();
    assert_eq!(
        error,
        "397 half steps in 10 frames: the nearest plan found makes 400"
    );
    assert!(turn(Law::CarrySigned, 397, 10).is_ok());
}

#[test]
fn a_lower_highest_speed_is_kept() {
    for law in Law::ALL {
        assert_eq!(motor(law).with_max_speed(200).max_speed(), 127);
        let slow = motor(law).with_max_speed(60);
        assert_eq!(slow.max_speed(), 60);
        // A frame at 60 makes 20 half steps.
        let turn = slow.turn(200, 10, Easing::Linear).unwrap();
        assert_eq!(turn, [60; 10]);
        let refused = slow.turn(210, 10, Easing::Linear).unwrap_err();
        assert!(
            matches!(
                refused,
                TurnError::TooFast {
                    speed: 63,
                    max: 60,
                    ..
                }
            ),
            "{refused}"
        );
    }
}
