//! The steps of a two-link arm whose tool goes along a line from rest to rest, to a tick of 72 MHz.
//!
//! `cargo run -p stepper-sync --example arm_line`

use core::error::Error;
use stepper_sync::{PvtQuantiser, PvtSteps, Rate, StepDirTiming, StepScale};

/// Both links, in mm.
const LINK_MM: f64 = 132.0;
/// From one knot to the next.
const KNOT_S: f64 = 0.01;
const KNOTS: u32 = 100;

/// Angles in radians, the elbow's seen from the first link, for the tool at (x, y) mm.
fn inverse(x: f64, y: f64) -> [f64; 2] {
    let half = (x.hypot(y) / (2.0 * LINK_MM)).acos();
    [y.atan2(x) - half, 2.0 * half]
}

/// Their speeds in rad/s, for those of the tool in mm/s.
fn inverse_speeds([shoulder, elbow]: [f64; 2], vx: f64, vy: f64) -> [f64; 2] {
    let (upper, lower) = (shoulder, shoulder + elbow);
    let determinant = LINK_MM * elbow.sin();
    let first_link = (vx * lower.cos() + vy * lower.sin()) / determinant;
    let second_link = -(vx * upper.cos() + vy * upper.sin()) / determinant;
    [first_link, second_link - first_link]
}

fn main() -> Result<(), Box<dyn Error>> {
    let tick_rate = Rate::from_hz(72_000_000)?;
    let steps_per_rad = StepScale::new(32_000.0 / core::f64::consts::TAU)?;
    // From (60, 150) by (140, -200) mm in a second, the fraction 3 s² - 2 s³ of it after s.
    let start = inverse(60.0, 150.0);
    let mut table = PvtQuantiser::new(tick_rate, [steps_per_rad; 2], start)?;
    let timing = StepDirTiming::DRV8825.min_intervals(tick_rate);
    let mut steps = PvtSteps::new(table.knots(), timing);
    for knot in 1..=KNOTS {
        let s = f64::from(knot) * KNOT_S;
        let fraction = s * s * (3.0 - 2.0 * s);
        let joints = inverse(60.0 + 140.0 * fraction, 150.0 - 200.0 * fraction);
        let speed = 6.0 * s * (1.0 - s);
        let speeds = inverse_speeds(joints, 140.0 * speed, -200.0 * speed);
        steps.push(&table.row(s, joints, speeds)?)?;
        for step in &mut steps {
            println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
        }
    }
    Ok(())
}
