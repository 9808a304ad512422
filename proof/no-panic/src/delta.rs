//! delta-kin.

use std::hint::black_box;

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    Delta, Dimensions, Follow, ForwardError, InverseError, PlatformPath, Pose, PoseError,
    SpeedLimits, Waypoint,
};
use no_panic::no_panic;

#[no_panic]
#[inline(never)]
fn inverse(delta: &Delta, point: Point3<f64>) -> Result<Vector3<f64>, InverseError> {
    delta.inverse(point)
}

#[no_panic]
#[inline(never)]
fn forward(delta: &Delta, angles: Vector3<f64>) -> Result<Point3<f64>, ForwardError> {
    delta.forward(angles)
}

#[no_panic]
#[inline(never)]
fn joint_rates(pose: &Pose, velocity: Vector3<f64>) -> Result<Vector3<f64>, PoseError> {
    pose.joint_rates(velocity)
}

#[no_panic]
#[inline(never)]
fn holding_torques(pose: &Pose, force: Vector3<f64>) -> Result<Vector3<f64>, PoseError> {
    pose.holding_torques(force)
}

#[no_panic]
#[inline(never)]
fn chord_bound(delta: &Delta, from: &Pose, to: &Pose) -> Option<f64> {
    delta.chord_bound(from, to)
}

#[no_panic]
#[inline(never)]
fn follow_next(follow: &mut Follow) -> Option<Waypoint> {
    follow.next()
}

pub fn run() {
    let Ok(delta) = Delta::new(Dimensions {
        base: black_box(42.0),
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    }) else {
        return;
    };
    let delta = &black_box(delta);
    let point = || black_box(Point3::new(50.0, 50.0, -300.0));
    let vector = || black_box(Vector3::new(0.3, 0.4, 0.5));
    let _ = black_box(inverse(delta, point()));
    let _ = black_box(forward(delta, vector()));
    if let Ok(pose) = delta.pose_at(point()) {
        let pose = &black_box(pose);
        let _ = black_box(joint_rates(pose, vector()));
        let _ = black_box(holding_torques(pose, vector()));
        black_box(chord_bound(delta, pose, pose));
    }
    let line = PlatformPath::line(point(), Point3::new(-50.0, 50.0, -300.0));
    let speed_limits = SpeedLimits::new(black_box(200.0), [3.0; 3]);
    if let (Ok(line), Ok(speed_limits)) = (line, speed_limits)
        && let Ok(follow) = delta.follow(line, 0.01, speed_limits)
    {
        black_box(follow_next(&mut black_box(follow)));
    }
}
