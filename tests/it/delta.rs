//! The example `delta` from outside: its files, checked by other code than its own.

mod outcome;
mod rounded;

use core::time::Duration;
use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::Stdio;

use serialport::{SerialPort as _, TTYPort};
use tempfile::TempDir;

use outcome::{Run, THESIS, distance, off_line};

use crate::tools::artefacts::{assert_all_or_none, assert_refused};
use crate::tools::command::lines;
use crate::tools::example::example;

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("machines/delta")
        .join(name)
}

/// Half a step of each arm, 0.0044 mm at the knee, through the mechanism.
const STEP_MM: f64 = 0.02;

/// What a file of lines asks for, errors left out by their answers.
fn asked(text: &str, answers: &[String]) -> Vec<([f64; 3], [i32; 3])> {
    text.lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'))
        .zip(answers)
        .filter_map(|(line, answer)| {
            let steps: Vec<i32> = answer
                .strip_prefix("ok ")?
                .split(' ')
                .map(|n| n.parse().unwrap())
                .collect();
            let mut numbers = line.split_whitespace().map(|n| n.parse().unwrap());
            let to = [(); 3].map(|()| numbers.next().unwrap());
            Some((to, steps.try_into().unwrap()))
        })
        .collect()
}

#[test]
fn shipped_inputs_follow_their_lines() {
    for name in ["pick-and-place", "spiral"] {
        let file = shipped(&format!("inputs/{name}.txt"));
        let arguments = ["--motion", "trains", "--input", file.to_str().unwrap()];
        let run = Run::of(&arguments, "");
        let asked = asked(&fs::read_to_string(&file).unwrap(), &run.answers);
        assert_eq!(run.report["moves"], asked.len());
        assert_eq!(run.report["refused"], run.answers.len() - asked.len());
        // What is shipped shows no error and no note.
        assert_eq!((run.errors.as_slice(), run.status), (&[][..], Some(0)));
        let (mut worst, mut line) = (0f64, 0);
        let mut from = run.place(&THESIS, [0; 3]);
        for (_, steps) in run.steps.iter().skip(1) {
            let (to, answer) = asked[line];
            let place = run.place(&THESIS, *steps);
            worst = worst.max(off_line(place, from, to));
            if *steps == answer && line + 1 < asked.len() {
                assert!(
                    distance(place, to) < STEP_MM,
                    "{name}: {place:?} for {to:?}"
                );
                (from, line) = (to, line + 1);
            }
        }
        assert_eq!(line + 1, asked.len(), "{name}: not all lines were reached");
        assert_eq!(run.steps.last().unwrap().1, asked[line].1);
        assert!(
            (worst - run.number("/max_path_error_mm")).abs() < 1e-6,
            "{worst}"
        );
        // The tolerance between whole steps is 0.01 mm, and one step each is on its way.
        assert!(worst < 0.01 + 2.0 * STEP_MM, "{name}: {worst}");
        assert!(run.number("/tick/max_path_error_mm") > 10.0 * worst);
        assert!(run.picture.ends_with("</svg>\n"));
    }
}

#[test]
fn steps_come_one_by_one_and_not_too_fast() {
    let run = Run::of(&[], "");
    assert_eq!(run.steps[0], (0.0, [0; 3]));
    let (mut made, mut last) = (0u64, [0f64; 3]);
    // 240°/s, in steps.
    let shortest = run.number("/rad_per_step") / 240f64.to_radians();
    for pair in run.steps.windows(2) {
        assert!(pair[1].0 >= pair[0].0);
        let ways = [0, 1, 2].map(|k| pair[1].1[k].abs_diff(pair[0].1[k]));
        assert_eq!(ways.iter().sum::<u32>(), 1);
        made += 1;
        let arm = ways.iter().position(|way| *way == 1).unwrap();
        let interval = pair[1].0 - last[arm];
        // Two pieces may meet between steps: half an interval each.
        assert!(interval > shortest * 0.45, "{interval} at {}", pair[1].0);
        last[arm] = pair[1].0;
    }
    assert_eq!(run.report["steps"], made);
    assert!(run.steps.last().unwrap().0 <= run.number("/duration_s") + 1e-6);
}

/// The worked example of [Delta thesis], and the numbers of a right one.
#[test]
fn thesis_numbers() {
    let run = Run::of(&["--input", "-"], "50 50 100\n50 50 -300\n");
    assert!(run.answers[0].starts_with("error: line 1: 50 50 100: out of reach: arm 1 is 12.89"));
    assert!(
        run.answers[0].ends_with("too long; the next move starts at 0 0 -195.737"),
        "{}",
        run.answers[0]
    );
    assert_eq!(run.answers[1], "ok -7799 -12831 -14361");
    assert_eq!(
        (&run.report["moves"], &run.report["refused"]),
        (&1.into(), &1.into())
    );
    assert!((run.number("/rad_per_step") - 1.8f64.to_radians() / 16.0 / 27.0).abs() < 1e-18);
    for k in 0..3 {
        let home = run.number(&format!("/home_rad/{k}"));
        assert!((home - core::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }
}

#[test]
fn bad_lines_are_answered_and_the_next_is_served() {
    let input = "\n# a comment\n0 0 -250\n1 2\nx y z\n1 2 3 4 5\n0 0 nan\n0 0 -240 0\n0 0 -240 -5\n\
        400 0 -250\n100 0 -250 2000\n0 0 -1e300\n0 0 -251 1e-9\n0 0 -250\nEND\n0 0 -200\n";
    let run = Run::of(&["--input", "-"], input);
    let wanted = [
        "ok ",
        "error: line 4: 2 numbers in \"1 2\"",
        "error: line 5: \"x\" is not a number",
        "error: line 6: 5 numbers",
        "error: line 7: \"nan\" is not a number",
        "error: line 8: feed 0 mm/s is not above zero",
        "error: line 9: feed -5 mm/s is not above zero",
        "error: line 10: 400 0 -250: out of reach: arm ",
        "error: line 11: 100 0 -250: feed 2000 mm/s: arm ",
        "error: line 12: 0 0 -1000",
        "error: line 13: 0 0 -251: feed 0.000000001 mm/s: a step would take",
        "ok ",
    ];
    assert_eq!(run.answers.len(), wanted.len(), "{:?}", run.answers);
    for (answer, wanted) in run.answers.iter().zip(wanted) {
        assert!(answer.starts_with(wanted), "{answer}");
    }
    assert_eq!(run.answers[0], run.answers[11], "it has moved");
    assert_eq!(
        (&run.report["moves"], &run.report["refused"]),
        (&2.into(), &10.into())
    );
    let empty = Run::of(&["--input", "-"], "");
    assert_eq!((empty.steps.len(), &empty.report["moves"]), (1, &0.into()));
}

/// The line after a refused one is straight from where the machine is, which is never where the
/// refused one would have brought it.
#[test]
fn after_a_refusal_the_next_line_starts_where_the_machine_is() {
    let run = Run::of(
        &["--motion", "trains", "--input", "-"],
        "60 0 -280\n60 300 -280\nhello\n-60 0 -280\n",
    );
    let stays = "; the next move starts at 60 0 -280";
    assert!(run.answers[1].ends_with(stays) && run.answers[2].ends_with(stays));
    let first = run.answers[0].strip_prefix("ok ").unwrap();
    let first: Vec<i32> = first.split(' ').map(|n| n.parse().unwrap()).collect();
    let begin = run
        .steps
        .iter()
        .position(|(_, steps)| steps[..] == first[..]);
    let worst = run.steps[begin.unwrap()..].iter().map(|(_, steps)| {
        let place = run.place(&THESIS, *steps);
        off_line(place, [60.0, 0.0, -280.0], [-60.0, 0.0, -280.0])
    });
    assert!(worst.fold(0.0, f64::max) < 0.01 + 2.0 * STEP_MM);
}

#[test]
fn what_comes_after_the_end_is_noted() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("some.txt");
    fs::write(
        &file,
        "\u{FEFF}0 0 -250\nend\n# no more\n\n0 0 -240\nhello\n",
    )
    .unwrap();
    let file = file.to_str().unwrap();
    let run = Run::of(&["--input", file], "");
    assert_eq!((run.answers.len(), run.status), (1, Some(0)));
    let note = "line 5: \"0 0 -240\", \"hello\": after `end`, not done (2 times)";
    assert_eq!(run.errors, [format!("note: {file}: {note}")]);
    assert_eq!(run.report["notes"], serde_json::json!([note]));
    // Nobody waits for what may come behind it on a line.
    assert_eq!(
        Run::of(&["--input", "-"], "end\n0 0 -250\n").errors,
        [""; 0]
    );
}

/// Cut anywhere, this one would be another place.
#[test]
fn a_line_too_long_is_refused_whole() {
    let zeros = "0".repeat(400);
    let comment = "#".repeat(400);
    let input = format!(
        "0 0 -{zeros}250\n0 0 -250 {comment}\n{}1 2 3\n",
        " ".repeat(400)
    );
    let run = Run::of(&["--input", "-"], &input);
    assert_eq!(run.answers.len(), 3, "{:?}", run.answers);
    let refused = |line: &str| format!("error: line {line}: longer than 256 bytes; the next move");
    assert!(run.answers[0].starts_with(&refused("1")));
    assert!(run.answers[1].starts_with("ok "), "{:?}", run.answers);
    assert!(run.answers[2].starts_with(&refused("3")));
}

#[test]
fn a_calibrated_geometry_is_used() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("calibrated.toml");
    let text = fs::read_to_string(shipped("machine.toml")).unwrap()
        + "[[arm]]\nazimuth_deg = 0.5\nlower_mm = 1.0\n[[arm]]\nupper_mm = -0.7\nbase_mm = 0.4\n\
           [[arm]]\nhome_deg = 1.5\nplatform_mm = 0.3\n";
    fs::write(&file, text).unwrap();
    let run = Run::of(
        &["--input", "-", "--geometry", file.to_str().unwrap()],
        "40 -30 -280\n",
    );
    let arms = [
        [30.5, 24.0, 120.0, 244.0],
        [150.0, 24.4, 119.3, 243.0],
        [270.0, 23.7, 120.0, 243.0],
    ];
    let end = run.steps.last().unwrap().1;
    assert!(distance(run.place(&arms, end), [40.0, -30.0, -280.0]) < STEP_MM);
    assert!(distance(run.place(&THESIS, end), [40.0, -30.0, -280.0]) > 0.5);
    assert!((run.number("/home_rad/2") - 91.5f64.to_radians()).abs() < 1e-12);
}

/// Far above what an answer takes.
const PATIENCE: Duration = Duration::from_secs(30);

#[test]
fn a_terminal_is_served_line_by_line() {
    let folder = TempDir::new().unwrap();
    // Both ends are kept open: a port that everybody has closed is an error at the other end.
    let (mut line, end) = TTYPort::pair().unwrap();
    line.set_timeout(PATIENCE).unwrap();
    let child = example("delta")
        .args(["--port", &end.name().unwrap(), "--out"])
        .arg(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut answers = Vec::new();
    let mut reader = BufReader::new(line.try_clone_native().unwrap());
    for ask in ["50 50 -300\r\n", "50 50 100\n", "0 0 -250 120\r"] {
        line.write_all(ask.as_bytes()).unwrap();
        let mut answer = String::new();
        reader.read_line(&mut answer).unwrap();
        answers.push(answer.trim_end().to_owned());
    }
    line.write_all(b"end\n").unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let [error] = &lines(&output.stderr)[..] else {
        panic!("{output:?}");
    };
    assert!(error.starts_with("error: 1 of 3 lines refused, the first: line 2: 50 50 100: "));
    assert_eq!(answers[0], "ok -7799 -12831 -14361");
    assert!(answers[1].starts_with("error: line 2: 50 50 100: out of reach"));
    assert!(answers[1].ends_with("; the next move starts at 50 50 -300"));
    assert!(answers[2].starts_with("ok "), "{answers:?}");
    let run = Run::read(folder.path(), answers);
    assert_eq!(
        (&run.report["moves"], &run.report["refused"]),
        (&2.into(), &1.into())
    );
}

/// A file is looked at as a whole: with a line that is refused nothing moves, unless that is left
/// out.
#[test]
fn a_file_with_a_refused_line_moves_nothing_unless_it_is_skipped() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("some.txt");
    fs::write(&file, "0 0 -250\n0,0,-260\n50 50 100\n10 0 -250\n").unwrap();
    let file = file.to_str().unwrap();
    let place = format!("{file} (--skip leaves out what is refused): nothing moves: line 2: ");
    let comma = "\"0,0,-260\" is not a number: blanks separate the numbers of a line; line 3: ";
    assert_refused("delta", &["--input", file], &format!("{place}{comma}"));
    let run = Run::of(&["--input", file, "--skip"], "");
    assert_eq!(run.status, Some(1));
    assert_eq!(
        (&run.report["moves"], &run.report["refused"]),
        (&2.into(), &2.into())
    );
    // Nobody can look at what is still to come.
    let run = Run::of(&["--input", "-"], "0 0 -250\n0,0,-260\n");
    assert_eq!((&run.report["moves"], run.status), (&1.into(), Some(1)));
}

/// An arm that would leave its range is refused in the words of the machine file.
#[test]
fn a_range_is_named_as_the_machine_file_has_it() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("narrow.toml");
    let machine = fs::read_to_string(shipped("machine.toml")).unwrap();
    fs::write(&file, machine.replace("max_deg = 120.0", "max_deg = 91.0")).unwrap();
    let arguments = ["--input", "-", "--geometry", file.to_str().unwrap()];
    let run = Run::of(&arguments, "0 0 -250\n0 0 -180\n");
    let [first, second] = &run.answers[..] else {
        panic!("{:?}", run.answers);
    };
    assert!(first.starts_with("ok "), "{first}");
    let wanted = [
        "error: line 2: 0 0 -180: arm ",
        "outside min_deg = -20.00 to max_deg = 91.00",
    ];
    assert!(
        wanted.iter().all(|words| second.contains(words)),
        "{second}"
    );
}

#[test]
fn bad_files_are_one_line_and_leave_nothing() {
    let folder = TempDir::new().unwrap();
    let machine = fs::read_to_string(shipped("machine.toml")).unwrap();
    let write = |name: &str, text: &str| {
        let file = folder.path().join(name);
        fs::write(&file, text).unwrap();
        file.to_str().unwrap().to_owned()
    };
    let with = |name, from, to| {
        assert!(machine.contains(from), "{from}");
        write(name, &machine.replace(from, to))
    };
    let short = with("short.toml", "lower_mm = 243.0", "lower_mm = -1.0");
    let typo = with("typo.toml", "upper_mm = 120.0", "uper_mm = 120.0");
    let home = with("home.toml", "home_deg = 90.0", "home_deg = 170.0");
    let two = write("two.toml", &format!("{machine}[[arm]]\n[[arm]]\n"));
    let no_home = with("no_home.toml", "home_deg = 90.0", "home_deg = nan");
    let micro = with("micro.toml", "microsteps = 16", "microsteps = 0");
    let cases: [(&[&str], &str); 11] = [
        (&["--input", "nowhere.txt"], "nowhere.txt: No such file"),
        (&["--input", folder.path().to_str().unwrap()], "is a folder"),
        (
            &["--geometry", "nowhere.toml"],
            "nowhere.toml: No such file",
        ),
        (
            &["--geometry", &short],
            "short.toml: arm 1: lower arm -1 is not within",
        ),
        (
            &["--geometry", &typo],
            "typo.toml: line 5, column 1: unknown field `uper_mm`",
        ),
        (&["--geometry", &home], "home.toml: home_deg: arm 1"),
        (
            &["--geometry", &no_home],
            "no_home.toml: arm 1: zero NaN rad is not within",
        ),
        (
            &["--geometry", &two],
            "two.toml: 2 tables [[arm]], none or three",
        ),
        (&["--geometry", &micro], "microsteps = 0 is not above zero"),
        (&["--port", "/dev/nowhere"], "/dev/nowhere: No such file"),
        (&["--port", "x", "--input", "y"], "cannot be used with"),
    ];
    for (arguments, wanted) in cases {
        assert_refused("delta", arguments, wanted);
    }
    assert_all_or_none("delta", &[], &["steps.csv", "delta.svg", "report.json"]);
}
