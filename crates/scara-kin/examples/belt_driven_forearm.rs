//! A forearm whose motor stands on the base and turns it through a belt: encoder angles of both
//! drives to the tool's place, and back.
//!
//! `cargo run -p scara-kin --example belt_driven_forearm`

use core::error::Error;

use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, DriveAngles, DriveSense, Drives, Joints};

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(200.0, 160.0)?; // mm
    let drives = Drives::default()
        .with_coupling(1.0)? // a belt of 1:1
        .with_senses(DriveSense::Forward, DriveSense::Reversed)
        .with_zero(Joints::new(0.1, -0.2))?; // where the encoders read zero
    println!(
        "coupling {}, senses {:?}",
        drives.coupling(),
        drives.senses()
    );

    let read = DriveAngles {
        shoulder: 0.5,
        elbow: -1.4,
    };
    let joints = drives.to_joints(read);
    let tool = arm.forward(joints);
    println!(
        "encoders {read:?}: {joints:?}, the tool at ({:.2}, {:.2})",
        tool.x, tool.y
    );

    // The shoulder alone: the belt turns the forearm's drive too, that the elbow keeps its angle.
    let (_, aside) = arm.inverse_nearest(Point2::new(tool.x, tool.y + 10.0), joints)?;
    println!("10 mm up: {:?}", drives.from_joints(aside));
    Ok(())
}
