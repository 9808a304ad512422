//! How near the tables come to the shortest time by another program, toppra.
//!
//! It runs where `python3` has it, and must where `PATH_TIMING_REQUIRE_TOPPRA` is set.

use core::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use path_timing::{Knot, Table};

use crate::support::machine::{Line, limits};

/// Speed and acceleration of the angle, in rad, and of the reach, in mm.
const LIMITS: [[f64; 2]; 2] = [[2.0, 20.0], [300.0, 2000.0]];

/// What toppra's 4000 cells are off by.
const CELLS: f64 = 5e-4;

/// Above the optimum, by segments.
const ABOVE: [(u32, f64); 2] = [(100, 0.006), (1000, 5e-4)];

const LINES: [[f64; 4]; 8] = [
    [-100.0, 101.0, 100.0, 99.0],
    [-100.0, 21.0, 100.0, 19.0],
    [30.0, 40.0, 200.0, 130.0],
    [-150.0, -60.0, 90.0, -140.0],
    [60.0, -180.0, 45.0, 170.0],
    [-30.0, 35.0, 160.0, 25.0],
    [120.0, 10.0, 10.0, 120.0],
    [15.0, 80.0, -5.0, 220.0],
];

fn is_there() -> bool {
    let mut python = Command::new("python3");
    let status = python
        .args(["-c", "import toppra"])
        .stderr(Stdio::null())
        .status();
    status.is_ok_and(|status| status.success())
}

/// The shortest times of all lines.
fn durations_s() -> Vec<f64> {
    let mut python = Command::new("python3")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/toppra/duration.py"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let [[v0, a0], [v1, a1]] = LIMITS;
    let mut input = String::new();
    for [x0, y0, x1, y1] in LINES {
        writeln!(input, "{x0} {y0} {x1} {y1} {v0} {v1} {a0} {a1}").unwrap();
    }
    let mut stdin = python.stdin.take().unwrap();
    stdin.write_all(input.as_bytes()).unwrap();
    drop(stdin);
    let output = python.wait_with_output().unwrap();
    assert!(output.status.success());
    let output = String::from_utf8(output.stdout).unwrap();
    output.lines().map(|line| line.parse().unwrap()).collect()
}

#[test]
fn time_above_that_of_toppra() {
    if !is_there() {
        let is_required = std::env::var_os("PATH_TIMING_REQUIRE_TOPPRA").is_some();
        assert!(!is_required, "python3 has no toppra");
        return;
    }
    let shortest_s = durations_s();
    assert_eq!(shortest_s.len(), LINES.len());
    let limits = LIMITS.map(|[speed, acceleration]| limits(speed, acceleration, None));
    for ([x0, y0, x1, y1], shortest_s) in LINES.into_iter().zip(shortest_s) {
        let line = Line {
            from: [x0, y0],
            to: [x1, y1],
        };
        for (segments, above) in ABOVE {
            let mut knots = [Knot::default(); 1001];
            let table = Table::plan([line], limits, |_| segments, &mut knots).unwrap();
            let share = table.duration_s() / shortest_s;
            println!("{line:?}, {segments} segments: {share:.5} of {shortest_s:.4} s");
            assert!((1.0 - CELLS..1.0 + above).contains(&share), "{share}");
        }
    }
}
