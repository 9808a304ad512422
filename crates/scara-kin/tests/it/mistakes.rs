//! Mistakes seen in other implementations, each as a test that they fail.

use core::f64::consts::{FRAC_PI_2, PI};

use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, Elbow, InverseError, JointRange, Joints, Limits};

use crate::common::{engraver, limits};

/// Forward and inverse of a pose away from singular ones, in radians.
const ANGLE_ERROR: f64 = 1e-12;

/// Poses all over the arm's range, the straight and folded ones among them.
fn poses() -> impl Iterator<Item = Joints> {
    (-18..=18).flat_map(|shoulder| {
        (-18..=18).map(move |elbow| {
            Joints::new(
                f64::from(shoulder) * PI / 18.0,
                f64::from(elbow) * PI / 18.0,
            )
        })
    })
}

/// A flag that tests the elbow for < 90° instead of < 0 gives the other elbow for half
/// of all poses.
#[test]
fn elbow_of_a_pose_leads_back_to_the_pose() {
    let arm = engraver();
    let inner = |joints: &Joints| joints.elbow.sin().abs() > 0.1;
    for joints in poses().filter(inner) {
        let elbow = Elbow::of(&joints).unwrap();
        let back = arm.inverse_elbow(arm.forward(joints), elbow).unwrap();
        let change = back - joints;
        let turns = (change.x / (2.0 * PI)).round();
        assert!(
            (change.x - turns * 2.0 * PI).abs() < ANGLE_ERROR,
            "{joints:?}: {back:?}"
        );
        assert!(change.y.abs() < ANGLE_ERROR, "{joints:?}: {back:?}");
    }
}

/// Out of reach must not be clamped without a word.
#[test]
fn out_of_reach_is_an_error_with_its_margin() {
    assert_eq!(
        engraver().inverse(Point2::new(0.0, 265.0)),
        Err(InverseError::TooFar {
            distance: 265.0,
            reach: 264.0
        })
    );
    let unequal = Arm::new(200.0, 125.0).unwrap();
    assert_eq!(
        unequal.inverse(Point2::new(60.0, 0.0)),
        Err(InverseError::TooNear {
            distance: 60.0,
            reach: 75.0
        })
    );
}

/// Some refuse everything within 5.7° of straight.
#[test]
fn nearly_straight_is_reached() {
    let arm = engraver();
    for degrees in [5.7, 1.0, 1e-3, 1e-6, 0.0f64] {
        let joints = Joints::new(0.4, degrees.to_radians());
        let tip = arm.forward(joints);
        let back = arm.inverse_elbow(tip, Elbow::Right).unwrap();
        assert!((arm.forward(back) - tip).norm() <= arm.tolerance());
    }
}

/// Some refuse stretched and folded poses that their own forward function made.
#[test]
fn own_stretched_and_folded_poses_are_reached() {
    for (upper, fore) in [(132.0, 132.0), (200.0, 125.0), (0.1, 0.3), (1.0, 1e-6)] {
        let arm = Arm::new(upper, fore).unwrap();
        for elbow in [0.0, PI, -PI] {
            for step in 0..10_000 {
                let tip = arm.forward(Joints::new(f64::from(step) * 1e-3, elbow));
                let reached = arm.inverse(tip);
                let centre = reached == Err(InverseError::AnyAngle);
                assert!(
                    centre || reached.is_ok(),
                    "{upper} {fore} {elbow} {step}: {reached:?}"
                );
            }
        }
    }
}

/// Joints put exactly on their limits by our own forward function are within them.
#[test]
fn own_poses_on_the_limits_are_reached() {
    let ranges = limits([-1.0, 2.5], [0.0, 2.6]);
    let arm = engraver().with_limits(ranges);
    for shoulder in [-1.0, 0.3, 2.5] {
        for elbow in [0.0, 1e-9, 1e-4, 1.1, 2.6] {
            let joints = Joints::new(shoulder, elbow);
            let back = arm
                .inverse_elbow(arm.forward(joints), Elbow::Right)
                .unwrap();
            assert!(ranges.contains(&back), "{joints:?}: {back:?}");
            let miss = arm.forward(back) - arm.forward(joints);
            assert!(miss.norm() <= 2.0 * arm.tolerance(), "{joints:?}: {back:?}");
        }
    }
}

/// One elbow only.
#[test]
fn both_elbows_are_given() {
    let solutions = engraver().inverse(Point2::new(150.0, 80.0)).unwrap();
    let elbows: Vec<Elbow> = solutions.iter().map(|(elbow, _)| elbow).collect();
    assert_eq!(elbows, [Elbow::Right, Elbow::Left]);
    for (elbow, joints) in solutions.iter() {
        assert_eq!(Elbow::of(&joints), Some(elbow));
    }
}

/// A flip of the elbow in the middle of a move.
#[test]
fn a_stroke_keeps_its_elbow() {
    let arm = engraver();
    let line = [Point2::new(260.0, 0.0), Point2::new(20.0, 5.0)];
    for elbow in [Elbow::Right, Elbow::Left] {
        for waypoint in arm.follow(line, elbow, 0.01).unwrap() {
            assert_eq!(Elbow::of(&waypoint.joints), Some(elbow));
        }
    }
}

/// Joint limits choose the other elbow instead of hitting the stop.
#[test]
fn limits_choose_the_other_elbow() {
    let arm = engraver().with_limits(limits([-PI, PI], [-2.6, 0.0]));
    let solutions = arm.inverse(Point2::new(150.0, 80.0)).unwrap();
    assert_eq!(solutions.get(Elbow::Right), None);
    let near_right = Joints::new(-0.4, 1.7);
    let (elbow, joints) = arm
        .inverse_nearest(Point2::new(150.0, 80.0), near_right)
        .unwrap();
    assert_eq!(elbow, Elbow::Left);
    assert_eq!(solutions.get(Elbow::Left), Some(joints));
    assert!(matches!(
        arm.inverse_elbow(Point2::new(150.0, 80.0), Elbow::Right),
        Err(InverseError::JointLimit {
            elbow: Elbow::Right,
            ..
        })
    ));
}

/// A pose with the shoulder or elbow on the end of its range is no answer for the other elbow,
/// which would have to pass that end.
#[test]
fn the_other_elbow_is_not_answered_in_its_place() {
    let range = |min, max| JointRange::new(min, max).unwrap();
    for (arm, pose) in [
        (range(-1.0, 1.0), Joints::new(1.0, 0.8)),
        (range(-1.0, 1.0), Joints::new(-1.0, -0.8)),
        (range(-1.0, 1.0), Joints::new(1.0, 1e-3)),
        (range(0.5, 2.0), Joints::new(2.0, 3.1)),
        (range(0.5, 2.0), Joints::new(2.0 - 1e-15, 3.1)),
    ]
    .map(|(shoulder, pose)| {
        let elbow = JointRange::unlimited();
        let arm = Arm::new(132.0, 100.0).unwrap();
        (arm.with_limits(Limits { shoulder, elbow }), pose)
    }) {
        let own = Elbow::of(&pose).unwrap();
        let point = arm.forward(pose);
        let refused = arm.inverse_elbow_near(point, own.other(), pose);
        assert!(
            matches!(refused, Err(InverseError::JointLimit { elbow, .. }) if elbow == own.other()),
            "{pose:?}: {refused:?}"
        );
        let solutions = arm.inverse(point).unwrap();
        assert!(solutions.get(own).is_some() && solutions.get(own.other()).is_none());
    }
}

/// The nearest solution keeps the whole turn that the arm is on, as far as limits allow.
#[test]
fn nearest_solution_counts_whole_turns() {
    let arm = engraver();
    let point = arm.forward(Joints::new(3.0, 1.0));
    let wound = Joints::new(3.0 - 4.0 * PI, 1.1 + 2.0 * PI);
    let (elbow, joints) = arm.inverse_nearest(point, wound).unwrap();
    assert_eq!(elbow, Elbow::Right);
    assert!((joints - wound).amax() < 0.2);

    let limited = arm.with_limits(limits([-1.5 * PI, 1.5 * PI], [-PI, PI]));
    let (_, joints) = limited.inverse_nearest(point, wound).unwrap();
    // 3.0 - 2π is in range and nearer to the wound-up shoulder than 3.0.
    assert!((joints.shoulder - (3.0 - 2.0 * PI)).abs() < ANGLE_ERROR);
    assert!((joints.elbow - 1.0).abs() < ANGLE_ERROR);
}

/// At the base of equal links there are infinitely many solutions.
#[test]
fn the_centre_of_equal_links_is_said_to_be_degenerate() {
    let arm = engraver();
    assert_eq!(arm.inverse(Point2::origin()), Err(InverseError::AnyAngle));
    let stay = Joints::new(0.7, 2.9);
    let folded = arm.inverse_nearest(Point2::origin(), stay).unwrap();
    assert_eq!(folded, (Elbow::Right, Joints::new(0.7, PI)));

    // A shoulder out of its range comes back to the end of it; no elbow folds to 150°.
    let folded = |limits| {
        let limited = arm.with_limits(limits);
        limited.inverse_nearest(Point2::origin(), stay)
    };
    let ranges = Limits {
        shoulder: JointRange::new(-0.5, 0.5).unwrap(),
        elbow: JointRange::unlimited(),
    };
    assert_eq!(folded(ranges), Ok((Elbow::Right, Joints::new(0.5, PI))));
    let refused = folded(limits([-0.5, 0.5], [-2.6, 2.6]));
    assert!(matches!(refused, Err(InverseError::JointLimit { .. })));
}

/// Half a turn that is taken back by a whole one is rounded twice.
#[test]
fn a_folded_arm_comes_back_into_its_range_in_f32() {
    let ranges = Limits {
        shoulder: JointRange::new(0.5, 5.5).unwrap(),
        elbow: JointRange::unlimited(),
    };
    let arm = Arm::<f32>::new(132.0, 132.0).unwrap().with_limits(ranges);
    for previous in [-0.0, 0.0, 0.4, 5.6, 6.2] {
        let previous = Joints::new(previous, 0.0);
        let (_, joints) = arm.inverse_nearest(Point2::origin(), previous).unwrap();
        let nearest = if previous.shoulder < 3.0 { 0.5 } else { 5.5 };
        assert!((joints.shoulder - nearest).abs() < 1e-6, "{previous:?}");
        assert!((joints.elbow.abs() - core::f32::consts::PI).abs() < 1e-6);
    }
}

/// No NaN in, no NaN out.
#[test]
fn coordinates_that_are_not_finite_are_refused() {
    let arm = engraver();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for point in [Point2::new(bad, 1.0), Point2::new(1.0, bad)] {
            assert!(matches!(
                arm.inverse(point),
                Err(InverseError::NotFinite { .. })
            ));
        }
    }
    let far = arm.inverse(Point2::new(f64::MAX, -f64::MAX));
    assert!(matches!(far, Err(InverseError::TooFar { distance, .. }) if distance.is_finite()));
}

/// A straight tool line through a quarter turn of the elbow, by hand.
#[test]
fn right_angle_by_hand() {
    let arm = engraver();
    let tip = arm.forward(Joints::new(0.0, FRAC_PI_2));
    assert!((tip - Point2::new(132.0, 132.0)).norm() < arm.tolerance());
    let joints = arm
        .inverse_elbow(Point2::new(132.0, 132.0), Elbow::Right)
        .unwrap();
    assert!(joints.shoulder.abs() < ANGLE_ERROR);
    assert!((joints.elbow - FRAC_PI_2).abs() < ANGLE_ERROR);
}
