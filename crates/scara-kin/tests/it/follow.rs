//! Following curves: guarantees, errors and the places they name.

use core::f64::consts::PI;

use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, Elbow, FollowError, InverseError, Joint, Joints};

use crate::common::{engraver, limits};

/// A place is found to the shortest step, 2⁻³⁰ of a line.
const PLACE: f64 = 1e-8;

fn line(from: (f64, f64), to: (f64, f64)) -> [Point2<f64>; 2] {
    [Point2::new(from.0, from.1), Point2::new(to.0, to.1)]
}

/// 500 mm past the base at a distance.
fn pass(distance: f64) -> [Point2<f64>; 2] {
    line((-250.0, distance), (250.0, distance))
}

/// Equal steps would have to be as short everywhere as beside the base: how many, to
/// the next power of two.
fn equal_steps(arm: &Arm, line: [Point2<f64>; 2], tolerance: f64) -> u64 {
    let keeps = |steps: u32| {
        let at = |k: u32| line[0] + (line[1] - line[0]) * (f64::from(k) / f64::from(steps));
        let mut from = arm.inverse_elbow(at(0), Elbow::Right).unwrap();
        (1..=steps).all(|k| {
            let to = arm.inverse_elbow_near(at(k), Elbow::Right, from).unwrap();
            let keeps = arm.chord_bound(from, to) <= tolerance;
            from = to;
            keeps
        })
    };
    let steps = (0..).map(|k| 1 << k).find(|steps| keeps(*steps));
    steps.unwrap().into()
}

#[test]
fn half_a_millimetre_from_the_base_steps_are_short_only_there() {
    let arm = engraver();
    let waypoints = arm.follow(pass(0.5), Elbow::Right, 0.01).unwrap();
    let equal = equal_steps(&arm, pass(0.5), 0.01);
    println!(
        "0.5 mm: {} waypoints, {equal} equal steps",
        waypoints.remaining()
    );
    assert!(waypoints.remaining() < 120, "{}", waypoints.remaining());
    assert!(equal > 20 * waypoints.remaining(), "{equal}");
}

#[test]
fn far_from_the_base_steps_are_nearly_equal() {
    let arm = engraver();
    let line = line((-200.0, 100.0), (200.0, 100.0));
    let waypoints = arm.follow(line, Elbow::Right, 0.01).unwrap();
    let equal = equal_steps(&arm, line, 0.01);
    println!(
        "100 mm: {} waypoints, {equal} equal steps",
        waypoints.remaining()
    );
    assert!(waypoints.remaining() < 2 * equal);
}

#[test]
fn leaving_the_reach_names_the_place() {
    let error = engraver()
        .follow(line((0.0, 200.0), (0.0, 300.0)), Elbow::Right, 0.01)
        .unwrap_err();
    let FollowError::Unreachable {
        line: 0,
        fraction,
        reason,
        ..
    } = error
    else {
        panic!("{error}");
    };
    assert!((fraction - 0.64).abs() < PLACE, "{error}");
    assert!(matches!(reason, InverseError::TooFar { .. }));
}

/// Both ends are within reach; the line between them is not.
#[test]
fn dipping_into_the_inner_circle_names_the_place() {
    let unequal = Arm::new(200.0, 125.0).unwrap();
    let kept_out = engraver().with_keep_out(75.0).unwrap();
    let points = [
        Point2::new(-100.0, 200.0),
        Point2::new(-100.0, 60.0),
        Point2::new(100.0, 60.0),
    ];
    for arm in [unequal, kept_out] {
        // A coarse tolerance would step right over it.
        for tolerance in [0.01, 50.0] {
            let error = arm.follow(points, Elbow::Left, tolerance).unwrap_err();
            let FollowError::Unreachable {
                line: 1,
                fraction,
                reason,
                ..
            } = error
            else {
                panic!("{error}");
            };
            // The circle of 75 mm is met at x = -45.
            assert!((fraction - 55.0 / 200.0).abs() < PLACE, "{error}");
            assert!(matches!(reason, InverseError::TooNear { .. }));
        }
    }
}

#[test]
fn passing_a_limit_names_joint_and_place() {
    let arm = engraver().with_limits(limits([-1.0, 1.0], [-PI, PI]));
    // An arc of 150 mm: the shoulder runs from -0.5 past 1.
    let arc = (0..=200).map(|k| {
        let angle = f64::from(k) * 0.01;
        arm.forward(Joints::new(angle - 0.5, 1.2))
    });
    let error = arm.follow(arc, Elbow::Right, 0.01).unwrap_err();
    let FollowError::Unreachable { line, reason, .. } = error else {
        panic!("{error}");
    };
    assert!((149..=150).contains(&line), "{error}");
    assert!(matches!(
        reason,
        InverseError::JointLimit {
            joint: Joint::Shoulder,
            elbow: Elbow::Right,
            max: 1.0,
            ..
        }
    ));
}

/// A range wider than a turn has an end too: the joint must not wind back in mid-stroke.
#[test]
fn the_end_of_a_wide_range_is_a_limit() {
    let arm = engraver().with_limits(limits([-3.4, 3.4], [-PI, PI]));
    let arc = (0..=100).map(|k| arm.forward(Joints::new(3.0 + f64::from(k) * 0.01, 1.2)));
    let near = Joints::new(3.0, 1.2);
    let error = arm
        .follow_from(arc.clone(), Elbow::Right, 0.01, near)
        .unwrap_err();
    let FollowError::Unreachable { line, reason, .. } = error else {
        panic!("{error}");
    };
    assert!((39..=40).contains(&line), "{error}");
    assert!(
        matches!(reason, InverseError::JointLimit { angle, max: 3.4, .. } if angle > 3.4 && angle < 3.5)
    );
    // Begun one turn lower, the same arc is free.
    let low = Joints::new(3.0 - 2.0 * PI, 1.2);
    let waypoints = arm.follow_from(arc, Elbow::Right, 0.01, low).unwrap();
    assert!(waypoints.clone().all(|w| w.joints.shoulder < -2.0));
}

#[test]
fn through_the_base_a_joint_would_jump() {
    let through = line((-50.0, 0.0), (50.0, 0.0));
    let error = engraver().follow(through, Elbow::Right, 0.01).unwrap_err();
    let at = match error {
        FollowError::Singular { fraction, .. } | FollowError::Unreachable { fraction, .. } => {
            fraction
        }
        other => panic!("{other}"),
    };
    assert!((at - 0.5).abs() < PLACE, "{error}");
}

#[test]
fn bad_curves_and_tolerances_are_refused() {
    let arm = engraver();
    let good = line((100.0, 100.0), (120.0, 100.0));
    for tolerance in [0.0, -1.0, 1e-13, f64::NAN, f64::INFINITY] {
        let error = arm.follow(good, Elbow::Right, tolerance).unwrap_err();
        assert!(matches!(error, FollowError::Tolerance { .. }), "{error}");
    }
    let none: [Point2<f64>; 0] = [];
    let error = arm.follow(none, Elbow::Right, 0.01).unwrap_err();
    assert_eq!(error, FollowError::Empty);
    let broken = line((100.0, 100.0), (f64::NAN, 100.0));
    let error = arm.follow(broken, Elbow::Right, 0.01).unwrap_err();
    assert!(matches!(
        error,
        FollowError::Unreachable {
            reason: InverseError::NotFinite { .. },
            ..
        }
    ));
}

#[test]
fn points_are_kept_and_repeated_ones_are_not() {
    let arm = engraver();
    let (a, b) = (Point2::new(100.0, 100.0), Point2::new(100.5, 100.0));
    let one = arm.follow([a, a, a], Elbow::Left, 0.01).unwrap();
    assert_eq!(one.remaining(), 1);
    let waypoints: Vec<_> = arm
        .follow([a, a, b, b, a], Elbow::Left, 0.01)
        .unwrap()
        .collect();
    let places: Vec<_> = waypoints.iter().map(|w| (w.line, w.point)).collect();
    assert_eq!(places, [(0, a), (1, b), (3, a)]);
}

#[test]
fn a_closed_circle_ends_where_it_began() {
    let arm = engraver();
    let circle = (0..=360).map(|k| {
        let angle = f64::from(k).to_radians();
        Point2::new(150.0 + 60.0 * angle.cos(), 60.0 * angle.sin())
    });
    let waypoints: Vec<_> = arm.follow(circle, Elbow::Right, 0.02).unwrap().collect();
    let (first, last) = (waypoints.first().unwrap(), waypoints.last().unwrap());
    assert!((last.joints - first.joints).amax() < 1e-12);
}
