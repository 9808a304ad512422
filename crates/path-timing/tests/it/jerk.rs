//! Limits of jerk under feed changes, holds and resumes.

use path_timing::{AxisLimits, Corner, Knot, Table};
use proptest::prelude::*;

use crate::support::jerk::{bits, check_jerk, feeds, held_at_each, run_under};
use crate::support::machine::limits;
use crate::support::polyline::lines;

const LIMITS: [AxisLimits; 2] = [
    limits(2.0, 20.0, Some(400.0)),
    limits(300.0, 2000.0, Some(40_000.0)),
];
const POINTS: [[f64; 2]; 3] = [[-100.0, 80.0], [0.0, 150.0], [90.0, 60.0]];

/// A speed that leaves a sixteenth of the jerk: ∛(15/16).
const WITH_ROOM: f64 = 0.978;

/// How long a hold takes from each row on, and that the run goes on to its exact end.
#[test]
fn a_hold_keeps_the_jerk_and_goes_on() {
    let mut knots = [Knot::default(); 183];
    let paths = lines(&POINTS, Corner::Stop, None);
    let table = Table::plan(&paths, LIMITS, |_| 60, &mut knots).unwrap();
    let table = table.at_speed(WITH_ROOM).unwrap();
    let mut holds_s = Vec::new();
    for (rows, hold_s) in held_at_each(&table, 2) {
        check_jerk(&LIMITS, None, &rows);
        holds_s.push(hold_s);
    }
    let count = u32::try_from(holds_s.len()).unwrap();
    let mean_s = holds_s.iter().sum::<f64>() / f64::from(count);
    let slowest_s = holds_s.iter().copied().fold(0.0, f64::max);
    println!("a hold takes {mean_s:.3} s, at most {slowest_s:.3} s");
    // From rest to full speed a line takes 0.3 s, from end to end 0.67 s.
    assert!(mean_s < 0.25 && slowest_s < 0.67, "{mean_s}, {slowest_s}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn jerk_is_kept_under_any_feeds(
        points in prop::collection::vec((-200.0..200.0_f64, 20.0..200.0_f64), 2..5),
        feeds in feeds(), segments in 7..60_u32, scale in 0.5..1.0_f64,
    ) {
        prop_assume!(points.windows(2).all(|pair| pair[0] != pair[1]));
        let points: Vec<_> = points.into_iter().map(|(x, y)| [x, y]).collect();
        let paths = lines(&points, Corner::Stop, None);
        let mut knots = [Knot::default(); 250];
        let table = Table::plan(&paths, LIMITS, |_| segments, &mut knots).unwrap();
        let table = table.at_speed(scale).unwrap();
        let rows = run_under(feeds, 0.3, &table);
        check_jerk(&LIMITS, None, &rows);
        let end = table.rows().last().unwrap();
        prop_assert_eq!(bits(rows.last().unwrap()), bits(&end));
    }
}
