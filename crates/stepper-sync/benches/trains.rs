//! Edges per second: two and eight synchronised trains in time order, one axis alone.
#![expect(clippy::expect_used, reason = "a bench with wrong input may stop")]

use core::hint::black_box;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use stepper_sync::{AxisTrain, Edge, Trains};

/// Folds an edge so that no part of it can be left out.
fn fold(sum: u64, edge: Edge) -> u64 {
    sum.wrapping_add(edge.ticks ^ edge.axis as u64 ^ edge.level as u64)
}

fn trains<const N: usize>(c: &mut Criterion, name: &str, steps: [i32; N]) {
    let trains = Trains::new(steps, 4096).expect("legal steps");
    let mut group = c.benchmark_group(name);
    group.throughput(Throughput::Elements(trains.edges().remaining()));
    group.bench_function("time order", |b| {
        b.iter(|| black_box(&trains).edges().fold(0, fold));
    });
    group.bench_function("time order, for loop", |b| {
        b.iter(|| {
            let mut sum = 0;
            for edge in black_box(&trains).edges() {
                sum = fold(sum, edge);
            }
            sum
        });
    });
    group.bench_function("per axis", |b| {
        b.iter(|| black_box(&trains).axes().map(AxisTrain::sum::<u64>));
    });
    group.finish();
}

fn two_trains(c: &mut Criterion) {
    trains(c, "two trains, 65535 and 32768", [65_535, 32_768]);
    trains(c, "two trains, 30000 and 29999", [30_000, -29_999]);
    trains(c, "two trains, 30000 and 1000", [30_000, 1000]);
}

fn eight_trains(c: &mut Criterion) {
    trains(
        c,
        "eight trains",
        [30_000, 29_999, 20_000, 17_001, 10_000, 5000, 1000, 1],
    );
}

criterion_group!(benches, two_trains, eight_trains);
criterion_main!(benches);
