//! Set-points: on their cubics, at each cycle, in integers without drift.

use path_timing::{
    AxisLimits, Cia402Scale, Corner, Cubic, Curve, Knot, LookAhead, Row, SetPoint, SetPoints, Table,
};
use proptest::prelude::*;

use crate::support::machine::limits;

/// Of positions of some hundred, and of their velocities.
const ROUNDING: f64 = 1e-10;

const LIMITS: [AxisLimits; 2] = [limits(200.0, 2000.0, None), limits(300.0, 5000.0, None)];

fn rows(points: &[[f64; 2]], segments: u32) -> Vec<Row<[f64; 2]>> {
    let lines = points.windows(2).map(|ends| {
        let line = Curve::line(ends[0], ends[1]).unwrap();
        line.with_corner(Corner::Jump([15.0, 10.0]))
    });
    let lines: Vec<_> = lines.collect();
    let mut knots = vec![Knot::default(); 4000];
    let table = Table::plan(&lines, LIMITS, |_| segments, &mut knots).unwrap();
    table.rows().collect()
}

fn check(point: &SetPoint<[f64; 2]>, rows: &[Row<[f64; 2]>]) {
    let index = rows.partition_point(|row| row.time_s <= point.time_s);
    let Some(to) = rows.get(index) else {
        let end = &rows[rows.len() - 1];
        assert_eq!(
            point.position.map(f64::to_bits),
            end.position.map(f64::to_bits)
        );
        assert!(
            point
                .velocity
                .iter()
                .chain(&point.acceleration)
                .all(|x| *x == 0.0)
        );
        return;
    };
    let from = &rows[index - 1];
    let since_s = point.time_s - from.time_s;
    for (axis, cubic) in Cubic::between(from, to).enumerate() {
        let [a0, a1] = cubic.accelerations();
        let acceleration = a0 + (a1 - a0) * since_s / cubic.duration_s;
        let velocity = cubic.v0 + (a0 + acceleration) * 0.5 * since_s;
        let position = cubic.position(since_s / cubic.duration_s);
        assert!((point.position[axis] - position).abs() < ROUNDING);
        // A row at the very time of a cycle counts as before or after, by rounding.
        assert!((point.velocity[axis] - velocity).abs() < 1e-6 || since_s < 1e-12);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn each_is_on_its_cubic(
        x in -90.0..90.0_f64,
        y in -90.0..90.0_f64,
        segments in 2..50_u32,
        cycle_s in 2e-4..0.02_f64,
    ) {
        let rows = rows(&[[0.0, 0.0], [100.0, y], [x, -100.0]], segments);
        let points: Vec<_> = SetPoints::new(rows.iter().copied(), cycle_s).map(Result::unwrap).collect();
        let end_s = rows[rows.len() - 1].time_s;
        for (number, point) in (0..).zip(&points) {
            prop_assert!((point.time_s - f64::from(number) * cycle_s).abs() < ROUNDING);
            check(point, &rows);
        }
        // One for each cycle, and the first at or after the end.
        let last_s = points[points.len() - 1].time_s;
        prop_assert!(last_s >= end_s - ROUNDING && last_s < end_s + cycle_s * (1.0 + 1e-9));
    }
}

#[test]
fn a_hold_goes_on_at_the_next_cycle() {
    let lines = [Curve::line([0.0, 0.0], [100.0, 0.0]).unwrap()];
    let mut window = [Knot::default(); 64];
    let motion = LookAhead::new(lines, LIMITS, |_| Ok(50), &mut window).unwrap();
    let mut points = SetPoints::new(motion, 0.001);
    let moving = points.by_ref().take(100).last().unwrap().unwrap();
    assert!(moving.velocity[0] > 100.0);
    points.rows_mut().stop();
    let held = points.by_ref().map(Result::unwrap).last().unwrap();
    assert!(held.velocity.iter().all(|v| *v == 0.0) && held.position[0] < 100.0);
    assert!(points.next().is_none());
    points.rows_mut().set_feed(1.0).unwrap();
    let rest: Vec<_> = points.map(Result::unwrap).collect();
    for pair in rest.windows(2) {
        assert!((pair[1].time_s - pair[0].time_s - 0.001).abs() < ROUNDING);
        let step = pair[1].position[0] - pair[0].position[0];
        assert!((0.0..=200.0 * 0.001 + ROUNDING).contains(&step), "{step}");
    }
    assert!((rest[0].position[0] - held.position[0]).abs() < 0.01);
    let end = rest[rest.len() - 1].position;
    assert_eq!(end.map(f64::to_bits), [100.0, 0.0].map(f64::to_bits));
    let mut none = SetPoints::new(core::iter::empty::<Row<[f64; 1]>>(), 0.001);
    assert!(none.next().is_none());
    let one = [Row {
        position: [3.0],
        ..Row::default()
    }];
    assert_eq!(SetPoints::new(one.into_iter(), 0.001).count(), 1);
    assert_eq!(SetPoints::new(one.into_iter(), 0.0).count(), 0);
}

#[test]
fn integers_of_drives() {
    let scale = Cia402Scale {
        counts_per_unit: -1000.0,
        rated_torque: 2.0,
    };
    let target = scale.target(1.2345, -0.5, 0.3).unwrap();
    assert_eq!(
        (
            target.position,
            target.velocity_offset,
            target.torque_offset
        ),
        (-1235, 500, 150)
    );
    let refused = |position, velocity, torque| {
        scale
            .target(position, velocity, torque)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        refused(3e6, 0.0, 0.0),
        "position of -3e9 is beyond its range of ±2147483647"
    );
    assert_eq!(
        refused(0.0, f64::NAN, 0.0),
        "velocity offset of NaN is beyond its range of ±2147483647"
    );
    assert_eq!(
        refused(0.0, 0.0, -100.0),
        "torque offset of -50000 is beyond its range of ±32767"
    );
}
