//! Our kinematics beside a bare loop and beside the best published crate, in one run.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pose2pulse_bench::{
    ARM_POINTS, DELTA_POINTS, arm, arm_points, delta, delta_points, peer_arm, peer_delta,
};
use scara_kin::Elbow;

fn two_links(c: &mut Criterion) {
    let points = arm_points();
    let (arm, peer) = (arm(), peer_arm());
    let mut group = c.benchmark_group("two-link inverse");
    group.throughput(Throughput::Elements(u64::from(ARM_POINTS)));
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

fn three_arms(c: &mut Criterion) {
    let points = delta_points();
    let (ours, mut peer) = (delta(), peer_delta());
    let mut group = c.benchmark_group("delta inverse");
    group.throughput(Throughput::Elements(u64::from(DELTA_POINTS)));
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
    group.throughput(Throughput::Elements(u64::from(DELTA_POINTS)));
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

criterion_group!(benches, two_links, three_arms);
criterion_main!(benches);
