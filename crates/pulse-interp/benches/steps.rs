//! Steps per second of each rule, of lines and of arcs.
#![expect(clippy::expect_used, reason = "a bench with wrong input may stop")]

use core::hint::black_box;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pulse_interp::{Arc, AxesLine, Line, Move, Rule, Turn};

/// Folds a move so that no part of it can be left out.
fn fold(sum: u32, step: Move) -> u32 {
    sum.wrapping_add(step as u32)
}

fn lines(c: &mut Criterion) {
    let line = Line::new([61_803, -38_197]).expect("legal end");
    let mut group = c.benchmark_group("line");
    group.throughput(Throughput::Elements(100_000));
    for (name, rule) in [("published", Rule::Published), ("nearest", Rule::Nearest)] {
        group.bench_function(name, |b| {
            b.iter(|| black_box(&line).steps(rule).fold(0, fold));
        });
    }
    group.throughput(Throughput::Elements(61_803));
    group.bench_function("bresenham", |b| {
        b.iter(|| black_box(&line).moves().fold(0, fold));
    });
    let space = AxesLine::new([61_803, -38_197, 20_000]).expect("legal end");
    group.throughput(Throughput::Elements(120_000));
    group.bench_function("three axes", |b| {
        b.iter(|| {
            let steps = black_box(&space).steps();
            steps.fold(0, |sum, step| sum ^ step.axis)
        });
    });
    group.finish();
}

fn arcs(c: &mut Criterion) {
    let start = [12_500, 0];
    let circle = Arc::new(start, start, Turn::CounterClockwise).expect("legal end");
    let mut group = c.benchmark_group("circle");
    group.throughput(Throughput::Elements(100_000));
    for (name, rule) in [("published", Rule::Published), ("nearest", Rule::Nearest)] {
        group.bench_function(name, |b| {
            b.iter(|| black_box(&circle).steps(rule).fold(0, fold));
        });
        group.bench_function(format!("{name}, with factors"), |b| {
            b.iter(|| {
                let (mut steps, mut sum) = (black_box(&circle).steps(rule), 0);
                loop {
                    let factor = steps.factor().to_q16();
                    let Some(step) = steps.next() else {
                        return sum;
                    };
                    sum = fold(sum, step) ^ factor;
                }
            });
        });
    }
    group.throughput(Throughput::Elements(circle.moves().remaining()));
    group.bench_function("midpoint", |b| {
        b.iter(|| black_box(&circle).moves().fold(0, fold));
    });
    group.finish();
}

criterion_group!(benches, lines, arcs);
criterion_main!(benches);
