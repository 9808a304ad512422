//! Which lengths measured points show, which they do not, and how many iterations that takes.
//!
//! `cargo run -p delta-kin --example fit_lengths`

use core::error::Error;

use delta_kin::nalgebra::Point3;
use delta_kin::{Delta, Dimensions, Measured, Parameter, Quantity};

fn main() -> Result<(), Box<dyn Error>> {
    let drawn = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })?; // mm
    let built = Delta::new(Dimensions {
        base: 42.3,
        platform: 18.0,
        upper: 119.8,
        lower: 243.4,
    })?;
    let mut measured = Vec::new();
    for (x, y) in [
        (60.0, 0.0),
        (-60.0, 10.0),
        (0.0, 60.0),
        (20.0, -60.0),
        (0.0, 0.0),
    ] {
        for z in [-310.0, -260.0] {
            let point = Point3::new(x, y, z);
            let angles = built.inverse(point)?;
            measured.push(Measured { angles, point });
        }
    }

    // Base and platform radius of all arms: only their difference moves the platform.
    let parameters = [
        Quantity::Base,
        Quantity::Platform,
        Quantity::Upper,
        Quantity::Lower,
    ]
    .map(Parameter::common);
    let found = drawn.calibrate(parameters, &measured)?;
    println!(
        "{} iterations, rms {:.2e} mm, {} of 4 determined, conditioning {:.1e}",
        found.iterations(),
        found.rms(),
        found.rank(),
        found.conditioning()
    );
    for parameter in found.undetermined() {
        println!("not determined: {parameter:?}");
    }
    for change in found.null_space() {
        println!("moves no point: {change:.3?}");
    }
    Ok(())
}
