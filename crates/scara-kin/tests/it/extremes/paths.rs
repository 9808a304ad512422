//! Curves as paths of the joints.

use path_timing::{Curve, Path as _, Row, Span};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, ArmPath, DiscPath, Elbow, Joints};

use super::machine::{Recipe, recipes};
use super::{anything, at_least, is_readable};

/// Of what rounding may leave: the arm's tolerance, and turns from zero the angles' own.
const OFF: f64 = 4.0;

fn arm_path(arm: &Arm, path: &ArmPath, numbers: [f64; 8]) -> TestCaseResult {
    let curve = path.curve();
    for share in [0.0, 0.1, 0.5, 0.77, 1.0] {
        let s = curve.length() * share;
        match path.joints(s) {
            Ok(joints) => {
                let off = (arm.forward(joints) - Point2::from(curve.at(s).point)).norm();
                let turns = joints.shoulder.abs() + joints.elbow.abs();
                let rounding = arm.tolerance() + turns * arm.reach() * f64::EPSILON;
                prop_assert!(off <= OFF * rounding, "{off}");
            }
            Err(error) => is_readable(&error)?,
        }
        match path.point(s) {
            Ok(point) => {
                let mut numbers = point.position.iter().chain(&point.slope);
                prop_assert!(numbers.all(|number| number.is_finite()));
            }
            Err(error) => is_readable(&error)?,
        }
    }
    let [s0, s1, q0, q1, q2, v0, v1, duration_s] = numbers;
    let row = |position, velocity| Row {
        time_s: 0.0,
        duration_s,
        position,
        velocity,
        leg: 0,
        s: s1,
    };
    let rows = [row([q0, q1], [v0, v1]), row([q1, q2], [v1, v0])];
    let span = Span { s: [s0, s1], rows };
    let departure = path.departure(&span);
    prop_assert!(departure.is_nan() || departure >= 0.0);
    path.check(&span)
        .map_or_else(|error| is_readable(&error), Ok)?;
    Ok(())
}

fn disc_path(path: &DiscPath, numbers: [f64; 8]) -> TestCaseResult {
    prop_assert_eq!(path.arm_path().length().to_bits(), path.length().to_bits());
    for share in [0.0, 0.3, 1.0] {
        match path.point(path.length() * share) {
            Ok(point) => prop_assert!(point.position.iter().all(|number| number.is_finite())),
            Err(error) => is_readable(&error)?,
        }
    }
    let [s0, s1, q0, q1, q2, v0, v1, duration_s] = numbers;
    let row = Row {
        time_s: 0.0,
        duration_s,
        position: [q0, q1, q2],
        velocity: [v0, v1, v0],
        leg: 0,
        s: s1,
    };
    let departure = path.departure(&Span {
        s: [s0, s1],
        rows: [row; 2],
    });
    prop_assert!(departure.is_nan() || departure >= 0.0);
    Ok(())
}

fn paths(
    recipe: Recipe,
    points: [[f64; 2]; 4],
    previous: [f64; 2],
    numbers: [f64; 8],
) -> TestCaseResult {
    let arm = recipe.arm::<f64>();
    let [start, end, direction, _] = points;
    let curves = [
        Curve::line(start, end),
        Curve::arc(start, end, direction, numbers[0]),
        Curve::bezier(points),
    ];
    for curve in curves.into_iter().flatten() {
        let previous = Joints::new(previous[0], previous[1]);
        let found = [
            arm.path(curve, Elbow::Left),
            arm.path_from(curve, Elbow::Right, previous),
        ];
        for path in found {
            let path = match path {
                Ok(path) => path,
                Err(error) => {
                    is_readable(&error)?;
                    continue;
                }
            };
            arm_path(&arm, &path, numbers)?;
            match path.with_disc(numbers[7]) {
                Ok(path) => disc_path(&path, numbers)?,
                Err(error) => is_readable(&error)?,
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn curves_of_any_size(
        recipe in recipes(),
        points in prop::array::uniform4(prop::array::uniform2(-1.0..1.0_f64)),
        previous in prop::array::uniform2(anything()),
        numbers in prop::array::uniform8(anything()),
    ) {
        let arm = recipe.arm::<f64>();
        let base = arm.base().translation.vector;
        let points = points.map(|[x, y]| [base.x + x * arm.reach(), base.y + y * arm.reach()]);
        paths(recipe, points, previous, numbers)?;
    }

    #[test]
    fn curves_anywhere(
        recipe in recipes(),
        points in prop::array::uniform4(prop::array::uniform2(anything())),
        previous in prop::array::uniform2(anything()),
        numbers in prop::array::uniform8(anything()),
    ) {
        paths(recipe, points, previous, numbers)?;
    }
}
