//! Our kinematics beside a bare loop and beside the best published crate, in one run.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use oxictl::kinematics::serial::scara::{ScaraConfig, ScaraRobot};
use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, Elbow};

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
