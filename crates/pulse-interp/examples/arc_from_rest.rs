//! A semicircle from rest to rest: a ramp over the length of the path is the clock, the arc says
//! which axis steps.
#![expect(clippy::print_stdout, reason = "that is what an example is for")]

use core::error::Error;

use pulse_interp::{Arc, Rule, StepIntervals, Turn};
use pvt_steps::{Ramp, RampLimits, Rate};

fn main() -> Result<(), Box<dyn Error>> {
    // 100 steps/mm: up to 50 mm/s at 500 mm/s², on a timer of 1 MHz.
    let limits = RampLimits {
        start_millihertz: 0,
        max_millihertz: 5_000_000,
        accel_steps_per_s2: 50_000,
    };
    let arc = Arc::new([400, 0], [-400, 0], Turn::CounterClockwise)?;
    let mut steps = arc.steps(Rule::Nearest);
    // The length of the path is an axis of its own: pi · 400 step lengths, rounded up.
    let length = i32::try_from(arc.length())?;
    let [ramp] = Ramp::new([length], &limits, Rate::from_hz(1_000_000)?)?.axes();
    let mut intervals = StepIntervals::from_units(periods(ramp));

    println!("    tick      x      y");
    let ([mut x, mut y], mut tick) = (arc.start(), 0);
    while let Some(ticks) = intervals.next(steps.factor())
        && let Some(step) = steps.next()
    {
        tick += ticks;
        x += step.dx();
        y += step.dy();
        println!("{tick:8} {x:6} {y:6}");
    }
    assert_eq!([x, y], arc.end());
    Ok(())
}

/// The intervals between pulses, from those between edges.
fn periods(mut edges: impl Iterator<Item = u64>) -> impl Iterator<Item = u32> {
    let mut pulse_ticks = 0;
    core::iter::from_fn(move || {
        let period_ticks = pulse_ticks + edges.next()?;
        pulse_ticks = edges.next()?;
        u32::try_from(period_ticks).ok()
    })
}
