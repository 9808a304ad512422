//! What a geometry refuses, and the workspace it gives.

use core::f64::consts::PI;

use scara_kin::nalgebra::{Isometry2, Point2, Vector2};
use scara_kin::{
    Arm, Drives, GeometryError, InverseError, Joints, RatesError, TangentError, TangentTool,
};

use crate::common::{engraver, limits};

/// Roundings of a few lengths of some hundred.
const ROUNDING: f64 = 1e-12;

#[test]
fn wrong_geometries_are_refused() {
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e100, 1e-60] {
        for (upper, fore) in [(length, 1.0), (1.0, length)] {
            let error = Arm::new(upper, fore).unwrap_err();
            assert!(matches!(error, GeometryError::LinkLength { .. }), "{error}");
        }
    }
    let arm = Arm::new(132.0, 100.0).unwrap();
    for radius in [-1.0, 232.0, f64::NAN] {
        let error = arm.with_keep_out(radius).unwrap_err();
        assert!(matches!(error, GeometryError::KeepOut { .. }), "{error}");
    }
    let nowhere = Isometry2::new(Vector2::new(0.0, f64::NAN), 0.0);
    let error = arm.with_base(nowhere).unwrap_err();
    assert!(error.to_string().contains("base y is NaN"), "{error}");
    assert!(Drives::default().with_coupling(f64::INFINITY).is_err());
}

#[test]
fn lengths_of_any_size_work() {
    for size in [1e-37, 1e-9, 1.0, 1e9, 1e75] {
        let arm = Arm::new(size, 0.7 * size).unwrap();
        let tip = arm.forward(Joints::new(0.3, 1.2));
        let (_, joints) = arm.inverse_nearest(tip, Joints::new(0.3, 1.2)).unwrap();
        assert!((joints - Joints::new(0.3, 1.2)).amax() < 1e-14);
    }
    let small = Arm::new(1e-4f32, 1e-4).unwrap();
    assert!(small.inverse(Point2::new(1e-4, 0.0)).is_ok());
}

#[test]
fn the_keep_out_disc_is_not_entered() {
    let arm = engraver().with_keep_out(40.0).unwrap();
    assert!(arm.inverse(Point2::new(40.0, 0.0)).is_ok());
    assert_eq!(
        arm.inverse(Point2::new(0.0, 39.0)),
        Err(InverseError::TooNear {
            distance: 39.0,
            reach: 40.0
        })
    );
    assert_eq!(
        arm.inverse(Point2::origin()),
        Err(InverseError::TooNear {
            distance: 0.0,
            reach: 40.0
        })
    );
}

#[test]
fn limits_cut_the_annulus() {
    let arm: Arm = Arm::new(132.0, 100.0).unwrap();
    let limited = arm.with_limits(limits([-1.0, 1.0], [0.1, 2.0]));
    let inside = arm.forward(Joints::new(0.5, 1.0));
    let outside = arm.forward(Joints::new(-2.5, 1.0));
    assert!(limited.is_reachable(inside));
    assert!(!limited.is_reachable(outside) && arm.is_reachable(outside));
}

#[test]
fn straight_and_folded_arms_have_no_joint_rates() {
    let arm = Arm::new(132.0, 100.0).unwrap();
    for elbow in (-200..=200).map(|half_turns| f64::from(half_turns) * PI) {
        let rates = arm.joint_rates(Joints::new(0.3, elbow), Vector2::x());
        assert_eq!(rates, Err(RatesError::Singular { elbow }));
    }
    assert!(arm.singularity_distance(Joints::new(0.3, 0.0)).abs() < ROUNDING);
}

/// With links of √2 : 1 and the elbow at 135° the Jacobian is isotropic: the tool moves equally
/// well in all directions, by one forearm per radian.
#[test]
fn isotropic_poses_are_found_to_the_last_digits() {
    for fore in [100.0, 93.7, 0.31] {
        let arm = Arm::new(fore * 2f64.sqrt(), fore).unwrap();
        for shoulder in (0..100).map(|k| f64::from(k) * 0.07) {
            let distance = arm.singularity_distance(Joints::new(shoulder, 0.75 * PI));
            let error = (distance - fore) / fore;
            assert!(error.abs() < 4.0 * f64::EPSILON, "{shoulder}: {error:e}");
        }
    }
}

#[test]
fn the_disc_refuses_what_has_no_heading() {
    let arm = engraver();
    let joints = Joints::new(0.2, 0.9);
    let mut disc = TangentTool::new(0.3).unwrap();
    disc.follow(&arm, joints, Vector2::y()).unwrap();
    let before = disc;
    for direction in [Vector2::zeros(), Vector2::new(f64::NAN, 1.0)] {
        let error = disc.follow(&arm, joints, direction).unwrap_err();
        assert!(matches!(error, TangentError::NoHeading { .. }));
    }
    let error = disc.follow(&arm, Joints::new(f64::NAN, 0.0), Vector2::x());
    assert!(matches!(error, Err(TangentError::OutOfRange { .. })));
    assert_eq!(disc, before);
    assert!(TangentTool::new(0.0).is_err() && TangentTool::new(f64::NAN).is_err());
}

/// A disc that stands at nearly a whole turn goes on to it, not back to zero.
#[test]
fn the_disc_turns_from_where_it_stands() {
    let arm = engraver();
    let mut disc = TangentTool::new(0.3).unwrap().starting_at(6.0).unwrap();
    let turn = disc
        .follow(&arm, Joints::new(0.0, 0.0), Vector2::x())
        .unwrap();
    assert!((turn.tool_angle - core::f64::consts::TAU).abs() < ROUNDING);
    assert!(disc.starting_at(f64::NAN).is_err());
}

/// Where a new stroke begins there is no corner, and the shorter turn is taken.
#[test]
fn a_lifted_disc_takes_the_shorter_turn() {
    let arm = engraver();
    let joints = Joints::new(0.0, 0.0);
    let mut disc = TangentTool::new(0.3).unwrap();
    let first = disc.follow(&arm, joints, Vector2::new(-1.0, 0.1)).unwrap();
    disc.lift();
    let second = disc.follow(&arm, joints, Vector2::new(-1.0, -0.1)).unwrap();
    assert!(second.corner.is_none());
    assert!(second.tool_angle > first.tool_angle && second.tool_angle > PI);
}
