//! A platform like that of a panel line, paths on it, and what its controller would run.

use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3};
use pose_pt::{Locator, LocatorAxis, Platform};

pub(crate) const SPEED: f64 = 10.0;
pub(crate) const ACCELERATION: f64 = 25.0;

/// Three locators up to 4.3 m apart, strokes of a metre and more, 10 mm/s, 25 mm/s².
pub(crate) fn panel() -> Platform<3> {
    panel_with(LocatorAxis {
        min: -1500.0,
        max: 1500.0,
        speed: SPEED,
        acceleration: ACCELERATION,
        jerk: None,
    })
}

pub(crate) fn panel_with(limits: LocatorAxis) -> Platform<3> {
    let anchors = [
        [0.0, 0.0, 0.0],
        [4000.0, 0.0, 50.0],
        [1800.0, 1490.0, -80.0],
    ];
    Platform::new(anchors.map(|anchor| {
        let anchor = Point3::from(anchor);
        Locator::new(anchor, anchor, [limits; 3])
    }))
    .unwrap()
}

/// Axes as calibrated: a degree and more from square, limits all different.
pub(crate) fn skewed() -> Platform<3> {
    let mut limits = (1..).map(|n| {
        let n = f64::from(n);
        LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: 5.0 + n,
            acceleration: 40.0 - 3.0 * n,
            jerk: None,
        }
    });
    let mut next = || limits.next().unwrap();
    let anchors = [
        [-900.0, -400.0, 10.0],
        [1100.0, -500.0, 0.0],
        [100.0, 800.0, -30.0],
    ];
    let axes = Matrix3::new(1.0, 0.02, -0.01, 0.0, 0.9998, 0.015, 0.0, 0.0, 0.99983);
    Platform::new(anchors.map(|anchor| {
        let anchor = Point3::from(anchor);
        Locator::new(anchor, anchor, [next(), next(), next()]).with_axes(axes)
    }))
    .unwrap()
}

pub(crate) fn pose(translation: [f64; 3], turn: [f64; 3]) -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::from(Vector3::from(translation)),
        UnitQuaternion::from_scaled_axis(Vector3::from(turn)),
    )
}
