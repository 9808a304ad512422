//! How near the tables come to the shortest time by another program, toppra.
//!
//! It runs where `python3` has it, and must where `PATH_TIMING_REQUIRE_TOPPRA` is set.

use core::convert::Infallible;
use core::fmt::Write as _;

use path_timing::{AxisLimits, Knot, Path, Table};
use test_support::{Random, setting};

use crate::support::machine::{Line, limits};
use crate::support::python::{ask, has};
use crate::support::waves::Waves;

/// Speed and acceleration of the angle, in rad, and of the reach, in mm.
const LIMITS: [[f64; 2]; 2] = [[2.0, 20.0], [300.0, 2000.0]];

/// The same of both axes of waves along a length of 1.
const LIMITS_ON_WAVES: [[f64; 2]; 2] = [[1.0, 4.0]; 2];

/// What toppra's cells are off by: limits hold at these alone.
const CELLS: f64 = 5e-4;

/// The same where both axes nearly stop within a few cells.
const CELLS_ON_WAVES: f64 = 2e-3;

/// Above the optimum, by segments.
const ABOVE: [(u32, f64); 2] = [(100, 0.005), (1000, 5e-4)];

/// The same where both axes nearly stop within a segment: mostly within half of it.
const ABOVE_ON_WAVES: [(u32, f64); 2] = [(100, 0.01), (1000, 0.002)];

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

/// The shortest times of paths, by their limits and what the script knows them by.
fn shortest_s(paths: impl Iterator<Item = ([AxisLimits; 2], String)>) -> Vec<f64> {
    let mut lines = String::new();
    for ([first, second], path) in paths {
        let speeds = [first.speed, second.speed];
        let accelerations = [first.acceleration, second.acceleration];
        for limit in speeds.iter().chain(&accelerations) {
            write!(lines, "{limit} ").unwrap();
        }
        writeln!(lines, "{path}").unwrap();
    }
    ask("toppra/duration.py", &lines)
}

fn has_toppra() -> bool {
    has("toppra", "PATH_TIMING_REQUIRE_TOPPRA")
}

/// The time of a table over the shortest.
fn share<P: Path<Axes = [f64; 2], Error = Infallible> + Clone>(
    path: &P,
    limits: [AxisLimits; 2],
    segments: u32,
    shortest_s: f64,
) -> f64 {
    let mut knots = [Knot::default(); 1001];
    let table = Table::plan([path], limits, |_| segments, &mut knots).unwrap();
    table.duration_s() / shortest_s
}

#[test]
fn time_above_that_of_toppra() {
    if !has_toppra() {
        return;
    }
    let limits = LIMITS.map(|[speed, acceleration]| limits(speed, acceleration, None));
    let words = LINES.map(|[x0, y0, x1, y1]| (limits, format!("line {x0} {y0} {x1} {y1}")));
    let shortest = shortest_s(words.into_iter());
    for ([x0, y0, x1, y1], shortest_s) in LINES.into_iter().zip(shortest) {
        let line = Line {
            from: [x0, y0],
            to: [x1, y1],
        };
        for (segments, above) in ABOVE {
            let share = share(&line, limits, segments, shortest_s);
            println!("{line:?}, {segments} segments: {share:.5} of {shortest_s:.4} s");
            assert!((1.0 - CELLS..1.0 + above).contains(&share), "{share}");
        }
    }
}

/// Shares of all paths, which are within bounds: least, median and most.
fn judge<P: Path<Axes = [f64; 2], Error = Infallible> + Clone>(
    what: &str,
    cases: &[(P, [AxisLimits; 2], String)],
    cells: f64,
    bounds: [(u32, f64); 2],
) {
    let words = cases
        .iter()
        .map(|(_, limits, words)| (*limits, words.clone()));
    let shortest = shortest_s(words);
    for (segments, above) in bounds {
        let found = cases.iter().zip(&shortest).filter(|(_, s)| !s.is_nan());
        let mut shares: Vec<_> = found
            .map(|((path, limits, words), shortest_s)| {
                let share = share(path, *limits, segments, *shortest_s);
                let is_near = (1.0 - cells..1.0 + above).contains(&share);
                assert!(is_near, "{share}: {words} {limits:?}");
                share
            })
            .collect();
        shares.sort_by(f64::total_cmp);
        let (median, worst) = (shares[shares.len() / 2], shares[shares.len() - 1]);
        let count = shares.len();
        println!("{count} {what}, {segments} segments: {median:.5} of the time, worst {worst:.5}");
    }
}

/// Limits around those of a machine.
fn random_limits(random: &mut Random, machine: [[f64; 2]; 2]) -> [AxisLimits; 2] {
    machine.map(|[speed, acceleration]| {
        limits(
            speed * random.size(-0.5, 0.5),
            acceleration * random.size(-0.5, 0.5),
            None,
        )
    })
}

/// `TOPPRA_PATHS` of each kind.
#[test]
fn time_above_that_of_toppra_on_random_paths() {
    if !has_toppra() {
        return;
    }
    let mut random = Random::new(setting("SEED", 1));
    let (mut lines, mut all_waves) = (Vec::new(), Vec::new());
    for _ in 0..setting("TOPPRA_PATHS", 8) {
        // The angle does not pass 180 degrees.
        let mut end = || [random.within(-200.0, 200.0), random.within(10.0, 200.0)];
        let line = Line {
            from: end(),
            to: end(),
        };
        let ([x0, y0], [x1, y1]) = (line.from, line.to);
        let words = format!("line {x0} {y0} {x1} {y1}");
        lines.push((line, random_limits(&mut random, LIMITS), words));
        let waves = Waves::random(&mut random);
        let words = format!("waves{waves}");
        let limits = random_limits(&mut random, LIMITS_ON_WAVES);
        all_waves.push((waves.path(), limits, words));
    }
    judge("lines", &lines, CELLS, ABOVE);
    judge("waves", &all_waves, CELLS_ON_WAVES, ABOVE_ON_WAVES);
}
