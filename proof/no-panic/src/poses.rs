//! pose-pt.

use std::hint::black_box;

use no_panic::no_panic;
use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};
use pose_pt::{
    BodyFit, Convention, FitError, LimitError, Locator, LocatorAxis, NotARotation, Platform,
    PoseVector, Resolved, RigidFit, from_matrix, rigid_fit, slerp,
};

type Axes = [Vector3<f64>; 3];

#[no_panic]
#[inline(never)]
fn to_isometry(vector: &PoseVector, convention: Convention) -> Isometry3<f64> {
    vector.to_isometry(convention)
}

#[no_panic]
#[inline(never)]
fn from_isometry_near(
    pose: &Isometry3<f64>,
    convention: Convention,
    previous: &PoseVector,
) -> Resolved {
    PoseVector::from_isometry_near(pose, convention, previous)
}

#[no_panic]
#[inline(never)]
fn slerp_any(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>, t: f64) -> UnitQuaternion<f64> {
    slerp(a, b, t)
}

#[no_panic]
#[inline(never)]
fn quaternion(matrix: &Matrix3<f64>, allowed: f64) -> Result<UnitQuaternion<f64>, NotARotation> {
    from_matrix(matrix, allowed)
}

#[no_panic]
#[inline(never)]
fn axes_at(platform: &Platform<3>, rotation: &Rotation3<f64>, translation: &Vector3<f64>) -> Axes {
    platform.axes_at(rotation, translation)
}

#[no_panic]
#[inline(never)]
fn checked_axes(platform: &Platform<3>, pose: &Isometry3<f64>) -> Result<Axes, LimitError> {
    platform.checked_axes(pose)
}

#[no_panic]
#[inline(never)]
fn axis_velocities(
    platform: &Platform<3>,
    pose: &Isometry3<f64>,
    linear: &Vector3<f64>,
    angular: &Vector3<f64>,
) -> Axes {
    platform.axis_velocities(pose, linear, angular)
}

#[no_panic]
#[inline(never)]
fn pose_of(platform: &Platform<3>, axes: &Axes) -> Result<BodyFit<3>, FitError> {
    platform.pose(axes)
}

#[no_panic]
#[inline(never)]
fn fit(from: &[Point3<f64>], to: &[Point3<f64>]) -> Result<RigidFit, FitError> {
    rigid_fit(from, to)
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
    let vector = || black_box(PoseVector::new(1.0, 2.0, 3.0, 0.1, 0.2, 0.3));
    let convention = || black_box(Convention::ExtrinsicXyz);
    let pose = &black_box(to_isometry(&vector(), convention()));
    black_box(from_isometry_near(pose, convention(), &vector()));
    black_box(slerp_any(
        &pose.rotation,
        &black_box(pose.rotation),
        black_box(0.5),
    ));
    let rotation = black_box(vector().to_rotation(convention()));
    let _ = black_box(quaternion(rotation.matrix(), black_box(0.0)));
    let axes = black_box(axes_at(platform, &rotation, &black_box(Vector3::zeros())));
    let _ = black_box(checked_axes(platform, pose));
    let twist = || black_box(Vector3::new(1.0, 2.0, 3.0));
    black_box(axis_velocities(platform, pose, &twist(), &twist()));
    let _ = black_box(pose_of(platform, &axes));
    let points = black_box(platform.positions(pose));
    let _ = black_box(fit(black_box(platform.anchors().as_slice()), &points));
}
