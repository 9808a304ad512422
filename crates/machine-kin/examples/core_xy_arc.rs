//! A CoreXY's pen along an arc, with a lift: the steps of both belts and the lift, to a tick of 72
//! MHz.
//!
//! `cargo run -p machine-kin --example core_xy_arc`

use core::error::Error;

use machine_kin::path_timing::{AxisLimits, Curve, ToolLimits};
use machine_kin::{CoreXy, Machine, MachinePath, WithZ};
use pvt_steps::{Drive, Rate};

fn main() -> Result<(), Box<dyn Error>> {
    let machine = WithZ::new(CoreXy::new(0.0..=300.0, 0.0..=200.0), 0.0..=20.0);
    let curve = Curve::arc(
        [240.0, 100.0, 5.0],
        [150.0, 100.0, 5.0],
        [0.0, 1.0, 0.0],
        3.0,
    )?;
    let feed = ToolLimits {
        feed: 100.0,
        acceleration: Some(2000.0),
    }; // mm, s
    let path = machine.path(curve.with_tool(feed), ())?; // or why not, and where
    let limits = [AxisLimits {
        speed: 300.0,
        acceleration: 4000.0,
        jerk: None,
    }; 3]; // mm, s
    let steps_per_unit = [80.0, 80.0, 400.0]; // per mm
    let mut drive = Drive::new(limits, steps_per_unit, Rate::from_hz(72_000_000)?)?;
    let tolerance = 0.01; // how far the tool may be from its path, mm
    for step in drive.along([path], tolerance, MachinePath::departure) {
        let step = step?;
        println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
    }
    Ok(())
}
