//! Long lines between corners that are passed next to rest: few segments take little more time than
//! many.

use path_timing::{AxisLimits, Corner, Curve, Knot, LookAhead, Table};

use crate::support::machine::limits;
use crate::support::polyline::{smoothed, within};

const AXES: [AxisLimits; 2] = [limits(300.0, 3000.0, None); 2];

/// Of two segments: their speeds are triangles, those of many trapezoids.
const SLOWEST: f64 = 1.6;

/// A staircase.
const POINTS: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [100.0, 0.0],
    [100.0, 70.0],
    [200.0, 70.0],
    [200.0, 140.0],
    [300.0, 140.0],
];

/// Its sides, with a jump of the speed at each corner.
fn jumping(speed: f64) -> Vec<Curve<2>> {
    let side = |ends: &[[f64; 2]]| Curve::line(ends[0], ends[1]).unwrap();
    let sides = POINTS.windows(2).map(side);
    let sides = sides.map(|side| side.with_corner(Corner::Jump([speed; 2])));
    sides.collect()
}

fn check(paths: &[Curve<2>], what: &str) {
    let mut knots = vec![Knot::default(); 10_000];
    let many = Table::plan(paths, AXES, |_| 400, &mut knots).unwrap();
    let best_s = many.duration_s();
    for segments in [1, 2, 3, 8] {
        let mut knots = [Knot::default(); 200];
        let table = Table::plan(paths, AXES, |_| segments, &mut knots).unwrap();
        let share = table.duration_s() / best_s;
        assert!(share < SLOWEST, "{what}, {segments} segments: {share}");
        let stream = LookAhead::new(paths, AXES, |_| Ok(segments), &mut knots).unwrap();
        let share = stream.last().unwrap().unwrap().time_s / best_s;
        assert!(share < SLOWEST, "{what}, {segments} segments: {share}");
    }
    let mut knots = [Knot::default(); 200];
    let table = Table::plan_within(paths, AXES, within(1, 1e-3), |_, _| 0.0, &mut knots);
    let share = table.unwrap().duration_s() / best_s;
    assert!(share < SLOWEST, "{what}, any segments: {share}");
}

#[test]
fn jumps() {
    for speed in [0.01, 0.1, 1.0] {
        check(&jumping(speed), &format!("jumps of {speed} mm/s"));
    }
}

#[test]
fn blends() {
    for tolerance in [1e-5, 1e-4, 1e-3, 1e-2] {
        let what = format!("blends within {tolerance} mm");
        check(&smoothed(&POINTS, tolerance), &what);
    }
}
