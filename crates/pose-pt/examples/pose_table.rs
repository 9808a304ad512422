//! A panel on three locators lifts by 100 mm and turns: the table for the controller, in which no
//! distance between two locators departs from that of their anchors by more than 0.01 mm.

use core::error::Error;

use path_timing::{Accuracy, Knot, Table};
use pose_pt::{BodyPath, Convention, Interpolation, Locator, LocatorAxis};
use pose_pt::{Platform, PosePath, PoseVector};

fn main() -> Result<(), Box<dyn Error>> {
    // Stroke in mm, speed in mm/s, acceleration in mm/s²; zero where the panel is at rest.
    let limits = [LocatorAxis {
        min: -300.0,
        max: 300.0,
        speed: 20.0,
        acceleration: 100.0,
        jerk: None,
    }; 3];
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
    let path = PosePath::new(&poses, Interpolation::Straight)?;
    let mut knots = [Knot::default(); 65];
    let accuracy = Accuracy {
        min_segments: 16,
        max_departure: 0.01,
        max_time_ratio: f64::INFINITY,
    };
    let (paths, limits) = (platform.paths(&path), platform.axis_limits());
    let table = Table::plan_within(paths, limits, accuracy, BodyPath::departure, &mut knots)?;

    for row in table.rows() {
        print!("{:8.4} s", row.time_s);
        let axes = row.position.iter().zip(&row.velocity);
        for (position, velocity) in axes.flat_map(|(q, v)| q.iter().zip(v)) {
            print!("{position:9.3} {velocity:7.3}");
        }
        println!();
    }
    println!("{} rows, {:.3} s", table.len(), table.duration_s());
    Ok(())
}
