//! Time per call of the kinematics, beside bare loops of the same arithmetic, and of a calibration.
//!
//! Ratios within one run count, not the figures: a machine's speed drifts.
#![expect(clippy::expect_used, reason = "a bench stops at once")]
#![expect(
    clippy::indexing_slicing,
    reason = "the bare loop is as bare as may be"
)]

mod bare;
mod eleven;
mod points;

use core::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{ArmRange, Delta, Dimensions, Measured, PlatformPath, SpeedLimits};

use bare::{BASE, LOWER, PLATFORM, UPPER};
use eleven::eleven;
use points::{POINTS, points};

fn delta() -> Delta {
    Delta::new(Dimensions {
        base: BASE,
        platform: PLATFORM,
        upper: UPPER,
        lower: LOWER,
    })
    .expect("lengths are good")
}

fn inverse(c: &mut Criterion) {
    let (points, arms) = (points(), bare::directions());
    let limited = delta()
        .with_range(ArmRange::new(-1.0, 3.0).expect("range is good"))
        .with_ball_joints(1.0)
        .expect("angle is good");
    let mut group = c.benchmark_group("inverse, three arms");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    group.bench_function("bare loop", |b| {
        b.iter(|| {
            for p in &points {
                black_box(bare::inverse(&arms, black_box([p.x, p.y, p.z])));
            }
        });
    });
    for (name, delta) in [
        ("Delta::inverse", delta()),
        ("Delta::inverse with limits", limited),
    ] {
        group.bench_function(name, |b| {
            b.iter(|| {
                for p in &points {
                    let _ = black_box(delta.inverse(black_box(*p)));
                }
            });
        });
    }
    group.finish();
}

fn forward(c: &mut Criterion) {
    let (delta, arms) = (delta(), bare::directions());
    let angles: Vec<Vector3<f64>> = points()
        .into_iter()
        .map(|p| delta.inverse(p).expect("point is reached"))
        .collect();
    let mut group = c.benchmark_group("forward");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    group.bench_function("bare loop", |b| {
        b.iter(|| {
            for a in &angles {
                black_box(bare::forward(&arms, black_box((*a).into())));
            }
        });
    });
    group.bench_function("Delta::forward", |b| {
        b.iter(|| {
            for a in &angles {
                let _ = black_box(delta.forward(black_box(*a)));
            }
        });
    });
    group.finish();
}

fn calibrate(c: &mut Criterion) {
    let start = delta();
    let mut arms = *start.arms();
    for (arm, off) in arms.iter_mut().zip([0.7, -0.4, 0.2]) {
        arm.zero += 0.02 * off;
        arm.lower += off;
        arm.azimuth += 0.01 * off;
        arm.base += 0.5;
        arm.upper -= 0.3;
    }
    let real = start.with_arms(arms).expect("lengths are good");
    let measured: Vec<Measured> = points()
        .into_iter()
        .step_by(68)
        .take(60)
        .zip(0..)
        .map(|(point, k)| {
            let noise = f64::from(k) * 1.7;
            Measured {
                angles: real.inverse(point).expect("point is reached"),
                point: point + Vector3::new(noise.sin(), noise.cos(), (2.0 * noise).sin()) * 0.02,
            }
        })
        .collect();
    let found = start.calibrate(eleven(), &measured).expect("it fits");
    assert!(found.rank() == 11 && found.rms() < 0.05);
    c.bench_function("calibrate 11 parameters from 60 points", |b| {
        b.iter(|| black_box(start.calibrate(eleven(), black_box(&measured))));
    });
}

fn follow(c: &mut Criterion) {
    let delta = delta();
    let line = PlatformPath::line(
        Point3::new(-80.0, 20.0, -280.0),
        Point3::new(80.0, 20.0, -280.0),
    );
    let line = line.expect("points are finite");
    let limits = SpeedLimits::new(200.0, [3.0; 3]).expect("limits are good");
    let count = delta
        .follow(line, 0.01, limits)
        .map_or(0, |path| path.remaining());
    let mut group = c.benchmark_group("follow");
    group.throughput(Throughput::Elements(count));
    group.bench_function("waypoints, checked and handed out", |b| {
        b.iter(|| {
            delta
                .follow(black_box(line), 0.01, limits)
                .map_or(0.0, |way| way.map(|waypoint| waypoint.duration_s).sum())
        });
    });
    group.finish();
    c.bench_function("largest cylinder of 60 mm height to 0.5 mm", |b| {
        b.iter(|| delta.largest_cylinder(black_box([-290.0, -230.0]), 0.5));
    });
}

criterion_group!(benches, inverse, forward, calibrate, follow);
criterion_main!(benches);
