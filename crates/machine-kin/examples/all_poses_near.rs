//! Where the motors of a machine are, and how fast they turn for the tool, anywhere within some mm
//! of a point: what a proof of a whole region asks of the same inverse that a path does.
//!
//! `cargo run -p machine-kin --example all_poses_near`

use core::error::Error;

use machine_kin::path_timing::Curve;
use machine_kin::{Gradient, HBot, Interval, LinearDelta, Machine};

fn main() -> Result<(), Box<dyn Error>> {
    let gantry = HBot::new(0.0..=300.0, 0.0..=200.0); // mm
    near(&gantry, [150.0, 100.0], ())?;

    // Columns as they were measured, one of them 0.4 mm off.
    let printer = LinearDelta::new(250.0, 110.0, 0.0..=450.0)?.with_columns([
        [-95.3, -55.0],
        [95.3, -55.0],
        [0.4, 110.0],
    ])?;
    near(&printer, [20.0, 10.0, 30.0], ())?;

    let path = printer.path(Curve::line([0.0, 0.0, 20.0], [60.0, 0.0, 20.0])?, ())?;
    println!(
        "a path of {} mm in the branch {:?}",
        path.curve().length(),
        path.branch()
    );
    Ok(())
}

/// Prints the ranges of all axes within 5 mm of a point, and of their slopes.
fn near<M: Machine<N>, const N: usize>(
    machine: &M,
    point: [f64; N],
    branch: M::Branch,
) -> Result<(), Box<dyn Error>> {
    let around = Gradient::variables(point.map(|x| Interval::around(x, 5.0)));
    let axes = machine.inverse(around, branch)?;
    for (axis, found) in machine.axes().iter().zip(axes) {
        let (place, slopes) = (found.value(), found.slopes());
        println!(
            "{}: {:.2} to {:.2} mm",
            axis.name(),
            place.low(),
            place.high()
        );
        for slope in slopes {
            println!("  {:.3} to {:.3} per mm", slope.low(), slope.high());
        }
    }
    Ok(())
}
