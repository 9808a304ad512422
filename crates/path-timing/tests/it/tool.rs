//! Limits of the tool along smoothed lines, by the velocities that the rows of a Cartesian machine
//! have, whatever the parameter of the path is.

use core::convert::Infallible;
use core::f64::consts::PI;

use path_timing::{
    Accuracy, AxisLimits, Curve, FeedCeiling, FeedError, Knot, LookAhead, Playback, Promise, Row,
    Smoothed, Table, ToolLimits, Verifier, Vertex, Violation, Waypoint,
};
use proptest::prelude::*;
use test_support::{Random, setting};

use crate::support::vectors::norm;

/// Of speeds, and of a mean acceleration of short rows.
const ROUNDING: f64 = 1.0 + 1e-6;

const AXIS: AxisLimits = AxisLimits {
    speed: 600.0,
    acceleration: 12_000.0,
    jerk: None,
};

/// Lines that turn by some angles, with a tool, smoothed.
fn curves(turns: &[f64], length: f64, tool: ToolLimits, tolerance: f64) -> Vec<Curve<2>> {
    let (mut at, mut angle) = ([0.0; 2], 0.0_f64);
    let mut points = vec![at];
    for turn in turns {
        at = [at[0] + length * angle.cos(), at[1] + length * angle.sin()];
        points.push(at);
        angle += turn;
    }
    let points = points.into_iter().map(|point| Waypoint {
        point,
        tool: Some(tool),
    });
    let mut vertices = [Vertex::default(); 32];
    let curves = Smoothed::new(points, tolerance, &mut vertices).unwrap();
    curves.map(Result::unwrap).collect()
}

/// Largest speed and largest mean acceleration of the tool along its path.
fn most(rows: &[Row<[f64; 2]>]) -> ToolLimits {
    let speed = |row: &Row<[f64; 2]>| norm(row.velocity);
    let rises = rows.windows(2).filter(|pair| pair[1].duration_s > 1e-6);
    let rises = rises.map(|pair| (speed(&pair[1]) - speed(&pair[0])).abs() / pair[1].duration_s);
    ToolLimits {
        feed: rows.iter().map(speed).fold(0.0, f64::max),
        acceleration: Some(rises.fold(0.0, f64::max)),
    }
}

const JERKY: AxisLimits = AxisLimits {
    jerk: Some(2e5),
    ..AXIS
};

/// Rows of a table, of one with jerk, and of a stream.
fn plans(curves: &[Curve<2>]) -> [Vec<Row<[f64; 2]>>; 3] {
    let mut knots = vec![Knot::default(); 20_000];
    let accuracy = Accuracy {
        min_segments: 16,
        max_departure: 0.01,
        max_time_ratio: f64::INFINITY,
    };
    let [free, limited] = [AXIS, JERKY].map(|axis| {
        let bound = Curve::departure;
        let table = Table::plan_within(
            curves,
            [axis; 2],
            accuracy,
            |curve, span| bound(curve, span),
            &mut knots,
        );
        table.unwrap().rows().collect()
    });
    let mut window = [Knot::default(); 256];
    let stream = LookAhead::new(curves, [AXIS; 2], |_| Ok(12), &mut window).unwrap();
    [free, limited, stream.map(Result::unwrap).collect()]
}

/// Rows of tables and of streams, without jerk and with it, whose feed is changed at some of them:
/// up to 2 where the first says so. Where the machine is held it goes on.
fn at_feeds(curves: &[Curve<2>], feeds: &[(usize, f64)]) -> [(f64, Vec<Row<[f64; 2]>>); 4] {
    let table = |axis: AxisLimits| {
        let mut knots = vec![Knot::default(); 2000];
        let table = Table::plan(curves, [axis; 2], |_| 40, &mut knots).unwrap();
        let mut ceilings = vec![FeedCeiling::default(); table.len()];
        let mut motion = table.playback(1.0, &mut ceilings).unwrap();
        let set_feed = |motion: &mut Playback<'_, _>, feed: f64| motion.set_feed(feed.min(1.0));
        (
            1.0,
            changed(feeds, &mut motion, set_feed, Playback::next_row),
        )
    };
    let stream = |axis: AxisLimits, most: f64| {
        let mut window = [Knot::default(); 96];
        let motion = LookAhead::new(curves, [axis; 2], |_| Ok(20), &mut window).unwrap();
        let mut motion = motion.with_max_feed(most).unwrap();
        let set_feed =
            |motion: &mut LookAhead<'_, _, _, _>, feed: f64| motion.set_feed(feed.min(most));
        let next = |motion: &mut LookAhead<'_, _, _, _>| motion.next().map(Result::unwrap);
        (most, changed(feeds, &mut motion, set_feed, next))
    };
    [
        table(AXIS),
        table(JERKY),
        stream(AXIS, 2.0),
        stream(JERKY, 1.0),
    ]
}

fn changed<M>(
    feeds: &[(usize, f64)],
    motion: &mut M,
    set_feed: impl Fn(&mut M, f64) -> Result<(), FeedError>,
    next: impl Fn(&mut M) -> Option<Row<[f64; 2]>>,
) -> Vec<Row<[f64; 2]>> {
    let mut rows = Vec::new();
    for (count, feed) in feeds {
        let more = core::iter::from_fn(|| next(motion));
        rows.extend(more.take(*count));
        set_feed(motion, *feed).unwrap();
    }
    set_feed(motion, 1.0).unwrap();
    rows.extend(core::iter::from_fn(|| next(motion)));
    rows
}

/// What the verifier says of rows along curves whose tool has these limits.
fn verify(
    curves: &[Curve<2>],
    tool: ToolLimits,
    tool_feed: f64,
    rows: &[Row<[f64; 2]>],
) -> Result<(), Violation<Infallible>> {
    let mut verifier = Verifier::new(Promise {
        limits: [AXIS; 2],
        start_stop: [0.0; 2],
        max_departure: f64::INFINITY,
        max_slowness: f64::INFINITY,
        tool_feed: Some(tool_feed),
    });
    let path = |leg: usize| curves.get(leg).map(|curve| curve.with_tool(tool));
    rows.iter()
        .try_for_each(|row| verifier.add(row, path, Curve::departure))
}

#[test]
fn the_verifier_finds_limits_that_are_lower_by_a_hundredth() {
    let tool = ToolLimits {
        feed: 200.0,
        acceleration: Some(1000.0),
    };
    let curves = curves(&[0.75 * PI, 0.4, 0.0], 40.0, tool, 0.1);
    for rows in plans(&curves) {
        verify(&curves, tool, 1.0, &rows).unwrap();
        let lower = ToolLimits {
            acceleration: Some(990.0),
            ..tool
        };
        let error = verify(&curves, lower, 1.0, &rows).unwrap_err();
        assert!(
            matches!(
                error,
                Violation::Tool {
                    name: "acceleration",
                    ..
                }
            ),
            "{error}"
        );
        let lower = ToolLimits {
            feed: 0.99 * most(&rows).feed,
            ..tool
        };
        let error = verify(&curves, lower, 1.0, &rows).unwrap_err();
        assert!(
            matches!(error, Violation::Tool { name: "feed", .. }),
            "{error}"
        );
    }
}

#[test]
fn a_sharp_corner_is_no_way_around_the_acceleration() {
    let tool = ToolLimits {
        feed: 200.0,
        acceleration: Some(1000.0),
    };
    let curves = curves(&[0.75 * PI, 0.0], 40.0, tool, 0.1);
    for rows in plans(&curves) {
        let most = most(&rows);
        let acceleration = most.acceleration.unwrap();
        assert!(acceleration <= 1000.0 * ROUNDING, "{acceleration} mm/s²");
        // Two lines with a stop between them take 0.4 s each.
        let time_s = rows.last().unwrap().time_s;
        assert!(time_s < 0.8, "{time_s} s");
    }
}

#[test]
fn a_hold_and_a_higher_feed_keep_the_acceleration() {
    let tool = ToolLimits {
        feed: 200.0,
        acceleration: Some(1000.0),
    };
    let curves = curves(&[0.5, -0.4, 0.0], 40.0, tool, 0.1);
    for (most_feed, rows) in at_feeds(&curves, &[(30, 0.0), (20, 2.0), (40, 0.3), (10, 1.0)]) {
        verify(&curves, tool, most_feed, &rows).unwrap();
        let end = rows.last().unwrap();
        assert!(end.leg + 1 == curves.len() && norm(end.velocity) <= 0.0);
        let most = most(&rows);
        let acceleration = most.acceleration.unwrap();
        assert!(acceleration <= 1000.0 * ROUNDING, "{acceleration} mm/s²");
        assert!(most.feed > 120.0, "{} mm/s", most.feed);
    }
}

/// However dense the knots, speeds that rounding moves do not keep the tool from its acceleration:
/// `√(L / A)` up and the same down, in a table and in a stream.
#[test]
fn the_tool_keeps_its_acceleration_on_any_number_of_segments() {
    const LENGTH: f64 = 6.0;
    const SEGMENTS: [u32; 5] = [50, 200, 800, 3200, 12_800];
    for acceleration in [3.0, 290.0_f64] {
        let tool = ToolLimits {
            feed: 84.0,
            acceleration: Some(acceleration),
        };
        let line = Curve::line([0.0, 0.0], [LENGTH, 0.0]).unwrap();
        let line = line.with_tool(tool);
        let shortest_s = 2.0 * (LENGTH / acceleration).sqrt();
        for segments in SEGMENTS {
            let mut knots = vec![Knot::default(); 13_000];
            let table = Table::plan([line], [AXIS; 2], |_| segments, &mut knots).unwrap();
            let ratio = table.duration_s() / shortest_s;
            assert!(
                ratio < 1.001,
                "{acceleration} mm/s², {segments}: {ratio} times"
            );
            let motion = LookAhead::new([line], [AXIS; 2], |_| Ok(segments), &mut knots).unwrap();
            let end = motion.last().unwrap().unwrap();
            let ratio = end.time_s / shortest_s;
            assert!(
                ratio < 1.001,
                "stream, {acceleration} mm/s², {segments}: {ratio} times"
            );
        }
    }
}

/// Along short lines that turn by any angle, held at each row in turn: nothing is passed on the way
/// to rest. `LINES` of them, from `SEED` on.
#[test]
fn holds_at_any_row_of_short_lines_are_proven() {
    let mut random = Random::new(setting("SEED", 1));
    for line in 0..setting("LINES", 40) {
        let turns: Vec<f64> = (0..20)
            .map(|turn: usize| [0.0, 0.3, 1.6, 3.1][turn % 4] * random.within(-1.0, 1.0))
            .collect();
        let tool = ToolLimits {
            feed: random.size(0.3, 2.8),
            acceleration: (line % 2 == 0).then(|| random.size(1.3, 4.0)),
        };
        let tolerance = random.size(-3.0, -1.0);
        let curves = curves(&turns, random.size(-1.0, 1.0), tool, tolerance);
        for moving in 0..60 {
            let mut window = [Knot::default(); 24];
            let mut motion = LookAhead::new(&curves, [AXIS; 2], |_| Ok(2), &mut window).unwrap();
            let mut rows: Vec<_> = motion.by_ref().take(moving).map(Result::unwrap).collect();
            motion.stop();
            rows.extend(motion.by_ref().map(Result::unwrap));
            motion.set_feed(1.0).unwrap();
            rows.extend(motion.map(Result::unwrap));
            let proven = verify(&curves, tool, 1.0, &rows);
            assert!(proven.is_ok(), "line {line}, row {moving}: {proven:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_tool_keeps_its_limits_along_bezier_curves(
        points in prop::array::uniform4(prop::array::uniform2(-50.0..50.0_f64)),
        feed in 20.0..400.0_f64, acceleration in 200.0..9000.0_f64,
    ) {
        let curve = Curve::bezier(points);
        prop_assume!(curve.is_ok());
        let tool = ToolLimits { feed, acceleration: Some(acceleration) };
        for rows in plans(&[curve.unwrap().with_tool(tool)]) {
            let most = most(&rows);
            prop_assert!(most.feed <= feed * ROUNDING, "{} of {}", most.feed, feed);
            let reached = most.acceleration.unwrap();
            prop_assert!(reached <= acceleration * ROUNDING, "{} of {}", reached, acceleration);
        }
    }

    #[test]
    fn the_tool_keeps_its_limits_in_corners(
        turns in prop::collection::vec(-2.9..2.9_f64, 1..6), length in 1.0..40.0_f64,
        feed in 20.0..400.0_f64, acceleration in 200.0..9000.0_f64, tolerance in 0.005..1.0_f64,
    ) {
        let tool = ToolLimits { feed, acceleration: Some(acceleration) };
        for rows in plans(&curves(&turns, length, tool, tolerance)) {
            let most = most(&rows);
            prop_assert!(most.feed <= feed * ROUNDING, "{} of {}", most.feed, feed);
            let reached = most.acceleration.unwrap();
            prop_assert!(reached <= acceleration * ROUNDING, "{} of {}", reached, acceleration);
        }
    }

    #[test]
    fn the_tool_keeps_its_acceleration_at_feeds_that_change(
        turns in prop::collection::vec(-2.0..2.0_f64, 1..6), length in 5.0..40.0_f64,
        feed in 20.0..400.0_f64, acceleration in 200.0..9000.0_f64, tolerance in 0.01..1.0_f64,
        feeds in prop::collection::vec((0..40_usize, prop_oneof![Just(0.0), 0.05..2.0_f64]), 1..8),
    ) {
        let tool = ToolLimits { feed, acceleration: Some(acceleration) };
        let curves = curves(&turns, length, tool, tolerance);
        for (most_feed, rows) in at_feeds(&curves, &feeds) {
            let verified = verify(&curves, tool, most_feed, &rows);
            prop_assert!(verified.is_ok(), "{}", verified.unwrap_err());
            let reached = most(&rows).acceleration.unwrap();
            prop_assert!(reached <= acceleration * ROUNDING, "{} of {}", reached, acceleration);
        }
    }
}
