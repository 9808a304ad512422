//! The pins of a line against the line: each step in its tick.

use std::f64::consts::TAU;

use path_timing::{AxisLimits, Curve, Knot, Row, Table};
use scara_kin::{Elbow, Joints};

use crate::rig::{
    ACCELERATION_DEG_S2, Rig, SPEED_DEG_S, START_STEPS, STEPS_PER_TURN, TICK_HZ, arm, forward,
};

/// Of the line: what the firmware makes of it.
const SEGMENTS: u32 = 26;
/// All pulses come that much after their steps: the direction's setup time.
const SETUP_TICKS: u64 = 1;
/// A step is less than a tick off, and the tick at which it is played rounds once more.
const TICKS: f64 = 2.0;
/// Rows at whole ticks instead of their times: that much besides, in steps.
const STEPS: f64 = 0.01;

/// Positions and velocities at a time, along the cubics of the rows.
fn at(rows: &[Row<[f64; 2]>], time_s: f64) -> [[f64; 2]; 2] {
    let next = rows
        .partition_point(|row| row.time_s < time_s)
        .clamp(1, rows.len() - 1);
    let (from, to) = (&rows[next - 1], &rows[next]);
    let t = to.time_s - from.time_s;
    let s = (time_s - from.time_s) / t;
    [0, 1].map(|joint| {
        let (q0, q1) = (from.position[joint], to.position[joint]);
        let (v0, v1) = (from.velocity[joint] * t, to.velocity[joint] * t);
        let (second, third) = (3.0 * (q1 - q0) - 2.0 * v0 - v1, v0 + v1 - 2.0 * (q1 - q0));
        let position = q0 + s * (v0 + s * (second + s * third));
        let velocity = (v0 + s * (2.0 * second + 3.0 * s * third)) / t;
        [position, velocity]
    })
}

#[test]
fn each_step_is_in_its_tick() {
    let mut rig = Rig::homed();
    let start_ticks = rig.pins.ticks;
    // Where the planner is, not the steps.
    let start = [-30.0_f64, 20.0].map(f64::to_radians);
    let from = forward(start);
    let to = [60.0, 150.0];
    assert!(
        rig.ask("line 60 150").contains(" 301.751 mm"),
        "{:?}",
        rig.log()
    );
    assert!(rig.answer().starts_with("done, "));

    let line = Curve::line(from, to).unwrap();
    let path = arm()
        .path_from(line, Elbow::Right, Joints::new(start[0], start[1]))
        .unwrap()
        .in_f32()
        .unwrap();
    let limits = AxisLimits {
        speed: SPEED_DEG_S.to_radians(),
        acceleration: ACCELERATION_DEG_S2.to_radians(),
        jerk: None,
    };
    let mut knots = [Knot::default(); SEGMENTS as usize + 1];
    let table = Table::plan_in_f32([path], [limits; 2], |_| SEGMENTS, &mut knots).unwrap();
    let rows: Vec<_> = table.rows().collect();

    let mut steps = START_STEPS;
    let steps_per_rad = STEPS_PER_TURN / TAU;
    for made in &rig.pins.made {
        let time_s = (made.ticks - start_ticks - SETUP_TICKS) as f64 / f64::from(TICK_HZ);
        let [position, velocity] = at(&rows, time_s)[made.axis].map(|value| value * steps_per_rad);
        steps[made.axis] += made.sign;
        let passed = f64::from(steps[made.axis]) - 0.5 * f64::from(made.sign);
        let allowed = velocity.abs() / f64::from(TICK_HZ) * TICKS + STEPS;
        let off = (position - passed).abs();
        assert!(off <= allowed, "{off} of {allowed} steps off: {made:?}");
    }
    let end = rows
        .last()
        .unwrap()
        .position
        .map(|angle| (angle * steps_per_rad).round() as i32);
    assert_eq!(steps, end);
    assert!(rig.pins.made.len() > 2000, "{} steps", rig.pins.made.len());
}
