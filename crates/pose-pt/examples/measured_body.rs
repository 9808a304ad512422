//! A body that was measured: where it is by its marks, what its locators' axes are, and how fast
//! they have to move.
//!
//! `cargo run -p pose-pt --example measured_body`

use core::error::Error;

use pose_pt::nalgebra::{Matrix3, Point3, Vector3};
use pose_pt::{Convention, Locator, LocatorAxis, Platform, PoseVector, calibrate, rigid_fit};

fn main() -> Result<(), Box<dyn Error>> {
    // Four marks, as drawn and as a laser tracker sees them: moved, and each off by up to 0.05 mm.
    let drawn = [[0.0, 0.0], [3000.0, 0.0], [3000.0, 2000.0], [0.0, 2000.0]]
        .map(|[x, y]| Point3::new(x, y, 0.0));
    let pose = PoseVector::new(12.0, -3.0, 100.0, 0.0, 0.01, 0.02);
    let moved = pose.to_isometry(Convention::ExtrinsicXyz);
    let off = [0.05, -0.03, 0.02, -0.04].map(|z| Vector3::new(0.0, 0.0, z));
    let mut seen = drawn.map(|mark| moved * mark);
    for (mark, off) in seen.iter_mut().zip(off) {
        *mark += off;
    }
    let fit = rigid_fit(&drawn, &seen)?;
    let at = fit.motion.translation.vector;
    println!("rms {:.4} mm, at {:.3?}", fit.rms, at.as_slice());
    for (drawn, seen) in drawn.iter().zip(&seen) {
        println!("  {:.4?} mm left", fit.residual(drawn, seen).as_slice());
    }

    // A locator's axes, from positions and where the held point was: Y leans by 1 mrad.
    let axes = Matrix3::new(1.0, 0.001, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let positions = [
        [0.0; 3],
        [200.0, 0.0, 0.0],
        [0.0, 200.0, 0.0],
        [0.0, 0.0, 200.0],
    ]
    .map(Vector3::from);
    let points = positions.map(|position| Point3::new(5.0, 6.0, 7.0) + axes * position);
    let frame = calibrate(&positions, &points)?;
    println!(
        "out of square by {:.5?} rad",
        frame.squareness_errors().as_slice()
    );

    let axis = LocatorAxis {
        min: -300.0,
        max: 300.0,
        speed: 20.0,
        acceleration: 100.0,
        jerk: None,
    };
    let [a, b, c, _] = drawn;
    let held = [a, b, c].map(|anchor| Locator::new(anchor, anchor, [axis; 3]));
    let platform: Platform<3> = Platform::new(held)?;
    // Turning at 0.002 rad/s about Z, where the body is.
    let turn = Vector3::new(0.0, 0.0, 0.002);
    for speeds in platform.axis_velocities(&fit.motion, &Vector3::zeros(), &turn) {
        println!("axes at {:.2?} mm/s", speeds.as_slice());
    }
    let axes = platform.axes(&fit.motion);
    match platform.check_axes(&axes) {
        Ok(()) => println!("all strokes are long enough"),
        Err(limit) => println!("{limit}"),
    }
    Ok(())
}
