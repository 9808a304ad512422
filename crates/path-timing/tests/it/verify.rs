//! The verifier: it finds nothing in what the crate hands out, and each fault that is put there.

use core::convert::Infallible;

use path_timing::{
    AxisLimits, Corner, Curve, FeedCeiling, Knot, Promise, Row, Table, Verifier, Violation,
};
use proptest::prelude::*;

use crate::support::machine::limits;
use crate::support::polyline::{lines, within};

const TOLERANCE: f64 = 0.01;

type Rows = Vec<Row<[f64; 2]>>;

fn promise(limits: [AxisLimits; 2]) -> Promise<[f64; 2]> {
    Promise {
        limits,
        start_stop: [0.0; 2],
        max_departure: TOLERANCE,
        max_slowness: f64::INFINITY,
        tool_feed: None,
    }
}

fn three_quarters() -> Curve<2> {
    Curve::arc([50.0, 0.0], [0.0, 0.0], [0.0, 1.0], 4.5).unwrap()
}

fn verify(promise: Promise<[f64; 2]>, rows: &[Row<[f64; 2]>]) -> Result<(), Violation<Infallible>> {
    let mut verifier = Verifier::new(promise);
    rows.iter()
        .try_for_each(|row| verifier.add(row, |_| Some(three_quarters()), Curve::departure))
}

/// Rows along the arc at any feeds, and with no change of it.
fn rows(jerk: Option<f64>, feeds: &[(f64, usize)]) -> ([AxisLimits; 2], Rows) {
    let limits = [limits(200.0, 2000.0, jerk); 2];
    let mut knots = vec![Knot::default(); 4000];
    let table = Table::plan_within_at_any_feed(
        [three_quarters()],
        limits,
        within(7, TOLERANCE),
        Curve::departure,
        &mut knots,
    );
    let table = table.unwrap();
    let mut ceilings = vec![FeedCeiling::default(); table.len()];
    let mut playback = table.playback(1.5, &mut ceilings).unwrap();
    let mut rows = Vec::new();
    for (feed, count) in feeds {
        playback.set_feed(*feed).unwrap();
        rows.extend(playback.by_ref().take(*count));
    }
    playback.set_feed(1.0).unwrap();
    rows.extend(playback);
    (limits, rows)
}

#[test]
fn what_is_planned_is_proven() {
    for jerk in [None, Some(20_000.0)] {
        let (limits, rows) = rows(jerk, &[]);
        let promise = Promise {
            max_slowness: 1.02,
            ..promise(limits)
        };
        verify(promise, &rows).unwrap();
    }
}

/// Of jumps as of all else: also where the segments beside them are short, where the machine rests
/// at one, and with a limit of jerk that is lower by a twentieth.
#[test]
fn jumps_are_proven() {
    let points = [[-100.0, 80.0], [0.0, 80.0], [100.0, 110.0]];
    let start_stop = [0.05, 10.0];
    let paths = lines(&points, Corner::Jump(start_stop), None);
    let verify = |limits: [AxisLimits; 2], rows: &[Row<[f64; 2]>]| {
        let mut verifier = Verifier::new(Promise {
            start_stop,
            ..promise(limits)
        });
        rows.iter()
            .try_for_each(|row| verifier.add(row, |leg| paths.get(leg), |_, _| 0.0))
    };
    for (jerk, segments) in [(None, 100), (Some(400.0), 100), (Some(400.0), 400)] {
        let axes = |jerk: Option<f64>| {
            [
                limits(2.0, 20.0, jerk),
                limits(300.0, 2000.0, jerk.map(|j| j * 100.0)),
            ]
        };
        let mut knots = vec![Knot::default(); 1000];
        let table = Table::plan(&paths, axes(jerk), |_| segments, &mut knots).unwrap();
        let rows: Vec<_> = table.rows().collect();
        verify(axes(jerk), &rows).unwrap();
        if jerk.is_some() {
            let error = verify(axes(jerk.map(|jerk| 0.95 * jerk)), &rows).unwrap_err();
            assert!(matches!(error, Violation::Limit { name: "jerk", .. }));
        }
        let at = rows.iter().position(|row| row.leg == 1).unwrap();
        for moving in at - 60..at + 3 {
            let mut ceilings = vec![FeedCeiling::default(); table.len()];
            let mut playback = table.playback(1.0, &mut ceilings).unwrap();
            let mut held: Vec<_> = playback.by_ref().take(moving).collect();
            playback.stop();
            held.extend(playback.by_ref());
            assert!(playback.is_at_rest() && !playback.is_finished());
            playback.set_feed(1.0).unwrap();
            held.extend(playback);
            verify(axes(jerk), &held).unwrap();
        }
    }
}

/// One fault each, at every row.
#[test]
fn seeded_faults_are_found() {
    for jerk in [None, Some(20_000.0)] {
        let (limits, good) = rows(jerk, &[]);
        verify(promise(limits), &good).unwrap();
        let count = good.len();
        for index in 1..count - 1 {
            let seed = |fault: &dyn Fn(&mut Rows)| {
                let mut rows = good.clone();
                fault(&mut rows);
                assert!(verify(promise(limits), &rows).is_err(), "row {index}");
            };
            // A row moved, along the path and beside it.
            seed(&|rows| rows[index].position[0] += 1e-5);
            seed(&|rows| rows[index].position[1] += 1e-5);
            seed(&|rows| rows[index].s += 1e-5);
            // A velocity that is not along the path, and one that goes back.
            seed(&|rows| {
                let row = &mut rows[index];
                for (velocity, out) in row.velocity.iter_mut().zip(row.position) {
                    *velocity += 1e-3 * out;
                }
            });
            seed(&|rows| rows[index].velocity = rows[index].velocity.map(|v| -v));
            // A time stretched 100 times, with all after it.
            seed(&|rows| {
                let late_s = rows[index].duration_s * 99.0;
                rows[index].duration_s *= 100.0;
                for row in &mut rows[index..] {
                    row.time_s += late_s;
                }
            });
            // A time that does not rise, one that is not a number, rows exchanged.
            seed(&|rows| rows[index].time_s = rows[index - 1].time_s);
            seed(&|rows| rows[index].time_s = f64::NAN);
            seed(&|rows| rows.swap(index, index + 1));
        }
        // All of it faster by a hundredth, a limit lower by a hundredth, all slower 100 times.
        let faster = |by: f64| {
            let faster = good.iter().map(|row| Row {
                time_s: row.time_s / by,
                duration_s: row.duration_s / by,
                velocity: row.velocity.map(|v| v * by),
                ..*row
            });
            faster.collect::<Vec<_>>()
        };
        assert!(verify(promise(limits), &faster(1.01)).is_err());
        let slow = Promise {
            max_slowness: 3.0,
            ..promise(limits)
        };
        let error = verify(slow, &faster(0.01)).unwrap_err();
        assert!(matches!(error, Violation::Slow { .. }), "{error}");
        let lower = limits.map(|axis| AxisLimits {
            speed: axis.speed * 0.99,
            acceleration: axis.acceleration * 0.99,
            jerk: axis.jerk.map(|jerk| jerk * 0.99),
        });
        assert!(verify(promise(lower), &good).is_err());
        let near = Promise {
            max_departure: TOLERANCE * 1e-4,
            ..promise(limits)
        };
        let error = verify(near, &good).unwrap_err();
        assert!(matches!(error, Violation::Departure { .. }), "{error}");
    }
}

/// The jerk of a cubic and the step at a row are within the limit each, both together are not.
#[test]
fn jerks_and_steps_count_together() {
    // Accelerations at both ends of segments of a second each.
    let from_rest: &[[f64; 2]] = &[[0.5, 1.5]];
    let going: &[[f64; 2]] = &[[0.0, 1.0], [1.9, 2.9]];
    for (accelerations, most) in [(from_rest, 2.0), (going, 1.9)] {
        let mut verifier = Verifier::new(promise([limits(10.0, 10.0, Some(1.0)); 2]));
        let line = |_| Some(Curve::line([0.0; 2], [100.0, 0.0]).unwrap());
        let mut row = Row::<[f64; 2]>::default();
        let mut found = verifier.add(&row, line, Curve::departure);
        for [a0, a1] in accelerations {
            found.unwrap();
            let [[x, _], [v, _]] = [row.position, row.velocity];
            let x = x + v + a0 / 2.0 + (a1 - a0) / 6.0;
            row = Row {
                time_s: row.time_s + 1.0,
                duration_s: 1.0,
                position: [x, 0.0],
                velocity: [v + (a0 + a1) / 2.0, 0.0],
                s: x,
                ..row
            };
            found = verifier.add(&row, line, Curve::departure);
        }
        let error = found.unwrap_err();
        assert!(
            matches!(error, Violation::Limit { name: "jerk", value, .. } if (value - most).abs() < TOLERANCE),
            "{error}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn feeds_and_holds_are_proven(
        feeds in prop::collection::vec((0.0..1.5_f64, 1..30_usize), 1..12),
        jerk in prop::option::of(5e3..1e5_f64),
    ) {
        let feeds: Vec<_> = feeds.into_iter().map(|(feed, count)| (if feed < 0.3 { 0.0 } else { feed }, count)).collect();
        let (limits, rows) = rows(jerk, &feeds);
        let verified = verify(promise(limits), &rows);
        prop_assert!(verified.is_ok(), "{:?}", verified);
        prop_assert!(rows.last().unwrap().is_at_rest());
    }
}
