//! A Delta picks a part and places it: up, over in an arc, and down, as angles and times.
#![expect(clippy::print_stdout, reason = "that is what an example is for")]

use core::error::Error;
use core::f64::consts::{FRAC_PI_2, PI};

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{ArmRange, Delta, Dimensions, PlatformPath, SpeedLimits};

fn main() -> Result<(), Box<dyn Error>> {
    // Radii of base and platform, upper and lower arm, mm; angles read zero with the arms
    // horizontal, and may go 90° down and 30° up.
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })?
    .with_zero(FRAC_PI_2)?
    .with_range(ArmRange::new(-FRAC_PI_2, 0.52)?);
    println!(
        "a cylinder of radius {:.0} mm between z = -300 and -240 is all reached\n",
        delta.largest_cylinder([-300.0, -240.0], 1.0)?
    );

    let (pick, place) = (
        Point3::new(-50.0, 20.0, -300.0),
        Point3::new(50.0, 20.0, -300.0),
    );
    let lift = Vector3::new(0.0, 0.0, 20.0);
    let moves = [
        ("up", PlatformPath::line(pick, pick + lift)?),
        (
            "over",
            PlatformPath::arc(
                pick + lift,
                Point3::new(0.0, 20.0, -280.0),
                Vector3::y(),
                PI,
            )?,
        ),
        ("down", PlatformPath::line(place + lift, place)?),
    ];
    let limits = SpeedLimits::new(500.0, [6.0; 3])?; // mm/s; rad/s
    for (name, path) in moves {
        let (mut seconds, mut last) = (0.0, None);
        let waypoints = delta.follow(path, 0.01, limits)?;
        let count = waypoints.remaining();
        for waypoint in waypoints {
            seconds += waypoint.duration_s;
            last = Some(waypoint);
        }
        let Some(end) = last else { continue };
        let degrees = end.angles.map(f64::to_degrees);
        println!(
            "{name:5} {count:4} waypoints {seconds:.3} s, to ({:.1}, {:.1}, {:.1}): {:.2}° {:.2}° {:.2}°",
            end.point.x, end.point.y, end.point.z, degrees.x, degrees.y, degrees.z
        );
    }
    Ok(())
}
