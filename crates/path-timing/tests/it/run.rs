//! Feed override and stops on the path.

use path_timing::{AxisLimits, FeedCeiling, Knot, PlanError, Row, Table};
use proptest::prelude::*;

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

/// All digits of a position.
fn bits(row: &Row<[f64; 2]>) -> [u64; 2] {
    row.position.map(f64::to_bits)
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
    for moving in 1..table.len() {
        let mut ahead = [FeedCeiling::default(); 181];
        let mut run = table.playback(1.0, &mut ahead).unwrap();
        let mut rows: Vec<_> = run.by_ref().take(moving).collect();
        run.stop();
        rows.extend(run.by_ref());
        let rest = rows.last().unwrap();
        assert!(rest.velocity.iter().all(|v| *v == 0.0));
        // Three lines take 0.6 s and more each; a stop takes 0.2 s.
        let stop_s = rest.time_s - rows[moving - 1].time_s;
        assert!(stop_s < 0.3, "{moving}: {stop_s}");
        run.set_feed(1.0).unwrap();
        rows.extend(run);
        check_limits(&LIMITS, None, &rows);
        assert_eq!(rows.len(), table.len());
        for (row, planned) in rows.iter().zip(table.rows()) {
            assert_eq!(bits(row), bits(&planned));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn limits_hold_under_any_feed(
        feeds in prop::collection::vec((0.0..1.5_f64, 1..30_usize), 1..12),
        segments in 3..60_u32, scale in 0.3..1.0,
    ) {
        let mut knots = [Knot::default(); 183];
        let table = Table::plan(legs(), LIMITS, |_| segments, &mut knots).unwrap();
        let table = table.at_speed(scale).unwrap();
        let mut ahead = [FeedCeiling::default(); 181];
        let mut run = table.playback(1.5, &mut ahead).unwrap();
        let mut rows = Vec::new();
        for (feed, count) in feeds {
            run.set_feed(if feed < 0.2 { 0.0 } else { feed }).unwrap();
            rows.extend(run.by_ref().take(count));
        }
        run.set_feed(1.0).unwrap();
        rows.extend(run.by_ref());
        prop_assert!(run.is_finished());
        prop_assert_eq!(rows.len(), table.len());
        check_limits(&LIMITS, None, &rows);
        for (row, planned) in rows.iter().zip(table.rows()) {
            prop_assert_eq!(bits(row), bits(&planned));
        }
    }
}
