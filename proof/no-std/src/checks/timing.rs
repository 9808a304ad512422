//! A table along a path.

use core::convert::Infallible;
use core::hint::black_box;

use path_timing::{Ahead, AxisLimits, Knot, PathFn, Place, Table};

use super::{CLOSE_MM, holds};

/// A straight way of two axes as a trapezoid, and the same under a feed of a half.
pub fn table() -> Option<()> {
    let straight = |s: f64| {
        Ok::<_, Infallible>(Place {
            position: [s, 0.5 * s],
            slope: [1.0, 0.5],
        })
    };
    let limits = AxisLimits {
        speed: black_box(10.0),
        acceleration: 20.0,
        jerk: None,
    };
    let path = PathFn::new(black_box(100.0), straight);
    let mut knots = [Knot::default(); 65];
    let table = Table::plan([&path], [limits; 2], |_| 64, &mut knots).ok()?;
    // 100 mm at 10 mm/s, and half a second for the ramps.
    holds((10.5..10.6).contains(&table.duration_s()))?;
    let last = table.rows().last()?.ok()?;
    holds(last.position == [100.0, 50.0] && last.velocity == [0.0; 2])?;
    let mut ahead = [Ahead::default(); 65];
    let mut run = table.run(1.0, &mut ahead).ok()?;
    run.set_feed(0.5).ok()?;
    let last = run.last()?.ok()?;
    holds((last.time_s - 2.0 * table.duration_s()).abs() < CLOSE_MM)
}
