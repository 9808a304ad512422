//! Instructions per call, counted by callgrind: the same from run to run.
//!
//! `cargo install gungraun-runner` once, with valgrind installed.
//!
//! Instructions per item: what a bench reports, divided by its count below; call, setting up and
//! return cost less than one part in a thousand.
//!
//! | bench | divide by | for instructions per |
//! |---|---:|---|
//! | `inverse_bare`, `inverse_both` | 1 | call |
//! | `train_edges` | 59,998 | edge of `AxisTrain` in a loop |
//! | `train_edges_by_call` | 59,998 | the same as a function of its own, its call and a sum around it included |
//! | `merged_edges` | 119,998 | edge of two trains in time order |
//! | `ticks_of_eight` | 10,000 | tick of eight accumulators in a loop |
//! | `ticks_of_eight_by_call` | 10,000 | the same as a function of its own, its call included |
//! | `decoded_records` | 65,536 | record of three bytes |
//! | `sines`, `sines_in_lanes`, `angles`, `angles_in_lanes` | 1024 | value of f64 |
//! | `sines_of_libm`, `angles_of_libm` | 1024 | the same by `libm` |
//!
//! The bytes of 3964R are counted in its own crate:
//! `cargo bench -p proto3964r --bench instructions`.

#[path = "../../crates/scara-kin/benches/inverse/bare.rs"]
mod bare;

use std::hint::black_box;

use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};
use motor_phases::{Accumulation, Accumulators, SpeedLaw};
use pattern_codec::engraving::{Format, Record};
use scara_kin::Arm;
use scara_kin::nalgebra::Point2;
use stepper_sync::{AxisTrain, Rate, Trains};

fn point() -> Point2<f64> {
    Point2::new(150.0, 80.0)
}

fn arm() -> (Arm, Point2<f64>) {
    (pose2pulse_bench::arm(), point())
}

#[library_benchmark(setup = point)]
fn inverse_bare(point: Point2<f64>) -> [f64; 4] {
    black_box(bare::bare(point.x, point.y))
}

#[library_benchmark(setup = arm)]
fn inverse_both((arm, point): (Arm, Point2<f64>)) {
    let _ = black_box(black_box(arm).inverse(point));
}

fn trains() -> Trains<2> {
    Trains::new(black_box([30_000, -29_999]), black_box(4096)).expect("steps and period are good")
}

fn train() -> AxisTrain {
    let [_, train] = trains().axes();
    train
}

// Uneven intervals: 59,998 edges in the time of 60,000.
#[library_benchmark(setup = train)]
fn train_edges(train: AxisTrain) -> u64 {
    black_box(train).sum()
}

#[inline(never)]
fn next(train: &mut AxisTrain) -> Option<u64> {
    train.next()
}

#[library_benchmark(setup = train)]
fn train_edges_by_call(train: AxisTrain) -> u64 {
    let mut train = black_box(train);
    let mut ticks = 0;
    while let Some(interval) = next(&mut train) {
        ticks += interval;
    }
    ticks
}

// 60,000 and 59,998 edges.
#[library_benchmark(setup = trains)]
fn merged_edges(trains: Trains<2>) -> u64 {
    black_box(trains)
        .edges()
        .fold(0, |sum, edge| sum ^ edge.ticks ^ edge.axis as u64)
}

const TICKS: u32 = 10_000;

fn eight(law: SpeedLaw) -> Accumulators<8> {
    let tick = Rate::from_hz(1000).expect("not zero");
    let mut motors = Accumulation::new(law, black_box(600), tick)
        .expect("threshold is good")
        .motors();
    motors.set_speeds(black_box([127, -127, 100, -60, 33, 7, 0, -128]));
    motors
}

#[library_benchmark(setup = eight)]
#[bench::reset(SpeedLaw::Reset)]
#[bench::carry_magnitude(SpeedLaw::CarryMagnitude)]
#[bench::carry_signed(SpeedLaw::CarrySigned)]
fn ticks_of_eight(motors: Accumulators<8>) {
    let mut motors = black_box(motors);
    for _ in 0..TICKS {
        black_box(&motors.tick());
    }
}

#[inline(never)]
fn tick(motors: &mut Accumulators<8>) -> [i32; 8] {
    motors.tick()
}

#[library_benchmark(setup = eight)]
#[bench::reset(SpeedLaw::Reset)]
#[bench::carry_magnitude(SpeedLaw::CarryMagnitude)]
#[bench::carry_signed(SpeedLaw::CarrySigned)]
fn ticks_of_eight_by_call(motors: Accumulators<8>) {
    let mut motors = black_box(motors);
    for _ in 0..TICKS {
        black_box(&tick(&mut motors));
    }
}

/// Records of random counts and signs: one FAST in 32, the share of its mark.
fn records() -> Vec<u8> {
    const RECORDS: usize = 65_536;
    let mut state = 0x2545_F491_u32;
    let mut below = |end: u32| {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        (u64::from(state) * u64::from(end) >> 32) as u8
    };
    let mut bytes = Vec::with_capacity(3 * RECORDS);
    for _ in 0..RECORDS {
        match below(32) {
            31 => bytes.extend([below(8) << 5 | 31, below(256), below(256)]),
            disc => bytes.extend([disc, below(31), below(31)].map(|count| count | below(2) << 7)),
        }
    }
    bytes
}

#[library_benchmark(setup = records)]
fn decoded_records(bytes: Vec<u8>) -> i32 {
    let format = black_box(Format::default());
    let mut sum = 0;
    for located in format.records(&bytes) {
        match located.expect("all are records").record {
            Record::Fast(fast) => sum ^= fast.pulses(),
            Record::Slow(slow) => sum ^= slow.pulses().elbow,
        }
    }
    // Freeing them is no decoding.
    std::mem::forget(bytes);
    sum
}

/// Evenly from -3 to 3.
fn numbers() -> Vec<f64> {
    (0..1024_u32)
        .map(|n| f64::from(n.wrapping_mul(2_654_435_769)) * (6.0 / 4_294_967_296.0) - 3.0)
        .collect()
}

fn sum_of_sines(numbers: &[f64], sin_cos: impl Fn(f64) -> (f64, f64)) -> f64 {
    numbers
        .iter()
        .map(|&x| sin_cos(x))
        .fold(0.0, |sum, (sin, cos)| sum + sin + cos)
}

fn sum_of_angles(numbers: &[f64], atan2: impl Fn(f64, f64) -> f64) -> f64 {
    numbers
        .iter()
        .zip(numbers.iter().rev())
        .map(|(&y, &x)| atan2(y, x))
        .sum()
}

#[library_benchmark(setup = numbers)]
fn sines(numbers: Vec<f64>) -> f64 {
    sum_of_sines(numbers.leak(), trig_kernels::sin_cos)
}

#[library_benchmark(setup = numbers)]
fn sines_of_libm(numbers: Vec<f64>) -> f64 {
    sum_of_sines(numbers.leak(), libm::sincos)
}

#[library_benchmark(setup = numbers)]
fn sines_in_lanes(numbers: Vec<f64>) -> f64 {
    let (chunks, _) = numbers.leak().as_chunks::<8>();
    chunks
        .iter()
        .map(|&x| trig_kernels::sin_cos_lanes(x))
        .fold(0.0, |sum, (sin, cos)| sum + sin[0] + cos[0])
}

#[library_benchmark(setup = numbers)]
fn angles(numbers: Vec<f64>) -> f64 {
    sum_of_angles(numbers.leak(), trig_kernels::atan2)
}

#[library_benchmark(setup = numbers)]
fn angles_of_libm(numbers: Vec<f64>) -> f64 {
    sum_of_angles(numbers.leak(), libm::atan2)
}

#[library_benchmark(setup = numbers)]
fn angles_in_lanes(numbers: Vec<f64>) -> f64 {
    let (chunks, _) = numbers.leak().as_chunks::<8>();
    chunks
        .iter()
        .zip(chunks.iter().rev())
        .map(|(&y, &x)| trig_kernels::atan2_lanes(y, x)[0])
        .sum()
}

library_benchmark_group!(name = kinematics; benchmarks = inverse_bare, inverse_both);
library_benchmark_group!(
    name = pulses;
    benchmarks = train_edges, train_edges_by_call, merged_edges
);
library_benchmark_group!(
    name = accumulators;
    // At most 60 instructions a tick.
    config = LibraryBenchmarkConfig::default().tool(
        Callgrind::default().hard_limits([(EventKind::Ir, 60 * u64::from(TICKS) + 100)])
    );
    benchmarks = ticks_of_eight, ticks_of_eight_by_call
);
library_benchmark_group!(name = patterns; benchmarks = decoded_records);
library_benchmark_group!(
    name = trigonometry;
    benchmarks = sines, sines_of_libm, sines_in_lanes, angles, angles_of_libm, angles_in_lanes
);

main!(
    library_benchmark_groups = kinematics,
    pulses,
    accumulators,
    patterns,
    trigonometry
);
