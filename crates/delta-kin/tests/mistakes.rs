//! Mistakes seen in other implementations, each as a test that they fail.
#![cfg(test)]

use core::f64::consts::{FRAC_PI_2, PI};

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{Delta, InverseError, Knee};

/// Angles away from singular poses, in radians.
const ANGLE_ERROR: f64 = 1e-13;

/// Some divide by z: off by 0.02° at z = -1e-12, not a number at 0, which the listing that goes
/// round in forums then hands on.
#[test]
fn the_plane_of_the_hips_is_no_exception() {
    // Rods short enough for the platform to come up between the hips.
    let delta: Delta = Delta::new(60.0, 20.0, 120.0, 130.0).unwrap();
    let level = delta.inverse(Point3::new(3.0, -2.0, 0.0)).unwrap();
    assert!(level.iter().all(|angle| angle.is_finite()));
    for z in [1e-12, -1e-12, 1e-300, -0.0] {
        let near = delta.inverse(Point3::new(3.0, -2.0, z)).unwrap();
        assert!((near - level).amax() < ANGLE_ERROR, "{z}");
    }
    for rod in delta.pose_at(Point3::new(3.0, -2.0, 0.0)).unwrap().rods() {
        assert!((rod.norm() - 1.0).abs() < 1e-14);
    }
}

/// Some use the length of one arm for all in their forward kinematics.
#[test]
fn every_arm_has_its_own_length() {
    let mut arms = *Delta::<f64>::new(42.0, 18.0, 120.0, 243.0).unwrap().arms();
    for (arm, more) in arms.iter_mut().zip([0.0, 1.5, -2.5]) {
        arm.lower += more;
        arm.upper += more / 2.0;
        arm.base -= more;
        arm.azimuth += more * 0.01;
        arm.zero += more * 0.02;
    }
    let delta = Delta::from_arms(arms).unwrap();
    for point in [
        Point3::new(50.0, 50.0, -300.0),
        Point3::new(-60.0, 40.0, -280.0),
    ] {
        let angles = delta.inverse(point).unwrap();
        assert!((delta.forward(angles).unwrap() - point).norm() <= delta.tolerance());
        for ((knee, arm), angle) in delta.knees(angles).into_iter().zip(arms).zip(&angles) {
            let wrist =
                point + Vector3::new(arm.azimuth.cos(), arm.azimuth.sin(), 0.0) * arm.platform;
            assert!(((wrist - knee).norm() - arm.lower).abs() <= delta.tolerance());
            let theta = angle + arm.zero;
            assert!((knee.z + arm.upper * theta.cos()).abs() <= delta.tolerance());
        }
    }
}

/// An arcsine cannot see beyond 90°.
#[test]
fn arms_above_horizontal_are_found() {
    let delta: Delta = Delta::new(42.0, 18.0, 120.0, 243.0).unwrap();
    for theta in [1.5, FRAC_PI_2, 1.6, 2.0, 2.4] {
        let angles = Vector3::new(theta, theta - 0.1, theta + 0.1);
        let back = delta.inverse(delta.forward(angles).unwrap()).unwrap();
        assert!((back - angles).amax() < ANGLE_ERROR, "{theta}: {back}");
    }
}

/// In the tangent half-angle form θ = π has no tangent, and there the root that means "knee
/// out" changes its sign.
#[test]
fn straight_up_is_an_angle_like_others() {
    // A platform wider than the base, for which a knee straight up is out.
    let delta: Delta = Delta::new(18.0, 42.0, 120.0, 243.0).unwrap();
    for off in [-1e-3, -1e-9, 0.0, 1e-9, 1e-3] {
        let angles = Vector3::repeat(PI + off);
        let point = delta.forward(angles).unwrap();
        let back = delta.inverse(point).unwrap();
        let turns = ((back - angles) / (2.0 * PI)).map(f64::round);
        assert!(
            (back - angles - turns * 2.0 * PI).amax() < ANGLE_ERROR,
            "{off}: {back}"
        );
        let other = delta.inverse_knees(point, [Knee::In; 3]).unwrap();
        assert!(other.iter().all(|angle| angle.is_finite()));
        assert!((other - back).amin() > 0.1);
    }
}

/// Knee out is the solution whose knee is farther from the base's axis, wherever A changes sign.
#[test]
fn knees_keep_their_names() {
    let delta: Delta = Delta::new(42.0, 18.0, 120.0, 243.0).unwrap();
    for z in -340..-130 {
        let point = Point3::new(20.0, -10.0, f64::from(z));
        let out = delta.inverse(point).unwrap();
        let inside = delta.inverse_knees(point, [Knee::In; 3]).unwrap();
        for (out, inside) in delta.knees(out).iter().zip(delta.knees(inside)) {
            let radial = out.coords.normalize();
            assert!(radial.dot(&(out - inside)) > 0.0 || out.z > inside.z, "{z}");
        }
        let levers = delta.pose_at(point).unwrap().levers();
        assert!(levers.max() < 0.0, "{z}: {levers}");
        let levers = delta.pose_at_knees(point, [Knee::In; 3]).unwrap().levers();
        assert!(levers.min() > 0.0, "{z}: {levers}");
    }
}

/// What `forward` made is never refused, stretched and folded arms among it.
#[test]
fn own_stretched_and_folded_poses_are_reached() {
    let delta: Delta = Delta::new(42.0, 18.0, 120.0, 243.0).unwrap();
    for step in 0..20_000 {
        let turn = f64::from(step) * 0.618;
        let angles = Vector3::new(turn, turn * 1.7, turn * 2.9).map(|a| a % (2.0 * PI) - PI);
        let Ok(both) = delta.forward_both(angles) else {
            continue;
        };
        for point in [both.lower, both.upper] {
            let reached = delta.inverse(point);
            assert!(reached.is_ok(), "{angles}: {reached:?}");
        }
    }
    // All arms stretched in their planes, where knee out and knee in are one.
    let plain: Delta = Delta::new(50.0, 50.0, 100.0, 200.0).unwrap();
    for z in [-300.0, -100.0, 100.0, 300.0] {
        assert!(plain.inverse(Point3::new(0.0, 0.0, z)).is_ok(), "{z}");
    }
}

/// A wrist on the motor's axis is reached by every angle, or by none.
#[test]
fn a_wrist_on_the_motors_axis_is_said_to_be_indefinite() {
    let delta: Delta = Delta::new(50.0, 50.0, 100.0, 100.0).unwrap();
    assert!(matches!(
        delta.inverse(Point3::origin()),
        Err(InverseError::AnyAngle { .. })
    ));
    let delta: Delta = Delta::new(50.0, 50.0, 100.0, 120.0).unwrap();
    assert!(matches!(
        delta.inverse(Point3::origin()),
        Err(InverseError::TooNear { by, .. }) if (by - 20.0).abs() < 1e-12
    ));
}
