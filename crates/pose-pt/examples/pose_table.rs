//! A panel on three locators lifts by 100 mm and turns: the table for the controller, in which no
//! distance between two locators departs from that of their anchors by more than 0.01 mm.

use core::error::Error;

use pose_pt::{AxisLimits, Convention, Interpolation, Knot, Locator, Segmentation};
use pose_pt::{Path, Platform, PoseVector, PvtTable};

fn main() -> Result<(), Box<dyn Error>> {
    // Stroke in mm, speed in mm/s, acceleration in mm/s²; zero where the panel is at rest.
    let limits = [AxisLimits::new(-300.0, 300.0, 20.0, 100.0); 3];
    let anchors = [
        [-1500.0, -1000.0, 0.0],
        [1500.0, -1000.0, 0.0],
        [0.0, 1000.0, 0.0],
    ];
    let held = anchors.map(|anchor| Locator::new(anchor.into(), anchor.into(), limits));
    let platform: Platform<3> = Platform::new(held)?;

    let rest = PoseVector::default();
    let lifted = PoseVector::new(0.0, 0.0, 100.0, 0.0, 0.0, 0.02);
    let poses = [rest, lifted].map(|vector| vector.to_isometry(Convention::ExtrinsicXyz));
    let path = Path::new(&poses, Interpolation::Straight)?;
    let mut knots = [Knot::default(); 65];
    let table = PvtTable::plan(
        &platform,
        &path,
        Segmentation::max_distance_error(0.01),
        &mut knots,
    )?;

    for point in table.points() {
        print!("{:8.4} s", point.time_s);
        for (axes, velocities) in point.axes.iter().zip(&point.velocities) {
            for (axis, velocity) in axes.iter().zip(velocities) {
                print!("{axis:9.3} {velocity:7.3}");
            }
        }
        println!();
    }
    println!(
        "{} points, {:.3} s, distance error at most {:.1e} mm",
        table.len(),
        table.duration_s(),
        table.distance_error_bound()
    );
    Ok(())
}
