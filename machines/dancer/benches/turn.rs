//! Time to plan a turn: linear in its frames, however short they are.

#![expect(clippy::unwrap_used, reason = "a bench may stop at a wrong input")]

use core::hint::black_box;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use dancer::{Easing, Law, Motor};
use pattern_codec::dance::{Threshold, Timing};

fn whole_steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("turn of 25 frames");
    for law in [Law::Reset, Law::CarrySigned] {
        let motor = Motor::new(law, Threshold::DEFAULT, Timing::DEFAULT);
        group.bench_function(format!("{law:?}"), |b| {
            b.iter(|| {
                motor
                    .turn(black_box(517), 25, Easing::Smooth)
                    .unwrap()
                    .len()
            });
        });
    }
    group.finish();
}

/// Ten times as many frames, each shorter than a step, take ten times as long.
fn short_frames(c: &mut Criterion) {
    let mut group = c.benchmark_group("turn in frames of one tick");
    let timing = Timing::new(1000, 1).unwrap();
    for law in [Law::Reset, Law::CarrySigned] {
        let motor = Motor::new(law, Threshold::DEFAULT, timing);
        for frames in [6553, 65_535] {
            group.throughput(Throughput::Elements(frames.into()));
            group.bench_function(format!("{law:?}, {frames} frames"), |b| {
                let half_steps = i32::from(frames) / 13;
                b.iter(|| {
                    motor
                        .turn(black_box(half_steps), frames, Easing::Smooth)
                        .unwrap()
                        .len()
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, whole_steps, short_frames);
criterion_main!(benches);
