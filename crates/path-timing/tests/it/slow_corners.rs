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

/// Of the time to brake and to go over some segments from rest to rest: to a rest that is asked for,
/// and by how much later the machine is at the end when it goes on from there at once. At the rows
/// of 300 polylines the most was 2.57, and 0.32 behind the rest (`LINES=300`); where it crawled to
/// the next knot, 349 and 468.
const SOON: [f64; 2] = [3.0, 0.5];

/// Segments within which a stop ends: to a corner and beyond.
const NEAR: usize = 4;

/// The time to brake from a speed, or to gain it, and to go over some segments from a row on from
/// rest to rest.
fn near_s(planned: &[Row<[f64; 2]>], row: usize, speed: f64, axis: &AxisLimits) -> f64 {
    let distance = |from: &Row<[f64; 2]>, to: &Row<[f64; 2]>| {
        (to.position[0] - from.position[0]).hypot(to.position[1] - from.position[1])
    };
    let near = planned[row..].windows(2).take(NEAR);
    let length = near.map(|ends| distance(&ends[0], &ends[1])).sum::<f64>();
    let a = axis.acceleration;
    let [ramp_s, jerk_s] = axis.jerk.map_or([0.0; 2], |jerk| {
        [a / jerk, 2.0 * (60.0 * length / jerk).cbrt()]
    });
    let over_s = length / axis.speed + 2.0 * (6.0 * length / a).sqrt() + jerk_s;
    speed / a + ramp_s + over_s
}

/// The rows to a rest that is asked for at a row, and those behind it.
type Held = [Vec<Row<[f64; 2]>>; 2];

/// The slowest stop of a motion, and the largest loss by one, of those at all of its rows. Without a
/// row, `held` gives all rows first.
fn slowest(axis: &AxisLimits, held: impl Fn(Option<usize>) -> Held) -> [f64; 2] {
    let [planned, _] = held(None);
    let end_s = planned.last().unwrap().time_s;
    let time_s = |rows: &[Row<_>]| rows.iter().map(|row| row.duration_s).sum::<f64>();
    let mut slowest = [0.0_f64; 2];
    for row in 0..planned.len() - 2 {
        let [stopping, behind] = held(Some(row));
        let rest = row + stopping.len();
        let late_s = time_s(&behind) - (end_s - planned[rest].time_s);
        let speed = planned[row].velocity[0].hypot(planned[row].velocity[1]);
        let shares = [
            time_s(&stopping) / near_s(&planned, row, speed, axis),
            late_s / near_s(&planned, rest, axis.speed, axis),
        ];
        for (slowest, share) in slowest.iter_mut().zip(shares) {
            *slowest = slowest.max(share);
        }
    }
    slowest
}

/// Of a table and of a stream of lines through random points.
fn slowest_holds(random: &mut Random) -> [[f64; 2]; 2] {
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
    let played = |row: Option<usize>| {
        let mut ceilings = [FeedCeiling::default(); 2000];
        let mut motion = table.playback(1.0, &mut ceilings).unwrap();
        if let Some(row) = row {
            motion.nth(row);
            motion.stop();
        }
        let stopping = motion.by_ref().collect();
        motion.set_feed(1.0).unwrap();
        [stopping, motion.collect()]
    };
    let streamed = |row: Option<usize>| {
        let mut window = [Knot::default(); 64];
        let mut motion = LookAhead::new(&lines, [axis; 2], |_| Ok(segments), &mut window).unwrap();
        if let Some(row) = row {
            motion.nth(row);
            motion.stop();
        }
        let stopping = motion.by_ref().map(Result::unwrap).collect();
        motion.set_feed(1.0).unwrap();
        [stopping, motion.map(Result::unwrap).collect()]
    };
    [slowest(&axis, played), slowest(&axis, streamed)]
}

#[test]
fn holds_cost_little() {
    let mut random = Random::new(setting("SEED", 1));
    let mut slowest = [[0.0_f64; 2]; 2];
    for _ in 0..setting("LINES", 10) {
        let holds = slowest_holds(&mut random);
        for (slowest, hold) in slowest
            .as_flattened_mut()
            .iter_mut()
            .zip(holds.as_flattened())
        {
            *slowest = slowest.max(*hold);
        }
    }
    println!("table and stream: {slowest:.2?}");
    for [stop, late] in slowest {
        assert!(stop < SOON[0] && late < SOON[1], "{slowest:?}");
    }
}

/// From where a bend leaves little of the limits, the first stop that was found lasted 2.6 s.
#[test]
fn a_long_stop_is_shortened() {
    let curves = [
        [
            [80.244, 9.717],
            [1.466, 6.624],
            [66.518, 29.266],
            [12.177, 47.179],
        ],
        [
            [12.177, 47.179],
            [53.956, 80.153],
            [76.732, 71.944],
            [76.347, 27.748],
        ],
        [
            [76.347, 27.748],
            [50.941, 44.85],
            [70.58, 16.633],
            [57.917, 48.697],
        ],
        [
            [57.917, 48.697],
            [50.976, 71.05],
            [56.992, 82.736],
            [5.204, 8.314],
        ],
    ];
    let curves = curves.map(|points| {
        let curve = Curve::bezier(points).unwrap();
        curve.with_corner(Corner::Jump([0.13; 2]))
    });
    let axis = limits(79.732_153_87, 1_930.042_326_6, Some(47_832.033_22));
    let mut knots = vec![Knot::default(); 400];
    let table = Table::plan(curves, [axis; 2], |_| 11, &mut knots).unwrap();
    let mut ceilings = [FeedCeiling::default(); 400];
    for row in 106..116 {
        let mut motion = table.playback(1.0, &mut ceilings).unwrap();
        motion.nth(row);
        motion.stop();
        let rest_s = motion.map(|row| row.duration_s).sum::<f64>();
        assert!(rest_s < 1.0, "{rest_s} s from row {row}");
    }
}
