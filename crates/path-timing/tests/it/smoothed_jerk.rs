//! Dense points under a limit of jerk: where the curvature does not step, short rows lose nothing.

use core::f64::consts::TAU;

use path_timing::{AxisLimits, Curve, Knot, Smoothed, Table, ToolLimits, Vertex, Waypoint};

use crate::support::polyline::circle;

const TOOL: ToolLimits = ToolLimits {
    feed: 300.0,
    acceleration: None,
};

const AXIS: AxisLimits = AxisLimits {
    speed: 1000.0,
    acceleration: 3000.0,
    jerk: Some(100_000.0),
};

/// Rows of a third of a millisecond.
const ROW_MM: f64 = 0.1;

/// Of the time of the arc: what is measured is within 0.0001.
const SLOWER: f64 = 1.001;

/// Of the circle's curvature, the most that it steps by from a curve to the next: 0.053 is the most
/// that is measured; it was up to 0.9.
const STEP: f64 = 0.08;

fn smoothed(points: &[[f64; 2]], tolerance: f64) -> Vec<Curve<2>> {
    let mut memory = [Vertex::default(); 24];
    let waypoints = points.iter().map(|point| Waypoint {
        point: *point,
        tool: Some(TOOL),
    });
    let curves = Smoothed::new(waypoints, tolerance, &mut memory).unwrap();
    curves.map(Result::unwrap).collect()
}

/// The time with rows of `ROW_MM`.
fn time_s(curves: &[Curve<2>]) -> f64 {
    let mut knots = vec![Knot::default(); 6000];
    let segments = |curve: &&Curve<2>| {
        let rows = (curve.length() / ROW_MM).ceil();
        (1..).find(|n| f64::from(*n) >= rows).unwrap()
    };
    let table = Table::plan(curves, [AXIS; 2], segments, &mut knots).unwrap();
    table.duration_s()
}

/// The largest step of the curvature from a curve to the next.
fn largest_step(curves: &[Curve<2>]) -> f64 {
    let steps = curves.windows(2).map(|pair| {
        let (before, after) = (pair[0].at(pair[0].length()), pair[1].at(0.0));
        let [x, y] = [0, 1].map(|axis| after.curvature[axis] - before.curvature[axis]);
        x.hypot(y)
    });
    steps.fold(0.0, f64::max)
}

#[test]
fn short_rows_along_dense_points_take_the_time_of_the_arc() {
    let arc = Curve::arc([40.0, 0.0], [0.0, 0.0], [0.0, 1.0], TAU).unwrap();
    let best_s = time_s(&[arc.with_tool(TOOL)]);
    for step_mm in [0.1, 0.2, 0.5, 1.0] {
        let points = circle(step_mm);
        for tolerance in [0.01, 0.02, 0.05] {
            let curves = smoothed(&points, tolerance);
            let ratio = time_s(&curves) / best_s;
            let step = largest_step(&curves) * 40.0;
            println!(
                "{step_mm} mm within {tolerance}: {ratio:.4} of the arc's time, curvature steps by {step:.4}"
            );
            assert!(ratio < SLOWER && step < STEP);
        }
    }
}
