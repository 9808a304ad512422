//! The example `dance` from outside: its files, checked by other code than its own.
#![cfg(test)]
#![cfg(all(feature = "pattern-codec", feature = "stepper-sync"))]

#[path = "tools/artefacts.rs"]
mod artefacts;
#[path = "tools/example.rs"]
mod example;

use std::collections::HashMap;
use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use artefacts::{assert_all_or_none, assert_refused, run_into};

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
            report: serde_json::from_str(&read("report.json")).unwrap(),
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

/// The `#define`s and the bytes of a header.
fn header(text: &str) -> (HashMap<&str, usize>, Vec<u8>) {
    let defines = text.lines().filter_map(|line| {
        let words: Vec<_> = line.split_whitespace().collect();
        match words[..] {
            ["#define", name, value] => Some((name.strip_prefix("DANCE_")?, value.parse().ok()?)),
            _ => None,
        }
    });
    let table = text.split_once('{').unwrap().1.split_once('}').unwrap().0;
    let bytes = table.split(',').map(|number| match number.trim() {
        hex if hex.starts_with("0x") => u8::from_str_radix(&hex[2..], 16).unwrap(),
        signed => signed.parse::<i16>().unwrap().to_le_bytes()[0],
    });
    (defines.collect(), bytes.collect())
}

fn frames(text: &str) -> Vec<[i8; 8]> {
    let (defines, bytes) = header(text);
    assert_eq!(bytes.len(), defines["BYTES"]);
    assert_eq!((defines["MOTORS"], defines["FRAME_TICKS"]), (8, 200));
    assert_eq!((defines["TICK_US"], defines["THRESHOLD"]), (1000, 600));
    let mut bytes = bytes.into_iter();
    let mut frames = Vec::new();
    let mut frame = [0; 8];
    while let Some(first) = bytes.next() {
        let (count, mask) = match defines["PACKING"] {
            0 => {
                frame[0] = first.cast_signed();
                (1, 0xFE)
            }
            1 => (first, 0xFF),
            _ => (first, bytes.next().unwrap()),
        };
        for (motor, speed) in frame.iter_mut().enumerate() {
            if mask >> motor & 1 == 1 {
                *speed = bytes.next().unwrap().cast_signed();
            }
        }
        frames.extend(vec![frame; count.into()]);
    }
    assert_eq!(frames.len(), defines["FRAMES"]);
    frames
}

/// Each motor's steps: the tick, from 1, and the position after it.
fn steps(frames: &[[i8; 8]], law: &str) -> [Vec<(u64, i64)>; 8] {
    core::array::from_fn(|motor| {
        let (mut sum, mut position, mut tick) = (0_i32, 0, 0);
        let mut steps = Vec::new();
        for frame in frames {
            let speed = i32::from(frame[motor]);
            for _ in 0..200 {
                tick += 1;
                sum += if law == "signed" { speed } else { speed.abs() };
                if sum.abs() >= 600 {
                    let forward = if law == "signed" { sum > 0 } else { speed > 0 };
                    sum -= match law {
                        "reset" => sum,
                        _ if sum < 0 => -600,
                        _ => 600,
                    };
                    position += if forward { 1 } else { -1 };
                    steps.push((tick, position));
                }
            }
        }
        steps
    })
}

/// The wires of the dump: data, then strobes, then motors.
fn wires(head: &str) -> HashMap<&str, usize> {
    let declared = head.lines().filter_map(|line| {
        let words: Vec<_> = line.split_whitespace().collect();
        let ["$var", "wire", _, id, name, "$end"] = words[..] else {
            return None;
        };
        let number = |start| Some(name.strip_prefix(start)?.parse::<usize>().unwrap());
        let strobe = number("strobe").map(|number| 1 + number);
        let motor = number("motor").map(|number| 9 + number);
        Some((id, strobe.or(motor).unwrap_or(0)))
    });
    declared.collect()
}

/// What the dump says: each motor's steps as [`steps`] has them. The data must be stable while a
/// strobe is high, only one strobe may be, and the motors must be what the latches follow.
fn decoded(dump: &str) -> [Vec<(u64, i64)>; 8] {
    const HALF_STEPS: [u8; 8] = [1, 3, 2, 6, 4, 12, 8, 9];
    let (head, body) = dump.split_once("$enddefinitions $end\n").unwrap();
    let wires = wires(head);
    assert_eq!(wires.len(), 17);
    let mut levels = [0_u8; 17];
    let mut latches = [0; 8];
    let mut at: [Option<i64>; 8] = [None; 8];
    let mut steps: [Vec<(u64, i64)>; 8] = Default::default();
    let mut last = None;
    for stamp in format!("\n{body}").split("\n#").skip(1) {
        let mut lines = stamp.lines();
        let ns: u64 = lines.next().unwrap().parse().unwrap();
        assert!(last < Some(ns), "time goes back at {ns}");
        last = Some(ns);
        let before = levels;
        for line in lines.filter(|line| !line.starts_with('$')) {
            let (value, id) = match line.strip_prefix('b') {
                Some(vector) => vector.split_once(' ').unwrap(),
                None => line.split_at(1),
            };
            levels[wires[id]] = u8::from_str_radix(value, 2).unwrap();
        }
        let open = (0..8).filter(|motor| before[1 + motor] == 1 || levels[1 + motor] == 1);
        let open: Vec<usize> = open.collect();
        assert!(open.len() < 2, "two strobes at {ns}");
        if let [motor] = open[..] {
            assert_eq!(before[0], levels[0], "data under a strobe at {ns}");
            latches[motor] = levels[0];
        }
        assert_eq!(levels[9..], latches, "{ns}");
        for motor in (0..8).filter(|motor| latches[*motor] != 0) {
            let place = HALF_STEPS
                .iter()
                .position(|nibble| *nibble == latches[motor]);
            let place = i64::try_from(place.expect("no phase")).unwrap();
            // The first phase comes before the first tick.
            let old = at[motor].unwrap_or(0);
            let position = old + (place - old + 4).rem_euclid(8) - 4;
            if position != old {
                assert_eq!((position - old).abs(), 1, "a jump at {ns}");
                assert!(ns % 1_000_000 < 100_000, "a step between ticks at {ns}");
                steps[motor].push((ns / 1_000_000, position));
            }
            at[motor] = Some(position);
        }
    }
    assert_eq!(levels[1..9], [0; 8], "a strobe stays high");
    assert!(at.iter().all(Option::is_some), "a motor without current");
    steps
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
