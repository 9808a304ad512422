//! A two-link arm's tool along a line, from rest to rest as fast as both joints allow: the steps of
//! its motors, to a tick of 72 MHz.
//!
//! `cargo run -p stepper-sync --example arm_line`

use core::convert::Infallible;
use core::error::Error;

use path_timing::{AxisLimits, Knot, PathFn, Place, Table};
use stepper_sync::{PvtQuantiser, PvtSteps, Rate, StepDirTiming, StepScale};

/// Both links, in mm.
const LINK_MM: f64 = 132.0;
/// The line, in mm.
const START: [f64; 2] = [60.0, 150.0];
const WAY: [f64; 2] = [140.0, -200.0];

/// Shoulder and elbow in radians, the elbow's seen from the first link, and what they turn by for
/// each mm, `s` mm along the line.
fn place(s: f64) -> Result<Place<[f64; 2]>, Infallible> {
    let [dx, dy] = WAY.map(|way| way / WAY[0].hypot(WAY[1]));
    let (x, y) = (START[0] + s * dx, START[1] + s * dy);
    let half = (x.hypot(y) / (2.0 * LINK_MM)).acos();
    let (first, second) = (y.atan2(x) - half, y.atan2(x) + half);
    let determinant = LINK_MM * (second - first).sin();
    let first_slope = (dx * second.cos() + dy * second.sin()) / determinant;
    let second_slope = -(dx * first.cos() + dy * first.sin()) / determinant;
    Ok(Place {
        position: [first, second - first],
        slope: [first_slope, second_slope - first_slope],
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let line = PathFn::new(WAY[0].hypot(WAY[1]), place);
    let joint = AxisLimits {
        speed: 3.0,
        acceleration: 30.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 101];
    let table = Table::plan([&line], [joint; 2], |_| 100, &mut knots)?;

    let tick_rate = Rate::from_hz(72_000_000)?;
    let steps_per_rad = StepScale::new(32_000.0 / core::f64::consts::TAU)?;
    let Ok(start) = place(0.0);
    let mut rows = PvtQuantiser::new(tick_rate, [steps_per_rad; 2], start.position)?;
    let timing = StepDirTiming::DRV8825.min_intervals(tick_rate);
    let mut steps = PvtSteps::new(rows.knots(), timing);
    for row in table.rows().skip(1) {
        let row = row?;
        steps.push(&rows.row(row.time_s, row.position, row.velocity)?)?;
        for step in &mut steps {
            println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
        }
    }
    Ok(())
}
