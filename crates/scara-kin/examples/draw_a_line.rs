//! A two-link arm draws a straight line: the waypoints of its joints, and how far the tool leaves
//! it.
#![expect(clippy::print_stdout, reason = "that is what an example is for")]

use core::error::Error;

use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, InverseError, Joints};

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(132.0, 132.0)?; // mm
    let (from, to) = (Point2::new(-80.0, 100.0), Point2::new(80.0, 100.0));

    // What cannot be reached says why.
    if let Err(error @ InverseError::TooFar { .. }) = arm.inverse(Point2::new(264.5, 0.0)) {
        println!("{error}\n");
    }

    // Of both elbows that with less to turn.
    let now = Joints::new(0.3, 1.2);
    let (elbow, _) = arm.inverse_nearest(from, now)?;
    let waypoints = arm.follow([from, to], elbow, 0.01)?;
    println!("{} waypoints, {elbow:?} elbow", waypoints.remaining());
    println!("    x mm  shoulder°   elbow°   off the line, mm");

    let mut before = None;
    for waypoint in waypoints {
        let joints = waypoint.joints;
        // Halfway from one waypoint to the next, where a tool is farthest from the line.
        let off = before.map_or(0.0, |before: Joints| {
            let halfway = Joints::new(
                f64::midpoint(before.shoulder, joints.shoulder),
                f64::midpoint(before.elbow, joints.elbow),
            );
            (arm.forward(halfway).y - from.y).abs()
        });
        assert!(off <= 0.01);
        println!(
            "{:8.2} {:10.3} {:8.3}   {off:.4}",
            waypoint.point.x,
            joints.shoulder.to_degrees(),
            joints.elbow.to_degrees(),
        );
        before = Some(joints);
    }
    Ok(())
}
