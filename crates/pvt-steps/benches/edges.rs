//! Edges per second of a ramp, steps per second along the cubics of a circle.
#![expect(clippy::expect_used, reason = "a bench with wrong input may stop")]

use core::hint::black_box;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pvt_steps::{
    AxisRamp, AxisSegments, Edge, MinIntervals, PvtKnot, PvtQuantiser, PvtRow, PvtSteps, Ramp,
    RampLimits, Rate, SegmentPlayer, StepScale,
};

/// Folds an edge so that no part of it can be left out.
fn fold(sum: u64, edge: Edge) -> u64 {
    sum.wrapping_add(edge.ticks ^ edge.axis as u64 ^ edge.level as u64)
}

fn ramps(c: &mut Criterion) {
    let limits = RampLimits {
        start_millihertz: 100_000,
        max_millihertz: 20_000_000,
        accel_steps_per_s2: 20_000,
    };
    let rate = Rate::from_hz(1_000_000).expect("not zero");
    // s_a = 9999.75 steps: all ramp, no constant speed.
    let ramp = Ramp::new([19_999, -12_345], &limits, rate).expect("legal ramp");
    let mut group = c.benchmark_group("ramp of two axes, 19999 and 12345");
    let edges = ramp.axes().iter().map(AxisRamp::remaining).sum();
    group.throughput(Throughput::Elements(edges));
    group.bench_function("time order", |b| {
        b.iter(|| black_box(&ramp).edges().fold(0, fold));
    });
    group.finish();
}

const LEAST: MinIntervals = MinIntervals {
    step_ticks: 100,
    reversal_ticks: 100,
};

/// A turn of a circle in a second as rows of a table, two axes with `radius` steps each, at 72 MHz.
fn circle(radius: f64, rows: u32) -> ([PvtKnot; 2], Vec<PvtRow<2>>) {
    let rate = Rate::from_hz(72_000_000).expect("not zero");
    let one = StepScale::new(1.0).expect("in range");
    let mut table = PvtQuantiser::new(rate, [one; 2], [0.0, radius]).expect("in range");
    let turn = core::f64::consts::TAU;
    let start = table.jump([radius * turn, 0.0]).expect("in range").knots;
    let row = |row: u32| {
        let time_s = f64::from(row) / f64::from(rows);
        let (sin, cos) = (turn * time_s).sin_cos();
        let positions = [radius * sin, radius * cos];
        let velocities = [radius * turn * cos, -radius * turn * sin];
        table.row(time_s, positions, velocities).expect("in range")
    };
    (start, (1..=rows).map(row).collect())
}

fn merged(start: [PvtKnot; 2], rows: &[PvtRow<2>]) -> (u64, u64) {
    let (mut count, mut sum) = (0, 0_u64);
    let mut steps = PvtSteps::new(start, LEAST);
    for row in rows {
        steps.push(row).expect("slow enough");
        for step in &mut steps {
            count += 1;
            sum = sum.wrapping_add(step.ticks ^ step.axis as u64 ^ step.direction as u64);
        }
    }
    (count, sum)
}

fn one_by_one(start: [PvtKnot; 2], rows: &[PvtRow<2>]) -> u64 {
    let mut ticks = 0_u64;
    for (axis, start) in start.into_iter().enumerate() {
        let mut segments = AxisSegments::new(start, LEAST);
        let mut player = SegmentPlayer::new();
        for row in rows {
            let knot = row.knots.get(axis).copied().expect("two axes");
            segments.push(row.ticks, knot).expect("slow enough");
            for segment in segments.by_ref() {
                ticks = ticks.wrapping_add(player.load(&segment));
                for interval in player.by_ref() {
                    ticks = ticks.wrapping_add(interval.into());
                }
            }
        }
    }
    ticks
}

fn cubics(c: &mut Criterion) {
    for (radius, rows) in [(20_000.0, 256), (2000.0, 256)] {
        let (start, rows) = circle(radius, rows);
        let (count, _) = merged(start, &rows);
        let per_row = count / (2 * rows.len() as u64);
        let mut group = c.benchmark_group(format!("circle, {per_row} steps a row and axis"));
        group.throughput(Throughput::Elements(count));
        group.bench_function("time order", |b| {
            b.iter(|| merged(black_box(start), black_box(&rows)));
        });
        group.bench_function("per axis", |b| {
            b.iter(|| one_by_one(black_box(start), black_box(&rows)));
        });
        group.finish();
    }
}

criterion_group!(benches, ramps, cubics);
criterion_main!(benches);
