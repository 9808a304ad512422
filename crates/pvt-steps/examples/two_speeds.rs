//! Two moves that join at speed, edge by edge.
//!
//! `cargo run -p pvt-steps --example two_speeds`

use core::error::Error;

use pvt_steps::{Ramp, RampEnds, RampLimits, Rate};

fn main() -> Result<(), Box<dyn Error>> {
    let limits = RampLimits {
        start_millihertz: 0,
        max_millihertz: 2_000_000,
        accel_steps_per_s2: 10_000,
    };
    let tick_rate = Rate::from_hz(1_000_000)?;
    // 50 steps up to 1000 steps/s, then 200 more from there to rest.
    let middle = 1_000_000;
    let up = RampEnds {
        entry_millihertz: 0,
        exit_millihertz: middle,
    };
    let down = RampEnds {
        entry_millihertz: middle,
        exit_millihertz: 0,
    };
    let mut start = 0;
    for (steps, ends) in [(50, up), (200, down)] {
        let ramp = Ramp::between([steps], &limits, ends, tick_rate)?;
        println!(
            "{steps} steps from tick {start} to {}",
            start + ramp.end_ticks()
        );
        for edge in ramp.edges().take(4) {
            println!("{:>9} {:?}", start + edge.ticks, edge.level);
        }
        start += ramp.end_ticks();
    }
    Ok(())
}
