//! A line past the middle of a polar machine: the steps of table and carriage, to a tick of 72 MHz.
//!
//! `cargo run -p machine-kin --example polar_machine`

use core::error::Error;
use core::f64::consts::TAU;

use machine_kin::path_timing::{AxisLimits, Curve, ToolLimits};
use machine_kin::{CarriageSide, Machine, MachinePath, Polar};
use pvt_steps::{Drive, Rate};

fn main() -> Result<(), Box<dyn Error>> {
    let machine = Polar::new(0.0..=120.0);
    let curve = Curve::line([-80.0, 20.0], [80.0, 20.0])?;
    let feed = ToolLimits {
        feed: 100.0,
        acceleration: Some(2000.0),
    }; // mm, s
    let path = machine.path(curve.with_tool(feed), CarriageSide::Front)?; // or why not, and where
    let limits = [
        AxisLimits {
            speed: 4.0,
            acceleration: 60.0,
            jerk: None,
        }, // rad, s
        AxisLimits {
            speed: 300.0,
            acceleration: 4000.0,
            jerk: None,
        }, // mm, s
    ];
    let steps_per_unit = [3200.0 / TAU, 80.0];
    let mut drive = Drive::new(limits, steps_per_unit, Rate::from_hz(72_000_000)?)?;
    let tolerance = 0.01; // how far the tool may be from its path, mm
    for step in drive.along([path], tolerance, MachinePath::departure) {
        let step = step?;
        println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
    }
    Ok(())
}
