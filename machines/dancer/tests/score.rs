//! Scores: what they become, and what is refused.
#![cfg(test)]

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

#[test]
fn wrong_scores_are_refused_with_line_and_move() {
    let good = "[[move]]\nmotor = 'arm'\nat_s = 0\nfor_s = 1\nto_deg = 45\n";
    for (from, to, wanted) in [
        (
            "to_deg",
            "to_grad",
            "line 15, move 1: unknown field `to_grad`",
        ),
        ("at_s = 0\n", "", "line 11, move 1: missing field `at_s`"),
        (
            "0\n",
            "0.3\n",
            "line 11, move 1: at_s = 0.3 is no whole number of frames of 0.2 s",
        ),
        (
            "at_s = 0",
            "at_s = -1",
            "line 11, move 1: at_s = -1 is not within 0 s",
        ),
        (
            "at_s = 0",
            "at_s = nan",
            "line 11, move 1: at_s = NaN is not within 0 s",
        ),
        (
            "at_s = 0",
            "at_s = 1e9",
            "line 11, move 1: at_s = 1000000000 is not within 0 s",
        ),
        (
            "at_s = 0",
            "at_s = 13107",
            "line 11, move 1: it ends at 13108 s, the longest dance at 13107 s",
        ),
        (
            "at_s = 0",
            "at_s = 'x'",
            "line 13, move 1: invalid type: string",
        ),
        (
            "for_s = 1",
            "for_s = 0",
            "line 11, move 1: for_s = 0 is not above 0",
        ),
        (
            "'arm'",
            "'leg'",
            "line 11, move 1: no motor is called \"leg\"",
        ),
        (
            "to_deg = 45",
            "",
            "line 11, move 1: one of speed, to_deg and turn_deg must be given, here are 0",
        ),
        (
            "to_deg = 45",
            "to_deg = 45\nspeed = 1",
            "line 11, move 1: one of speed, to_deg and turn_deg must be given, here are 2",
        ),
        (
            "to_deg = 45",
            "speed = -128",
            "line 11, move 1: speed = -128, max 127",
        ),
        (
            "to_deg = 45",
            "to_deg = inf",
            "line 11, move 1: to_deg = inf is not finite",
        ),
        ("to_deg = 45", "to_deg = 1e300", "line 11, move 1: 2.2"),
        (
            "to_deg = 45",
            "to_deg = 45\nrepeat = 2",
            "line 11, move 1: repeat and every_s go together",
        ),
        (
            "to_deg = 45",
            "to_deg = 45\nrepeat = 2\nevery_s = 0.8",
            "line 11, move 1: it starts at 0.8 s, before move 1 of \"arm\" ends at 1 s",
        ),
        (
            "to_deg = 45",
            "to_deg = 45\nrepeat = 4000000000\nevery_s = 5",
            "line 11, move 1: it ends at 13111 s, the longest dance at 13107 s",
        ),
        (
            "to_deg = 45",
            "to_deg = 45\nrepeat = 4000000000\nevery_s = 0",
            "line 11, move 1: it starts at 0 s, before move 1 of \"arm\" ends at 1 s",
        ),
        (
            "to_deg = 45",
            "to_deg = 45\nrepeat = 0\nevery_s = 5",
            "line 11, move 1: repeat = 0 is not above 0",
        ),
        (
            "for_s = 1",
            "for_s = 13107.2",
            "line 11, move 1: for_s = 13107.2 is not within 65535 frames",
        ),
        (
            "to_deg = 45",
            "to_deg = 99",
            "line 11, move 1: \"arm\": frame 1 of 5 needs a speed of 132, max 127",
        ),
        (
            "to_deg = 45",
            "to_deg = 45\neasing = 'bouncy'",
            "line 16, move 1: unknown variant `bouncy`",
        ),
        (
            "to_deg = 45",
            "to_deg = 45\n[[move]]\nmotor = 'wheel'\nat_s = 3\nfor_s = 1\nspeed = 101",
            "line 16, move 2: speed = 101, max 100",
        ),
        (
            "to_deg = 45",
            "to_deg = 45\n[[move]]\nmotor = 'arm'\nat_s = 0.8\nfor_s = 1\nspeed = 1",
            "line 16, move 2: it starts at 0.8 s, before move 1 of \"arm\" ends at 1 s",
        ),
        ("to_deg = 45", "to_deg = 45 46", "line 15, move 1: "),
        (
            "[[move]]",
            "[[motor]]\nname = 'arm'\nhalf_step_deg = 1\n[[move]]",
            "line 11, motor 3: the name \"arm\" is taken by motor 1",
        ),
        (
            "[[move]]",
            "[[motor]]\nname = 'head'\nhalf_step_deg = 0\n[[move]]",
            "line 11, motor 3: half_step_deg = 0 is not above 0",
        ),
        (
            "[[move]]",
            "[[motor]]\nname = 'head'\nhalf_step_deg = 1\nmax_speed = 128\n[[move]]",
            "line 11, motor 3: max_speed = 128 is not within 1..=127",
        ),
    ] {
        assert!(good.contains(from), "{from}");
        let text = format!("{MOTORS}\n{}", good.replacen(from, to, 1));
        let error = text
            .parse::<Score>()
            .and_then(|score| score.compile::<8>(Law::CarryMagnitude));
        let error = error.unwrap_err().to_string();
        assert!(error.starts_with(wanted), "{error}\nwanted: {wanted}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
    for (head, wanted) in [
        (
            "length_s = 0.8",
            "line 1: length_s = 0.8 is not at or after the end of the last move",
        ),
        (
            "length_s = 99999999",
            "line 1: length_s = 99999999 is not within 65535 frames",
        ),
        (
            "tick_us = 0",
            "line 1: a frame of 200 ticks of 0 us has no length",
        ),
        ("threshold = 127", "line 1: a threshold of 127, min 128"),
        ("tempo = 3", "line 1: unknown field `tempo`"),
        (
            "title = 'Gavotte'\nlength_s = -1",
            "line 2: length_s = -1 is not within 0 s",
        ),
        (
            "length_s = 5\n\nthreshold = 1",
            "line 3: a threshold of 1, min 128",
        ),
        (
            "tick_us = 500\nframe_ticks = 0",
            "line 2: a frame of 0 ticks of 500 us has no length",
        ),
    ] {
        let error = format!("{head}\n{MOTORS}\n{good}")
            .parse::<Score>()
            .unwrap_err()
            .to_string();
        assert!(error.starts_with(wanted), "{error}");
    }
    let none = |text: &str| text.parse::<Score>().unwrap_err().kind;
    assert_eq!(none(""), ScoreErrorKind::NoMotor);
    assert_eq!(none(MOTORS), ScoreErrorKind::NoFrames);
}

#[test]
fn moves_in_one_line_each_are_named_too() {
    let score = "
motor = [{ name = 'arm', half_step_deg = 1 }]
move = [
    { motor = 'arm', at_s = 0, for_s = 1, turn_deg = 20 },
    { motor = 'arm', at_s = 1, for_s = 1, turn_deg = -20 }, # back
]";
    assert!(score.parse::<Score>().is_ok());
    for (from, to, wanted) in [
        (
            "1, for_s",
            "1, fur_s",
            "line 5, move 2: unknown field `fur_s`",
        ),
        ("at_s = 1, ", "", "line 5, move 2: missing field `at_s`"),
        (
            "at_s = 1",
            "at_s = 0.8",
            "line 5, move 2: it starts at 0.8 s",
        ),
        ("-20", "-", "line 5"),
        ("half", "full", "line 2, motor 1: unknown field"),
    ] {
        let error = score
            .replace(from, to)
            .parse::<Score>()
            .unwrap_err()
            .to_string();
        assert!(error.starts_with(wanted), "{error}");
    }
}

#[test]
fn what_the_reset_law_cannot_make_is_refused() {
    let moves = "\n[[move]]\nmotor = 'arm'\nat_s = 0\nfor_s = 0.2\nturn_deg = 13.5\n";
    let score: Score = format!("{MOTORS}{moves}").parse().unwrap();
    assert!(score.compile::<8>(Law::CarrySigned).is_ok());
    let error = score.compile::<8>(Law::Reset).unwrap_err().to_string();
    let wanted =
        "line 11, move 1: \"arm\": 30 half steps in 1 frames: the nearest plan found makes 28";
    assert_eq!(error, wanted);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn turns_end_within_one_half_step(
        law in prop::sample::select(&Law::ALL[..]),
        turns in prop::collection::vec((-1.0_f64..1.0, 4_u32..30, prop::sample::select(&["linear", "in", "out", "smooth"][..])), 1..12),
    ) {
        let (mut moves, mut start) = (String::new(), 0);
        for (share, frames, easing) in &turns {
            // Up to 20 half steps of 0.45 deg in a frame.
            let deg = share * 9.0 * f64::from(*frames);
            let (at_s, for_s) = (f64::from(start) * 0.2, f64::from(*frames) * 0.2);
            moves += &format!("[[move]]\nmotor = 'arm'\nat_s = {at_s}\nfor_s = {for_s}\nturn_deg = {deg}\neasing = '{easing}'\n");
            start += frames;
        }
        let dance = compile(&moves, law);
        let mut asked = 0.0;
        prop_assert_eq!(dance.landings.len(), turns.len());
        for (landing, (share, frames, _)) in dance.landings.iter().zip(&turns) {
            asked += share * 9.0 * f64::from(*frames) / 0.45;
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
