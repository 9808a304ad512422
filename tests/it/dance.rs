//! The example `dance` from outside: its files, checked by other code than its own.

mod decoded;

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use decoded::{decoded, frames, header, steps};

use crate::tools::artefacts::{assert_all_or_none, assert_refused, run_into};
use crate::tools::report::report_in;

const LAWS: [&str; 3] = ["reset", "carry", "signed"];
const ARTEFACTS: [&str; 4] = ["data.h", "dance.vcd", "dance.svg", "report.json"];

/// A finished run's files.
struct Run {
    law: String,
    data: String,
    dump: String,
    picture: String,
    report: Value,
}

impl Run {
    fn of(law: &str, arguments: &[&str]) -> Self {
        let folder = TempDir::new().unwrap();
        let output = run_into(
            folder.path(),
            "dance",
            &[&["--law", law], arguments].concat(),
        );
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{errors}");
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        Self {
            law: law.to_owned(),
            data: read("data.h"),
            dump: read("dance.vcd"),
            picture: read("dance.svg"),
            report: report_in(folder.path()),
        }
    }

    fn number(&self, pointer: &str) -> i64 {
        let value = self.report.pointer(pointer).and_then(Value::as_i64);
        value.unwrap_or_else(|| panic!("{pointer}"))
    }

    fn eight(&self, pointer: &str) -> [i64; 8] {
        [0, 1, 2, 3, 4, 5, 6, 7].map(|k| self.number(&format!("{pointer}/{k}")))
    }
}

#[test]
fn the_shipped_score_is_danced_under_every_law() {
    for law in LAWS {
        let run = Run::of(law, &[]);
        let frames = frames(&run.data);
        assert_eq!(frames.len(), 1500);
        assert_eq!(run.number("/frames"), 1500);
        assert_eq!(run.number("/bytes_raw"), 12_000);
        let packed = i64::try_from(header(&run.data).1.len()).unwrap();
        assert_eq!(run.number("/bytes_packed"), packed);
        assert!(packed < 6000, "{packed}");
        assert_eq!(run.report["fits_at89c52"], true);
        assert_eq!(run.report["law"], *run.law);
        assert_eq!(run.number("/code_bytes"), 589);

        // The turn on the spot, 25 frames at +60 and -60.
        let turn = &frames[325..350];
        assert!(turn.iter().all(|frame| frame[6..] == [60, -60]));
        assert!(frames[324][6..] == [0, 0] && frames[350][6..] == [0, 0]);
        assert!(frames.iter().flatten().all(|speed| *speed > -128));

        let own = steps(&frames, law);
        assert_eq!(own, decoded(&run.dump), "{law}");
        let counts = own
            .each_ref()
            .map(|steps| i64::try_from(steps.len()).unwrap());
        let ends = own
            .each_ref()
            .map(|steps| steps.last().map_or(0, |(_, position)| *position));
        assert_eq!(run.eight("/steps"), counts, "{law}");
        assert_eq!(run.eight("/positions"), ends, "{law}");
        // Arms, elbows, waist and head go back to where they were.
        assert!(
            ends[..6].iter().all(|end| end.abs() <= 1),
            "{law}: {ends:?}"
        );
        let worst = run.report["worst_angle_error_steps"].as_f64().unwrap();
        assert!(worst > 0.0 && worst <= 1.0, "{law}: {worst}");

        let other = run
            .report
            .pointer("/other_law/law")
            .unwrap()
            .as_str()
            .unwrap();
        assert_ne!(other, law);
        let other = steps(&frames, other);
        let ends = other
            .each_ref()
            .map(|steps| steps.last().map_or(0, |(_, position)| *position));
        assert_eq!(run.eight("/other_law/positions"), ends, "{law}");
        for shown in [
            "right elbow",
            "angle in °",
            "The same frames under the law ",
        ] {
            assert!(run.picture.contains(shown), "{shown}");
        }
        assert!(run.picture.ends_with("</svg>\n"));
    }
}

const MOTOR: &str = "[[motor]]\nname = 'arm'\nhalf_step_deg = 0.9\n";

fn with_score<T>(score: &str, run: impl FnOnce(&str) -> T) -> T {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("own.toml");
    fs::write(&file, score).unwrap();
    run(file.to_str().unwrap())
}

#[test]
fn angles_are_where_they_were_asked() {
    let moves = "
        [[move]]\nmotor = 'arm'\nat_s = 1\nfor_s = 2\nto_deg = 100\neasing = 'smooth'
        [[move]]\nmotor = 'arm'\nat_s = 3\nfor_s = 2\nturn_deg = -130.4\neasing = 'in'";
    for law in LAWS {
        let run = with_score(&format!("{MOTOR}{moves}"), |file| {
            Run::of(law, &["--score", file])
        });
        let own = steps(&frames(&run.data), law);
        let until = |tick: u64| own[0].iter().rfind(|(at, _)| *at <= tick).unwrap().1;
        // 100 deg are 111.1 half steps, -30.4 deg are -33.8.
        assert!((until(3000) - 111).abs() <= 1, "{law}: {}", until(3000));
        assert!((until(5000) + 34).abs() <= 1, "{law}: {}", until(5000));
        assert!(own[0].iter().all(|(tick, _)| *tick > 1000));
        assert_eq!(decoded(&run.dump), own);
        assert!(own[1..].iter().all(Vec::is_empty));
    }
}

#[test]
fn control_characters_of_a_score_do_not_spoil_the_picture() {
    let motor = MOTOR.replace("'arm'", "\"left\\u001b<arm>\"");
    let score = format!("title = \"a\\u0001b\"\nlength_s = 1\n{motor}");
    let run = with_score(&score, |file| Run::of("carry", &["--score", file]));
    for shown in ["left &lt;arm&gt;", "a b"] {
        assert!(run.picture.lines().any(|line| line == shown), "{shown}");
    }
    let spoils = |c: char| c.is_control() && c != '\n';
    assert!(!run.picture.contains(spoils));
}

#[test]
fn a_dance_too_long_for_the_part_says_so() {
    // A new speed in every frame.
    let moves = "[[move]]\nmotor = 'arm'\nat_s = 0\nfor_s = 600\nspeed = 1\neasing = 'in'\n\
                 [[move]]\nmotor = 'leg'\nat_s = 0\nfor_s = 0.2\nspeed = 1\nrepeat = 1500\nevery_s = 0.4";
    let score = format!("{MOTOR}{}{moves}", MOTOR.replace("arm", "leg"));
    let run = with_score(&score, |file| {
        Run::of("carry", &["--score", file, "--code-bytes", "200"])
    });
    assert_eq!(run.report["fits_at89c52"], false);
    assert_eq!(frames(&run.data).len(), 3000);
    assert_eq!(run.number("/code_bytes"), 200);
}

#[test]
fn bad_input_is_one_line_and_leaves_nothing() {
    let one_move = "[[move]]\nmotor = 'arm'\nat_s = 0\nfor_s = 1\nturn_deg = 45\n";
    let score = format!("{MOTOR}{one_move}");
    let nine: String = (0..9)
        .map(|k| MOTOR.replace("arm", &format!("arm{k}")))
        .collect();
    for (score, arguments, wanted) in [
        (
            score.replace("45", "450"),
            &[][..],
            "own.toml: line 4, move 1: \"arm\": frame 1 of 5 needs a speed of 300, max 127",
        ),
        (
            score.replace("at_s", "start_s"),
            &[],
            "own.toml: line 6, move 1: unknown field `start_s`",
        ),
        (
            score.replace("for_s = 1", "for_s = 0.5"),
            &[],
            "own.toml: line 4, move 1: for_s = 0.5 is no whole number of frames of 0.2 s",
        ),
        (
            score.replace("'arm'\nat", "'leg'\nat"),
            &[],
            "own.toml: line 4, move 1: no motor is called \"leg\"",
        ),
        (
            format!("{score}{one_move}"),
            &[],
            "own.toml: line 9, move 2: it starts at 0 s, before move 1 of \"arm\" ends at 1 s",
        ),
        (
            format!("{nine}{}", one_move.replace("arm", "arm0")),
            &[],
            "own.toml: line 1: 9 motors, a frame has 8",
        ),
        (
            score.replace("= 45", "="),
            &[],
            "own.toml: line 8, move 1: ",
        ),
        (
            format!("threshold = 40000\n{score}").replace("turn_deg = 45", "speed = 45"),
            &["--law", "carry"],
            "data.h: a threshold of 40000",
        ),
        (
            format!("frame_ticks = 400000000\nlength_s = 400000\n{MOTOR}"),
            &[],
            "data.h: 400000000 ticks, max 268435456",
        ),
        (
            String::new(),
            &[],
            "own.toml: line 1: there is no [[motor]]",
        ),
        (
            score.clone(),
            &["--law", "waltz"],
            "invalid value 'waltz' for '--law <LAW>'",
        ),
        (score.clone(), &["--code-bytes", "-1"], "error: "),
        (
            score.clone(),
            &["--tempo", "3"],
            "unexpected argument '--tempo'",
        ),
        (
            score.clone(),
            &["--score", "nowhere.toml"],
            "nowhere.toml: No such file",
        ),
    ] {
        with_score(&score, |file| match arguments {
            ["--score", _] => assert_refused("dance", arguments, wanted),
            _ => assert_refused("dance", &[&["--score", file], arguments].concat(), wanted),
        });
    }
}

#[test]
fn a_folder_in_an_artefacts_place_is_refused_before_any_is_written() {
    assert_all_or_none("dance", &["--law", "carry"], &ARTEFACTS);
}
