//! A two-link arm's tool along a line, from rest to rest as fast as both joints allow: the steps of
//! its motors, to a tick of 72 MHz.
//!
//! `cargo run -p pvt-steps --example arm_line`

use core::error::Error;

use path_timing::{Accuracy, AxisLimits, Curve, Knot, Path, Table};
use pvt_steps::{PvtQuantiser, PvtSteps, Rate, StepDirTiming, StepScale};
use scara_kin::{Arm, ArmPath, Elbow};

/// Both links, in mm.
const LINK_MM: f64 = 132.0;
/// How far the tool may be from the line, in mm.
const TOLERANCE_MM: f64 = 0.01;

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(LINK_MM, LINK_MM)?;
    let line = arm.path(Curve::line([60.0, 150.0], [200.0, -50.0])?, Elbow::Left)?;
    let joint = AxisLimits {
        speed: 3.0,
        acceleration: 30.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 200];
    let accuracy = Accuracy {
        min_segments: 8,
        max_departure: TOLERANCE_MM,
        max_time_ratio: f64::INFINITY,
    };
    let departure = ArmPath::departure;
    let table = Table::plan_within([line], [joint; 2], accuracy, departure, &mut knots)?;

    let tick_rate = Rate::from_hz(72_000_000)?;
    let steps_per_rad = StepScale::of_motor(200, 16, 10.0, core::f64::consts::TAU)?;
    let start = line.point(0.0)?.position;
    let mut rows = PvtQuantiser::new(tick_rate, [steps_per_rad; 2], start)?;
    let timing = StepDirTiming::DRV8825.min_intervals(tick_rate);
    let mut steps = PvtSteps::new(rows.knots(), timing);
    for row in table.rows().skip(1) {
        steps.push(&rows.row(row.time_s, row.position, row.velocity)?)?;
        for step in &mut steps {
            println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
        }
    }
    Ok(())
}
