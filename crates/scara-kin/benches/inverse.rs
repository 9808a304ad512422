//! Time per call of the kinematics, beside a bare loop of the same arithmetic.
//!
//! Ratios within one run count, not the figures: a machine's speed drifts.
#![expect(clippy::expect_used, reason = "a bench stops at once")]

use core::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, Elbow, JointRange, Joints, Limits};

const LINK: f64 = 132.0;
const POINTS: u32 = 4096;

/// Points spread evenly over the annulus, in an order that jumps about.
fn points() -> Vec<Point2<f64>> {
    (0..POINTS)
        .map(|k| {
            let golden = f64::from(k) * 2.399_963_229_728_653;
            let r = 2.0 * LINK * (f64::from(k) + 0.5).sqrt() / f64::from(POINTS).sqrt();
            Point2::new(r * golden.cos(), r * golden.sin())
        })
        .collect()
}

/// The same arithmetic without base, checks, limits or types: both elbows.
fn bare(x: f64, y: f64) -> [f64; 4] {
    let r2 = x * x + y * y;
    let r = r2.sqrt();
    let s2 = r2 * ((2.0 * LINK - r) * (2.0 * LINK + r));
    let s = s2.max(0.0).sqrt();
    let elbow = libm::atan2(s, (r - LINK) * (r + LINK) - LINK * LINK);
    let right = libm::atan2(r2 * y - s * x, r2 * x + s * y);
    let left = libm::atan2(r2 * y + s * x, r2 * x - s * y);
    [right, elbow, left, -elbow]
}

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
    group.finish();

    let line = [Point2::new(-200.0, 30.0), Point2::new(200.0, 30.0)];
    let waypoints = arm
        .follow(line, Elbow::Right, 0.001)
        .map_or(0, |path| path.len());
    let mut group = c.benchmark_group("follow");
    group.throughput(Throughput::Elements(u64::try_from(waypoints).unwrap_or(0)));
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
