//! Time per call of the kinematics, beside a bare loop of the same arithmetic.
//!
//! Ratios within one run count, not the figures: a machine's speed drifts.
#![expect(clippy::expect_used, reason = "a bench stops at once")]

mod bare;
mod points;

use core::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, Elbow, JointRange, Joints, Limits};

use bare::bare;
use points::{LINK, POINTS, points};

fn inverse(c: &mut Criterion) {
    let points = points();
    let arm = Arm::new(LINK, LINK).expect("lengths are good");
    let free = JointRange::new(-7.0, 7.0).expect("range is good");
    let limited = arm.with_limits(Limits {
        shoulder: free,
        elbow: free,
    });
    let mut group = c.benchmark_group("inverse, both elbows");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    group.bench_function("bare loop", |b| {
        b.iter(|| {
            for p in &points {
                black_box(bare(black_box(p.x), black_box(p.y)));
            }
        });
    });
    for (name, arm) in [("Arm::inverse", arm), ("Arm::inverse with limits", limited)] {
        group.bench_function(name, |b| {
            b.iter(|| {
                for p in &points {
                    let _ = black_box(arm.inverse(black_box(*p)));
                }
            });
        });
    }
    group.bench_function("Arm::inverse_each", |b| {
        b.iter(|| {
            arm.inverse_each(black_box(&points)).for_each(|found| {
                let _ = black_box(found);
            });
        });
    });
    group.finish();
}

fn others(c: &mut Criterion) {
    let points = points();
    let arm = Arm::new(LINK, LINK).expect("lengths are good");
    let mut group = c.benchmark_group("one call");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    group.bench_function("inverse_elbow", |b| {
        b.iter(|| {
            for p in &points {
                let _ = black_box(arm.inverse_elbow(black_box(*p), Elbow::Right));
            }
        });
    });
    group.bench_function("forward", |b| {
        b.iter(|| {
            for p in &points {
                black_box(arm.forward(black_box(Joints::new(p.x, p.y))));
            }
        });
    });
    let poses: Vec<_> = points.iter().map(|p| Joints::new(p.x, p.y)).collect();
    group.bench_function("forward_each", |b| {
        b.iter(|| {
            arm.forward_each(black_box(&poses)).for_each(|point| {
                black_box(point);
            });
        });
    });
    group.finish();

    let line = [Point2::new(-200.0, 30.0), Point2::new(200.0, 30.0)];
    let waypoints = arm
        .follow(line, Elbow::Right, 0.001)
        .map_or(0, |path| path.remaining());
    let mut group = c.benchmark_group("follow");
    group.throughput(Throughput::Elements(waypoints));
    group.bench_function("waypoints, checked and handed out", |b| {
        b.iter(|| {
            arm.follow(black_box(line), Elbow::Right, 0.001)
                .map_or(0.0, |path| path.map(|w| w.joints.shoulder).sum())
        });
    });
    group.finish();
}

criterion_group!(benches, inverse, others);
criterion_main!(benches);
