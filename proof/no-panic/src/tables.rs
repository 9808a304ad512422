//! Paths and tables of pose-pt.

use std::hint::black_box;

use no_panic::no_panic;
use pose_pt::nalgebra::Isometry3;
use pose_pt::{
    AxisLimits, Convention, FeedCeiling, Interpolation, Knot, Locator, Path, PlanError, Platform,
    PoseVector, PtPoint, PtPoints, PtTable, PvtPoint, PvtPoints, PvtRun, PvtTable, Segmentation,
    hermite_distance_error,
};

type Planned<T> = Result<T, PlanError>;

#[no_panic]
#[inline(never)]
fn pt_plan<'a>(
    platform: &'a Platform<3>,
    path: &Path<'a>,
    segmentation: Segmentation,
) -> Planned<PtTable<'a, 3>> {
    PtTable::plan(platform, path, segmentation)
}

#[no_panic]
#[inline(never)]
fn pt_next(points: &mut PtPoints<'_, 3>) -> Option<PtPoint<3>> {
    points.next()
}

#[no_panic]
#[inline(never)]
fn pvt_plan<'a>(
    platform: &'a Platform<3>,
    path: &Path<'a>,
    segmentation: Segmentation,
    knots: &'a mut [Knot<[[f64; 3]; 3]>],
) -> Planned<PvtTable<'a, 3>> {
    PvtTable::plan(platform, path, segmentation, knots)
}

#[no_panic]
#[inline(never)]
fn pvt_next(points: &mut PvtPoints<'_, 3>) -> Option<PvtPoint<3>> {
    points.next()
}

#[no_panic]
#[inline(never)]
fn distance_error(platform: &Platform<3>, from: &PvtPoint<3>, to: &PvtPoint<3>) -> f64 {
    hermite_distance_error(platform, from, to)
}

#[no_panic]
#[inline(never)]
fn run_next(run: &mut PvtRun<'_, 3>) -> Option<PvtPoint<3>> {
    run.next_point()
}

pub fn run() {
    let limits = [AxisLimits::new(-300.0, 300.0, 20.0, 100.0); 3];
    let anchors = black_box([
        [-1500.0, -1000.0, 0.0],
        [1500.0, -1000.0, 0.0],
        [0.0, 1000.0, 0.0],
    ]);
    let held = anchors.map(|anchor| Locator::new(anchor.into(), anchor.into(), limits));
    let Ok(platform) = Platform::new(held) else {
        return;
    };
    let platform = &black_box(platform);
    let vector = PoseVector::new(1.0, 2.0, 3.0, 0.01, 0.02, 0.03);
    let poses = black_box([
        Isometry3::identity(),
        vector.to_isometry(Convention::ExtrinsicXyz),
    ]);
    let kind = black_box(Interpolation::Straight);
    let Ok(path) = Path::new(black_box(poses.as_slice()), kind) else {
        return;
    };
    let segmentation = || black_box(Segmentation::max_distance_error(0.01));
    if let Ok(table) = pt_plan(platform, black_box(&path), segmentation()) {
        let mut points = black_box(table).points();
        black_box(pt_next(&mut points));
    }
    let mut knots = black_box([Knot::default(); 64]);
    let Ok(table) = pvt_plan(
        platform,
        black_box(&path),
        segmentation(),
        black_box(&mut knots),
    ) else {
        return;
    };
    let mut points = black_box(table).points();
    if let (Some(from), Some(to)) = (pvt_next(&mut points), pvt_next(&mut points)) {
        black_box(distance_error(platform, &from, &to));
    }
    let mut ceilings = black_box([FeedCeiling::default(); 64]);
    if let Ok(mut run) = table.run(black_box(1.5), black_box(&mut ceilings)) {
        black_box(run_next(&mut run));
    }
}
