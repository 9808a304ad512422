//! Tables: closed forms, limits, legs, errors.

use core::convert::Infallible;

use path_timing::{
    FeedCeiling, Knot, Path, PathFn, PathPoint, PlanError, Row, Span, Table, ToolLimits,
};
use proptest::prelude::*;

use crate::support::limits::check_limits;
use crate::support::machine::{self, Line, limits};
use crate::support::polyline::within;

/// Of sums of some hundred times and positions.
const ROUNDING: f64 = 1e-9;

/// At which the search for speeds under a limit of jerk ends.
const SEARCH: f64 = 2e-3;

fn straight(s: f64) -> Result<PathPoint<[f64; 1]>, Infallible> {
    Ok(PathPoint {
        position: [3.0 + s],
        slope: [1.0],
    })
}

fn rows<const N: usize>(rows: impl Iterator<Item = Row<[f64; N]>>) -> Vec<Row<[f64; N]>> {
    rows.collect()
}

/// A straight way is run as a trapezoid: d/v + v/a.
#[test]
fn a_straight_way_takes_the_closed_form() {
    let path = PathFn::new(100.0, straight);
    let mut knots = [Knot::default(); 257];
    for (speed, acceleration) in [(10.0, 25.0), (50.0, 40.0), (1e3, 1.0)] {
        let limits = [limits(speed, acceleration, None)];
        let table = Table::plan([path], limits, |_| 256, &mut knots).unwrap();
        let peak = speed.min((100.0_f64 * acceleration).sqrt());
        let shortest = 100.0 / peak + peak / acceleration;
        let share = table.duration_s() / shortest;
        assert!((1.0 - ROUNDING..1.002).contains(&share), "{share}");
        check_limits(&limits, None, &rows(table.rows()));
    }
}

/// An S-curve from rest to rest without the speed: 4 ∛(d / 2j).
#[test]
fn a_straight_way_with_jerk_takes_the_closed_form() {
    let path = PathFn::new(100.0, straight);
    let mut knots = [Knot::default(); 65];
    let limits = [limits(1e9, 1e9, Some(200.0))];
    let table = Table::plan([path], limits, |_| 64, &mut knots).unwrap();
    let shortest = 4.0 * (100.0_f64 / 400.0).cbrt();
    let share = table.duration_s() / shortest;
    assert!((share - 1.0).abs() < SEARCH, "{share}");
}

#[test]
fn legs_join_at_rest() {
    let corners = [[-100.0, 80.0], [20.0, 150.0], [90.0, 60.0], [150.0, 60.0]];
    let legs: Vec<_> = corners
        .windows(2)
        .map(|ends| Line {
            from: ends[0],
            to: ends[1],
        })
        .collect();
    let limits = [limits(2.0, 20.0, None), limits(300.0, 2000.0, None)];
    let mut knots = [Knot::default(); 93];
    // As many as it is long, in each leg.
    let segments = |line: &&Line| if line.to[0] > 100.0 { 10 } else { 40 };
    let table = Table::plan(&legs, limits, segments, &mut knots).unwrap();
    let all = rows(table.rows());
    assert_eq!((table.len(), all.len()), (91, 91));
    check_limits(&limits, None, &all);
    for row in [0, 40, 80, 90] {
        assert!(all[row].velocity.iter().all(|v| *v == 0.0), "{row}");
    }
    let numbers: Vec<_> = all.iter().map(|row| row.leg).collect();
    assert_eq!((numbers[40], numbers[41], numbers[90]), (0, 1, 2));
    assert!((all[90].time_s - table.duration_s()).abs() < ROUNDING);
    let slower = table.at_speed(0.25).unwrap();
    assert!((slower.duration_s() / table.duration_s() - 4.0).abs() < ROUNDING);
}

/// The fewest segments by any bound: here the longest duration.
#[test]
fn the_fewest_segments_within_a_departure() {
    let line = Line {
        from: [-100.0, 80.0],
        to: [100.0, 80.0],
    };
    let limits = [limits(2.0, 20.0, None), limits(300.0, 2000.0, None)];
    let mut knots = [Knot::default(); 500];
    let longest = |_: &Line, span: &Span<_>| span.rows[1].duration_s;
    let table = Table::plan_within([line], limits, within(2, 0.02), longest, &mut knots).unwrap();
    let segments = u32::try_from(table.len() - 1).unwrap();
    let worst = |rows: Vec<Row<[f64; 2]>>| rows.iter().fold(0.0_f64, |w, r| w.max(r.duration_s));
    assert!(worst(rows(table.rows())) <= 0.02);
    let fewer = (segments * 15 / 16) as usize;
    let error = Table::plan_within(
        [line],
        limits,
        within(2, 0.02),
        longest,
        &mut knots[..fewer],
    );
    assert!(matches!(error.unwrap_err(), PlanError::Memory { .. }));
    for allowed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Table::plan_within([line], limits, within(2, allowed), longest, &mut knots);
        assert!(matches!(error.unwrap_err(), PlanError::Allowed { .. }));
    }
    let error = Table::plan_within([line], limits, within(2, 1e-3), longest, &mut knots[..50]);
    let PlanError::Memory { needed, available } = error.unwrap_err() else {
        panic!()
    };
    assert!(needed > available && available == 50);
}

#[test]
fn what_cannot_be_planned_is_named() {
    let good = [limits(10.0, 25.0, Some(100.0))];
    let mut knots = [Knot::default(); 11];
    let mut plan = |length: f64, limits| {
        let path = PathFn::new(length, straight);
        let table = Table::plan([path], limits, |_| 10, &mut knots);
        table.map(|table| table.duration_s())
    };
    assert!(plan(100.0, good).unwrap() > 10.0);
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e-310, 1e300] {
        assert!(
            matches!(plan(bad, good), Err(PlanError::Length { .. })),
            "{bad}"
        );
        for changed in [
            limits(bad, 25.0, Some(100.0)),
            limits(10.0, bad, Some(100.0)),
            limits(10.0, 25.0, Some(bad)),
        ] {
            assert!(matches!(
                plan(100.0, [changed]),
                Err(PlanError::Limit { axis: 0, .. })
            ));
        }
    }
    let error = plan(100.0, [limits(1e300, 25.0, None)]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "axis 0: speed is 1e300, not within 1e-50..=1e50"
    );

    // The path ends at 60, or has no number there.
    let ends = |s: f64| {
        if s < 60.0 {
            straight(s).map_err(|_| "")
        } else {
            Err("out of reach")
        }
    };
    let error = Table::plan([PathFn::new(100.0, ends)], good, |_| 10, &mut knots).unwrap_err();
    assert_eq!(error.to_string(), "leg 0, at 64.8: out of reach");
    for bad in [f64::NAN, f64::INFINITY] {
        let hole = move |s: f64| {
            let mut point = straight(s)?;
            point.slope = [if (40.0..60.0).contains(&s) { bad } else { 1.0 }];
            Ok::<_, Infallible>(point)
        };
        let error = Table::plan([PathFn::new(100.0, hole)], good, |_| 10, &mut knots);
        assert!(matches!(error, Err(PlanError::NotFinite { leg: 0, .. })));
    }
    let path = PathFn::new(100.0, straight);
    let error = Table::plan([path, path], good, |_| 4, &mut knots).unwrap_err();
    assert_eq!(
        error,
        PlanError::Gap {
            leg: 1,
            axis: 0,
            by: -100.0
        }
    );
    let error = Table::plan([path], good, |_| 11, &mut knots).unwrap_err();
    assert_eq!(
        error,
        PlanError::Memory {
            needed: 12,
            available: 11
        }
    );
    let error = Table::plan([path], good, |_| u32::MAX, &mut knots).unwrap_err();
    assert_eq!(
        error,
        PlanError::TooFine {
            leg: 0,
            max: 1 << 24
        }
    );
    let table = Table::plan([path], good, |_| 10, &mut knots).unwrap();
    for scale in [0.0, -1.0, 1.1, f64::NAN, 1e-60] {
        assert!(matches!(
            table.at_speed(scale),
            Err(PlanError::SpeedScale { .. })
        ));
    }
}

#[test]
fn no_leg_is_no_row() {
    let none: [Line; 0] = [];
    let limits = [limits(1.0, 1.0, None); 2];
    let table = Table::plan(none, limits, |_| 10, &mut []).unwrap();
    assert!(table.is_empty() && table.rows().next().is_none());
    let mut run = table.playback(1.0, &mut []).unwrap();
    assert!(run.is_finished() && run.next_row().is_none());
}

/// Axes that limit nothing: a trapezoid of the tool, as fast as a feed override makes it.
#[test]
fn the_tool_keeps_its_feed_and_acceleration() {
    let tool = ToolLimits {
        feed: 10.0,
        acceleration: Some(25.0),
    };
    let path = PathFn::new(100.0, straight).with_tool(tool);
    let mut knots = [Knot::default(); 257];
    for jerk in [None, Some(1e9)] {
        let limits = [limits(1e9, 1e9, jerk)];
        let table = Table::plan([path], limits, |_| 256, &mut knots).unwrap();
        let share = table.duration_s() / (100.0 / 10.0 + 10.0 / 25.0);
        assert!((1.0 - ROUNDING..1.002).contains(&share), "{share}");
        let as_axis = [machine::limits(10.0, 25.0, None)];
        check_limits(&as_axis, None, &rows(table.rows()));
        let mut ahead = [FeedCeiling::default(); 257];
        let mut run = table.playback(1.5, &mut ahead).unwrap();
        run.set_feed(1.5).unwrap();
        let time_s = run.last().unwrap().time_s;
        assert!((time_s * 1.5 / table.duration_s() - 1.0).abs() < ROUNDING);
    }
}

/// The tool on a line at a feed that the axes allow on the way, but not at its ends.
#[test]
fn the_tool_on_a_line_is_as_fast_as_its_feed() {
    let tool = ToolLimits {
        feed: 120.0,
        acceleration: None,
    };
    let line = Line {
        from: [-100.0, 80.0],
        to: [100.0, 80.0],
    };
    let path = PathFn::new(line.length(), |s| line.point(s)).with_tool(tool);
    let mut knots = [Knot::default(); 201];
    for jerk in [None, Some(400.0)] {
        let limits = [limits(2.0, 20.0, jerk), limits(300.0, 2000.0, None)];
        let table = Table::plan([&path], limits, |_| 200, &mut knots).unwrap();
        let all = rows(table.rows());
        check_limits(&limits, None, &all);
        let speeds = all.iter().map(|row| {
            let [angle, reach] = row.velocity;
            reach.hypot(angle * row.position[1])
        });
        let fastest = speeds.clone().fold(0.0, f64::max);
        assert!(
            fastest < 120.0 * (1.0 + ROUNDING) && fastest > 119.0,
            "{fastest}"
        );
        let at_feed = speeds.filter(|speed| *speed > 119.0).count();
        assert!(jerk.is_some() || at_feed > 80, "{at_feed}");
    }
    for bad in [f64::NAN, 0.0, -1.0, f64::INFINITY, 1e300] {
        let feed = ToolLimits { feed: bad, ..tool };
        let acceleration = Some(bad);
        for wrong in [
            feed,
            ToolLimits {
                acceleration,
                ..tool
            },
        ] {
            let limits = [limits(2.0, 20.0, None); 2];
            let error = Table::plan([path.with_tool(wrong)], limits, |_| 200, &mut knots);
            assert!(
                matches!(error.unwrap_err(), PlanError::Tool { leg: 0, .. }),
                "{bad}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn limits_hold_on_any_line(
        from in prop::array::uniform2(-200.0..200.0), to in prop::array::uniform2(-200.0..200.0),
        speed in 0.1..10.0, acceleration in 0.5..100.0, slide in 10.0..1e3,
        jerk in prop::option::of(10.0..1e4), segments in 2..200_u32,
    ) {
        let line = Line { from, to };
        let limits = [limits(speed, acceleration, jerk), limits(slide, 10.0 * slide, None)];
        let mut knots = [Knot::default(); 201];
        let table = Table::plan([line], limits, |_| segments, &mut knots);
        prop_assume!(!matches!(table, Err(PlanError::TooCoarse { .. })));
        let table = table.unwrap();
        let all = rows(table.rows());
        check_limits(&limits, None, &all);
        prop_assert!(all.windows(2).all(|pair| pair[1].time_s > pair[0].time_s));
        let last = all.last().unwrap();
        prop_assert!(last.velocity.iter().all(|v| *v == 0.0));
        prop_assert!((last.position[1] - to[0].hypot(to[1])).abs() < ROUNDING);
    }
}
