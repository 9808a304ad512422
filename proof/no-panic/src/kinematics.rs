//! scara-kin.

use std::array::IntoIter;
use std::hint::black_box;

use no_panic::no_panic;
use scara_kin::nalgebra::{Point2, Vector2};
use scara_kin::{Arm, Elbow, Follow, InverseError, Joints, RatesError, Solutions, Waypoint};

type Line = IntoIter<Point2<f64>, 2>;

#[no_panic]
#[inline(never)]
fn forward(arm: &Arm, joints: Joints) -> Point2<f64> {
    arm.forward(joints)
}

#[no_panic]
#[inline(never)]
fn inverse(arm: &Arm, point: Point2<f64>) -> Result<Solutions, InverseError> {
    arm.inverse(point)
}

#[no_panic]
#[inline(never)]
fn inverse_elbow(arm: &Arm, point: Point2<f64>, elbow: Elbow) -> Result<Joints, InverseError> {
    arm.inverse_elbow(point, elbow)
}

#[no_panic]
#[inline(never)]
fn inverse_nearest(
    arm: &Arm,
    point: Point2<f64>,
    now: Joints,
) -> Result<(Elbow, Joints), InverseError> {
    arm.inverse_nearest(point, now)
}

#[no_panic]
#[inline(never)]
fn joint_rates(
    arm: &Arm,
    joints: Joints,
    velocity: Vector2<f64>,
) -> Result<Vector2<f64>, RatesError> {
    arm.joint_rates(joints, velocity)
}

#[no_panic]
#[inline(never)]
fn chord_bound(arm: &Arm, from: Joints, to: Joints) -> f64 {
    arm.chord_bound(from, to)
}

#[no_panic]
#[inline(never)]
fn follow_next(follow: &mut Follow<Line>) -> Option<Waypoint> {
    follow.next()
}

pub fn run() {
    let Ok(arm) = Arm::new(black_box(132.0), black_box(132.0)) else {
        return;
    };
    let arm = &black_box(arm);
    let joints = || black_box(Joints::new(0.3, 1.2));
    let point = || black_box(Point2::new(150.0, 80.0));
    let elbow = black_box(Elbow::Right);
    black_box(forward(arm, joints()));
    let _ = black_box(inverse(arm, point()));
    let _ = black_box(inverse_elbow(arm, point(), elbow));
    let _ = black_box(inverse_nearest(arm, point(), joints()));
    let _ = black_box(joint_rates(
        arm,
        joints(),
        black_box(Vector2::new(1.0, 2.0)),
    ));
    black_box(chord_bound(arm, joints(), joints()));
    if let Ok(follow) = arm.follow([point(), Point2::new(80.0, 100.0)], elbow, 0.01) {
        black_box(follow_next(&mut black_box(follow)));
    }
}
