//! A SCARA's gripper along a line, up, and round by a quarter turn: the steps of its four motors,
//! to a tick of 72 MHz.
//!
//! `cargo run -p machine-kin --example scara_with_wrist`

use core::error::Error;
use core::f64::consts::{FRAC_PI_2, TAU};

use machine_kin::path_timing::{AxisLimits, Curve, ToolLimits};
use machine_kin::{Elbow, Machine, MachinePath, Scara};
use pvt_steps::{Drive, Rate};

fn main() -> Result<(), Box<dyn Error>> {
    let machine = Scara::new(160.0, 140.0, 30.0)?; // links, and the radius at which a turn counts as a way, mm
    let curve = Curve::line(
        [100.0, 150.0, 0.0, 0.0],
        [-100.0, 180.0, 20.0, 30.0 * FRAC_PI_2],
    )?;
    let feed = ToolLimits {
        feed: 100.0,
        acceleration: Some(2000.0),
    }; // mm, s
    let path = machine.path(curve.with_tool(feed), Elbow::Right)?; // or why not, and where
    let limits = [
        AxisLimits {
            speed: 4.0,
            acceleration: 60.0,
            jerk: None,
        }, // shoulder and elbow: rad, s
        AxisLimits {
            speed: 4.0,
            acceleration: 60.0,
            jerk: None,
        },
        AxisLimits {
            speed: 300.0,
            acceleration: 4000.0,
            jerk: None,
        },
        AxisLimits {
            speed: 4.0,
            acceleration: 60.0,
            jerk: None,
        },
    ];
    let steps_per_unit = [3200.0 / TAU, 3200.0 / TAU, 400.0, 3200.0 / TAU];
    let mut drive = Drive::new(limits, steps_per_unit, Rate::from_hz(72_000_000)?)?;
    let tolerance = 0.01; // how far the tool may be from its path, mm
    for step in drive.along([path], tolerance, MachinePath::departure) {
        let step = step?;
        println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
    }
    Ok(())
}
