//! Feed override and stops on the path.

use path_timing::{AxisLimits, FeedCeiling, Knot, PlanError, Table};
use proptest::prelude::*;

use crate::support::jerk::{assert_planned, feeds, held_at_each, run_under};
use crate::support::limits::check_limits;
use crate::support::machine::{Line, limits};

const LIMITS: [AxisLimits; 2] = [limits(2.0, 20.0, None), limits(300.0, 2000.0, None)];

/// Three lines with two corners.
fn legs() -> [Line; 3] {
    let corners = [[-100.0, 80.0], [20.0, 150.0], [90.0, 60.0], [150.0, 60.0]];
    [0, 1, 2].map(|i| Line {
        from: corners[i],
        to: corners[i + 1],
    })
}

#[test]
fn wrong_feeds_and_memory_are_named() {
    let mut knots = [Knot::default(); 33];
    let table = Table::plan(legs(), LIMITS, |_| 10, &mut knots).unwrap();
    let mut ahead = [FeedCeiling::default(); 31];
    for max in [f64::NAN, 0.0, -1.0, f64::INFINITY, 1e-310] {
        let error = table.playback(max, &mut ahead).unwrap_err();
        assert!(matches!(error, PlanError::Feed { .. }), "{max}");
    }
    let error = table.playback(1.0, &mut ahead[..30]).unwrap_err();
    let (needed, available) = (31, 30);
    assert_eq!(error, PlanError::Memory { needed, available });
    let mut run = table.playback(1.5, &mut ahead).unwrap();
    for feed in [1.6, -0.1, f64::NAN, 1e-310] {
        let error = run.set_feed(feed).unwrap_err();
        assert!(error.max > 1.4 && error.min < 1e-49);
    }
}

#[test]
fn a_stop_rests_on_the_path_and_goes_on() {
    let mut knots = [Knot::default(); 183];
    let table = Table::plan(legs(), LIMITS, |_| 60, &mut knots).unwrap();
    for (rows, hold_s) in held_at_each(&table, 1) {
        // Three lines take 0.6 s and more each; a stop takes 0.2 s.
        assert!(hold_s < 0.3, "{hold_s}");
        check_limits(&LIMITS, None, &rows);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn limits_hold_under_any_feed(
        feeds in feeds(), segments in 3..60_u32, scale in 0.3..1.0,
    ) {
        let mut knots = [Knot::default(); 183];
        let table = Table::plan(legs(), LIMITS, |_| segments, &mut knots).unwrap();
        let table = table.at_speed(scale).unwrap();
        let rows = run_under(feeds, 0.2, &table);
        check_limits(&LIMITS, None, &rows);
        assert_planned(&rows, &table);
    }
}
