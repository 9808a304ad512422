//! Eight unipolar motors on one tick: speeds in, bytes for the latches of their windings out.
//!
//! `cargo run -p motor-phases --example half_step_eight_motors`

use core::error::Error;
use motor_phases::{Accumulation, LatchWrites, Latches, Phases, Rate, SpeedLaw, Stepping, Wiring};
use stepper_sync::Position;

/// Ticks for which a row of speeds holds: 200 ms.
const FRAME_TICKS: u32 = 200;
/// A speed of 120 is a step in 5 ticks.
const SPEEDS: [[i8; 8]; 3] = [
    [60, -60, 0, 0, 0, 0, 0, 127],
    [120, -120, 30, 0, 0, 15, 0, 127],
    [0, 0, 30, 60, 90, 15, -128, 0],
];

fn main() -> Result<(), Box<dyn Error>> {
    let tick_rate = Rate::from_hz(1000)?;
    let accumulation = Accumulation::new(SpeedLaw::CarrySigned, 600, tick_rate)?;
    for speed in [15, 120, -128] {
        let (per_tick, millihertz) = (
            accumulation.steps_per_tick(speed),
            accumulation.millihertz(speed),
        );
        println!("speed {speed}: {per_tick} half steps a tick, {millihertz} mHz");
    }
    let mut motors = accumulation.motors::<8>();
    let windings = Phases::new(Stepping::Half, Wiring::UNIPOLAR)?;
    let mut phases = [windings.start(); 8];
    let mut latches = Latches::<8>::new();
    let mut position = Position::<8>::home();
    for speeds in SPEEDS {
        motors.set_speeds(speeds);
        for _ in 0..FRAME_TICKS {
            // What the interrupt handler does.
            let steps = motors.tick();
            let mut bytes = [None; 8];
            for ((phase, step), byte) in phases.iter_mut().zip(steps).zip(&mut bytes) {
                *phase = windings.advance(*phase, step);
                *byte = (step != 0).then(|| windings.byte(*phase));
            }
            for write in LatchWrites::new(bytes) {
                latches.write(write)?;
            }
            position.apply(steps)?;
        }
        println!("half steps {:?}", position.steps());
        println!("windings   {:?}", latches.outputs());
    }
    println!("towards the next step {:?}", motors.sums());
    let nibbles = phases.map(|phase| format!("{:04b}", windings.nibble(phase)));
    println!(
        "windings {}; off: {:04b}, the byte {:#04x}",
        nibbles.join(" "),
        windings.off_nibble(),
        windings.off_byte()
    );
    Ok(())
}
