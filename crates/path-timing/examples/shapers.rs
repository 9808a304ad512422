//! Shapers against a vibration of 40 Hz: what each costs in time, what it leaves, also where the
//! machine rings higher or lower than thought.
//!
//! `cargo run -p path-timing --example shapers`

use core::error::Error;

use path_timing::{AxisLimits, Curve, Impulse, Knot, Mode, Row, Shaped, Shaper, Table};

fn main() -> Result<(), Box<dyn Error>> {
    let mode = |hz| Mode { hz, damping: 0.05 };
    // Two modes: the products of the impulses of a shaper for each.
    let (low, high) = (Shaper::zv(mode(40.0))?, Shaper::zv(mode(90.0))?);
    let mut both: Vec<Impulse> = Vec::with_capacity(Shaper::MAX_IMPULSES);
    for a in low.impulses() {
        both.extend(high.impulses().iter().map(|b| Impulse {
            time_s: a.time_s + b.time_s,
            amplitude: a.amplitude * b.amplitude,
        }));
    }
    both.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    let shapers = [
        ("ZV", low),
        ("two hump", Shaper::two_hump(mode(40.0))?),
        ("three hump", Shaper::three_hump(mode(40.0))?),
        ("ZV twice", Shaper::from_impulses(&both)?),
    ];

    let axis = AxisLimits {
        speed: 300.0,
        acceleration: 5000.0,
        jerk: None,
    }; // mm, s
    let mut knots = [Knot::default(); 41];
    let table = Table::plan([Curve::line([0.0], [80.0])?], [axis], |_| 40, &mut knots)?;
    for (name, shaper) in shapers {
        let [low, thought, high] = [34.0, 40.0, 46.0].map(|hz| 100.0 * shaper.residual(mode(hz)));
        println!(
            "{name:>10}: {low:4.1} % at 34 Hz, {thought:4.1} % at 40 Hz, {high:4.1} % at 46 Hz"
        );
        let mut memory = vec![Row::default(); Shaped::memory_for(table.rows(), &[shaper])];
        let mut rows = Shaped::new(table.rows(), [shaper], &mut memory);
        let last = rows.by_ref().last().ok_or("no rows")??;
        println!(
            "            {:.4} s behind in the middle, {:.4} s at the end: {:.4} s",
            rows.delay_s(),
            rows.longest_delay_s(),
            last.time_s
        );
    }

    // On an arc the tool stays on its path where what is shaped is the place along it.
    let arc = Curve::arc([40.0, 0.0], [0.0, 0.0], [0.0, 1.0], 3.0)?;
    let mut knots = [Knot::default(); 101];
    let table = Table::plan([arc], [axis; 2], |_| 100, &mut knots)?;
    let mut memory = [Row::default(); 104];
    let course = table.rows().map(|row| row.course(&arc));
    let mut off = 0.0_f64;
    for row in Shaped::new(course, [low], &mut memory) {
        let [x, y] = row?.on(&arc)?.position;
        off = off.max((x.hypot(y) - 40.0).abs());
    }
    println!("along an arc: rows within {off:.1e} mm of it");
    Ok(())
}
