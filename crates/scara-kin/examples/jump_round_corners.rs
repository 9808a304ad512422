//! An arm draws a hexagon twice: with a stop at each corner, and with motors that jump round it, by
//! the speed that steppers start and stop with.
//!
//! `cargo run -p scara-kin --features path-timing --example jump_round_corners`
#![expect(clippy::print_stdout, reason = "that is what an example is for")]

use core::error::Error;
use core::f64::consts::{FRAC_PI_3, TAU};

use path_timing::{AxisLimits, Corner, Curve, Knot, Table};
use scara_kin::{Arm, ArmPath, Elbow};

/// Full steps a second that the motors start with, and steps a turn of a joint.
const START_STEPS_PER_S: f64 = 150.0;
const STEPS_PER_TURN: f64 = 32_000.0 / 16.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(132.0, 132.0)?; // mm
    let corner = |n: u32| {
        let (sin, cos) = (f64::from(n) * FRAC_PI_3).sin_cos();
        [20.0 * cos, 150.0 + 20.0 * sin]
    };
    let side = |n| -> Result<ArmPath, Box<dyn Error>> {
        let line = Curve::line(corner(n), corner(n + 1))?;
        Ok(arm.path(line, Elbow::Right)?)
    };
    let sides = (0..6).map(side).collect::<Result<Vec<_>, _>>()?;

    let joint = AxisLimits {
        speed: 3.0,
        acceleration: 30.0,
        jerk: None,
    }; // rad, s
    let mut knots = [Knot::default(); 200];
    let stops = Table::plan(&sides, [joint; 2], |_| 16, &mut knots)?.duration_s();

    let jump = START_STEPS_PER_S / STEPS_PER_TURN * TAU; // rad/s
    let jumping: Vec<_> = sides
        .iter()
        .map(|side| side.with_corner(Corner::Jump([jump; 2])))
        .collect();
    let table = Table::plan(&jumping, [joint; 2], |_| 16, &mut knots)?;
    println!(
        "{stops:.3} s with stops, {:.3} s round corners",
        table.duration_s()
    );
    for rows in table.rows().collect::<Vec<_>>().windows(2) {
        let [before, after] = rows else { continue };
        // Two rows of the same time: the velocities jump.
        if after.duration_s <= 0.0 {
            let [v0, v1] = [before.velocity, after.velocity];
            println!(
                "side {}: shoulder from {:+.3} to {:+.3} rad/s, elbow from {:+.3} to {:+.3}",
                after.leg, v0[0], v1[0], v0[1], v1[1]
            );
        }
    }
    assert!(table.duration_s() < stops);
    Ok(())
}
