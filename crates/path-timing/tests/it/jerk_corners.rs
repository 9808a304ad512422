//! Limits of jerk on paths that are passed without a stop.

use core::convert::Infallible;
use core::fmt::Debug;

use path_timing::{
    AxisLimits, Corner, Curve, Knot, LookAhead, Path, PlanError, Row, Table, ToolLimits,
};
use proptest::prelude::*;

use crate::support::jerk::{bits, check_jerk, feeds, run_under};
use crate::support::limits::ROUNDING;
use crate::support::machine::limits;
use crate::support::polyline::{lines, points, smoothed, within};

/// A polar arm, and a stage.
const ARM: [AxisLimits; 2] = [
    limits(2.0, 20.0, Some(400.0)),
    limits(300.0, 2000.0, Some(40_000.0)),
];
const STAGE: [AxisLimits; 2] = [limits(300.0, 2000.0, Some(400_000.0)); 2];

/// The sides of a polyline and the roundings between, with the same corner between all of them.
fn rounded(points: &[[f64; 2]], tolerance: f64, corner: Corner<[f64; 2]>) -> Vec<Curve<2>> {
    let curves = smoothed(points, tolerance).into_iter();
    curves.map(|curve| curve.with_corner(corner)).collect()
}

fn planned<P: Path<Axes = [f64; 2], Error = Infallible> + Clone + Debug>(
    legs: &[P],
    limits: [AxisLimits; 2],
    segments: u32,
) -> Vec<Row<[f64; 2]>> {
    try_planned(legs, limits, segments).unwrap()
}

/// None where a rounding turns so sharply that the segments are too coarse for it.
fn try_planned<P: Path<Axes = [f64; 2], Error = Infallible> + Clone + Debug>(
    legs: &[P],
    limits: [AxisLimits; 2],
    segments: u32,
) -> Option<Vec<Row<[f64; 2]>>> {
    let mut knots = vec![Knot::default(); 10_000];
    match Table::plan(legs, limits, |_| segments, &mut knots) {
        Err(PlanError::TooCoarse { .. }) => None,
        table => Some(table.unwrap().rows().collect()),
    }
}

fn time_s(rows: &[Row<[f64; 2]>]) -> f64 {
    rows.last().unwrap().time_s
}

/// A line of an arm in two halves takes as long as the line: knots stand elsewhere.
#[test]
fn a_smooth_joint_costs_nothing() {
    let [from, to] = [[-100.0, 80.0], [100.0, 80.0]];
    let whole_s = time_s(&planned(&lines(&[from, to], Corner::Stop, None), ARM, 200));
    let points = [from, [0.0, 80.0], to];
    let halves = lines(&points, Corner::Smooth, None);
    let rows = planned(&halves, ARM, 100);
    check_jerk(&ARM, None, &rows);
    assert!(rows[100].velocity[0].abs() > 1.0);
    let ratio = time_s(&rows) / whole_s;
    assert!((0.97..1.03).contains(&ratio), "{ratio}");
}

/// Where directions differ a smooth corner is a stop; velocities jump between two rows, with the
/// acceleration of constant speed on either side.
#[test]
fn sharp_corners_are_stops_or_jumps() {
    let points = [[-100.0, 80.0], [0.0, 80.0], [50.0, 140.0]];
    let stops = planned(&lines(&points, Corner::Smooth, None), ARM, 30);
    check_jerk(&ARM, None, &stops);
    assert_eq!(stops.len(), 61);
    assert!(stops[30].is_at_rest());
    let start_stop = [0.1, 20.0];
    let rows = planned(&lines(&points, Corner::Jump(start_stop), None), ARM, 30);
    check_jerk(&ARM, Some(&start_stop), &rows);
    assert_eq!(rows.len(), 62);
    assert!(!rows[30].is_at_rest() && rows[31].duration_s == 0.0);
    assert!(time_s(&rows) < time_s(&stops));
}

/// An arm bends its axes along a line: they have the acceleration of its bend right at the jump, so
/// that it is as fast on short segments as on long ones, in tables and streams.
#[test]
fn jumps_of_an_arm_are_as_fast_on_short_segments() {
    let points = [[-100.0, 80.0], [0.0, 80.0], [100.0, 110.0]];
    let legs = lines(&points, Corner::Jump([0.1, 20.0]), None);
    let planned = |segments| planned(&legs, ARM, segments);
    let streamed = |segments| {
        let mut window = [Knot::default(); 400];
        let rows = LookAhead::new(&legs, ARM, |_| Ok(segments), &mut window).unwrap();
        rows.map(Result::unwrap).collect::<Vec<_>>()
    };
    let plans: [&dyn Fn(u32) -> Vec<Row<[f64; 2]>>; 2] = [&planned, &streamed];
    for rows in plans {
        let speed = |segments| {
            let rows = rows(segments);
            let jump = rows.windows(2).find(|pair| pair[1].duration_s == 0.0);
            (time_s(&rows), jump.unwrap()[0].velocity[0].abs())
        };
        let (long_s, long_speed) = speed(40);
        for segments in [80, 160] {
            let (short_s, short_speed) = speed(segments);
            assert!(short_s < 1.01 * long_s, "{segments}: {}", short_s / long_s);
            assert!(
                short_speed > 0.97 * long_speed,
                "{segments}: {}",
                short_speed / long_speed
            );
        }
    }
}

/// Roundings that are passed at speed: what a limit of jerk costs.
#[test]
fn jerk_costs_rounded_corners_little() {
    let points: Vec<_> = (0..12_u32)
        .map(|n| [20.0 * f64::from(n), 15.0 * f64::from(n % 2)])
        .collect();
    let legs = rounded(&points, 2.0, Corner::Smooth);
    let free = STAGE.map(|axis| AxisLimits { jerk: None, ..axis });
    let rows = planned(&legs, STAGE, 64);
    check_jerk(&STAGE, None, &rows);
    let ratio = time_s(&rows) / time_s(&planned(&legs, free, 64));
    println!("with jerk {ratio} of the time without");
    assert!((1.0..1.03).contains(&ratio), "{ratio}");
}

/// Each leg has a feed of its own, which the tool keeps up to the joint.
#[test]
fn the_tool_keeps_the_feed_of_each_leg() {
    let feeds = [100.0, 20.0, 150.0, 60.0];
    let legs: Vec<_> = (0_u32..)
        .zip(feeds)
        .map(|(number, feed)| {
            let [from, to] = [number, number + 1].map(|n| [50.0 * f64::from(n), 0.0]);
            let tool = ToolLimits {
                feed,
                acceleration: Some(1000.0),
            };
            Curve::line(from, to).unwrap().with_tool(tool)
        })
        .collect();
    let rows = planned(&legs, STAGE, 50);
    check_jerk(&STAGE, None, &rows);
    for (leg, feed) in feeds.iter().enumerate() {
        let own = &rows[50 * leg..=50 * (leg + 1)];
        let fastest = own.iter().map(|row| row.velocity[0]).fold(0.0, f64::max);
        assert!(fastest <= feed * ROUNDING, "{fastest} on leg {leg}");
        assert!(fastest > 0.95 * feed, "{fastest} on leg {leg}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Also never slower than with a stop at each joint.
    #[test]
    fn limits_of_jerk_hold_on_rounded_corners(
        points in points(), tolerance in 0.01..5.0_f64, jerk in 1e4..1e6_f64,
        acceleration in 200.0..5000.0_f64, segments in 24..60_u32,
    ) {
        let limits = [limits(300.0, acceleration, Some(jerk)); 2];
        let rows = try_planned(&rounded(&points, tolerance, Corner::Smooth), limits, segments);
        prop_assume!(rows.is_some());
        let rows = rows.unwrap();
        check_jerk(&limits, None, &rows);
        prop_assert!(rows.windows(2).all(|pair| pair[1].duration_s > 0.0));
        let stops = try_planned(&rounded(&points, tolerance, Corner::Stop), limits, segments);
        prop_assume!(stops.is_some());
        let stops = stops.unwrap();
        prop_assert_eq!(rows.len(), stops.len());
        prop_assert!(time_s(&rows) <= time_s(&stops) * ROUNDING);
        let ends = [rows.first().unwrap(), rows.last().unwrap()];
        for (row, point) in ends.iter().zip([&points[0], points.last().unwrap()]) {
            let off = (row.position[0] - point[0]).hypot(row.position[1] - point[1]);
            prop_assert!(off < 1e-9);
            prop_assert!(row.velocity.iter().all(|v| *v == 0.0));
        }
    }

    #[test]
    fn jerk_is_kept_under_any_feeds_on_rounded_corners(
        points in points(), tolerance in 0.1..5.0_f64, scale in 0.5..1.0_f64,
        feeds in feeds(), segments in 7..30_u32,
    ) {
        let legs = rounded(&points, tolerance, Corner::Smooth);
        let mut knots = vec![Knot::default(); 1000];
        let table = Table::plan(&legs, STAGE, |_| segments, &mut knots);
        prop_assume!(!matches!(table, Err(PlanError::TooCoarse { .. })));
        let table = table.unwrap().at_speed(scale).unwrap();
        let rows = run_under(feeds, 0.3, &table);
        check_jerk(&STAGE, None, &rows);
        for (row, planned) in rows.iter().zip(table.rows()) {
            prop_assert_eq!(bits(row), bits(&planned));
        }
    }

    #[test]
    fn jumps_under_jerk_take_no_longer_than_stops(
        points in points(), jump in 1.0..100.0_f64, jerk in 1e4..1e6_f64, segments in 16..60_u32,
    ) {
        let limits = [limits(300.0, 2000.0, Some(jerk)); 2];
        let sides = |corner| {
            let side = move |ends: &[[f64; 2]]| Curve::line(ends[0], ends[1]).unwrap().with_corner(corner);
            points.windows(2).map(side).collect::<Vec<_>>()
        };
        let jumps = planned(&sides(Corner::Jump([jump; 2])), limits, segments);
        check_jerk(&limits, Some(&[jump; 2]), &jumps);
        let stops = planned(&sides(Corner::Stop), limits, segments);
        prop_assert!(time_s(&jumps) <= time_s(&stops) * ROUNDING);
    }

    /// The number of segments is chosen before the speeds are.
    #[test]
    fn departures_hold_with_jerk(
        points in points(), tolerance in 0.1..5.0_f64, allowed in 0.001..0.1_f64,
        jerk in 1e4..1e6_f64,
    ) {
        let curves = smoothed(&points, tolerance);
        let limits = [limits(300.0, 2000.0, Some(jerk)); 2];
        let mut knots = vec![Knot::default(); 20_000];
        let legs = curves.iter().copied();
        let accuracy = within(7, allowed);
        let table = Table::plan_within(legs, limits, accuracy, Curve::departure, &mut knots);
        for span in table.unwrap().spans() {
            prop_assert!(curves[span.rows[1].leg].departure(&span) <= allowed);
        }
    }
}
