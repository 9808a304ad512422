//! Scores: what they become, and what is refused.

mod refused;

use dancer::{Choreography, Law, Motor, Score, ScoreErrorKind};
use pattern_codec::dance::{Threshold, Timing};
use proptest::prelude::*;

const MOTORS: &str = "
[[motor]]
name = 'arm'
half_step_deg = 0.45

[[motor]]
name = 'wheel'
half_step_deg = 0.9
max_speed = 100
";

fn compile(moves: &str, law: Law) -> Choreography<8> {
    let score: Score = format!("{MOTORS}{moves}")
        .parse()
        .unwrap_or_else(|error| panic!("{error}"));
    score.compile(law).unwrap_or_else(|error| panic!("{error}"))
}

/// Where the firmware brings a motor.
fn position(frames: &[[i8; 8]], law: Law, motor: usize) -> i64 {
    let mut one = Motor::new(law, Threshold::DEFAULT, Timing::DEFAULT);
    frames.iter().for_each(|frame| one.run(frame[motor]));
    one.position()
}

#[test]
fn an_arm_waves_as_asked() {
    for law in Law::ALL {
        let dance = compile(
            "
            [[move]]
            motor = 'arm'
            at_s = 0.4
            for_s = 1
            to_deg = 45
            easing = 'smooth'
            [[move]]
            motor = 'arm'
            at_s = 1.4
            for_s = 0.6
            turn_deg = -45.0
            repeat = 3
            every_s = 0.8
            ",
            law,
        );
        assert_eq!(dance.frames.len(), 18, "{law:?}");
        assert_eq!(dance.frames[..2], [[0; 8]; 2]);
        // 45 deg, then three times -45 deg, in half steps.
        let asked: Vec<_> = dance
            .landings
            .iter()
            .map(|landing| {
                (
                    landing.number,
                    landing.frame,
                    landing.asked_half_steps.round(),
                )
            })
            .collect();
        assert_eq!(
            asked,
            [
                (1, 7, 100.0),
                (2, 10, 0.0),
                (2, 14, -100.0),
                (2, 18, -200.0)
            ]
        );
        for landing in &dance.landings {
            assert!(
                landing.error_half_steps().abs() <= 1.0,
                "{law:?}: {landing:?}"
            );
            let off =
                f64::from(i32::try_from(landing.half_steps).unwrap()) - landing.asked_half_steps;
            assert!((landing.error_half_steps() - off).abs() < 1e-12);
            let there = usize::try_from(landing.frame).unwrap();
            assert_eq!(position(&dance.frames[..there], law, 0), landing.half_steps);
        }
    }
}

#[test]
fn speeds_are_written_as_they_are() {
    let dance = compile(
        "
        [[move]]
        motor = 'wheel'
        at_s = 0
        for_s = 5
        speed = -60
        [[move]]
        motor = 'wheel'
        at_s = 5
        for_s = 1
        speed = 90
        easing = 'smooth'
        ",
        Law::Reset,
    );
    let wheel: Vec<i8> = dance.frames.iter().map(|frame| frame[1]).collect();
    assert_eq!(wheel[..25], [-60; 25]);
    assert_eq!(wheel[25..], [32, 76, 90, 76, 32]);
    assert!(dance.landings.is_empty());
}

#[test]
fn other_timings_count() {
    let text = format!(
        "title = 'Gavotte'\ntick_us = 500\nframe_ticks = 100\nthreshold = 300\nlength_s = 0.2\n{MOTORS}
        [[move]]\nmotor = 'arm'\nat_s = 0.05\nfor_s = 0.1\nturn_deg = 9"
    );
    let score: Score = text.parse().unwrap();
    assert_eq!(
        (
            score.frames(),
            score.timing().frame_us(),
            score.threshold().get()
        ),
        (4, 50_000, 300)
    );
    assert_eq!(score.title(), "Gavotte");
    assert!(score.motors().eq([("arm", 0.45), ("wheel", 0.9)]));
    let dance = score.compile::<2>(Law::CarrySigned).unwrap();
    // 20 half steps in two frames of 100 ticks at a threshold of 300.
    assert_eq!(dance.frames, [[0, 0], [30, 0], [30, 0], [0, 0]]);
    let error = score
        .compile::<1>(Law::CarrySigned)
        .unwrap_err()
        .to_string();
    assert_eq!(error, "line 1: 2 motors, a frame has 1");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn turns_end_within_one_half_step(
        law in prop::sample::select(&Law::ALL[..]),
        turns in prop::collection::vec((-1.0_f64..1.0, 4_u32..30, prop::sample::select(&["linear", "in", "out", "smooth"][..])), 1..12),
    ) {
        let (mut moves, mut start) = (String::new(), 0);
        for (fraction, frames, easing) in &turns {
            // Up to 20 half steps of 0.45 deg in a frame.
            let deg = fraction * 9.0 * f64::from(*frames);
            let (at_s, for_s) = (f64::from(start) * 0.2, f64::from(*frames) * 0.2);
            moves += &format!("[[move]]\nmotor = 'arm'\nat_s = {at_s}\nfor_s = {for_s}\nturn_deg = {deg}\neasing = '{easing}'\n");
            start += frames;
        }
        let dance = compile(&moves, law);
        let mut asked = 0.0;
        prop_assert_eq!(dance.landings.len(), turns.len());
        for (landing, (fraction, frames, _)) in dance.landings.iter().zip(&turns) {
            asked += fraction * 9.0 * f64::from(*frames) / 0.45;
            prop_assert!((landing.asked_half_steps - asked).abs() < 1e-6);
            prop_assert!(landing.error_half_steps().abs() <= 1.0, "{:?}", landing);
            let there = usize::try_from(landing.frame).unwrap();
            prop_assert_eq!(position(&dance.frames[..there], law, 0), landing.half_steps);
        }
        prop_assert!(dance.frames.iter().flatten().all(|speed| *speed > -128));
    }

    #[test]
    fn any_text_is_a_score_or_an_error(text in "(\\[\\[move\\]\\]\n|\\[\\[motor\\]\\]\n|motor = 'arm'\n|at_s = [0-9.-]{1,4}\n|for_s = [0-9]\n|speed = [0-9]{1,3}\n|to_deg = [0-9e-]{1,6}\n){0,12}") {
        for text in [format!("{MOTORS}{text}"), text] {
            if let Ok(score) = text.parse::<Score>() {
                let _ = score.compile::<3>(Law::CarryMagnitude);
            }
        }
    }
}
