//! Long rows in parts: the same motion.

use path_timing::{AxisLimits, Corner, Cubic, Curve, Knot, LookAhead, Row, ShortRows, Table};
use proptest::prelude::*;

use crate::support::machine::limits;
use crate::support::vectors::bits;

/// Of positions of some hundred and their velocities.
const ROUNDING: f64 = 1e-10;

const LIMITS: [AxisLimits; 2] = [limits(200.0, 2000.0, None), limits(300.0, 5000.0, None)];

fn lines(points: &[[f64; 2]]) -> Vec<Curve<2>> {
    let line = |ends: &[[f64; 2]]| {
        let line = Curve::line(ends[0], ends[1]).unwrap();
        line.with_corner(Corner::Jump([15.0, 10.0]))
    };
    points.windows(2).map(line).collect()
}

/// Every part is on the cubic of its row, and the last one ends where the row does.
fn check(rows: &[Row<[f64; 2]>], parts: &[Row<[f64; 2]>], longest_s: f64) {
    let mut before = rows[0];
    let mut parts = parts.iter();
    assert_eq!(parts.next(), Some(&before));
    for row in &rows[1..] {
        let cubics = || Cubic::between(&before, row);
        let mut passed_s = 0.0;
        loop {
            let part = parts.next().unwrap();
            assert!(part.duration_s <= longest_s && part.leg == row.leg);
            passed_s += part.duration_s;
            if passed_s >= row.duration_s * (1.0 - 1e-9) {
                assert_eq!(bits(part.position), bits(row.position));
                assert_eq!(bits(part.velocity), bits(row.velocity));
                assert_eq!((part.time_s, part.s), (row.time_s, row.s));
                break;
            }
            assert!((part.time_s - before.time_s - passed_s).abs() <= ROUNDING);
            let fraction = passed_s / row.duration_s;
            for (axis, cubic) in cubics().enumerate() {
                let [position, velocity] = [cubic.position(fraction), cubic.velocity(fraction)];
                assert!((part.position[axis] - position).abs() <= ROUNDING);
                assert!((part.velocity[axis] - velocity).abs() <= ROUNDING);
            }
        }
        before = *row;
    }
    assert_eq!(parts.next(), None);
}

proptest! {
    #[test]
    fn parts_are_the_same_motion(
        points in prop::collection::vec(prop::array::uniform2(-100.0..100.0_f64), 2..5),
        segments in 2..12_u32, longest_s in 1e-3..1.0_f64,
    ) {
        let mut knots = vec![Knot::default(); 200];
        let table = Table::plan(lines(&points), LIMITS, |_| segments, &mut knots).unwrap();
        let rows: Vec<_> = table.rows().collect();
        let parts: Result<Vec<_>, _> = ShortRows::new(table.rows(), longest_s).collect();
        check(&rows, &parts.unwrap(), longest_s);
    }

    /// What the cubic's positions make of a short time.
    #[test]
    fn a_velocity_is_the_slope_of_the_position(
        ends in prop::array::uniform4(-100.0..100.0_f64), duration_s in 0.1..10.0_f64,
        fraction in 0.01..0.99_f64,
    ) {
        const STEP: f64 = 1e-4;
        const GAP: f64 = 1e-4;
        let [q0, q1, v0, v1] = ends;
        let cubic = Cubic { q0, q1, v0, v1, duration_s };
        let [before, after] = [fraction - STEP, fraction + STEP].map(|u| cubic.position(u));
        let slope = (after - before) / (2.0 * STEP * duration_s);
        prop_assert!((cubic.velocity(fraction) - slope).abs() <= GAP * cubic.peak_speed());
    }
}

/// What would have too many parts is one, and a time that is no number cuts nothing.
#[test]
fn what_cannot_be_cut_stays_whole() {
    let mut knots = [Knot::default(); 20];
    let lines = lines(&[[0.0, 0.0], [100.0, 0.0]]);
    let table = Table::plan(&lines, LIMITS, |_| 4, &mut knots).unwrap();
    for longest_s in [0.0, -1.0, f64::NAN, 1e-9, f64::INFINITY] {
        let parts: Result<Vec<_>, _> = ShortRows::new(table.rows(), longest_s).collect();
        assert_eq!(parts.unwrap(), table.rows().collect::<Vec<_>>());
    }
}

/// The feed of the rows is set behind it, in the middle of a cut row too.
#[test]
fn a_stream_is_held_through_it() {
    let mut window = [Knot::default(); 40];
    let lines = lines(&[[0.0, 0.0], [100.0, 0.0], [100.0, 80.0]]);
    let stream = LookAhead::new(&lines, LIMITS, |_| Ok(8), &mut window).unwrap();
    let mut rows = ShortRows::new(stream, 0.01);
    let mut last = rows.nth(6).unwrap().unwrap();
    rows.rows_mut().stop();
    for row in rows.by_ref() {
        let row = row.unwrap();
        assert!(row.time_s > last.time_s && row.duration_s <= 0.01);
        last = row;
    }
    assert!(last.is_at_rest() && !rows.rows_mut().is_finished());
    rows.rows_mut().set_feed(1.0).unwrap();
    let end = rows.last().unwrap().unwrap();
    assert_eq!(bits(end.position), bits([100.0, 80.0]));
}
