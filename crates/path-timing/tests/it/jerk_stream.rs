//! Streams with limits of jerk.

use alloc::collections::VecDeque;
use core::cell::RefCell;

use path_timing::{AxisLimits, Corner, Curve, Knot, LookAhead, PlanError, Row, Table};
use proptest::prelude::*;

use test_support::{Random, setting};

use crate::support::jerk::check_jerk;
use crate::support::machine::limits;
use crate::support::polyline::{points, smoothed};
use crate::support::vectors::bits;

type Rows = Vec<Row<[f64; 2]>>;

/// Start-stop speeds in mm/s.
const JUMP: [f64; 2] = [15.0, 10.0];

/// Of 200 sides of 2 to 5 mm.
const MOST_S: f64 = 15.0;

/// What a window costs, whose knots do not stand where those of a table do.
const WINDOW: f64 = 1.05;

fn staircase(count: u32, step: [f64; 2]) -> Vec<[f64; 2]> {
    let point = |n: u32| {
        [
            f64::from(n / 2) * step[0],
            f64::from(n.div_ceil(2)) * step[1],
        ]
    };
    (0..count).map(point).collect()
}

/// The curves of points smoothed within a tolerance, or their lines with a corner.
fn curves(points: &[[f64; 2]], tolerance: f64, corner: Option<Corner<[f64; 2]>>) -> Vec<Curve<2>> {
    let Some(corner) = corner else {
        return smoothed(points, tolerance);
    };
    let line = |ends: &[[f64; 2]]| Curve::line(ends[0], ends[1]).unwrap();
    let lines = points.windows(2).map(line);
    lines.map(|line| line.with_corner(corner)).collect()
}

fn table_s(curves: &[Curve<2>], limits: [AxisLimits; 2], segments: u32) -> f64 {
    let mut knots = vec![Knot::default(); 20_000];
    let table = Table::plan(curves, limits, |_| segments, &mut knots);
    table.unwrap().duration_s()
}

/// The rows in a window of so many knots, with feeds wanted for so many rows; none where a corner
/// is too sharp for the segments.
fn stream(
    curves: &[Curve<2>],
    limits: [AxisLimits; 2],
    segments: u32,
    knots: usize,
    feeds: &[(f64, usize)],
) -> Option<Rows> {
    let mut window = vec![Knot::default(); knots];
    let mut motion = LookAhead::new(curves, limits, |_| Ok(segments), &mut window).unwrap();
    let mut rows = Vec::new();
    let all = (1.0, usize::MAX);
    for (feed, count) in feeds.iter().copied().chain([all]) {
        motion.set_feed(feed).unwrap();
        for row in motion.by_ref().take(count) {
            match row {
                Err(PlanError::TooCoarse { .. }) => return None,
                row => rows.push(row.unwrap()),
            }
        }
    }
    assert!(motion.is_at_rest());
    Some(rows)
}

#[test]
fn a_window_costs_little_time() {
    let stage = [limits(300.0, 2000.0, Some(80_000.0)); 2];
    let curves = smoothed(&staircase(40, [20.0, 14.0]), 0.05);
    let best_s = table_s(&curves, stage, 8);
    for (knots, most) in [(10, 1.2), (20, 1.02), (40, 1.01), (400, 1.005)] {
        let rows = stream(&curves, stage, 8, knots, &[]).unwrap();
        check_jerk(&stage, None, &rows);
        let share = rows.last().unwrap().time_s / best_s;
        assert!(share < most, "{knots} knots: {share}");
    }
}

/// 200 sides of 2 to 5 mm that turn by 5 to 30 degrees, at 150 mm/s.
#[test]
fn corners_are_passed_faster_than_with_stops() {
    let mut random = Random::new(1);
    let (mut at, mut heading) = ([0.0, 0.0], 0.0_f64);
    let mut points = vec![at];
    for _ in 0..200 {
        let turn = random.within(5.0, 30.0_f64).to_radians();
        heading += if random.below(2) == 0 { turn } else { -turn };
        let length = random.within(2.0, 5.0);
        at = [
            at[0] + length * heading.cos(),
            at[1] + length * heading.sin(),
        ];
        points.push(at);
    }
    let axes = [limits(150.0, 3000.0, Some(100_000.0)); 2];
    let stops_s = table_s(&curves(&points, 0.0, Some(Corner::Stop)), axes, 16);
    let jumps_s = table_s(
        &curves(&points, 0.0, Some(Corner::Jump([10.0; 2]))),
        axes,
        16,
    );
    println!("stops {stops_s:.2} s, jumps {jumps_s:.2} s");
    let rounded = smoothed(&points, 0.02);
    for segments in [4, 8, 16] {
        let table_s = table_s(&rounded, axes, segments);
        let rows = stream(&rounded, axes, segments, 200, &[]).unwrap();
        check_jerk(&axes, None, &rows);
        let stream_s = rows.last().unwrap().time_s;
        println!("{segments} segments: table {table_s:.2} s, stream {stream_s:.2} s");
        assert!(table_s < MOST_S && stream_s < table_s * WINDOW);
    }
}

/// Of the time of a table at the lowest feed that is wanted: in a window of 5 to 9 knots the machine
/// rests at many. Of 20,000 polylines the most was 2.31 (`LINES=20000`); where it crawled from the
/// knot at which a window had ended, 184.
const SHORT: f64 = 3.0;

#[test]
fn a_short_window_does_not_crawl() {
    let mut random = Random::new(setting("SEED", 1));
    let mut slowest = 0.0_f64;
    for _ in 0..setting("LINES", 200) {
        let acceleration = random.within(500.0, 10_000.0);
        let jerk = acceleration * 10.0_f64.powf(random.within(1.0, 3.0));
        let limits = [limits(random.within(50.0, 500.0), acceleration, Some(jerk)); 2];
        let count = 2 + usize::try_from(random.below(3)).unwrap();
        let mut point = |_| core::array::from_fn(|_| random.within(0.0, 100.0));
        let points: Vec<[f64; 2]> = (0..count).map(&mut point).collect();
        let corner = [Corner::Stop, Corner::Jump([random.within(0.1, 10.0); 2])];
        let corner = corner[usize::try_from(random.below(2)).unwrap()];
        let curves = curves(&points, 0.0, Some(corner));
        let segments = 4 + u32::try_from(random.below(20)).unwrap();
        let knots = 5 + usize::try_from(random.below(5)).unwrap();
        let changes = random.below(5);
        let feeds = (0..changes).map(|_| {
            let feed = 10.0_f64.powf(random.within(-1.5, 0.0));
            let feed = if random.below(3) == 0 { 0.0 } else { feed };
            (feed, 1 + usize::try_from(random.below(20)).unwrap())
        });
        let feeds: Vec<_> = feeds.collect();
        let rows = stream(&curves, limits, segments, knots, &feeds).unwrap();
        let moving = feeds
            .iter()
            .map(|(feed, _)| *feed)
            .filter(|feed| *feed > 0.0);
        let share = rows.last().unwrap().time_s * moving.fold(1.0, f64::min)
            / table_s(&curves, limits, segments);
        slowest = slowest.max(share);
    }
    println!("{slowest:.2} times the table");
    assert!(slowest < SHORT, "{slowest}");
}

/// The rest at the end of what is known so far is passed when there is more.
#[test]
fn a_stream_that_pauses_goes_on() {
    let stage = [limits(300.0, 2000.0, Some(80_000.0)); 2];
    let curves = smoothed(&staircase(20, [20.0, 14.0]), 0.05);
    let queue = RefCell::new(VecDeque::from_iter(&curves));
    let late = queue.borrow_mut().split_off(9);
    let source = core::iter::from_fn(|| queue.borrow_mut().pop_front());
    let mut window = [Knot::default(); 60];
    let mut motion = LookAhead::new(source, stage, |_| Ok(8), &mut window).unwrap();
    let mut rows: Rows = motion.by_ref().map(Result::unwrap).collect();
    assert!(motion.is_at_rest() && rows.len() == 9 * 8 + 1);
    queue.borrow_mut().extend(late);
    rows.extend(motion.map(Result::unwrap));
    check_jerk(&stage, None, &rows);
    let end = curves.last().unwrap().end();
    assert_eq!(bits(rows.last().unwrap().position), bits(end));
}

/// 100 % is what is planned.
#[test]
fn no_feed_is_above_the_plan() {
    let stage = [limits(300.0, 2000.0, Some(80_000.0)); 2];
    let curves = smoothed(&staircase(4, [20.0, 14.0]), 0.05);
    let mut window = [Knot::default(); 20];
    let motion = LookAhead::new(&curves, stage, |_| Ok(8), &mut window).unwrap();
    let error = motion.with_max_feed(1.5).unwrap_err();
    assert!(
        matches!(error, PlanError::Feed { max: 1.0, .. }),
        "{error:?}"
    );
}

fn corner() -> impl Strategy<Value = Option<Corner<[f64; 2]>>> {
    prop::sample::select(vec![None, Some(Corner::Stop), Some(Corner::Jump(JUMP))])
}

fn feeds() -> impl Strategy<Value = Vec<(f64, usize)>> {
    let feed = prop_oneof![Just(0.0), Just(1.0), 0.05..1.0_f64];
    prop::collection::vec((feed, 1..40_usize), 0..6)
}

proptest! {
    /// Speed, acceleration and jerk at all rows and in all cubics, whatever is wanted when, in any
    /// window; the stream ends at the end of the path.
    #[test]
    fn limits_hold(
        points in points(), tolerance in 0.01..5.0_f64, corner in corner(), jerk in 1e4..1e6_f64,
        acceleration in 200.0..5000.0_f64, segments in 2..30_u32, knots in 4..100_usize,
        feeds in feeds(),
    ) {
        let limits = [limits(300.0, acceleration, Some(jerk)); 2];
        let curves = curves(&points, tolerance, corner);
        let rows = stream(&curves, limits, segments, knots, &feeds);
        prop_assume!(rows.is_some());
        let rows = rows.unwrap();
        check_jerk(&limits, Some(&JUMP), &rows);
        let end = *points.last().unwrap();
        prop_assert_eq!(bits(rows.last().unwrap().position), bits(end));
    }

    /// A window that holds the whole path takes the time of the table.
    #[test]
    fn a_stream_is_as_fast_as_a_table(
        points in points(), tolerance in 0.01..5.0_f64, corner in corner(), jerk in 1e4..1e6_f64,
        segments in 24..40_u32,
    ) {
        let limits = [limits(300.0, 2000.0, Some(jerk)); 2];
        let curves = curves(&points, tolerance, corner);
        let rows = stream(&curves, limits, segments, 2000, &[]);
        prop_assume!(rows.is_some());
        let time_s = rows.unwrap().last().unwrap().time_s;
        let best_s = table_s(&curves, limits, segments);
        prop_assert!(time_s < best_s * WINDOW, "{} {}", time_s, best_s);
    }
}
