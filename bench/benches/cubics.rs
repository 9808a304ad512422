//! Instructions a step along cubics, counted by callgrind.
//!
//! `cargo install gungraun-runner` once, with valgrind installed. What a bench reports, divided by
//! its count:
//!
//! | bench | divide by | for instructions per |
//! |---|---:|---|
//! | `player` | 10,230 | step of a segment, by `SegmentPlayer` in a loop |
//! | `player_by_call` | 10,230 | the same as a function of its own, its call and a sum around it included |
//! | `ramp_edges` | 80,000 | edge of `AxisRamp`, its segments included |
//! | `cubic_axis` | 40,000 | step of one axis along cubics, its segments included |
//! | `cubic_steps` | 70,000 | step of two axes along cubics in time order, the same |

use std::hint::black_box;

use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};
use pvt_steps::{
    AxisRamp, AxisSegments, PvtRow, PvtSteps, Ramp, RampLimits, Segment, SegmentPlayer,
};
use stepper_sync::{MinIntervals, Rate};

/// 1024 steps at a step in 100 ticks.
fn segment() -> Segment {
    let bytes = [0b0011_1111, 31, 0x80, 50, 128, 128, 144, 3];
    let (segment, _) = Segment::decode(&bytes).expect("written by hand");
    assert_eq!(segment.count(), 1024);
    segment
}

const PLAYED: u32 = 10;

#[library_benchmark(setup = segment)]
fn player(segment: Segment) -> u32 {
    let segment = black_box(segment);
    (0..PLAYED)
        .map(|_| black_box(segment.intervals()).sum::<u32>())
        .sum()
}

#[inline(never)]
fn next_interval(player: &mut SegmentPlayer) -> Option<u32> {
    player.next()
}

#[library_benchmark(setup = segment)]
fn player_by_call(segment: Segment) -> u32 {
    let segment = black_box(segment);
    let mut ticks = 0;
    for _ in 0..PLAYED {
        let mut player = black_box(segment.intervals());
        while let Some(interval) = next_interval(&mut player) {
            ticks += interval;
        }
    }
    ticks
}

/// 40,000 and 30,000 steps at up to 40 kHz, a third of the way in each ramp, at 72 MHz.
fn rapid() -> Ramp<2> {
    let limits = RampLimits {
        start_millihertz: 0,
        max_millihertz: black_box(40_000_000),
        accel_steps_per_s2: black_box(60_000),
    };
    let rate = Rate::from_hz(black_box(72_000_000)).expect("not zero");
    Ramp::new(black_box([40_000, -30_000]), &limits, rate).expect("limits are good")
}

fn ramp_axis() -> AxisRamp {
    let [axis, _] = rapid().axes();
    axis
}

#[library_benchmark(setup = ramp_axis)]
fn ramp_edges(axis: AxisRamp) -> u64 {
    black_box(axis).sum()
}

const LEAST: MinIntervals = MinIntervals {
    step_ticks: 274,
    reversal_ticks: 274,
};

fn axis_rows() -> (AxisSegments, Vec<PvtRow<2>>) {
    let ramp = rapid();
    let [start, _] = ramp.start();
    (AxisSegments::new(start, LEAST), ramp.rows().collect())
}

#[library_benchmark(setup = axis_rows)]
fn cubic_axis((axis, rows): (AxisSegments, Vec<PvtRow<2>>)) -> u64 {
    let mut axis = black_box(axis);
    let mut player = SegmentPlayer::new();
    let mut ticks = 0;
    for row in rows.leak() {
        let [knot, _] = row.knots;
        axis.push(row.ticks, knot).expect("slow enough");
        for segment in axis.by_ref() {
            ticks += player.load(&segment);
            for interval in player.by_ref() {
                ticks += u64::from(interval);
            }
        }
    }
    ticks
}

fn merged_rows() -> (PvtSteps<2>, Vec<PvtRow<2>>) {
    let ramp = rapid();
    (PvtSteps::new(ramp.start(), LEAST), ramp.rows().collect())
}

#[library_benchmark(setup = merged_rows)]
fn cubic_steps((steps, rows): (PvtSteps<2>, Vec<PvtRow<2>>)) -> u64 {
    let mut steps = black_box(steps);
    let mut sum = 0;
    for row in rows.leak() {
        steps.push(row).expect("slow enough");
        for step in steps.by_ref() {
            sum ^= step.ticks ^ step.axis as u64;
        }
    }
    sum
}

library_benchmark_group!(
    name = segments;
    // At most 30 instructions a step.
    config = LibraryBenchmarkConfig::default().tool(
        Callgrind::default().hard_limits([(EventKind::Ir, 30 * 1023 * u64::from(PLAYED))])
    );
    benchmarks = player, player_by_call
);
library_benchmark_group!(
    name = ramp;
    // At most 60 instructions an edge.
    config = LibraryBenchmarkConfig::default().tool(
        Callgrind::default().hard_limits([(EventKind::Ir, 60 * 80_000)])
    );
    benchmarks = ramp_edges
);
library_benchmark_group!(
    name = axis;
    // At most 60 instructions a step.
    config = LibraryBenchmarkConfig::default().tool(
        Callgrind::default().hard_limits([(EventKind::Ir, 60 * 40_000)])
    );
    benchmarks = cubic_axis
);
library_benchmark_group!(
    name = axes;
    // At most 60 instructions a step.
    config = LibraryBenchmarkConfig::default().tool(
        Callgrind::default().hard_limits([(EventKind::Ir, 60 * 70_000)])
    );
    benchmarks = cubic_steps
);

main!(library_benchmark_groups = segments, ramp, axis, axes);
