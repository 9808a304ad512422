//! A polar arm along a line: rows of time, positions and velocities, with a hold in between.

use core::convert::Infallible;
use core::error::Error;

use path_timing::{AxisLimits, FeedCeiling, Knot, PathFn, PathPoint, Row, Table};

/// The line's length and its distance from the arm, in mm.
const LENGTH: f64 = 200.0;
const DISTANCE: f64 = 100.0;

/// Angle and reach of the arm, and their slopes, `s` mm along the line.
fn point(s: f64) -> Result<PathPoint<[f64; 2]>, Infallible> {
    let (x, y) = (s - LENGTH / 2.0, DISTANCE);
    let reach = x.hypot(y);
    Ok(PathPoint {
        position: [y.atan2(x), reach],
        slope: [-y / (reach * reach), x / reach],
    })
}

fn limits(speed: f64, acceleration: f64) -> AxisLimits {
    AxisLimits {
        speed,
        acceleration,
        jerk: None,
    }
}

fn print(row: &Row<[f64; 2]>) {
    let ([angle, reach], [turn, slide]) = (row.position, row.velocity);
    println!(
        "{:.4},{angle:.5},{reach:.3},{turn:.4},{slide:.2}",
        row.time_s
    );
}

fn main() -> Result<(), Box<dyn Error>> {
    let limits = [limits(2.0, 20.0), limits(300.0, 2000.0)]; // rad, mm; s
    let line = PathFn::new(LENGTH, point);
    let mut knots = [Knot::default(); 41];
    let table = Table::plan([&line], limits, |_| 40, &mut knots)?;
    println!("time_s,angle_rad,reach_mm,angle_rad_s,reach_mm_s");

    // Half of the rows, a hold, and the rest.
    let mut ahead = [FeedCeiling::default(); 41];
    let mut run = table.playback(1.0, &mut ahead)?;
    for row in run.by_ref().take(20) {
        print(&row);
    }
    run.stop();
    for row in run.by_ref() {
        print(&row);
    }
    run.set_feed(1.0)?;
    for row in run {
        print(&row);
    }
    Ok(())
}
