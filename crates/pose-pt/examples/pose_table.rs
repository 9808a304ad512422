//! A panel on three locators lifts by 100 mm and turns: the table for the controller, in which no
//! distance between two locators departs from that of their anchors by more than 0.01 mm.

use core::error::Error;

use path_timing::{Accuracy, Knot, Table};
use pose_pt::{BodyPath, Convention, Interpolation, Locator, LocatorAxis};
use pose_pt::{Platform, PosePath, PoseVector, PtTable, Segmentation, hermite_distance_error};

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

    let mut before = None;
    let mut largest = 0.0_f64;
    for row in table.rows() {
        if let Some(before) = before.replace(row) {
            largest = largest.max(hermite_distance_error(&platform, &[before, row]));
        }
        print!("{:8.4} s", row.time_s);
        let axes = row.position.iter().zip(&row.velocity);
        for (position, velocity) in axes.flat_map(|(q, v)| q.iter().zip(v)) {
            print!("{position:9.3} {velocity:7.3}");
        }
        println!();
    }
    println!(
        "{} rows, {:.3} s, the body strained by up to {largest:.4} mm",
        table.len(),
        table.duration_s()
    );

    // For a controller that takes positions and times alone.
    let segments = Segmentation::max_distance_error(0.01).at_least(4);
    let straight = PtTable::plan(&platform, &path, segments)?;
    println!("{} rows without velocities", straight.points().count());
    Ok(())
}
