//! Curves and tables that are refused, with the place.

use core::f64::consts::{FRAC_PI_2, PI};

use path_timing::{Curve, Knot, PlanError, Row, Span, Table};
use scara_kin::{Arm, ArmPath, ArmPathError, Elbow, InverseError, Joint, JointRange, Limits};

use crate::{JOINT, arm, line};

#[test]
fn what_cannot_be_followed_is_refused_with_its_place() {
    let arm = arm().with_keep_out(40.0).unwrap();
    let refused = |arm: &Arm, from, to| arm.path(line(from, to), Elbow::Right).unwrap_err();
    let near = |s: f64, wanted: f64| assert!((s - wanted).abs() < 0.01, "{s} {wanted}");
    // Over the rim, into the keep-out disc, through the base.
    let ArmPathError::Edge { s, point, .. } = refused(&arm, [200.0, 0.0], [300.0, 0.0]) else {
        panic!()
    };
    near(s, 64.0);
    near(point.x, 264.0);
    let ArmPathError::Edge { s, .. } = refused(&arm, [-100.0, 0.0], [100.0, 0.0]) else {
        panic!()
    };
    near(s, 60.0);
    let free = Arm::new(132.0, 132.0).unwrap();
    let ArmPathError::Edge { s, .. } = refused(&free, [-100.0, 0.0], [100.0, 0.0]) else {
        panic!()
    };
    near(s, 100.0);
    // A start out of reach.
    let error = refused(&arm, [300.0, 0.0], [200.0, 0.0]);
    assert_eq!(
        error.to_string(),
        "at 0 of the curve, (300, 0): too far: distance 300 from the base is past the reach 264 by 36"
    );
    // A joint limit: the shoulder at π/2 where the tool is there by the elbow's half angle more.
    let limited = free.with_limits(Limits {
        shoulder: JointRange::new(-FRAC_PI_2, FRAC_PI_2).unwrap(),
        elbow: JointRange::new(-3.0, 3.0).unwrap(),
    });
    let circle = Curve::arc([200.0, 0.0], [0.0, 0.0], [0.0, 1.0], 3.0).unwrap();
    let start = limited
        .path(line([200.0, 0.0], [199.0, 0.0]), Elbow::Right)
        .unwrap();
    let first = start.joints(0.0).unwrap().shoulder;
    let Err(ArmPathError::Unreachable { s, reason, .. }) = limited.path(circle, Elbow::Right)
    else {
        panic!()
    };
    near(s, 200.0 * (FRAC_PI_2 - first));
    assert!(matches!(
        reason,
        InverseError::JointLimit {
            joint: Joint::Shoulder,
            ..
        }
    ));
    // A range that has the other turn only.
    let turned = free.with_limits(Limits {
        shoulder: JointRange::new(-PI, PI).unwrap(),
        elbow: JointRange::new(-3.0, 3.0).unwrap(),
    });
    let behind = turned.path(line([-200.0, 100.0], [-200.0, -200.0]), Elbow::Right);
    assert!(
        matches!(
            behind,
            Err(ArmPathError::Unreachable {
                reason: InverseError::JointLimit { .. },
                ..
            })
        ),
        "{behind:?}"
    );
    // No departure is small enough for a segment on which a limit is passed.
    let path = limited
        .path(line([200.0, 0.0], [199.0, 0.0]), Elbow::Right)
        .unwrap();
    let row = |shoulder| Row {
        time_s: 0.0,
        duration_s: 1.0,
        position: [shoulder, 1.0],
        velocity: [0.5, 0.0],
    };
    let span = Span {
        s: [0.0, 1.0],
        rows: [row(1.5), row(1.6)],
    };
    assert!(path.departure(&span).is_infinite());
}

/// The digits of the curve do not show the arm: the walk along it would take hours.
#[test]
fn an_arm_too_small_for_the_curve_is_no_endless_walk() {
    let arm = Arm::new(7.5e-38, 7.5e-38).unwrap();
    let arc = Curve::arc([0.0, -1e-38], [0.0, 8e10], [1.0, 0.0], 0.1).unwrap();
    let error = arm.path(arc, Elbow::Left).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the curve is 8e9 long, within the workspace at most 1.5e-35"
    );
}

#[test]
fn knots_that_are_too_few_for_a_tolerance_are_refused() {
    let path = arm()
        .path(line([100.0, 100.0], [150.0, 100.0]), Elbow::Left)
        .unwrap();
    let mut knots = [Knot::default(); 4];
    let table = Table::plan_within([path], [JOINT; 2], 2, 1e-9, ArmPath::departure, &mut knots);
    let Err(PlanError::Memory {
        needed,
        available: 4,
    }) = table
    else {
        panic!("{table:?}")
    };
    assert!(needed > 4);
}
