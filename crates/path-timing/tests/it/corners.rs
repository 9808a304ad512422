//! Corners between paths: stops, smooth joints, velocities that jump.

use path_timing::{
    AxisLimits, Corner, FeedCeiling, Knot, LookAhead, PathFn, PathPoint, PlanError, Row, Table,
};
use proptest::prelude::*;

use crate::support::limits::check_limits;
use crate::support::machine::limits;
use crate::support::polyline::lines;

const LIMITS: [AxisLimits; 2] = [limits(2.0, 20.0, None), limits(300.0, 2000.0, None)];

/// Of sums of some hundred times.
const ROUNDING: f64 = 1e-9;

fn planned(
    points: &[[f64; 2]],
    corner: Corner<[f64; 2]>,
    segments: u32,
) -> (f64, Vec<Row<[f64; 2]>>) {
    let mut knots = vec![Knot::default(); 4000];
    let legs = lines(points, corner, None);
    let table = Table::plan(&legs, LIMITS, |_| segments, &mut knots).unwrap();
    let rows: Vec<_> = table.rows().collect();
    assert_eq!(rows.len(), table.len());
    let time_s = rows.last().unwrap().time_s;
    assert!((time_s / table.duration_s() - 1.0).abs() < ROUNDING);
    (table.duration_s(), rows)
}

/// Both rows of the only corner.
fn corner_rows(rows: &[Row<[f64; 2]>]) -> [Row<[f64; 2]>; 2] {
    let twins = rows.windows(2).filter(|pair| pair[1].duration_s == 0.0);
    let twins: Vec<_> = twins.collect();
    assert_eq!(twins.len(), 1);
    assert_eq!(twins[0][0].time_s.to_bits(), twins[0][1].time_s.to_bits());
    [twins[0][0], twins[0][1]]
}

/// A line in two halves takes as long as the line.
#[test]
fn a_smooth_joint_costs_nothing() {
    let [from, to] = [[-100.0, 80.0], [100.0, 80.0]];
    let (whole_s, _) = planned(&[from, to], Corner::Stop, 200);
    let (halves_s, rows) = planned(&[from, [0.0, 80.0], to], Corner::Smooth, 100);
    // Knots stand elsewhere.
    assert!(
        (halves_s / whole_s - 1.0).abs() < 1e-3,
        "{}",
        halves_s / whole_s
    );
    assert!(rows.iter().skip(1).all(|row| row.duration_s > 0.0));
    assert!(rows[100].velocity[0].abs() > 1.0);
    check_limits(&LIMITS, None, &rows);
    let (stops_s, rows) = planned(&[from, [0.0, 80.0], to], Corner::Stop, 100);
    assert!(stops_s > 1.05 * whole_s);
    assert!(rows[100].velocity.iter().all(|v| *v == 0.0));
}

#[test]
fn velocities_jump_by_what_motors_start_with() {
    let points = [[-100.0, 80.0], [0.0, 80.0], [100.0, 110.0]];
    let (stop_s, _) = planned(&points, Corner::Stop, 100);
    let mut before_s = stop_s;
    for start_stop in [[0.01, 2.0], [0.05, 10.0], [0.2, 40.0]] {
        let (time_s, rows) = planned(&points, Corner::Jump(start_stop), 100);
        let [before, after] = corner_rows(&rows);
        let used = [0, 1].map(|i| (after.velocity[i] - before.velocity[i]).abs() / start_stop[i]);
        let used = used[0].max(used[1]);
        assert!((1.0 - ROUNDING..=1.0).contains(&used), "{used}");
        check_limits(&LIMITS, Some(&start_stop), &rows);
        assert!(time_s < before_s);
        before_s = time_s;
    }
    // Not passed by the rounding of single precision either.
    for turn in (0..20).map(|n| 0.01 + 0.003 * f64::from(n)) {
        let start_stop = [turn, 200.0 * turn];
        let legs = lines(&points, Corner::Jump(start_stop), None);
        let mut knots = [Knot::default(); MOST];
        let table = Table::plan_in_f32(&legs, LIMITS, |_| 100, &mut knots).unwrap();
        let rows: Vec<_> = table.rows().collect();
        check_limits(&LIMITS, Some(&start_stop), &rows);
        assert!(!corner_rows(&rows)[0].is_at_rest());
    }
    // Motors that start at any speed limit nothing.
    let (_, rows) = planned(&points, Corner::Jump([1e9; 2]), 100);
    check_limits(&LIMITS, Some(&[1e9; 2]), &rows);
    // Nothing to start with is a stop, and so is a corner that is called smooth.
    for corner in [Corner::Jump([0.0; 2]), Corner::Smooth] {
        let (time_s, rows) = planned(&points, corner, 100);
        assert!((time_s / stop_s - 1.0).abs() < ROUNDING);
        assert!(rows.iter().skip(1).all(|row| row.duration_s > 0.0));
    }
}

/// Two axes at right angles, each the coordinate: w = δ at the corner.
#[test]
fn a_square_corner_takes_the_closed_form() {
    let side = |axis: usize| {
        let point = move |s: f64| {
            let mut point = PathPoint {
                position: if axis == 0 { [s, 0.0] } else { [50.0, s] },
                slope: [0.0; 2],
            };
            point.slope[axis] = 1.0;
            Ok::<_, core::convert::Infallible>(point)
        };
        PathFn::new(50.0, point).with_corner(Corner::Jump([4.0, 3.0]))
    };
    let mut knots = [Knot::default(); 202];
    let limits = [limits(20.0, 100.0, None); 2];
    let table = Table::plan([side(0), side(1)], limits, |_| 100, &mut knots).unwrap();
    let rows: Vec<_> = table.rows().collect();
    let [before, after] = corner_rows(&rows);
    assert!((before.velocity[0] - 3.0).abs() < ROUNDING && before.velocity[1].abs() < ROUNDING);
    assert!((after.velocity[1] - 3.0).abs() < ROUNDING && after.velocity[0].abs() < ROUNDING);
    // 0 to 20 mm/s, 20 to 3 mm/s and the rest of 50 mm at 20 mm/s, twice.
    let ramps = 20.0 * 20.0 / 200.0 + (20.0 * 20.0 - 3.0 * 3.0) / 200.0;
    let time_s = 2.0 * (20.0 / 100.0 + 17.0 / 100.0 + (50.0 - ramps) / 20.0);
    let ratio = table.duration_s() / time_s;
    assert!((1.0 - ROUNDING..1.002).contains(&ratio), "{ratio}");
}

#[test]
fn wrong_start_stop_speeds_are_named() {
    let mut knots = [Knot::default(); 100];
    for bad in [-1.0, f64::NAN, f64::INFINITY, 1e300] {
        let corner = Corner::Jump([1.0, bad]);
        let legs = lines(&[[-100.0, 80.0], [0.0, 80.0], [100.0, 110.0]], corner, None);
        let error = Table::plan(&legs, LIMITS, |_| 10, &mut knots).unwrap_err();
        assert!(
            matches!(
                error,
                PlanError::StartStopSpeed {
                    leg: 0,
                    axis: 1,
                    ..
                }
            ),
            "{error}"
        );
    }
}

/// Knots gather where one limit takes over from another, but not until only rounding lies between
/// them.
#[test]
fn more_segments_beside_jumps_take_no_longer() {
    let points = [[1.0, 1.9], [0.1, 0.2], [0.3, 0.4], [1.7, 2.1], [0.6, 0.9]];
    let timed_s = |segments| planned(&points, Corner::Jump([0.02, 3.0]), segments).0;
    let few_s = timed_s(300);
    for segments in [450, 600, 800] {
        let ratio = timed_s(segments) / few_s;
        assert!(ratio < MORE_SEGMENTS, "{segments} segments: {ratio}");
    }
}

/// They stand elsewhere.
const MORE_SEGMENTS: f64 = 1.0001;

/// Knots, more than any of the polylines takes.
const MOST: usize = 1024;

/// Knots are not as dense at a jump as at a stop: there short legs would have segments so short that
/// rounding takes the limits for itself.
#[test]
fn jumps_between_short_legs_are_as_fast_on_many_segments() {
    let points: Vec<_> = (0..7)
        .map(|n| [50.0 + 0.1 * f64::from(n), 140.0 + 0.08 * f64::from(n % 2)])
        .collect();
    let legs = lines(&points, Corner::Jump([1.0, 400.0]), None);
    for jerk in [None, Some([400.0, 40_000.0])] {
        let limits = [0, 1].map(|axis: usize| AxisLimits {
            jerk: jerk.map(|jerk| jerk[axis]),
            ..LIMITS[axis]
        });
        let time_s = |segments| {
            let mut knots = vec![Knot::default(); 12_000];
            let table = Table::plan(&legs, limits, |_| segments, &mut knots).unwrap();
            table.duration_s()
        };
        let few_s = time_s(100);
        for segments in [200, 400, 800, 1600] {
            let ratio = time_s(segments) / few_s;
            assert!(ratio < 1.01, "{jerk:?}, {segments}: {ratio}");
        }
    }
}

/// With 16 segments and more on each leg, which stand elsewhere, a jump next to rest takes up to
/// 0.16 % longer than the stop.
const ELSEWHERE: f64 = 1.003;

/// One of the three corners, with start-stop speeds.
fn corners() -> impl Strategy<Value = Corner<[f64; 2]>> {
    prop_oneof![
        Just(Corner::Stop),
        Just(Corner::Smooth),
        (0.0..0.5, 0.0..80.0).prop_map(|(turn, slide)| Corner::Jump([turn, slide])),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn limits_and_jumps_hold_on_any_polyline_at_any_feed(
        points in prop::collection::vec(prop::array::uniform2(-200.0..200.0_f64), 2..7),
        corner in corners(),
        feed in prop::option::of(20.0..500.0),
        overrides in prop::collection::vec((0.0..1.5_f64, 1..20_usize), 0..8),
        segments in 2..40_u32,
    ) {
        let start_stop = if let Corner::Jump(speeds) = corner { speeds } else { [0.0; 2] };
        let legs = lines(&points, corner, feed);
        let mut knots = [Knot::default(); MOST];
        let table = Table::plan(&legs, LIMITS, |_| segments, &mut knots);
        prop_assume!(!matches!(table, Err(PlanError::TooCoarse { .. })));
        let table = table.unwrap();
        let planned: Vec<_> = table.rows().collect();
        check_limits(&LIMITS, Some(&start_stop), &planned);
        let mut ahead = [FeedCeiling::default(); MOST];
        let mut run = table.playback(1.5, &mut ahead).unwrap();
        let mut rows = Vec::new();
        for (wanted, count) in overrides {
            run.set_feed(if wanted < 0.2 { 0.0 } else { wanted }).unwrap();
            rows.extend(run.by_ref().take(count));
        }
        run.set_feed(1.0).unwrap();
        rows.extend(run);
        check_limits(&LIMITS, Some(&start_stop), &rows);
        prop_assert_eq!(rows.len(), planned.len());
        let ends = |rows: &[Row<[f64; 2]>]| rows.last().map(|row| (row.position, row.velocity));
        prop_assert_eq!(ends(&rows), ends(&planned));
    }

    #[test]
    fn jumps_take_no_longer_than_stops(
        points in prop::collection::vec(prop::array::uniform2(-200.0..200.0_f64), 3..6),
        jump in -7.0..0.0_f64,
        segments in 16..200_u32,
    ) {
        let jump = [0.5, 80.0].map(|speed| speed * jump.exp());
        let table_s = |corner| {
            let mut knots = [Knot::default(); 2 * MOST];
            let table = Table::plan(lines(&points, corner, None), LIMITS, |_| segments, &mut knots);
            table.map(|table| table.duration_s())
        };
        let stream_s = |corner| {
            let mut window = [Knot::default(); 2 * MOST];
            let paths = lines(&points, corner, None);
            let rows = LookAhead::new(paths, LIMITS, |_| Ok(segments), &mut window).unwrap();
            rows.last().unwrap().map(|row| row.time_s)
        };
        let corners = [Corner::Jump(jump), Corner::Stop];
        for times in [corners.map(table_s), corners.map(stream_s)] {
            prop_assume!(times.iter().all(Result::is_ok));
            let [jumps_s, stops_s] = times.map(Result::unwrap);
            prop_assert!(jumps_s <= stops_s * ELSEWHERE, "{}", jumps_s / stops_s);
        }
    }
}
