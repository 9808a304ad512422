//! Joints that stand many whole turns from zero, where a float's own rounding is coarser.

use core::f64::consts::{PI, TAU};

use scara_kin::nalgebra::{Point2, RealField, convert};
use scara_kin::{Arm, Elbow, JointRange, Joints, Limits, Trig};

use crate::common::{double, limits, rounding};

/// Turns of both joints: from none to nearly as many as there may be.
const TURNS: [i32; 9] = [0, 1, -3, 10, 20, -100, 400, 100_000, -10_000_000];

/// Poses all over one turn of both joints, none of them straight or folded.
fn poses<T: RealField + Trig>() -> impl Iterator<Item = Joints<T>> {
    (-18..18).flat_map(|shoulder| {
        (1..18).chain(-17..0).map(move |elbow| {
            let angle = |tenths: i32| convert((f64::from(tenths) + 0.37) * PI / 18.0);
            Joints::new(angle(shoulder), angle(elbow))
        })
    })
}

fn turned<T: RealField + Trig>(joints: Joints<T>, turns: i32) -> Joints<T> {
    let change: T = convert(f64::from(turns) * TAU);
    Joints::new(joints.shoulder + change, joints.elbow - change)
}

fn reaches_its_own_points<T: RealField + Trig>(least_elbow: T) {
    let arms = [(132.0, 132.0), (200.0, 125.0), (10.0, 300.0)]
        .map(|(upper, fore)| Arm::new(convert(upper), convert(fore)).unwrap());
    let largest = JointRange::<T>::unlimited().max() - T::two_pi();
    for turns in TURNS
        .into_iter()
        .filter(|n| convert::<_, T>(f64::from(n.abs()) * TAU) < largest)
    {
        for (arm, pose) in arms
            .iter()
            .flat_map(|arm| poses().map(move |pose: Joints<T>| (arm, pose)))
        {
            let pose = turned(pose, turns);
            if pose.elbow.sin().abs() < least_elbow {
                continue;
            }
            let tip = arm.forward(pose);
            let back = arm.inverse_elbow_near(tip, Elbow::of(&pose).unwrap(), pose);
            let back = back.unwrap_or_else(|error| panic!("{turns} turns, {pose:?}: {error}"));
            assert!((back - pose).amax() < T::one(), "{pose:?}: {back:?}");
            assert!(
                double((arm.forward(back) - tip).norm()) <= rounding(arm, pose),
                "{pose:?}: {back:?}"
            );
        }
    }
}

#[test]
fn own_points_are_reached_at_any_turn() {
    reaches_its_own_points::<f64>(0.0);
}

#[test]
fn own_points_are_reached_at_any_turn_in_f32() {
    reaches_its_own_points::<f32>(0.01);
}

#[test]
fn ranges_may_lie_turns_away() {
    for turns in [1.0, 16.0, 1000.0] {
        let middle = turns * TAU;
        let range = [middle - PI, middle + PI];
        let arm = Arm::new(132.0, 100.0)
            .unwrap()
            .with_limits(limits(range, range));
        for pose in poses() {
            let tip = arm.forward(pose);
            let solutions = arm.inverse(tip).unwrap();
            assert_eq!(solutions.iter().count(), 2, "{pose:?}");
            for (_, joints) in solutions.iter() {
                assert!(arm.limits().contains(&joints), "{joints:?}");
                assert!((arm.forward(joints) - tip).norm() <= rounding(&arm, joints));
            }
        }
    }
}

/// A joint at an end of its range is there, not just beyond it, and not a turn away from it.
#[test]
fn own_poses_at_the_ends_of_ranges_are_reached() {
    for turns in [0.0, 10.0, 100.0, -1e6] {
        for half_width in [1.0, 3.4, 20.0] {
            let middle = turns * TAU;
            let range = JointRange::new(middle - half_width, middle + half_width).unwrap();
            let arm = Arm::new(132.0, 100.0).unwrap().with_limits(Limits {
                shoulder: range,
                elbow: range,
            });
            for pose in [
                Joints::new(range.min(), range.max()),
                Joints::new(range.max(), range.max()),
                Joints::new(range.min(), middle + 0.3),
                Joints::new(middle + 1e-9, range.max()),
                Joints::new(range.max(), middle),
                Joints::new(range.min(), middle + 1e-9),
            ] {
                let tip = arm.forward(pose);
                let back = arm
                    .inverse_elbow_near(tip, Elbow::of(&pose).unwrap(), pose)
                    .unwrap();
                assert!(arm.limits().contains(&back), "{pose:?}: {back:?}");
                // Beside a straight arm the angles follow from the point to half the digits.
                assert!((back - pose).amax() < 1e-6, "{pose:?}: {back:?}");
                assert!((arm.forward(back) - tip).norm() <= rounding(&arm, pose));
            }
        }
    }
}

/// The arm winds round its base until its range ends.
#[test]
fn curves_wind_round_the_base() {
    const TURNS: u32 = 30;
    let arm = Arm::new(132.0, 100.0).unwrap();
    let spiral = (0..=36 * TURNS).map(|k| {
        let angle = f64::from(k) * PI / 18.0;
        Point2::new(angle.cos(), angle.sin()) * 150.0
    });
    for sense in [1.0, -1.0] {
        let points = spiral.clone().map(|p| Point2::new(p.x, p.y * sense));
        let waypoints = arm.follow(points, Elbow::Left, 0.01).unwrap();
        let first = waypoints.clone().next().unwrap().joints;
        let last = waypoints.last().unwrap().joints;
        let wound = (last - first).x - f64::from(TURNS) * TAU * sense;
        assert!(wound.abs() < 1e-12, "{wound}");
    }
}

#[test]
fn messages_are_short() {
    let arm = Arm::new(132.0, 100.0).unwrap().with_limits(Limits {
        shoulder: JointRange::unlimited(),
        elbow: JointRange::new(100.0, 101.0).unwrap(),
    });
    let error = arm.inverse(Point2::new(150.0, 1.0)).unwrap_err();
    println!("{error}");
    assert!(error.to_string().len() < 100, "{error}");
    let error = arm
        .inverse(Point2::new(1.0 / 3.0 * 1e300, 1.0))
        .unwrap_err();
    println!("{error}");
    assert!(error.to_string().len() < 100, "{error}");
}

/// A forearm that rounding hides points anywhere within it; it has its elbow on the side of its
/// name all the same.
#[test]
fn an_elbow_keeps_its_side_however_short_the_forearm() {
    for ratio in [1e3, 5e10, 1e12, 6e13] {
        let arm = Arm::new(1.0, 1.0 / ratio).unwrap();
        for (min, max, elbow) in [(-3.0, -0.1, Elbow::Left), (0.1, 3.0, Elbow::Right)] {
            let elbow_range = JointRange::new(min, max).unwrap();
            let arm = arm.with_limits(Limits {
                elbow: elbow_range,
                ..Limits::unlimited()
            });
            for k in 0..200 {
                let (sin, cos) = (f64::from(k) * 0.37).sin_cos();
                let reach = arm.reach() - arm.fore() * f64::from(k) / 100.0;
                let point = Point2::new(cos, sin) * reach;
                assert!(
                    arm.inverse_elbow(point, elbow.other()).is_err(),
                    "{ratio} {k}"
                );
                if let Ok(solutions) = arm.inverse(point) {
                    for (found, joints) in solutions.iter() {
                        assert_eq!((found, Elbow::of(&joints)), (elbow, Some(elbow)));
                    }
                }
            }
        }
    }
}
