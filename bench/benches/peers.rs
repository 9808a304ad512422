//! Our kinematics beside a bare loop and beside the best published crate, in one run.

#[path = "../../crates/delta-kin/benches/kinematics/points.rs"]
mod delta_points;
#[path = "../../crates/scara-kin/benches/inverse/points.rs"]
mod points;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use delta_kin::{Delta, Dimensions};
use oxictl::kinematics::serial::delta::{DeltaConfig, DeltaRobot};
use oxictl::kinematics::serial::scara::{ScaraConfig, ScaraRobot};
use scara_kin::{Arm, Elbow};

use points::{LINK, POINTS, points};

fn inverse(c: &mut Criterion) {
    let points = points();
    let arm = Arm::new(LINK, LINK).expect("lengths are good");
    let peer = ScaraRobot::new(ScaraConfig {
        a1: LINK,
        a2: LINK,
        ..ScaraConfig::desktop()
    });
    let mut group = c.benchmark_group("two-link inverse");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    group.bench_function("scara-kin, both elbows", |b| {
        b.iter(|| {
            for p in &points {
                let _ = black_box(arm.inverse(black_box(*p)));
            }
        });
    });
    group.bench_function("scara-kin, one elbow", |b| {
        b.iter(|| {
            for p in &points {
                let _ = black_box(arm.inverse_elbow(black_box(*p), Elbow::Left));
            }
        });
    });
    group.bench_function("oxictl, one elbow", |b| {
        b.iter(|| {
            for p in &points {
                let p = black_box(*p);
                black_box(peer.inverse(p.x, p.y, 0.0, 0.0));
            }
        });
    });
    group.finish();
}

fn delta(c: &mut Criterion) {
    let points = delta_points::points();
    let ours = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .expect("lengths are good");
    let mut peer = DeltaRobot::new(DeltaConfig {
        r_f: 42.0,
        r_e: 18.0,
        l1: 120.0,
        l2: 243.0,
        theta_min: -7.0,
        theta_max: 7.0,
    });
    let mut group = c.benchmark_group("delta inverse");
    group.throughput(Throughput::Elements(u64::from(delta_points::POINTS)));
    group.bench_function("delta-kin", |b| {
        b.iter(|| {
            for p in &points {
                let _ = black_box(ours.inverse(black_box(*p)));
            }
        });
    });
    group.bench_function("oxictl", |b| {
        b.iter(|| {
            for p in &points {
                let p = black_box(*p);
                black_box(peer.inverse(p.x, p.y, p.z));
            }
        });
    });
    group.finish();

    let angles: Vec<_> = points
        .iter()
        .map(|p| ours.inverse(*p).expect("point is reached"))
        .collect();
    let mut group = c.benchmark_group("delta forward");
    group.throughput(Throughput::Elements(u64::from(delta_points::POINTS)));
    group.bench_function("delta-kin", |b| {
        b.iter(|| {
            for a in &angles {
                let _ = black_box(ours.forward(black_box(*a)));
            }
        });
    });
    let theirs: Vec<_> = points
        .iter()
        .filter_map(|p| peer.inverse(p.x, p.y, p.z))
        .collect();
    assert_eq!(theirs.len(), points.len(), "the peer refuses points");
    group.bench_function("oxictl", |b| {
        b.iter(|| {
            for a in &theirs {
                peer.theta = black_box(*a);
                black_box(peer.forward());
            }
        });
    });
    group.finish();
}

criterion_group!(benches, inverse, delta);
criterion_main!(benches);
