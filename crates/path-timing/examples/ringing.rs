//! A move of 20 mm with a machine that rings at 40 Hz, shaped and not: how long it takes, how far
//! the axis departs from the unshaped motion, and what an oscillator on it is left with.

use core::error::Error;
use core::f64::consts::TAU;

use path_timing::{AxisLimits, Cubic, Curve, Knot, Mode, Row, Shaped, Shaper, Table};

const MODE: Mode = Mode {
    hz: 40.0,
    damping: 0.03,
};
const MOVE_MM: f64 = 20.0;

/// The vibration left of a mass on a damped spring whose other end runs the rows.
fn left_mm(rows: &[Row<[f64; 1]>]) -> f64 {
    const PARTS: u32 = 1000;
    let omega = TAU * MODE.hz;
    let (mut x, mut v) = (0.0, 0.0);
    for (from, to) in rows.iter().zip(rows.iter().skip(1)) {
        for cubic in Cubic::between(from, to) {
            let time_s = cubic.duration_s / f64::from(PARTS);
            for part in 0..PARTS {
                let end = cubic.position((f64::from(part) + 0.5) / f64::from(PARTS));
                v += (omega * (end - x) - 2.0 * MODE.damping * v) * omega * time_s;
                x += v * time_s;
            }
        }
    }
    (x - MOVE_MM).hypot(v / omega)
}

fn main() -> Result<(), Box<dyn Error>> {
    let axis = AxisLimits {
        speed: 300.0,         // mm/s
        acceleration: 5000.0, // mm/s²
        jerk: None,
    };
    let mut knots = [Knot::default(); 41];
    let table = Table::plan([Curve::line([0.0], [MOVE_MM])?], [axis], |_| 40, &mut knots)?;
    let shapers = [
        ("none", Shaper::none()),
        ("ZV", Shaper::zv(MODE)?),
        ("ZVD", Shaper::zvd(MODE)?),
        ("EI", Shaper::ei(MODE)?),
    ];
    for (name, shaper) in shapers {
        let mut memory = [Row::default(); 44];
        let rows = Shaped::new(table.rows(), [shaper], &mut memory);
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        let time_s = rows.last().ok_or("no rows")?.time_s;
        let left_um = left_mm(&rows) * 1000.0;
        let departs = shaper.departure(axis.acceleration);
        println!("{name:>4}: {time_s:.4} s, at most {departs:.3} mm off, {left_um:.1} um left");
    }
    Ok(())
}
