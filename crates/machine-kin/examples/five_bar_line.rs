//! A five-bar's tool along a line, from rest to rest as fast as both motors allow: their steps, to
//! a tick of 72 MHz.
//!
//! `cargo run -p machine-kin --example five_bar_line`

use core::error::Error;
use core::f64::consts::TAU;

use machine_kin::path_timing::{AxisLimits, Curve};
use machine_kin::{Elbow, FiveBar, Machine, MachinePath};
use pvt_steps::{Drive, Rate};

fn main() -> Result<(), Box<dyn Error>> {
    let machine = FiveBar::new(80.0, 100.0, 160.0)?; // motors apart, upper arms, forearms, mm
    let outwards = [Elbow::Left, Elbow::Right];
    let line = machine.path(Curve::line([-60.0, 150.0], [60.0, 180.0])?, outwards)?;
    let motor = AxisLimits {
        speed: 6.0,
        acceleration: 100.0,
        jerk: None,
    }; // rad, s
    let mut drive = Drive::new([motor; 2], [3200.0 / TAU; 2], Rate::from_hz(72_000_000)?)?;
    let tolerance = 0.01; // how far the tool may be from the line, mm
    for step in drive.along([line], tolerance, MachinePath::departure) {
        let step = step?;
        println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
    }
    // On the way down one pair of elbows ends where an arm is folded, with the other both forearms
    // come in line.
    let inwards = [Elbow::Right, Elbow::Left];
    let down = Curve::line([0.0, 200.0], [0.0, 20.0])?;
    for branch in [outwards, inwards] {
        if let Err(refused) = machine.path(down, branch) {
            println!("{branch:?}: {refused}");
        }
    }
    Ok(())
}
