//! A pick and place as one motion of the arms, as fast as they may, with rounded corners; and where
//! the platform may be when the motion is shaped against a vibration.
//!
//! `cargo run -p delta-kin --features path-timing --example pick_by_path`

use core::error::Error;

use delta_kin::{Delta, DeltaPath, Dimensions};
use path_timing::{Accuracy, AxisLimits, Knot, Mode, Shaper, Table};

fn main() -> Result<(), Box<dyn Error>> {
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })?; // mm
    let (from, to) = ([80.0, 0.0, -300.0], [-60.0, 40.0, -290.0]);
    let moves = delta.pick_and_place(from, to, -270.0, 3.0, None)?;
    let arm = AxisLimits {
        speed: 6.0,
        acceleration: 100.0,
        jerk: None,
    }; // rad, s
    let accuracy = Accuracy {
        min_segments: 4,
        max_departure: 0.05,
        max_time_ratio: f64::INFINITY,
    };
    // Within 0.05 mm at any feed, and through a hold.
    let mut knots = [Knot::default(); 600];
    let table = Table::plan_within_at_any_feed(
        moves,
        [arm; 3],
        accuracy,
        DeltaPath::departure,
        &mut knots,
    )?;
    println!("{} rows, {:.3} s", table.len(), table.duration_s());

    // A shaped arm is off its unshaped motion by this much at most.
    let shaper = Shaper::zv(Mode {
        hz: 40.0,
        damping: 0.05,
    })?;
    let off = [shaper.departure(arm.acceleration); 3];
    let spans = table.spans();
    let shifted = spans.map(|span| {
        let [_, to] = &span.rows;
        let path = moves.get(to.leg);
        path.map_or(f64::INFINITY, |path| path.shifted_departure(&span, off))
    });
    println!(
        "shaped, within {:.2} mm of the path",
        shifted.fold(0.0, f64::max)
    );
    Ok(())
}
