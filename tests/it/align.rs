//! The example `align` from outside: its files, checked by other code than its own.

mod line;
mod table;

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::{NamedTempFile, TempDir};

use table::rows;

use crate::tools::command::{lines, run};
use crate::tools::example::example;
use crate::tools::refusal::assert_refused;
use crate::tools::report::{number, report_in};

const PLATFORM: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/machines/platform/platform.toml"
);
/// Poses in mm and degrees, other than those of the platform file, in whole steps of the pendant.
const FROM: &str = "-12 30.5 1185 -0.4 0.3 1";
const TO: [f64; 6] = [41.25, -18.006, 1231.5, 1.1, -0.70001, -2.2];
/// What coordinates of 4 m with 16 digits are rounded to, a few times over.
const ROUNDING_MM: f64 = 2e-11;

/// A finished run's files.
struct Run {
    folder: TempDir,
    report: Value,
    summary: Vec<String>,
}

impl Run {
    fn of(mode: &str, arguments: &[&str]) -> Self {
        let folder = TempDir::new().unwrap();
        let mut command = example("align");
        command.args(["--mode", mode]).args(arguments);
        let output = run(command.arg("--out").arg(folder.path()), b"");
        assert_eq!(lines(&output.stderr), [""; 0]);
        assert!(output.status.success());
        Self {
            report: report_in(folder.path()),
            summary: lines(&output.stdout),
            folder,
        }
    }

    fn number(&self, pointer: &str) -> f64 {
        number(&self.report, pointer)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.folder.path().join(name)).unwrap()
    }
}

fn from_to() -> [String; 4] {
    let to: Vec<_> = TO.iter().map(ToString::to_string).collect();
    ["--from", FROM, "--to", &to.join(" ")].map(str::to_owned)
}

/// The platform file with other words in it.
fn changed(changes: &[(&str, &str)]) -> NamedTempFile {
    let mut text = fs::read_to_string(PLATFORM).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let file = NamedTempFile::new().unwrap();
    fs::write(file.path(), text).unwrap();
    file
}

#[test]
fn a_small_move_keeps_its_digits() {
    for (mode, columns) in [("pt", 9), ("pvt", 18)] {
        let run = Run::of(mode, &["--to", "0.001 0 1200 0 0 0"]);
        // The first axis is calibrated, so that its neighbours move by next to nothing.
        let rows = rows(&run.read(&format!("{mode}.csv")), columns);
        assert!(rows.last().unwrap().time < 0.05);
    }
}

#[test]
fn velocities_are_in_the_table_unless_told_not_to() {
    let folder = TempDir::new().unwrap();
    let output = run(example("align").arg("--out").arg(folder.path()), b"");
    assert!(output.status.success());
    let named = fs::read(folder.path().join("pvt.csv")).unwrap();
    let table = Run::of("pvt", &[]).read("pvt.csv");
    assert_eq!(String::from_utf8(named).unwrap(), table);
}

#[test]
fn far_from_the_origin_the_bound_has_the_rounding_of_the_coordinates() {
    let far = [("1200.0", "1200000.0"), ("1450.0", "1200250.0")];
    let file = changed(&far);
    let platform = file.path().to_str().unwrap();
    let to = "35 -20 1200040 1.2 -0.8 2.5";
    let run = Run::of("pt", &["--platform", platform, "--to", to]);
    let [distance_error, bound] =
        ["/max_distance_error_mm", "/distance_error_bound_mm"].map(|it| run.number(it));
    assert!(
        distance_error <= bound && bound < 0.002 + 1e-8,
        "{distance_error} {bound}"
    );
}

#[test]
fn a_wheel_that_moves_nothing_is_shown() {
    let file = changed(&[
        (
            "max_mm = [250.0, 250.0, 200.0]",
            "max_mm = [0.01, 0.01, 0.01]",
        ),
        (
            "min_mm = [-250.0, -250.0, -200.0]",
            "min_mm = [-0.01, -0.01, -0.01]",
        ),
        ("full_jog_mm_s = 10.0", "full_jog_mm_s = 0.005"),
    ]);
    let platform = file.path().to_str().unwrap();
    let run = Run::of(
        "pt",
        &["--platform", platform, "--to", "0.001 0 1200 0 0 0"],
    );
    assert!(run.read("jog.svg").trim_end().ends_with("</svg>"));
}

#[test]
fn the_same_arguments_give_the_same_files() {
    let runs = [Run::of("pt", &[]), Run::of("pt", &[])];
    for name in ["line.log", "pt.csv", "jog.svg", "align.svg", "report.json"] {
        let [a, b] = runs.each_ref().map(|run| run.read(name));
        assert!(a == b, "{name}");
    }
    let picture = runs[0].read("align.svg");
    assert!(picture.contains("The body's move is drawn 5 times as large as it is."));
}

#[test]
fn the_old_name_of_the_allowed_distance_error_is_read() {
    let file = changed(&[("max_distance_error_mm = 0.002", "strain_mm = 0.02")]);
    let run = Run::of("pt", &["--platform", file.path().to_str().unwrap()]);
    let bound = run.number("/distance_error_bound_mm");
    assert!(bound > 0.01 && bound < 0.02 + 1e-8, "{bound}");
}

#[test]
fn bad_input_is_one_line_and_no_file() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let refused = |arguments: &[&str], line: &str| {
        assert_refused(
            example("align").args(arguments).arg("--out").arg(&out),
            line,
        );
        assert!(!out.exists());
    };
    refused(
        &["--from", "1 2 3"],
        "error: invalid value '1 2 3' for '--from <POSE>': 3 numbers, six are needed",
    );
    refused(
        &["--to", "0 0 a 0 0 0"],
        "error: invalid value '0 0 a 0 0 0' for '--to <POSE>': \"a\" is no number",
    );
    refused(
        &["--mode", "xyz"],
        "error: invalid value 'xyz' for '--mode <MODE>' [possible values: pt, pvt]",
    );
    refused(
        &["--to", "0 0 1200 0 0 0"],
        "error: from and to are the same pose: nothing moves",
    );
    refused(
        &["--to", "0 900 1200 0 0 0"],
        "error: to: out of reach: locator 0, axis Y: 900 is 650 beyond the stroke -250..=250",
    );
    let in_file = |from: &str, to: &str, error: &str| {
        let file = changed(&[(from, to)]);
        let platform = file.path().to_str().unwrap();
        let line = format!("error: {platform}: {error}");
        refused(&["--platform", platform], &line);
    };
    in_file(
        "speed_mm_s = [20.0, 20.0, 10.0]",
        "speed_mm_s = [20.0, 0.0, 10.0]",
        "locator 0, axis Y: speed is 0, not within 1e-50..=1e50",
    );
    in_file(
        "full_jog_mm_s = 10.0",
        "full_jog_mm_s = 10.5",
        "[wheel]: full_jog_mm_s = 10.5 is above the rated speed of an axis, 10",
    );
    in_file(
        "bins = 10",
        "bins = 0",
        "[wheel]: 0 bins for 100 counts; 1 to 100 are possible",
    );
    in_file(
        "full_counts = 100",
        "full_counts = 2147483648",
        "[wheel]: full_counts = 2147483648 is above 1000000000",
    );
    let anchor = "anchor_mm = [0.0, 2300.0, 250.0]";
    in_file(
        anchor,
        "anchor_mm = [0.0, 2300.0, 250.0, 1.0]",
        r#"line 26, column 13: 4 values, 3 are needed: "[0.0, 2300.0, 250.0, 1.0]""#,
    );
    in_file(
        anchor,
        "anchor_mm = [0.0, 2300.0, inf]",
        r#"line 26, column 13: inf is not a finite number: "[0.0, 2300.0, inf]""#,
    );
    in_file(
        "axes = [",
        "axes = [[0.0, 0.0, 1.0], ",
        r#"line 11, column 8: 4 values, 3 are needed: "[[0.0, 0.0, 1.0], [0.9999995, 0.001, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0005, 0.999999875]]""#,
    );
    in_file(
        "to = [35.0,",
        "to = [0.0, 35.0,",
        r#"line 43, column 6: 7 values, 6 are needed: "[0.0, 35.0, -20.0, 1240.0, 1.2, -0.8, 2.5]""#,
    );
    in_file(
        "[2500.0, -1500.0, 60.0]",
        "[nan, -1500.0, 60.0]",
        r#"line 36, column 29: NaN is not a finite number: "[nan, -1500.0, 60.0]""#,
    );
    let file = changed(&[(
        "max_distance_error_mm = 0.002",
        "max_distance_error_mm = 0.0",
    )]);
    refused(
        &["--platform", file.path().to_str().unwrap()],
        "error: [path]: max_distance_error_mm = 0: an allowed departure of 0 is not a positive finite number",
    );
    let file = changed(&[
        ("[20.0, 20.0, 10.0]", "[0.001, 20.0, 10.0]"),
        ("10.0\n", "0.001\n"),
    ]);
    refused(
        &["--platform", file.path().to_str().unwrap()],
        "error: the motion would take 9.4e4 s, 10000 s are simulated at most",
    );
    fs::create_dir_all(out.join("report.json")).unwrap();
    let mut command = example("align");
    let blocked = out.join("report.json");
    let line = format!("error: {}: is a folder", blocked.display());
    assert_refused(command.arg("--out").arg(&out), &line);
    assert_eq!(fs::read_dir(&out).unwrap().count(), 1);
    let taken = folder.path().join("file");
    fs::write(&taken, "").unwrap();
    let mut command = example("align");
    let inside = taken.join("out");
    command.arg("--out").arg(&inside);
    let line = format!("error: {}: Not a directory (os error 20)", inside.display());
    assert_refused(&mut command, &line);
    assert!(Path::new(&taken).is_file());
}
