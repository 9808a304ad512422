//! A machine that rings, with and without a shaper.

use core::f64::consts::TAU;

use machine_sim::{Axis, Figure, Plot, Stroke};
use pose2pulse::path_timing::{AxisLimits, Curve, Knot, Mode, Row, Shaped, Shaper, Table};

use crate::Result;
use crate::between::between;

/// A mass on a spring whose other end moves by 20 mm, shaped and not.
pub(crate) fn figure() -> Result<Figure> {
    const MODE: Mode = Mode {
        hz: 40.0,
        damping: 0.03,
    };
    const MOVE_MM: f64 = 20.0;
    /// After the motion, in s.
    const AFTER_S: f64 = 0.1;
    const STEP_S: f64 = 1e-5;
    let axis = AxisLimits {
        speed: 300.0,         // mm/s
        acceleration: 5000.0, // mm/s²
        jerk: None,
    };
    let mut knots = [Knot::default(); 41];
    let table = Table::plan([Curve::line([0.0], [MOVE_MM])?], [axis], |_| 40, &mut knots)?;
    let mut plot = Plot::chart(
        Axis::new("time in s"),
        Axis::new("mass, off its place in mm"),
    )
    .with_height(300.0);
    for (index, (name, shaper)) in [
        ("none", Shaper::none()),
        ("ZV", Shaper::zv(MODE)?),
        ("EI", Shaper::ei(MODE)?),
    ]
    .into_iter()
    .enumerate()
    {
        let mut memory = [Row::default(); 44];
        let rows = Shaped::new(table.rows(), [shaper], &mut memory);
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        let omega = TAU * MODE.hz;
        let (mut x, mut v, mut time_s) = (0.0, 0.0, 0.0);
        let mut left = Vec::new();
        let mut follow = |end: f64, until_s: f64| {
            while time_s < until_s {
                v += (omega * (end - x) - 2.0 * MODE.damping * v) * omega * STEP_S;
                x += v * STEP_S;
                time_s += STEP_S;
            }
            left.push([time_s, x - end]);
        };
        for (time_s, [end], _) in between(&rows) {
            follow(end, time_s);
        }
        let end_s = rows.last().ok_or("no rows")?.time_s;
        for place in 0..=200_u32 {
            follow(MOVE_MM, end_s + AFTER_S * f64::from(place) / 200.0);
        }
        plot = plot.line(name, Stroke::series(index), left);
    }
    Ok(
        Figure::new("A move of 20 mm with a machine that rings at 40 Hz")
            .with_note("The mass rides on a spring: how far it is from where the motor is")
            .with_row([plot]),
    )
}
