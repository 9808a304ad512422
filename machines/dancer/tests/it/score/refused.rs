//! Scores that are refused, with line and part.

use super::*;

/// Its one move starts in line 11.
const GOOD: &str = "[[move]]\nmotor = 'arm'\nat_s = 0\nfor_s = 1\nto_deg = 45\n";

/// What is said in one line about the good score with one part replaced.
fn refusal(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    let text = format!("{MOTORS}\n{}", GOOD.replacen(from, to, 1));
    let error = text
        .parse::<Score>()
        .and_then(|score| score.compile::<8>(Law::CarryMagnitude));
    let error = error.unwrap_err().to_string();
    assert_eq!(error.lines().count(), 1, "{error}");
    error
}

fn assert_names_the_move(from: &str, to: &str, wanted: &str) {
    let error = refusal(from, to);
    let said = error.strip_prefix("line 11, move 1: ");
    assert!(
        said.is_some_and(|said| said.starts_with(wanted)),
        "{error}\nwanted: {wanted}"
    );
}

#[test]
fn wrong_times_and_motors_are_refused_with_line_and_move() {
    let no_start = "missing field `at_s`";
    let too_late = "it ends at 13108 s, the longest dance at 13107 s";
    let no_frame = "at_s = 0.3 is no whole number of frames of 0.2 s";
    let too_long = "for_s = 13107.2 is not within 65535 frames";
    for (from, to, wanted) in [
        ("at_s = 0", "", no_start),
        ("at_s = 0", "at_s = 0.3", no_frame),
        ("at_s = 0", "at_s = -1", "at_s = -1 is not within 0 s"),
        ("at_s = 0", "at_s = nan", "at_s = NaN is not within 0 s"),
        ("0", "1e9", "at_s = 1000000000 is not within 0 s"),
        ("at_s = 0", "at_s = 13107", too_late),
        ("for_s = 1", "for_s = 0", "for_s = 0 is not above 0"),
        ("for_s = 1", "for_s = 13107.2", too_long),
        ("'arm'", "'leg'", "no motor is called \"leg\""),
    ] {
        assert_names_the_move(from, to, wanted);
    }
}

#[test]
fn wrong_ways_are_refused_with_line_and_move() {
    let needed = "one of speed, to_deg and turn_deg must be given";
    for (way, wanted) in [
        ("", format!("{needed}, here are 0")),
        ("to_deg = 45\nspeed = 1", format!("{needed}, here are 2")),
        ("speed = -128", "speed = -128, max 127".into()),
        ("to_deg = inf", "to_deg = inf is not finite".into()),
        ("to_deg = 1e300", "2.2".into()),
    ] {
        assert_names_the_move("to_deg = 45", way, &wanted);
    }
    let too_fast = "\"arm\": frame 1 of 5 needs a speed of 132, max 127";
    assert_names_the_move("to_deg = 45", "to_deg = 99", too_fast);
}

#[test]
fn wrong_repetitions_are_refused_with_line_and_move() {
    let behind_itself =
        |start: &str| format!("it starts at {start} s, before move 1 of \"arm\" ends at 1 s");
    let too_late = "it ends at 13111 s, the longest dance at 13107 s";
    for (repetition, wanted) in [
        ("repeat = 2", "repeat and every_s go together".into()),
        ("repeat = 2\nevery_s = 0.8", behind_itself("0.8")),
        ("repeat = 4000000000\nevery_s = 5", too_late.into()),
        ("repeat = 4000000000\nevery_s = 0", behind_itself("0")),
        (
            "repeat = 0\nevery_s = 5",
            "repeat = 0 is not above 0".into(),
        ),
    ] {
        let repeated = format!("to_deg = 45\n{repetition}");
        assert_names_the_move("to_deg = 45", &repeated, &wanted);
    }
}

#[test]
fn what_is_wrong_in_another_line_is_refused_there() {
    let key = "line 15, move 1: unknown field `to_grad`";
    let start = "line 13, move 1: invalid type: string";
    let easing = "line 16, move 1: unknown variant `bouncy`";
    for (from, to, wanted) in [
        ("to_deg", "to_grad", key),
        ("at_s = 0", "at_s = 'x'", start),
        ("= 45", "= 45 46", "line 15, move 1: "),
        ("= 45", "= 45\neasing = 'bouncy'", easing),
    ] {
        let error = refusal(from, to);
        assert!(error.starts_with(wanted), "{error}\nwanted: {wanted}");
    }
    for (second, wanted) in [
        (
            "motor = 'wheel'\nat_s = 3\nfor_s = 1\nspeed = 101",
            "speed = 101, max 100",
        ),
        (
            "motor = 'arm'\nat_s = 0.8\nfor_s = 1\nspeed = 1",
            "it starts at 0.8 s, before move 1 of \"arm\" ends at 1 s",
        ),
    ] {
        let error = refusal("= 45", &format!("= 45\n[[move]]\n{second}"));
        let said = error.strip_prefix("line 16, move 2: ");
        assert!(said.is_some_and(|said| said.starts_with(wanted)), "{error}");
    }
}

#[test]
fn wrong_motors_are_refused_with_line_and_motor() {
    for (motor, wanted) in [
        (
            "name = 'arm'\nhalf_step_deg = 1",
            "the name \"arm\" is taken by motor 1",
        ),
        (
            "name = 'head'\nhalf_step_deg = 0",
            "half_step_deg = 0 is not above 0",
        ),
        (
            "name = 'head'\nhalf_step_deg = 1\nmax_speed = 128",
            "max_speed = 128 is not within 1..=127",
        ),
    ] {
        let error = refusal("[[move]]", &format!("[[motor]]\n{motor}\n[[move]]"));
        let said = error.strip_prefix("line 11, motor 3: ");
        assert!(said.is_some_and(|said| said.starts_with(wanted)), "{error}");
    }
}

#[test]
fn wrong_heads_are_refused_with_their_line() {
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
        let error = format!("{head}\n{MOTORS}\n{GOOD}")
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
