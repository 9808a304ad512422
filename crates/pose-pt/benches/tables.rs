//! Time per point of PT and PVT tables.
//!
//! Ratios within one run count, not the figures: a machine's speed drifts.
#![expect(clippy::expect_used, reason = "a bench stops at once")]

use core::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use path_timing::{Accuracy, FeedCeiling, Knot, Table};
use pose_pt::nalgebra::{Isometry3, Matrix3, Vector3};
use pose_pt::{
    BodyPath, Convention, Interpolation, Locator, LocatorAxis, Platform, PosePath, PtTable,
    Segmentation,
};

const POINTS: u32 = 10_000;

const ROOM: usize = POINTS as usize + 1;

fn platform(axes: Matrix3<f64>) -> Platform<3> {
    let limits = [LocatorAxis {
        min: -300.0,
        max: 300.0,
        speed: 20.0,
        acceleration: 100.0,
        jerk: None,
    }; 3];
    let anchors = [
        [-1500.0, -1000.0, 0.0],
        [1500.0, -1000.0, 50.0],
        [0.0, 1000.0, -20.0],
    ];
    let locators =
        anchors.map(|anchor| Locator::new(anchor.into(), anchor.into(), limits).with_axes(axes));
    Platform::new(locators).expect("locators are good")
}

fn calibrated() -> Platform<3> {
    platform(Matrix3::new(
        1.0, 2e-3, 0.0, -1e-3, 1.0, 3e-3, 0.0, 1e-3, 1.0,
    ))
}

fn poses() -> [Isometry3<f64>; 2] {
    [
        Isometry3::identity(),
        Isometry3::new(
            Vector3::new(80.0, -30.0, 15.0),
            Vector3::new(0.01, 0.02, -0.05),
        ),
    ]
}

const KINDS: [(&str, Interpolation); 3] = [
    ("straight", Interpolation::Straight),
    ("screw", Interpolation::Screw),
    (
        "pose vector",
        Interpolation::Vector(Convention::ExtrinsicXyz),
    ),
];

fn pt(c: &mut Criterion) {
    let (poses, platform) = (poses(), calibrated());
    let mut group = c.benchmark_group("PT points");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    for (name, kind) in KINDS {
        let path = PosePath::new(&poses, kind).expect("poses are good");
        let table =
            PtTable::plan(&platform, &path, Segmentation::segments(POINTS)).expect("plan is good");
        group.bench_function(name, |b| {
            b.iter(|| {
                for point in black_box(&table).points() {
                    black_box(&point);
                }
            });
        });
    }
    group.finish();
}

fn pvt(c: &mut Criterion) {
    let (poses, platform) = (poses(), calibrated());
    let mut knots = vec![Knot::default(); ROOM];
    let mut group = c.benchmark_group("PVT plan");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    group.sample_size(20);
    for (name, kind) in KINDS {
        let path = PosePath::new(&poses, kind).expect("poses are good");
        group.bench_function(BenchmarkId::from_parameter(name), |b| {
            b.iter(|| {
                let paths = platform.paths(black_box(&path));
                Table::plan(paths, platform.axis_limits(), |_| POINTS, &mut knots)
                    .expect("plan is good")
                    .duration_s()
            });
        });
    }
    let path = PosePath::new(&poses, Interpolation::Straight).expect("poses are good");
    group.bench_function("straight, from a distance error of 0.01", |b| {
        b.iter(|| {
            let accuracy = Accuracy {
                min_segments: 2,
                max_departure: 0.01,
                max_time_ratio: f64::INFINITY,
            };
            let (paths, limits) = (platform.paths(black_box(&path)), platform.axis_limits());
            Table::plan_within(paths, limits, accuracy, BodyPath::departure, &mut knots)
                .expect("plan is good")
                .len()
        });
    });
    group.finish();

    let (paths, limits) = (platform.paths(&path), platform.axis_limits());
    let table = Table::plan(paths, limits, |_| POINTS, &mut knots);
    let table = table.expect("plan is good");
    let mut ceilings = vec![FeedCeiling::default(); ROOM];
    let mut group = c.benchmark_group("PVT points");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    group.sample_size(20);
    group.bench_function("of the table", |b| {
        b.iter(|| {
            for point in black_box(&table).rows() {
                black_box(&point);
            }
        });
    });
    group.bench_function("under a feed override", |b| {
        b.iter(|| {
            let mut run = table
                .playback(1.5, &mut ceilings)
                .expect("memory is enough");
            run.set_feed(0.7).expect("feed is good");
            for point in run {
                black_box(&point);
            }
        });
    });
    group.finish();
}

criterion_group!(benches, pt, pvt);
criterion_main!(benches);
