//! An arm over its workspace: what it reaches, how far from singular, how fast and how exact it is
//! there.
//!
//! `cargo run -p scara-kin --example arm_in_numbers`

use core::error::Error;

use scara_kin::nalgebra::{Point2, Vector2};
use scara_kin::{Arm, Elbow, Joints};

/// What one step of a motor turns its joint by, in radians.
const STEP: f64 = 0.001;

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(132.0, 110.0)?.with_keep_out(40.0)?; // mm
    println!(
        "reach {} mm, nothing within {} mm, half a step of both joints moves the tool by {:.3} mm",
        arm.reach(),
        arm.keep_out(),
        arm.tool_shift([STEP / 2.0; 2])
    );

    // All points of a row at once, and back.
    let row: Vec<_> = (0..8)
        .map(|n| Point2::new(35.0 * f64::from(n), 20.0))
        .collect();
    let mut joints = Vec::new();
    for (point, solutions) in row.iter().zip(arm.inverse_each(&row)) {
        match solutions {
            Ok(solutions) => joints.extend(solutions.get(Elbow::Right)),
            Err(reason) => println!("({:.0}, {:.0}): {reason}", point.x, point.y),
        }
    }
    for (joints, tool) in joints.iter().zip(arm.forward_each(&joints)) {
        let elbow = arm.elbow_position(*joints);
        println!(
            "({:3.0}, {:.0}): elbow at ({:.1}, {:.1}), manipulability {:6.0} mm², {:5.1} mm per radian at the worst",
            tool.x,
            tool.y,
            elbow.x,
            elbow.y,
            arm.manipulability(*joints),
            arm.singularity_distance(*joints)
        );
    }
    println!(
        "is (300, 0) reached? {}",
        arm.is_reachable(Point2::new(300.0, 0.0))
    );

    // Straight on at 200 mm/s takes accelerations of the joints, which bring no acceleration of the
    // tool.
    let at = Joints::new(0.3, 1.2);
    let rates = arm.joint_rates(at, Vector2::new(200.0, 0.0))?;
    let accelerations = arm.joint_accelerations(at, rates, Vector2::zeros())?;
    let tool = arm.tool_acceleration(at, rates, accelerations);
    println!(
        "{:.2?} rad/s² at {:.2?} rad/s: the tool's acceleration is {:.1e} mm/s²",
        accelerations.as_slice(),
        rates.as_slice(),
        tool.norm()
    );

    // Joints that turn evenly from one pose to the next leave the chord by this much at most.
    let next = Joints::new(0.32, 1.17);
    println!("within {:.3} mm of the chord", arm.chord_bound(at, next));
    Ok(())
}
