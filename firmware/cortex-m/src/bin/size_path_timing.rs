//! A table along a line of two axes in f64: planned, its rows.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::convert::Infallible;
use core::hint::black_box;

use path_timing::{AxisLimits, Knot, PathFn, PathPoint, Table};

fn work() -> Option<f64> {
    let straight = |s: f64| {
        Ok::<_, Infallible>(PathPoint {
            position: [s, 0.5 * s],
            slope: [1.0, 0.5],
        })
    };
    let limits = AxisLimits {
        speed: black_box(10.0),
        acceleration: 20.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 33];
    let path = PathFn::new(black_box(100.0), straight);
    let table = Table::plan([&path], [limits; 2], |_| 32, &mut knots).ok()?;
    Some(table.rows().last()?.time_s)
}
