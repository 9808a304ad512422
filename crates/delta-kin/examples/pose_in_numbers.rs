//! A Delta in one pose: rods, levers, distance from singular poses, speeds and forces.
//!
//! `cargo run -p delta-kin --example pose_in_numbers`

use core::error::Error;

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{Delta, Dimensions, PlatformPath};

fn main() -> Result<(), Box<dyn Error>> {
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })? // mm
    .with_ball_joints(0.6)?; // rad
    println!(
        "elbows {:?}, platform at the {} point, rods swivel by up to {:?} rad",
        delta.working_mode(),
        delta.assembly_mode(),
        delta.max_swivel()
    );

    let line = PlatformPath::line(
        Point3::new(0.0, 0.0, -300.0),
        Point3::new(150.0, 0.0, -300.0),
    )?;
    for tenth in 0..=10 {
        let Some(point) = line.point_at(f64::from(tenth) / 10.0) else {
            continue;
        };
        if !delta.is_reachable(point) {
            println!(
                "({:.0}, {:.0}, {:.0}) is out of reach",
                point.x, point.y, point.z
            );
            continue;
        }
        let pose = delta.pose_at(point)?;
        let (arm, lever) = pose.serial_distance();
        println!(
            "x = {:3.0} mm: {arm} is nearest to being stretched, {lever:.1} mm per radian; {:.3} rad from rods in a plane",
            point.x,
            pose.parallel_distance().asin()
        );
    }

    let pose = delta.pose_at(Point3::new(50.0, 20.0, -300.0))?;
    println!(
        "rods {:.3?}, levers {:.1?} mm",
        pose.rods(),
        pose.levers().as_slice()
    );
    let velocity = pose.platform_velocity(Vector3::new(0.5, 0.0, -0.5))?; // rad/s
    println!("the platform moves at {:.1?} mm/s", velocity.as_slice());
    let forces = pose.rod_forces(Vector3::new(0.0, 0.0, -9.81))?; // N, 1 kg
    println!("the rods hold 1 kg with {:.2?} N", forces.as_slice());
    Ok(())
}
