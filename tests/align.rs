//! The example `align` from outside: its files, checked by other code than its own.
#![cfg(test)]
#![cfg(unix)]

#[path = "tools/command.rs"]
mod command;
#[path = "tools/example.rs"]
mod example;
#[path = "align/line.rs"]
mod line;
#[path = "tools/refusal.rs"]
mod refusal;

use std::fs;
use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use serde_json::Value;
use tempfile::{NamedTempFile, TempDir};

use command::{lines, run};
use example::example;
use refusal::assert_refused;

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
        let report = fs::read(folder.path().join("report.json")).unwrap();
        Self {
            report: serde_json::from_slice(&report).unwrap(),
            summary: lines(&output.stdout),
            folder,
        }
    }

    fn number(&self, pointer: &str) -> f64 {
        let value = self.report.pointer(pointer).and_then(Value::as_f64);
        value.unwrap_or_else(|| panic!("{pointer}"))
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.folder.path().join(name)).unwrap()
    }
}

fn from_to() -> [String; 4] {
    let to: Vec<_> = TO.iter().map(ToString::to_string).collect();
    ["--from", FROM, "--to", &to.join(" ")].map(str::to_owned)
}

/// A locator of the platform file.
struct Locator {
    anchor: Vector3<f64>,
    origin: Vector3<f64>,
    to_axes: Matrix3<f64>,
    speed: Vector3<f64>,
}

fn locators() -> Vec<Locator> {
    let text = fs::read_to_string(PLATFORM).unwrap();
    let file: toml::Table = text.parse().unwrap();
    let vector = |value: &toml::Value| {
        let numbers = value.as_array().unwrap().iter();
        Vector3::from_iterator(numbers.map(|number| number.as_float().unwrap()))
    };
    let locator = |table: &toml::Value| Locator {
        anchor: vector(&table["anchor_mm"]),
        origin: vector(&table["origin_mm"]),
        to_axes: match table.get("axes").and_then(toml::Value::as_array) {
            Some(axes) => {
                let columns: Vec<_> = axes.iter().map(vector).collect();
                Matrix3::from_columns(&columns).try_inverse().unwrap()
            }
            None => Matrix3::identity(),
        },
        speed: vector(&table["speed_mm_s"]),
    };
    file["locator"]
        .as_array()
        .unwrap()
        .iter()
        .map(locator)
        .collect()
}

/// A line of the table: time, places, velocities.
struct Row {
    time: f64,
    places: Vec<Vector3<f64>>,
    velocities: Vec<Vector3<f64>>,
}

fn rows(csv: &str, columns: usize) -> Vec<Row> {
    let row = |line: &str| {
        let fields: Vec<_> = line.split(',').collect();
        assert_eq!(fields.len(), 1 + columns);
        let numbers: Vec<f64> = fields.iter().map(|field| field.parse().unwrap()).collect();
        for (field, number) in fields.iter().zip(&numbers) {
            let digits = field.chars().filter(char::is_ascii_digit);
            let significant = digits.skip_while(|digit| *digit == '0').count();
            assert!(significant >= 12 || *number == 0.0, "{field}");
        }
        let mut vectors = numbers[1..].chunks_exact(3).map(Vector3::from_column_slice);
        Row {
            time: numbers[0],
            places: vectors.by_ref().take(3).collect(),
            velocities: vectors.collect(),
        }
    };
    csv.lines().skip(1).map(row).collect()
}

/// The matrix printed in [Alignment 2010].
fn placed(pose: [f64; 6], anchor: &Vector3<f64>) -> Vector3<f64> {
    let [x, y, z, alpha, beta, gamma] = pose;
    let [(sa, ca), (sb, cb), (sg, cg)] =
        [alpha, beta, gamma].map(|degrees| degrees.to_radians().sin_cos());
    let rotation = Matrix3::new(
        cg * cb,
        -sg * ca + cg * sb * sa,
        sg * sa + cg * sb * ca,
        sg * cb,
        cg * ca + sg * sb * sa,
        -cg * sa + sg * sb * ca,
        -sb,
        cb * sa,
        cb * ca,
    );
    rotation * anchor + Vector3::new(x, y, z)
}

/// The largest change of a distance between two locators.
fn distance_error(places: &[Vector3<f64>], locators: &[Locator]) -> f64 {
    let pairs = [(0, 1), (0, 2), (1, 2)];
    let changes = pairs.map(|(a, b)| {
        let apart = (locators[a].anchor - locators[b].anchor).norm();
        ((places[a] - places[b]).norm() - apart).abs()
    });
    changes.into_iter().fold(0.0, f64::max)
}

/// Place and speed at a part `s` of a segment of `time` seconds: a line, or Hermite's cubic.
fn between(a: &Row, b: &Row, locator: usize, s: f64) -> (Vector3<f64>, Vector3<f64>) {
    let (p, q, time) = (a.places[locator], b.places[locator], b.time - a.time);
    if a.velocities.is_empty() {
        return (p + (q - p) * s, (q - p) / time);
    }
    let (v, w) = (a.velocities[locator] * time, b.velocities[locator] * time);
    let (s2, s3) = (s * s, s * s * s);
    let place = p * (2.0 * s3 - 3.0 * s2 + 1.0)
        + v * (s3 - 2.0 * s2 + s)
        + q * (3.0 * s2 - 2.0 * s3)
        + w * (s3 - s2);
    let slope =
        (p - q) * (6.0 * s2 - 6.0 * s) + v * (3.0 * s2 - 4.0 * s + 1.0) + w * (3.0 * s2 - 2.0 * s);
    (place, slope / time)
}

fn check_table(mode: &str) {
    let arguments = from_to();
    let run = Run::of(mode, &arguments.each_ref().map(String::as_str));
    let csv = run.read(&format!("{mode}.csv"));
    let names = |letter: &str| {
        let names = (1..=3).flat_map(|n| ["x", "y", "z"].map(|axis| format!(",{letter}{n}{axis}")));
        names.collect::<String>()
    };
    let velocities = if mode == "pvt" {
        names("v")
    } else {
        String::new()
    };
    let header = format!("time_s{}{velocities}", names("p"));
    assert_eq!(csv.lines().next().unwrap(), header);
    let rows = rows(&csv, if mode == "pvt" { 18 } else { 9 });
    let locators = locators();

    let first: Vec<f64> = FROM.split(' ').map(|word| word.parse().unwrap()).collect();
    let ends = [
        (&rows[0], first.try_into().unwrap()),
        (rows.last().unwrap(), TO),
    ];
    for (row, pose) in ends {
        for (place, locator) in row.places.iter().zip(&locators) {
            assert!((place - placed(pose, &locator.anchor)).norm() < ROUNDING_MM);
        }
    }
    let (bound, reported) = (
        run.number("/distance_error_bound_mm"),
        run.number("/max_distance_error_mm"),
    );
    let (mut worst, mut fastest) = (0.0_f64, 0.0_f64);
    for pair in rows.windows(2) {
        let [a, b] = pair else { unreachable!() };
        assert!(b.time > a.time);
        assert!(distance_error(&a.places, &locators) < ROUNDING_MM);
        for step in 0..=40 {
            let s = f64::from(step) / 40.0;
            let states = [0, 1, 2].map(|locator| between(a, b, locator, s));
            worst = worst.max(distance_error(&states.map(|it| it.0), &locators));
            for ((_, velocity), locator) in states.iter().zip(&locators) {
                let axes = (locator.to_axes * velocity).component_div(&locator.speed);
                fastest = fastest.max(axes.amax());
            }
        }
    }
    assert!(worst <= bound, "{worst} > {bound}");
    assert!(reported <= bound && (worst - reported).abs() < 0.01 * bound);
    // The default platform file allows 0.002 mm; a bound that is far below would be a bad plan.
    assert!(bound <= 0.002 + ROUNDING_MM && bound > 0.0005, "{bound}");
    assert!((0.999..=1.0 + 1e-9).contains(&fastest), "{fastest}");
    assert!((fastest - run.number("/max_speed_ratio")).abs() < 1e-6);
    check_jumps(mode, &run, &rows, &locators);
    let axes = locators.iter().zip(&rows[0].places);
    assert!(
        axes.clone()
            .all(|(it, place)| (it.to_axes * (place - it.origin)).amax() < 250.0)
    );

    let count = f64::from(u32::try_from(rows.len()).unwrap());
    assert!((run.number("/points") - count).abs() < 0.5);
    let end = rows.last().unwrap().time;
    assert!((run.number("/duration_s") - end).abs() < 1e-12 * end);
    assert!(run.number("/pose_error_mm") < ROUNDING_MM);
    assert!(run.number("/pose_error_rad") < 1e-14);
    for picture in ["align.svg", "jog.svg"] {
        assert!(run.read(picture).trim_end().ends_with("</svg>"));
    }
}

/// A PT table says that accelerations are not kept, and by how much a speed jumps.
fn check_jumps(mode: &str, run: &Run, rows: &[Row], locators: &[Locator]) {
    let says = run
        .summary
        .iter()
        .find(|line| line.contains("keeps speeds, not accelerations"));
    let jump = run.number("/max_speed_jump_mm_s");
    if mode == "pvt" {
        assert_eq!(says, None);
        // The digits of a table in which segments last milliseconds.
        assert!(jump < 1e-6, "{jump}");
        let keeps = ["speed_mm_s", "acceleration_mm_s2", "jerk_mm_s3"];
        assert_eq!(run.report["keeps"], serde_json::json!(keeps));
        return;
    }
    assert_eq!(run.report["keeps"], serde_json::json!(["speed_mm_s"]));
    let mut worst = 0.0_f64;
    for (number, locator) in locators.iter().enumerate() {
        let mut speeds = vec![Vector3::zeros()];
        speeds.extend(rows.windows(2).map(|pair| {
            let way = pair[1].places[number] - pair[0].places[number];
            locator.to_axes * way / (pair[1].time - pair[0].time)
        }));
        speeds.push(Vector3::zeros());
        let jumps = speeds.windows(2).map(|pair| (pair[1] - pair[0]).amax());
        worst = jumps.fold(worst, f64::max);
    }
    // From rest to full speed at once.
    assert!(
        worst > 1.0 && (worst - jump).abs() < 1e-6 * worst,
        "{worst} {jump}"
    );
    let says = says.unwrap();
    assert!(
        says.contains(&format!("jumps by {worst:.1} mm/s")),
        "{says}"
    );
}

#[test]
fn pt_table_is_rigid_within_the_bound() {
    check_table("pt");
}

#[test]
fn pvt_table_is_rigid_within_the_bound() {
    check_table("pvt");
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
        "error: [path]: max_distance_error_mm = 0: segmentation by 0: not a positive finite number",
    );
    let file = changed(&[
        ("[20.0, 20.0, 10.0]", "[0.001, 20.0, 10.0]"),
        ("10.0\n", "0.001\n"),
    ]);
    refused(
        &["--platform", file.path().to_str().unwrap()],
        "error: the motion would take 8.8e4 s, 10000 s are simulated at most",
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
