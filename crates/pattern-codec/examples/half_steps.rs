//! Eight motors in half steps, from the frames of a C header: prints the windings after each frame.

use pattern_codec::c_header::HeaderError;
use pattern_codec::dance::{Data, DataHeader, Packing};

/// A motor of the firmware: every tick its speed is added up, and at the threshold it steps.
#[derive(Debug, Clone, Copy, Default)]
struct Motor {
    accumulator: i32,
    half_step: u8,
}

impl Motor {
    fn tick(&mut self, speed: i8, threshold: i32) {
        self.accumulator += i32::from(speed);
        if self.accumulator.abs() >= threshold {
            let step = self.accumulator.signum();
            self.accumulator -= step * threshold;
            // 8 half steps are a turn of the currents.
            self.half_step = self.half_step.wrapping_add(if step > 0 { 1 } else { 7 }) % 8;
        }
    }

    /// The windings that carry current.
    fn windings(self) -> u8 {
        // In every other half step two of them.
        let first = self.half_step / 2;
        let second = (first + self.half_step % 2) % 4;
        1 << first | 1 << second
    }
}

fn play(header: &str) -> Result<(), HeaderError> {
    let data = Data::<8>::read(header)?;
    let threshold = data.threshold().get().into();
    let mut motors = [Motor::default(); 8];
    for speeds in data.frames() {
        for _ in 0..data.timing().frame_ticks() {
            for (motor, speed) in motors.iter_mut().zip(speeds) {
                motor.tick(speed, threshold);
            }
        }
        let windings = motors.map(|motor| format!("{:04b}", motor.windings()));
        println!("{}", windings.join(" "));
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn core::error::Error>> {
    // Two wheels at +61 and -61: a turn on the spot.
    let frames = [[0, 0, 0, 0, 0, 0, 61, -61]; 5];
    let mut header = String::new();
    let packed = DataHeader {
        packing: Packing::MaskedRuns,
        ..DataHeader::DEFAULT
    };
    packed.write(frames, &mut header)?;
    print!("{header}");
    Ok(play(&header)?)
}
