//! Curves and tables that are refused, with the place.

use core::f64::consts::{FRAC_PI_2, PI};

use path_timing::{Cubic, Curve, Knot, LookAhead, Path as _, PlanError, Row, Span, Table};
use scara_kin::{Arm, ArmPath, ArmPathError, Elbow, InverseError, Joint, JointRange, Limits};

use crate::common::{engraver, limits};
use crate::paths::{JOINT, line, within};

#[test]
fn what_cannot_be_followed_is_refused_with_its_place() {
    let arm = engraver().with_keep_out(40.0).unwrap();
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
    let free = engraver();
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
    let limited = free.with_limits(limits([-FRAC_PI_2, FRAC_PI_2], [-3.0, 3.0]));
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
    let turned = free.with_limits(limits([-PI, PI], [-3.0, 3.0]));
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
}

/// A line past the base of an arm of 132 and 132 mm, on which the elbow is bent most halfway.
fn past() -> Curve<2> {
    line([80.0, 40.0], [80.0, -40.0])
}

/// The elbow's angle halfway.
fn bent() -> f64 {
    let path = engraver().path(past(), Elbow::Right).unwrap();
    path.joints(40.0).unwrap().elbow
}

fn with_elbow(most: f64) -> Arm {
    engraver().with_limits(Limits {
        elbow: JointRange::new(-most, most).unwrap(),
        ..Limits::unlimited()
    })
}

/// Ends within the range, the middle beyond.
#[test]
fn a_path_through_a_joint_limit_is_refused_when_it_is_made() {
    let limited = with_elbow(2.51);
    for elbow in [Elbow::Left, Elbow::Right] {
        let error = limited.path(past(), elbow).unwrap_err();
        let ArmPathError::Unreachable {
            s,
            reason: InverseError::JointLimit { joint, .. },
            ..
        } = error
        else {
            panic!("{error}")
        };
        assert_eq!(joint, Joint::Elbow);
        let at = engraver().inverse_elbow(past().at(s).point, elbow);
        assert!((at.unwrap().elbow.abs() - 2.51).abs() < 1e-6);
    }
    // However narrow the part beyond is.
    for by in [1e-3, 1e-5, 1e-7] {
        let error = with_elbow(bent() - by).path(past(), Elbow::Right);
        assert!(error.is_err(), "{by}");
        let path = with_elbow(bent() + by).path(past(), Elbow::Right);
        assert!(path.is_ok(), "{by}: {path:?}");
    }
    // Along an end of a range, up to one and from one.
    let round = Curve::arc([80.0, 0.0], [0.0, 0.0], [0.0, 1.0], 1.0).unwrap();
    assert!(with_elbow(bent()).path(round, Elbow::Right).is_ok());
    for ends in [[40.0, 0.0], [0.0, 40.0]] {
        let line = line([80.0, ends[0]], [80.0, ends[1]]);
        assert!(with_elbow(bent()).path(line, Elbow::Right).is_ok());
    }
}

/// Cubics of a coarse table go further than the path: then it is refused.
#[test]
fn planners_refuse_segments_that_pass_a_joint_limit() {
    const RANGE: f64 = 1e-4;
    let limited = with_elbow(bent() + RANGE);
    let path = limited.path(past(), Elbow::Right).unwrap();
    let mut knots = [Knot::default(); 100];
    let mut window = [Knot::default(); 16];
    let (mut refused, mut accepted) = (0, 0);
    for segments in 2..=60 {
        let rows = Table::plan([path], [JOINT; 2], |_| segments, &mut knots)
            .map(|table| table.rows().collect::<Vec<_>>());
        let stream = LookAhead::new([path], [JOINT; 2], |_| Ok(segments), &mut window).unwrap();
        let streamed: Result<Vec<_>, _> = stream.collect();
        for rows in [rows, streamed] {
            match rows {
                Ok(rows) => {
                    for pair in rows.windows(2) {
                        let elbow = Cubic::between(&pair[0], &pair[1]).nth(1).unwrap();
                        assert!(elbow.extent()[1] <= bent() + RANGE + 1e-9, "{segments}");
                    }
                    accepted += 1;
                }
                Err(PlanError::Path { s, reason, .. }) => {
                    let ArmPathError::Limit {
                        s: [from, to],
                        joint: Joint::Elbow,
                        angle,
                        max,
                        ..
                    } = reason
                    else {
                        panic!("{reason}")
                    };
                    assert!(angle > max && s >= from && s < to);
                    refused += 1;
                }
                Err(PlanError::TooCoarse { .. }) => {}
                Err(error) => panic!("{error}"),
            }
        }
    }
    println!("{refused} refused, {accepted} accepted");
    assert!(refused > 4 && accepted > 20, "{refused} {accepted}");
}

/// What the planners ask of a segment, and what they are told.
#[test]
fn segments_beyond_a_range_or_in_the_keep_out_are_refused() {
    let row = |position: [f64; 2], velocity| Row {
        time_s: 0.0,
        duration_s: 1.0,
        position,
        velocity,
        leg: 0,
        s: 0.0,
    };
    let span = |from, to| Span {
        s: [2.0, 3.0],
        rows: [row(from, [0.0, 0.5]), row(to, [0.0, -0.5])],
    };
    let limited = with_elbow(2.0).with_keep_out(150.0).unwrap();
    let path = limited
        .path(line([200.0, 0.0], [199.0, 0.0]), Elbow::Right)
        .unwrap();
    // At rest at 1.9 it would hold; with ±0.5 it rises by T v/4.
    let error = path.check(&span([0.0, 1.9], [0.0, 1.9])).unwrap_err();
    assert_eq!(
        error.to_string(),
        "from 2 to 3 of the curve: elbow turns to 2.025 rad, outside its range -2..=2 rad by 0.025 rad"
    );
    let disc = path.with_disc(0.0).unwrap();
    let wide = |row: Row<[f64; 2]>| Row {
        time_s: row.time_s,
        duration_s: row.duration_s,
        position: [row.position[0], row.position[1], 0.0],
        velocity: [row.velocity[0], row.velocity[1], 0.0],
        leg: row.leg,
        s: row.s,
    };
    let Span { s, rows } = span([0.0, 1.9], [0.0, 1.9]);
    assert_eq!(
        disc.check(&Span {
            s,
            rows: rows.map(wide)
        }),
        Err(error)
    );
    // 2 · 132 · cos(elbow/2) = 150 at 1.9342.
    assert_eq!(path.check(&span([0.0, 1.8], [0.0, 1.8])), Ok(()));
    let error = path.check(&span([0.0, 1.84], [0.0, 1.84])).unwrap_err();
    assert_eq!(
        error.to_string(),
        "from 2 to 3 of the curve: the tool comes to 146.505 from the base, into the keep-out disc of radius 150 by 3.49463"
    );
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
    let path = engraver()
        .path(line([100.0, 100.0], [150.0, 100.0]), Elbow::Left)
        .unwrap();
    let mut knots = [Knot::default(); 9];
    let accuracy = within(1e-9);
    let table = Table::plan_within([path], [JOINT; 2], accuracy, ArmPath::departure, &mut knots);
    let Err(PlanError::Memory {
        needed,
        available: 9,
    }) = table
    else {
        panic!("{table:?}")
    };
    assert!(needed > 9);
}
