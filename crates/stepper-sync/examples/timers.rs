//! What three kinds of timers make of the same pulse rate: an 8051 that is written by its
//! interrupt, an STM32 that reloads itself, a `SysTick` that counts down.
//!
//! `cargo run -p stepper-sync --example timers`

use core::error::Error;
use core::time::Duration;

use stepper_sync::CounterWidth::{Bits16, Bits24};
use stepper_sync::{Rate, Timer, Trains};

/// Ticks from the stop of the 8051's timer to its start, while the reload is added.
const STOPPED_TICKS: u32 = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let rate = Rate::from_millihertz(112_800)?;
    println!(
        "{} mHz, an edge every {} ns",
        rate.to_millihertz(),
        rate.half_period_ns()
    );
    let timers = [
        (
            "8051, 11.0592 MHz",
            Timer::up_to_overflow(11_059_200, 12, Bits16)?,
        ),
        (
            "STM32, 72 MHz",
            Timer::up_to_compare(72_000_000, 72, Bits16)?,
        ),
        (
            "SysTick, 168 MHz",
            Timer::down_to_zero(168_000_000, 1, Bits24)?,
        ),
    ];
    for (name, timer) in timers {
        let exact = timer.half_period(rate)?;
        let ticks = exact.nearest();
        let reload = timer.reload(ticks)?;
        println!(
            "{name}: {} clocks a tick, {} to {} ticks a period, {} ticks in 1 ms",
            timer.clocks_per_tick(),
            timer.min_ticks(),
            timer.width().max_value() + 1,
            timer.ticks_in(Duration::from_millis(1))?,
        );
        println!(
            "  {ticks} ticks are {reload:#x} in the register, {} ppm off: {} mHz",
            exact.error_ppm(ticks),
            timer.half_period_to_millihertz(timer.ticks_of_reload(reload)?)?,
        );
    }

    // The 8051's interrupt came 23 ticks after the overflow: so much less is left to the next edge.
    let [(_, mcs51), ..] = timers;
    let ticks = mcs51.half_period(rate)?.nearest();
    let late = mcs51.compensated_reload(23, ticks, STOPPED_TICKS)?;
    println!(
        "written 23 ticks late: {late:#x} in place of {:#x}",
        mcs51.reload(ticks)?
    );

    // A slow motor next to a fast one: intervals longer than the counter, cut into periods.
    let [_, slow] = Trains::new([3000, 2], ticks)?.axes();
    for reload in mcs51.reloads(slow).take(3) {
        let reload = reload?;
        println!("{:#06x}, the pin toggles: {}", reload.value, reload.toggles);
    }
    Ok(())
}
