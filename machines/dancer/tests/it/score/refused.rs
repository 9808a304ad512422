//! Scores that are refused, with line and part.

use super::*;

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
