//! A shaped move that is held half-way and goes on: the hold is shaped too, and so are the
//! set-points of a drive.
//!
//! `cargo run -p path-timing --example hold_a_shaped_move`

use core::error::Error;

use path_timing::{
    AxisLimits, Curve, FeedCeiling, Knot, Mode, Row, SetPoints, Shaped, Shaper, Table,
};

fn main() -> Result<(), Box<dyn Error>> {
    let axis = AxisLimits {
        speed: 300.0,
        acceleration: 5000.0,
        jerk: None,
    }; // mm, s
    let mut knots = [Knot::default(); 101];
    let table = Table::plan([Curve::line([0.0], [100.0])?], [axis], |_| 100, &mut knots)?;
    let shaper = Shaper::zv(Mode {
        hz: 10.0,
        damping: 0.02,
    })?;

    let mut ceilings = [FeedCeiling::default(); 101];
    let mut memory = [Row::default(); 200];
    let mut rows = Shaped::new(table.playback(1.0, &mut ceilings)?, [shaper], &mut memory);
    let moving = rows.by_ref().take(60).last().ok_or("no rows")??;
    rows.rows_mut().stop();
    let rest = rows.by_ref().last().ok_or("no rows")??;
    println!(
        "held at {:.2} mm after {:.3} s: at rest at {:.2} mm after {:.3} s",
        moving.position[0], moving.time_s, rest.position[0], rest.time_s
    );
    rows.rows_mut().set_feed(1.0)?;
    let end = rows.last().ok_or("no rows")??;
    println!("and at {:.2} mm after {:.3} s", end.position[0], end.time_s);

    // The same in cycles of a drive: 1 ms each, none while the motion is held.
    let mut ceilings = [FeedCeiling::default(); 101];
    let mut points = SetPoints::new(table.playback(1.0, &mut ceilings)?, 0.001);
    let moving = points.by_ref().take(150).last().ok_or("no points")??;
    points.rows_mut().stop();
    let cycles = points.by_ref().count();
    println!(
        "{:.2} mm at 0.149 s, at rest after {cycles} cycles more",
        moving.position[0]
    );
    Ok(())
}
