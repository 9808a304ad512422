//! Five minutes of dance: 1500 frames of 200 ticks for eight motors, from speeds to what the
//! latches hold.
#![expect(clippy::expect_used, reason = "a bench with wrong input may stop")]

use core::hint::black_box;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use motor_phases::{Accumulation, LatchWrites, Latches, Phases, Rate, SpeedLaw, Stepping, Wiring};

const FRAMES: usize = 1500;
const FRAME_TICKS: u64 = 200;

/// Every speed comes up on every motor.
fn frames() -> Vec<[i8; 8]> {
    let mut speed = 0_i8;
    let mut next = || {
        speed = speed.wrapping_add(57);
        speed
    };
    (0..FRAMES).map(|_| [(); 8].map(|()| next())).collect()
}

/// Ticks alone; the positions of the motors at the end.
fn positions(accumulation: &Accumulation, frames: &[[i8; 8]]) -> [i32; 8] {
    let mut motors = accumulation.motors();
    let mut positions = [0; 8];
    for &frame in frames {
        motors.set_speeds(frame);
        for _ in 0..FRAME_TICKS {
            for (position, step) in positions.iter_mut().zip(motors.tick()) {
                *position += step;
            }
        }
    }
    positions
}

/// With phases, the writes on the bus and the latches; what they hold at the end.
fn outputs(accumulation: &Accumulation, frames: &[[i8; 8]]) -> [u8; 8] {
    let phases = Phases::new(Stepping::Half, Wiring::UNIPOLAR).expect("four bits");
    let mut motors = accumulation.motors();
    let mut at = [phases.start(); 8];
    let mut latches = Latches::<8>::new();
    for &frame in frames {
        motors.set_speeds(frame);
        for _ in 0..FRAME_TICKS {
            let mut bytes = [None; 8];
            for ((phase, step), byte) in at.iter_mut().zip(motors.tick()).zip(&mut bytes) {
                if step != 0 {
                    *phase = phases.advance(*phase, step);
                    *byte = Some(phases.byte(*phase));
                }
            }
            for write in LatchWrites::new(bytes) {
                latches.write(write).expect("data is still under a strobe");
            }
        }
    }
    latches.outputs()
}

fn five_minutes(c: &mut Criterion) {
    let frames = frames();
    let tick = Rate::from_hz(1000).expect("not zero");
    let mut group = c.benchmark_group("five minutes of eight motors");
    group.throughput(Throughput::Elements(FRAMES as u64 * FRAME_TICKS));
    for law in [
        SpeedLaw::Reset,
        SpeedLaw::CarryMagnitude,
        SpeedLaw::CarrySigned,
    ] {
        let accumulation = Accumulation::new(law, 600, tick).expect("legal threshold");
        group.bench_function(format!("positions, {law:?}"), |b| {
            b.iter(|| positions(black_box(&accumulation), black_box(&frames)));
        });
        group.bench_function(format!("latches, {law:?}"), |b| {
            b.iter(|| outputs(black_box(&accumulation), black_box(&frames)));
        });
    }
    group.finish();
}

criterion_group!(benches, five_minutes);
criterion_main!(benches);
