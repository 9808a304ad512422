//! Curves and the bound on their chords.

use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use scara_kin::nalgebra::{Point2, RealField};
use scara_kin::{Arm, Elbow, FollowError, Joints, Trig, Waypoint};

use super::inverse::is_true;
use super::machine::{Recipe, recipes};
use super::{angle, any_size, anything, at_least, double, epsilon, is_readable, single};
use crate::common::{departure, rounding};

/// Points at which a move is compared with its chord, and waypoints of a curve.
const SAMPLES: u32 = 32;

fn bound<T: RealField + Trig>(recipe: Recipe, [a, b, c, d]: [f64; 4]) -> TestCaseResult {
    let arm = recipe.arm::<T>();
    let from = Joints::new(single::<T>(a), single(b));
    let to = Joints::new(single::<T>(c), single(d));
    let bound = double(arm.chord_bound(from, to));
    if [a, b, c, d]
        .iter()
        .all(|angle| double(single::<T>(*angle)).is_finite())
    {
        let rounding = rounding(&arm, from).max(rounding(&arm, to));
        let chord = [arm.forward(from), arm.forward(to)];
        let departure = departure(&arm, (from, to), chord, SAMPLES);
        prop_assert!(departure <= bound + 2.0 * rounding, "{departure} {bound}");
    } else {
        prop_assert!(!bound.is_finite());
    }
    Ok(())
}

fn follow<T: RealField + Trig>(
    recipe: Recipe,
    points: [[f64; 2]; 3],
    tolerance: f64,
    previous: [f64; 2],
    elbow: Elbow,
) -> TestCaseResult {
    let arm = recipe.arm::<T>();
    let tolerance = single::<T>(tolerance);
    // Ten million waypoints are right, but take their time.
    let is_slow = tolerance > arm.tolerance() && tolerance < arm.reach() * single(1e-7);
    let tolerance = if is_slow { arm.reach() } else { tolerance };
    let points = points.map(|point| Point2::from(point.map(single::<T>)));
    let previous = Joints::new(single(previous[0]), single(previous[1]));
    for followed in [
        arm.follow(points, elbow, tolerance),
        arm.follow_from(points, elbow, tolerance, previous),
    ] {
        match followed {
            Ok(waypoints) => {
                prop_assert_eq!(waypoints.size_hint().0, waypoints.clone().count());
                prop_assert_eq!(waypoints.remaining(), waypoints.clone().count() as u64);
                prop_assert!(double(tolerance).is_finite());
                keeps(&arm, points, tolerance, waypoints.take(100).collect())?;
            }
            Err(error) => {
                is_readable(&error)?;
                is_so(&arm, points, &error)?;
            }
        }
    }
    let none: [Point2<T>; 0] = [];
    let empty = arm.follow(none, elbow, tolerance).map(|_| ());
    prop_assert_eq!(empty, Err(FollowError::Empty));
    Ok(())
}

/// An error says what is so.
fn is_so<T: RealField + Trig>(
    arm: &Arm<T>,
    points: [Point2<T>; 3],
    error: &FollowError<T>,
) -> TestCaseResult {
    match error {
        FollowError::Tolerance {
            tolerance,
            rounding,
        } => {
            let good = tolerance > rounding && tolerance.is_finite();
            prop_assert!(!good && *rounding >= arm.tolerance());
        }
        FollowError::Unreachable {
            line,
            fraction,
            point,
            reason,
        } => {
            is_on(points, *line, *fraction, *point)?;
            is_true(arm, *point, reason)?;
        }
        FollowError::Singular {
            line,
            fraction,
            point,
        } => is_on(points, *line, *fraction, *point)?,
        _ => prop_assert!(false, "{error}"),
    }
    Ok(())
}

/// A point is on the line that is named.
fn is_on<T: RealField + Trig>(
    points: [Point2<T>; 3],
    line: usize,
    fraction: T,
    point: Point2<T>,
) -> TestCaseResult {
    prop_assert!(line < 2 && fraction >= T::zero() && fraction <= T::one());
    let fraction = double(fraction);
    let ends = [points[line], points[line + 1]].map(|end| end.coords.map(double));
    let exact = ends[0] * (1.0 - fraction) + ends[1] * fraction;
    let off = (point.coords.map(double) - exact).amax();
    let size = ends[0].amax().max(ends[1].amax());
    let rounding = 4.0 * epsilon::<T>() * size + double(T::min_value().unwrap()).abs().recip();
    let is_moderate = ends.iter().all(|end| end.norm() < 1e300);
    prop_assert!(off <= rounding || !is_moderate, "{off} {rounding}");
    Ok(())
}

/// The tool keeps the tolerance between the waypoints.
fn keeps<T: RealField + Trig>(
    arm: &Arm<T>,
    points: [Point2<T>; 3],
    tolerance: T,
    waypoints: Vec<Waypoint<T>>,
) -> TestCaseResult {
    for waypoint in &waypoints {
        let joints = waypoint.joints;
        prop_assert!(arm.limits().contains(&joints));
        let miss = (arm.forward(joints) - waypoint.point).map(double).norm();
        prop_assert!(miss <= rounding(arm, joints), "{miss}");
        is_on(points, waypoint.line, waypoint.fraction, waypoint.point)?;
    }
    for pair in waypoints.windows(2) {
        let [from, to] = [pair[0].joints, pair[1].joints];
        let chord = [arm.forward(from), arm.forward(to)];
        let departure = departure(arm, (from, to), chord, SAMPLES);
        prop_assert!(departure <= double(tolerance), "{departure}");
    }
    Ok(())
}

/// Points of an arm of a recipe, or any at all.
fn points(recipe: Recipe) -> impl Strategy<Value = [[f64; 2]; 3]> {
    let arm = recipe.arm::<f64>();
    let own = (angle(), angle()).prop_map(move |(shoulder, elbow)| {
        let point = arm.forward(Joints::new(shoulder, elbow));
        [point.x, point.y]
    });
    let any = prop::array::uniform2(anything());
    prop::array::uniform3(prop_oneof![9 => own, 1 => any])
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn chords_are_bounded_or_not_finite(
        recipe in recipes(),
        joints in prop::array::uniform4(prop_oneof![1 => anything(), 9 => angle()]),
        close in prop::option::of(prop::array::uniform2(any_size(-12.0, 1.0))),
    ) {
        let [a, b, mut c, mut d] = joints;
        if let Some([x, y]) = close {
            (c, d) = (a + x, b + y);
        }
        bound::<f64>(recipe, [a, b, c, d])?;
        bound::<f32>(recipe, [a, b, c, d])?;
    }

    #[test]
    fn curves_are_followed_or_refused(
        (recipe, points) in recipes().prop_flat_map(|recipe| (Just(recipe), points(recipe))),
        previous in prop::array::uniform2(prop_oneof![anything(), angle()]),
        tolerance in prop_oneof![1 => anything(), 9 => any_size(-6.0, 1.0)],
        right in any::<bool>(),
    ) {
        let elbow = if right { Elbow::Right } else { Elbow::Left };
        // Tolerances of a size that suits the arm.
        let suited = tolerance * recipe.arm::<f64>().reach();
        follow::<f64>(recipe, points, suited, previous, elbow)?;
        let suited = tolerance * double(recipe.arm::<f32>().reach());
        follow::<f32>(recipe, points, suited, previous, elbow)?;
    }
}
