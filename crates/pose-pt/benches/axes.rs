//! Time per pose of the axes of three locators, beside the bare products of `nalgebra`.
//!
//! Ratios within one run count, not the figures: a machine's speed drifts.
#![expect(clippy::expect_used, reason = "a bench stops at once")]

use core::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, Vector3};
use pose_pt::{Convention, Locator, LocatorAxis, Platform, PoseVector, rigid_fit, slerp};

const POSES: u32 = 256;

const ANCHORS: [[f64; 3]; 3] = [
    [-1500.0, -1000.0, 0.0],
    [1500.0, -1000.0, 50.0],
    [0.0, 1000.0, -20.0],
];

fn platform(axes: Matrix3<f64>) -> Platform<3> {
    let limits = [LocatorAxis {
        min: -300.0,
        max: 300.0,
        speed: 20.0,
        acceleration: 100.0,
        jerk: None,
    }; 3];
    let locators =
        ANCHORS.map(|anchor| Locator::new(anchor.into(), anchor.into(), limits).with_axes(axes));
    Platform::new(locators).expect("locators are good")
}

fn vectors() -> Vec<PoseVector> {
    (0..POSES)
        .map(|number| {
            let s = f64::from(number) / f64::from(POSES);
            PoseVector::new(100.0 * s, -20.0, 30.0 * s, 0.1 * s, -0.2 * s, 0.3 - s)
        })
        .collect()
}

fn nine_axes(c: &mut Criterion) {
    let vectors = vectors();
    let poses: Vec<(Rotation3<f64>, Vector3<f64>)> = vectors
        .iter()
        .map(|v| (v.to_rotation(Convention::ExtrinsicXyz), v.position()))
        .collect();
    let isometries: Vec<Isometry3<f64>> = vectors
        .iter()
        .map(|v| v.to_isometry(Convention::ExtrinsicXyz))
        .collect();
    let anchors = ANCHORS.map(Point3::from);
    let parallel = platform(Matrix3::identity());
    let calibrated = platform(Matrix3::new(
        1.0, 2e-3, 0.0, -1e-3, 1.0, 3e-3, 0.0, 1e-3, 1.0,
    ));

    let mut group = c.benchmark_group("nine axes from a rotation matrix");
    group.throughput(Throughput::Elements(u64::from(POSES)));
    group.bench_function("nalgebra, three products and sums", |b| {
        let mut positions = [Point3::origin(); 3];
        b.iter(|| {
            for (rotation, translation) in black_box(&poses) {
                for (anchor, position) in black_box(&anchors).iter().zip(&mut positions) {
                    *position = rotation * anchor + translation;
                }
                black_box(&positions);
            }
        });
    });
    group.bench_function("nalgebra, less the locators' origins", |b| {
        let mut axes = [Vector3::zeros(); 3];
        b.iter(|| {
            for (rotation, translation) in black_box(&poses) {
                for (anchor, axes) in black_box(&anchors).iter().zip(&mut axes) {
                    *axes = rotation * anchor + translation - anchor;
                }
                black_box(&axes);
            }
        });
    });
    for (name, platform) in [
        ("axes_at, parallel to the world", &parallel),
        ("axes_at, calibrated frames", &calibrated),
    ] {
        group.bench_function(name, |b| {
            b.iter(|| {
                for (rotation, translation) in black_box(&poses) {
                    black_box(&black_box(platform).axes_at(rotation, translation));
                }
            });
        });
    }
    group.finish();

    let mut group = c.benchmark_group("nine axes from");
    group.throughput(Throughput::Elements(u64::from(POSES)));
    group.bench_function("an isometry", |b| {
        b.iter(|| {
            for pose in black_box(&isometries) {
                black_box(black_box(&parallel).axes(pose));
            }
        });
    });
    group.bench_function("an isometry, strokes checked", |b| {
        b.iter(|| {
            for pose in black_box(&isometries) {
                let _ = black_box(black_box(&parallel).checked_axes(pose));
            }
        });
    });
    group.bench_function("a pose vector", |b| {
        b.iter(|| {
            for vector in black_box(&vectors) {
                let rotation = vector.to_rotation(Convention::ExtrinsicXyz);
                black_box(black_box(&parallel).axes_at(&rotation, &vector.position()));
            }
        });
    });
    group.bench_function("a pose vector, by nalgebra", |b| {
        let mut positions = [Point3::origin(); 3];
        b.iter(|| {
            for v in black_box(&vectors) {
                let pose = Isometry3::from_parts(
                    Translation3::new(v.x, v.y, v.z),
                    Rotation3::from_euler_angles(v.alpha, v.beta, v.gamma).into(),
                );
                for (anchor, position) in black_box(&anchors).iter().zip(&mut positions) {
                    *position = pose * anchor;
                }
                black_box(&positions);
            }
        });
    });
    group.finish();
}

fn others(c: &mut Criterion) {
    let poses: Vec<Isometry3<f64>> = vectors()
        .iter()
        .map(|v| v.to_isometry(Convention::ExtrinsicXyz))
        .collect();
    let platform = platform(Matrix3::identity());
    let anchors = ANCHORS.map(Point3::from);
    let points: Vec<[Point3<f64>; 3]> = poses.iter().map(|p| platform.positions(p)).collect();
    let axes: Vec<[Vector3<f64>; 3]> = poses.iter().map(|p| platform.axes(p)).collect();
    let first = poses.first().expect("there are poses").rotation;
    let mut group = c.benchmark_group("one call");
    group.throughput(Throughput::Elements(u64::from(POSES)));
    group.bench_function("pose of nine axes, with distance error", |b| {
        b.iter(|| {
            for axes in black_box(&axes) {
                let _ = black_box(platform.pose(axes));
            }
        });
    });
    group.bench_function("rigid_fit of three points", |b| {
        b.iter(|| {
            for points in black_box(&points) {
                let _ = black_box(rigid_fit(&anchors, points));
            }
        });
    });
    group.bench_function("pose vector of a pose", |b| {
        b.iter(|| {
            for pose in black_box(&poses) {
                black_box(PoseVector::from_isometry(pose, Convention::ExtrinsicXyz));
            }
        });
    });
    group.bench_function("slerp", |b| {
        b.iter(|| {
            for pose in black_box(&poses) {
                black_box(slerp(&first, &pose.rotation, black_box(0.3)));
            }
        });
    });
    group.bench_function("slerp of nalgebra", |b| {
        b.iter(|| {
            for pose in black_box(&poses) {
                black_box(first.try_slerp(&pose.rotation, black_box(0.3), 1e-9));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, nine_axes, others);
criterion_main!(benches);
