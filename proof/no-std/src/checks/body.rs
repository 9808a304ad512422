//! A rigid body on locators.

use core::hint::black_box;

use path_timing::{Knot, Table};
use pose_pt::{
    Convention, Interpolation, Locator, LocatorAxis, Platform, PosePath, PoseVector, PtTable,
    Segmentation,
};

use super::{CLOSE_MM, holds};
/// A panel on three locators.
fn platform() -> Option<Platform<3>> {
    let limits = [LocatorAxis {
        min: -300.0,
        max: 300.0,
        speed: 20.0,
        acceleration: 100.0,
        jerk: None,
    }; 3];
    let anchors = [
        [-1500.0, -1000.0, 0.0],
        [1500.0, black_box(-1000.0), 0.0],
        [0.0, 1000.0, 0.0],
    ];
    let held = anchors.map(|anchor| Locator::new(anchor.into(), anchor.into(), limits));
    Platform::new(held).ok()
}

/// Pose to axes and back, with the distance error of the locators.
pub fn pose() -> Option<()> {
    let platform = platform()?;
    let vector = PoseVector::new(black_box(10.0), -20.0, 100.0, 0.01, 0.02, -0.03);
    let pose = vector.to_isometry(Convention::IntrinsicXyz);
    let mut axes = platform.checked_axes(&pose).ok()?;
    let body = platform.pose(&axes).ok()?;
    let back = PoseVector::from_isometry(&body.pose, Convention::IntrinsicXyz).vector;
    holds((back.position() - vector.position()).norm() < CLOSE_MM)?;
    holds((back.angles() - vector.angles()).norm() < CLOSE_MM)?;
    holds(body.distance_error.change.abs() < CLOSE_MM)?;
    axes.last_mut()?.y += black_box(0.5);
    holds(platform.pose(&axes).ok()?.distance_error.change > 0.4)?;
    axes.last_mut()?.y = 301.0;
    holds(platform.check_axes(&axes).is_err())
}

/// A way as PT and PVT tables within a distance error.
pub fn tables() -> Option<()> {
    let platform = platform()?;
    let poses = [0.0, black_box(0.02)].map(|gamma| {
        PoseVector::new(0.0, 0.0, 100.0, 0.0, 0.0, gamma).to_isometry(Convention::ExtrinsicXyz)
    });
    let path = PosePath::new(&poses, Interpolation::Straight).ok()?;
    let table = PtTable::plan(&platform, &path, Segmentation::max_distance_error(0.01)).ok()?;
    holds(table.points().count() == 5 && table.distance_error_bound() <= 0.01)?;
    let mut knots = [Knot::default(); 33];
    let (paths, limits) = (platform.paths(&path), platform.axis_limits());
    let table = Table::plan(paths, limits, |_| 32, &mut knots).ok()?;
    let last = table.rows().last()?;
    holds((last.time_s - table.duration_s()).abs() < CLOSE_MM)?;
    holds(last.is_at_rest())
}
