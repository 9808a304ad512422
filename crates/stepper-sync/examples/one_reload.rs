//! What one fixed reload per axis costs, and how a train avoids it: two motors, 30 and 7 pulses.
//!
//! `cargo run -p stepper-sync --example one_reload`

use core::error::Error;

use stepper_sync::{CounterWidth, Rounding, Trains};

fn main() -> Result<(), Box<dyn Error>> {
    let trains = Trains::new([30, 7], 4096)?;
    println!("both axes shall end at tick {}", trains.end_ticks());
    for rounding in [Rounding::Nearest, Rounding::Down] {
        for (axis, fixed) in trains.single_reload(rounding).into_iter().enumerate() {
            println!(
                "one reload, {rounding:?}: axis {axis} every {} ticks ends {} off",
                fixed.interval_ticks(),
                fixed.skew_ticks()
            );
        }
    }
    // A program that keeps the low bits of an interval alone.
    let [_, slow] = trains.single_reload(Rounding::Nearest);
    let kept = slow.kept_by(CounterWidth::Bits8);
    println!(
        "of which 8 bits are kept: it ends at tick {}",
        kept.end_ticks()
    );

    for (axis, train) in trains.axes().into_iter().enumerate() {
        println!(
            "train: axis {axis} has {} intervals of {} ticks and {} of {}: it ends at {}",
            train.remaining() - u64::from(train.long_intervals()),
            train.shortest_ticks(),
            train.long_intervals(),
            train.longest_ticks(),
            train.sum::<u64>()
        );
    }
    Ok(())
}
