//! What rows ask of axes with a limit of jerk, and rows under feeds.

use path_timing::{AxisLimits, Cubic, FeedCeiling, Row, Table};
use proptest::prelude::*;

use crate::support::limits::{ROUNDING, check_limits};

/// The jerk inside of each cubic, and over the time between the middles of two the steps of the
/// acceleration at rows, and what it changes by from middle to middle; at rest, and where
/// velocities jump, the acceleration is zero.
pub(crate) fn check_jerk<const N: usize>(
    limits: &[AxisLimits; N],
    start_stop: Option<&[f64; N]>,
    rows: &[Row<[f64; N]>],
) {
    check_limits(limits, start_stop, rows);
    for (axis, limits) in limits.iter().enumerate() {
        let jerk = limits.jerk.unwrap() * ROUNDING;
        // At the end of a cubic, and in its middle.
        let (mut before, mut before_s) = ([0.0_f64; 2], 0.0);
        let eased = |before: [f64; 2], before_s: f64| {
            let most = before[0].abs().max(before[1].abs());
            assert!(most <= jerk * before_s * 0.5, "to zero: {before:?}");
        };
        for pair in rows.windows(2) {
            if pair[0].is_at_rest() || pair[1].duration_s == 0.0 {
                eased(before, before_s);
                (before, before_s) = ([0.0; 2], 0.0);
            }
            if pair[1].duration_s == 0.0 {
                continue;
            }
            let cubic = Cubic::between(&pair[0], &pair[1]).nth(axis).unwrap();
            let [a0, a1] = cubic.accelerations();
            let time_s = cubic.duration_s;
            assert!((a1 - a0).abs() <= jerk * time_s, "{cubic:?}");
            let middle = (a0 + a1) * 0.5;
            for change in [a0 - before[0], middle - before[1]] {
                let change = change.abs() / ((time_s + before_s) * 0.5);
                assert!(change <= jerk, "{} at {}", change / jerk, pair[0].time_s);
            }
            (before, before_s) = ([a1, middle], time_s);
        }
        eased(before, before_s);
    }
}

/// All digits of a position.
pub(crate) fn bits(row: &Row<[f64; 2]>) -> [u64; 2] {
    row.position.map(f64::to_bits)
}

/// The table run to each row from `first` on, held there, and run on: all rows, and how long each
/// hold takes. The end is that of the table, to the last bit.
pub(crate) fn held_at_each<'a>(
    table: &'a Table<'_, [f64; 2]>,
    first: usize,
) -> impl Iterator<Item = (Vec<Row<[f64; 2]>>, f64)> + use<'a> {
    (first..table.len()).map(|moving| {
        let mut ahead = vec![FeedCeiling::default(); table.len()];
        let mut run = table.playback(1.0, &mut ahead).unwrap();
        let mut rows: Vec<_> = run.by_ref().take(moving).collect();
        run.stop();
        rows.extend(run.by_ref());
        let rest = rows.last().unwrap();
        assert!(rest.velocity.iter().all(|v| *v == 0.0));
        let hold_s = rest.time_s - rows[moving - 1].time_s;
        run.set_feed(1.0).unwrap();
        rows.extend(run);
        assert_planned(&rows, table);
        (rows, hold_s)
    })
}

/// As many rows as planned, at the planned places.
pub(crate) fn assert_planned(rows: &[Row<[f64; 2]>], table: &Table<'_, [f64; 2]>) {
    assert_eq!(rows.len(), table.len());
    for (row, planned) in rows.iter().zip(table.rows()) {
        assert_eq!(bits(row), bits(&planned));
    }
}

/// Feeds, and for how many rows each is wanted.
pub(crate) fn feeds() -> impl Strategy<Value = Vec<(f64, usize)>> {
    prop::collection::vec((0.0..1.5_f64, 1..30_usize), 1..12)
}

/// The rows of a table under feeds, of which those below `slowest` are holds, and at a feed of 1
/// from there to its end.
pub(crate) fn run_under(
    feeds: Vec<(f64, usize)>,
    slowest: f64,
    table: &Table<'_, [f64; 2]>,
) -> Vec<Row<[f64; 2]>> {
    let mut ahead = vec![FeedCeiling::default(); table.len()];
    let mut run = table.playback(1.5, &mut ahead).unwrap();
    let mut rows = Vec::new();
    for (feed, count) in feeds {
        run.set_feed(if feed < slowest { 0.0 } else { feed })
            .unwrap();
        rows.extend(run.by_ref().take(count));
    }
    run.set_feed(1.0).unwrap();
    rows.extend(run.by_ref());
    assert!(run.is_finished());
    assert_eq!(rows.len(), table.len());
    rows
}
