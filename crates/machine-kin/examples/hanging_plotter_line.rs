//! A pen on two cords along a line: the steps of both winches, to a tick of 72 MHz.
//!
//! `cargo run -p machine-kin --example hanging_plotter_line`

use core::error::Error;

use machine_kin::path_timing::{AxisLimits, Curve, ToolLimits};
use machine_kin::{HangingPlotter, Machine, MachinePath};
use pvt_steps::{Drive, Rate};

fn main() -> Result<(), Box<dyn Error>> {
    let machine = HangingPlotter::new(1200.0, 200.0..=1400.0)?; // winches apart, cords, mm
    let curve = Curve::line([300.0, 500.0], [900.0, 700.0])?;
    let feed = ToolLimits {
        feed: 100.0,
        acceleration: Some(2000.0),
    }; // mm, s
    let path = machine.path(curve.with_tool(feed), ())?; // or why not, and where
    let limits = [AxisLimits {
        speed: 300.0,
        acceleration: 4000.0,
        jerk: None,
    }; 2]; // mm, s
    let steps_per_unit = [40.0; 2]; // per mm
    let mut drive = Drive::new(limits, steps_per_unit, Rate::from_hz(72_000_000)?)?;
    let tolerance = 0.01; // how far the tool may be from its path, mm
    for step in drive.along([path], tolerance, MachinePath::departure) {
        let step = step?;
        println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
    }
    Ok(())
}
