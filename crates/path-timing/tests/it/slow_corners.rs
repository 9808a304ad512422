//! Long lines between corners that are passed next to rest: few segments take little more time than
//! many, and a stop rests soon.

use path_timing::{AxisLimits, Corner, Curve, FeedCeiling, Knot, LookAhead, Row, Table};
use test_support::{Random, setting};

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

/// Of the time to brake and to go over some segments from rest to rest. At the rows of 300 polylines
/// the most was 2.57 (`LINES=300`); where the next knot was crawled to, 349.
const SOON: f64 = 3.0;

/// Segments within which a stop ends: to a corner and beyond.
const NEAR: usize = 4;

/// The time from a row to the rest that is asked for there, over that.
fn stopped(planned: &[Row<[f64; 2]>], row: usize, axis: &AxisLimits, rest_s: f64) -> f64 {
    let (from, a) = (planned[row - 1], axis.acceleration);
    let distance = |to: &Row<[f64; 2]>, from: &Row<[f64; 2]>| {
        (to.position[0] - from.position[0]).hypot(to.position[1] - from.position[1])
    };
    let near = planned[row - 1..].windows(2).take(NEAR);
    let length = near.map(|ends| distance(&ends[1], &ends[0])).sum::<f64>();
    let speed = from.velocity[0].hypot(from.velocity[1]);
    let [ramp_s, jerk_s] = axis.jerk.map_or([0.0; 2], |jerk| {
        [a / jerk, 2.0 * (60.0 * length / jerk).cbrt()]
    });
    let over_s = length / axis.speed + 2.0 * (6.0 * length / a).sqrt() + jerk_s;
    rest_s / (speed / a + ramp_s + over_s)
}

/// The slowest stop of a table and of a stream of lines through random points.
fn slowest_stops(random: &mut Random) -> [f64; 2] {
    let acceleration = random.within(500.0, 10_000.0);
    let jerk = (random.below(2) == 0).then(|| acceleration * random.within(10.0, 200.0));
    let axis = limits(random.within(50.0, 500.0), acceleration, jerk);
    let segments = 4 + u32::try_from(random.below(40)).unwrap();
    let corner = Corner::Jump([10.0_f64.powf(random.within(-1.0, 1.0)); 2]);
    let points: [[f64; 2]; 4] =
        core::array::from_fn(|_| [random.within(0.0, 100.0), random.within(0.0, 100.0)]);
    let lines = points.windows(2).map(|ends| {
        let line = Curve::line(ends[0], ends[1]).unwrap();
        line.with_corner(corner)
    });
    let lines: Vec<_> = lines.collect();
    let mut knots = vec![Knot::default(); 2000];
    let table = Table::plan(&lines, [axis; 2], |_| segments, &mut knots).unwrap();
    // The rows behind one of them, where a stop is asked for; all without.
    let played = |row: Option<usize>| -> Vec<_> {
        let mut ceilings = [FeedCeiling::default(); 2000];
        let mut motion = table.playback(1.0, &mut ceilings).unwrap();
        if let Some(row) = row {
            motion.nth(row - 1);
            motion.stop();
        }
        motion.collect()
    };
    let streamed = |row: Option<usize>| -> Vec<_> {
        let mut window = [Knot::default(); 64];
        let mut motion = LookAhead::new(&lines, [axis; 2], |_| Ok(segments), &mut window).unwrap();
        if let Some(row) = row {
            motion.nth(row - 1);
            motion.stop();
        }
        motion.map(Result::unwrap).collect()
    };
    [slowest(&axis, played), slowest(&axis, streamed)]
}

/// The slowest stop of a motion, at all of its rows.
fn slowest(axis: &AxisLimits, rows: impl Fn(Option<usize>) -> Vec<Row<[f64; 2]>>) -> f64 {
    let planned = rows(None);
    let stops = (1..planned.len() - 1).map(|row| {
        let rest_s = rows(Some(row)).iter().map(|row| row.duration_s).sum();
        stopped(&planned, row, axis, rest_s)
    });
    stops.fold(0.0, f64::max)
}

#[test]
fn stops_rest_soon() {
    let mut random = Random::new(setting("SEED", 1));
    let mut slowest = [0.0_f64; 2];
    for _ in 0..setting("LINES", 10) {
        for (slowest, stop) in slowest.iter_mut().zip(slowest_stops(&mut random)) {
            *slowest = slowest.max(stop);
        }
    }
    println!("table and stream: {slowest:.2?}");
    assert!(slowest.iter().all(|stop| *stop < SOON), "{slowest:?}");
}
