//! The tables of `align`: rigid within the bound, within all limits, from pose to pose.

use std::fs;

use nalgebra::{Matrix3, Vector3};

use super::{FROM, PLATFORM, ROUNDING_MM, Run, TO, from_to};

/// A locator of the platform file.
pub(crate) struct Locator {
    anchor: Vector3<f64>,
    origin: Vector3<f64>,
    to_axes: Matrix3<f64>,
    speed: Vector3<f64>,
}

pub(crate) fn locators() -> Vec<Locator> {
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
pub(crate) struct Row {
    pub(crate) time: f64,
    pub(crate) places: Vec<Vector3<f64>>,
    pub(crate) velocities: Vec<Vector3<f64>>,
}

pub(crate) fn rows(csv: &str, columns: usize) -> Vec<Row> {
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

/// Position and speed at the fraction `s` of a segment of `time` seconds: a line, or Hermite's
/// cubic.
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
    let note = run
        .summary
        .iter()
        .find(|line| line.contains("keeps speeds, not accelerations"));
    let jump = run.number("/max_speed_jump_mm_s");
    if mode == "pvt" {
        assert_eq!(note, None);
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
            let change = pair[1].places[number] - pair[0].places[number];
            locator.to_axes * change / (pair[1].time - pair[0].time)
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
    let note = note.unwrap();
    assert!(
        note.contains(&format!("jumps by {worst:.1} mm/s")),
        "{note}"
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
