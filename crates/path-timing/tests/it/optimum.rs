//! How near the tables come to the shortest time, against a fine phase plane of its own.

use path_timing::{AxisLimits, Knot, Path, Table};

use crate::support::machine::{Line, limits};

/// Cells of the phase plane.
const CELLS: u32 = 20_000;

/// Slope p and curvature c of an axis by differences, and its limits.
struct Here {
    p: f64,
    c: f64,
    limits: AxisLimits,
}

fn here(line: &Line, limits: &[AxisLimits; 2], s: f64) -> [Here; 2] {
    let step = 1e-4 * line.length();
    let slope = |s: f64| line.point(s).unwrap().slope;
    let (before, now, after) = (slope(s - step), slope(s), slope(s + step));
    [0, 1].map(|i| Here {
        p: now[i],
        c: (after[i] - before[i]) / (2.0 * step),
        limits: limits[i],
    })
}

/// Range of the path's acceleration u with |c x + p u| ≤ a, x the squared speed.
fn range(axes: &[Here; 2], x: f64) -> (f64, f64) {
    axes.iter().fold((f64::MIN, f64::MAX), |(low, high), axis| {
        let middle = -axis.c * x / axis.p;
        let wide = (axis.limits.acceleration / axis.p).abs();
        (low.max(middle - wide), high.min(middle + wide))
    })
}

/// The largest squared speed for which there is such a u.
fn most(axes: &[Here; 2]) -> f64 {
    let caps = axes.iter().map(|axis| (axis.limits.speed / axis.p).powi(2));
    let (mut low, mut high) = (0.0, caps.fold(1e9, f64::min));
    let allows = |x: f64| {
        let (least, most) = range(axes, x);
        least <= most
    };
    if allows(high) {
        return high;
    }
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if allows(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The shortest time, by squared speeds that go as high as accelerations allow from both ends.
fn shortest(line: &Line, limits: &[AxisLimits; 2]) -> f64 {
    let step = line.length() / f64::from(CELLS);
    let places: Vec<_> = (0..=CELLS)
        .map(|k| here(line, limits, f64::from(k) * step))
        .collect();
    let mut squares: Vec<f64> = places.iter().map(most).collect();
    let last = squares.len() - 1;
    (squares[0], squares[last]) = (0.0, 0.0);
    for k in (0..last).rev() {
        let (least, _) = range(&places[k + 1], squares[k + 1]);
        squares[k] = squares[k].min((squares[k + 1] - 2.0 * least * step).max(0.0));
    }
    for k in 1..=last {
        let (_, most) = range(&places[k - 1], squares[k - 1]);
        squares[k] = squares[k].min((squares[k - 1] + 2.0 * most * step).max(0.0));
    }
    let times = squares
        .windows(2)
        .map(|pair| 2.0 * step / (pair[0].sqrt() + pair[1].sqrt()));
    times.sum()
}

/// What the phase plane is off by.
const GRID: f64 = 1e-3;

#[test]
fn time_above_the_shortest() {
    let limits = [limits(2.0, 20.0, None), limits(300.0, 2000.0, None)];
    for (name, line, above) in [
        (
            "past the arm",
            Line {
                from: [-100.0, 101.0],
                to: [100.0, 99.0],
            },
            [0.012, 1e-3],
        ),
        (
            "close past the arm",
            Line {
                from: [-100.0, 21.0],
                to: [100.0, 19.0],
            },
            [0.012, 1e-3],
        ),
        (
            "away from it",
            Line {
                from: [30.0, 40.0],
                to: [200.0, 130.0],
            },
            [0.012, 1e-3],
        ),
    ] {
        let shortest = shortest(&line, &limits);
        for (segments, above) in [100, 1000].into_iter().zip(above) {
            let mut knots = [Knot::default(); 1001];
            let table = Table::plan([line], limits, |_| segments, &mut knots).unwrap();
            let share = table.duration_s() / shortest;
            println!("{name}, {segments} segments: {share:.5} of {shortest:.4} s");
            assert!(
                (1.0 - GRID..1.0 + above).contains(&share),
                "{name}: {share}"
            );
        }
    }
}
