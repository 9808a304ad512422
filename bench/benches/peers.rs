//! Our kinematics beside a bare loop and beside the best published crate, in one run.

#[path = "../../crates/scara-kin/benches/common/points.rs"]
mod points;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
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

criterion_group!(benches, inverse);
criterion_main!(benches);
