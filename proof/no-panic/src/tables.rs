//! Paths and tables of pose-pt.

use std::hint::black_box;

use no_panic::no_panic;
use path_timing::{Accuracy, Knot, PlanError, Table};
use pose_pt::nalgebra::Isometry3;
use pose_pt::{
    BodyPath, BodyPathError, Convention, Interpolation, Locator, LocatorAxis, Platform, PosePath,
    PoseVector, PtPoint, PtPoints, PtTable, Segmentation,
};

#[no_panic]
#[inline(never)]
fn pt_plan<'a>(
    platform: &'a Platform<3>,
    path: &PosePath<'a>,
    segmentation: Segmentation,
) -> Result<PtTable<'a, 3>, pose_pt::PtError> {
    PtTable::plan(platform, path, segmentation)
}

#[no_panic]
#[inline(never)]
fn pt_next(points: &mut PtPoints<'_, 3>) -> Option<PtPoint<3>> {
    points.next()
}

#[no_panic]
#[inline(never)]
fn plan<'a>(
    platform: &Platform<3>,
    path: &PosePath<'_>,
    accuracy: Accuracy,
    knots: &'a mut [Knot<[[f64; 3]; 3]>],
) -> Result<Table<'a, [[f64; 3]; 3]>, PlanError<BodyPathError>> {
    let (paths, limits) = (platform.paths(path), platform.axis_limits());
    Table::plan_within(paths, limits, accuracy, BodyPath::departure, knots)
}

pub fn run() {
    let limits = [LocatorAxis {
        min: -300.0,
        max: 300.0,
        speed: 20.0,
        acceleration: 100.0,
        jerk: None,
    }; 3];
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
    let Ok(path) = PosePath::new(black_box(poses.as_slice()), kind) else {
        return;
    };
    let segmentation = || black_box(Segmentation::max_distance_error(0.01));
    if let Ok(table) = pt_plan(platform, black_box(&path), segmentation()) {
        let mut points = black_box(table).points();
        black_box(pt_next(&mut points));
    }
    let mut knots = black_box([Knot::default(); 64]);
    let accuracy = black_box(Accuracy {
        min_segments: 2,
        max_departure: 0.01,
        max_time_ratio: 1.02,
    });
    // What a table hands out is looked at without a body.
    let _ = black_box(plan(
        platform,
        black_box(&path),
        accuracy,
        black_box(&mut knots),
    ));
}
