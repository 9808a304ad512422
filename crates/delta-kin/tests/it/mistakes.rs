//! Mistakes seen in other implementations, each as a test that they fail.

use core::f64::consts::{FRAC_PI_2, PI};

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{AssemblyMode, Delta, Dimensions, ElbowSide, InverseError, Pose};

use crate::common::thesis::thesis;

/// Angles away from singular poses, in radians.
const ANGLE_ERROR: f64 = 1e-13;

/// The pose with the elbows in, in the one assembly mode that has it there.
fn bent_in(delta: &Delta, point: Point3<f64>) -> Pose {
    let bent = delta.with_working_mode([ElbowSide::In; 3]);
    let lower = bent.pose_at(point);
    let upper = bent.with_assembly_mode(AssemblyMode::Upper).pose_at(point);
    assert!(lower.is_ok() != upper.is_ok(), "{lower:?} {upper:?}");
    lower.or(upper).unwrap()
}

/// Some divide by z: off by 0.02° at z = -1e-12, not a number at 0, which the listing that goes
/// round in forums then hands on.
#[test]
fn the_plane_of_the_hips_is_no_exception() {
    // Rods short enough for the platform to come up between the shoulders, above its elbows.
    let delta: Delta = Delta::new(Dimensions {
        base: 60.0,
        platform: 20.0,
        upper: 120.0,
        lower: 130.0,
    })
    .unwrap()
    .with_assembly_mode(AssemblyMode::Upper);
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
    let mut arms = *thesis().arms();
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
        let pose = delta.pose_at(point).unwrap();
        for ((elbow, arm), angle) in pose.elbows().iter().zip(arms).zip(&angles) {
            let wrist =
                point + Vector3::new(arm.azimuth.cos(), arm.azimuth.sin(), 0.0) * arm.platform;
            assert!(((wrist - elbow).norm() - arm.lower).abs() <= delta.tolerance());
            let theta = angle + arm.zero;
            assert!((elbow.z + arm.upper * theta.cos()).abs() <= delta.tolerance());
        }
    }
}

/// An arcsine cannot see beyond 90°.
#[test]
fn arms_above_horizontal_are_found() {
    let delta = thesis();
    for theta in [1.5, FRAC_PI_2, 1.6, 2.0, 2.4] {
        let angles = Vector3::new(theta, theta - 0.1, theta + 0.1);
        let back = delta.inverse(delta.forward(angles).unwrap()).unwrap();
        assert!((back - angles).amax() < ANGLE_ERROR, "{theta}: {back}");
    }
}

/// In the tangent half-angle form θ = π has no tangent, and there the root that means "elbow
/// out" changes its sign.
#[test]
fn straight_up_is_an_angle_like_others() {
    // A platform wider than the base, for which an elbow straight up is out.
    let delta: Delta = Delta::new(Dimensions {
        base: 18.0,
        platform: 42.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap();
    for off in [-1e-3, -1e-9, 0.0, 1e-9, 1e-3] {
        let angles = Vector3::repeat(PI + off);
        let point = delta.forward(angles).unwrap();
        let back = delta.inverse(point).unwrap();
        let turns = ((back - angles) / (2.0 * PI)).map(f64::round);
        assert!(
            (back - angles - turns * 2.0 * PI).amax() < ANGLE_ERROR,
            "{off}: {back}"
        );
        let other = bent_in(&delta, point).angles();
        assert!(other.iter().all(|angle| angle.is_finite()));
        assert!((other - back).amin() > 0.1);
    }
}

/// Elbow out is the solution whose elbow is farther from the base's axis, wherever A changes sign.
#[test]
fn knees_keep_their_names() {
    let delta = thesis();
    for z in -340..-130 {
        let point = Point3::new(20.0, -10.0, f64::from(z));
        let out = delta.pose_at(point).unwrap();
        let inside = bent_in(&delta, point);
        for (out, inside) in out.elbows().iter().zip(inside.elbows()) {
            let radial = out.coords.normalize();
            assert!(radial.dot(&(out - inside)) > 0.0 || out.z > inside.z, "{z}");
        }
        let levers = out.levers();
        assert!(levers.max() < 0.0, "{z}: {levers}");
        let levers = inside.levers();
        assert!(levers.min() > 0.0, "{z}: {levers}");
    }
}

/// What `forward` made is never refused in the same modes, stretched and folded arms among it.
#[test]
fn own_stretched_and_folded_poses_are_reached() {
    let delta = thesis();
    for step in 0..20_000 {
        let turn = f64::from(step) * 0.618;
        let angles = Vector3::new(turn, turn * 1.7, turn * 2.9).map(|a| a % (2.0 * PI) - PI);
        for assembly_mode in [AssemblyMode::Lower, AssemblyMode::Upper] {
            let delta = delta.with_assembly_mode(assembly_mode);
            let Ok(pose) = delta.pose_of(angles) else {
                continue;
            };
            let elbows = <[f64; 3]>::from(pose.levers()).map(|lever| {
                if lever > 0.0 {
                    ElbowSide::In
                } else {
                    ElbowSide::Out
                }
            });
            let reached = delta.with_working_mode(elbows).inverse(pose.point());
            assert!(reached.is_ok(), "{angles}: {reached:?}");
        }
    }
    // All arms stretched or folded in their planes, where elbow out and elbow in are one.
    let plain: Delta = Delta::new(Dimensions {
        base: 50.0,
        platform: 40.0,
        upper: 100.0,
        lower: 200.0,
    })
    .unwrap();
    for theta in [-10f64.atan2(300.0), 10f64.atan2(100.0)] {
        for elbow in [ElbowSide::Out, ElbowSide::In] {
            let machine = plain.with_working_mode([elbow; 3]);
            let made = machine.forward(Vector3::repeat(theta)).unwrap();
            let back = machine.inverse(made).unwrap();
            assert!((machine.forward(back).unwrap() - made).norm() < 1e-12);
        }
    }
}

/// Some answer where all elbows meet on the axis: three rods beside each other hold nothing.
#[test]
fn knees_on_one_place_hold_no_platform() {
    let plain: Delta = Delta::new(Dimensions {
        base: 50.0,
        platform: 50.0,
        upper: 100.0,
        lower: 200.0,
    })
    .unwrap();
    for z in [-300.0, -100.0, 100.0, 300.0] {
        let refused = plain.inverse(Point3::new(0.0, 0.0, z));
        assert_eq!(refused, Err(InverseError::Collinear), "{z}");
    }
}

/// A wrist on the motor's axis is reached by every angle, or by none.
#[test]
fn a_wrist_on_the_motors_axis_is_said_to_be_indefinite() {
    let delta: Delta = Delta::new(Dimensions {
        base: 50.0,
        platform: 50.0,
        upper: 100.0,
        lower: 100.0,
    })
    .unwrap();
    assert!(matches!(
        delta.inverse(Point3::origin()),
        Err(InverseError::AnyAngle { .. })
    ));
    let delta: Delta = Delta::new(Dimensions {
        base: 50.0,
        platform: 50.0,
        upper: 100.0,
        lower: 120.0,
    })
    .unwrap();
    assert!(matches!(
        delta.inverse(Point3::origin()),
        Err(InverseError::TooNear { by, .. }) if (by - 20.0).abs() < 1e-12
    ));
}
