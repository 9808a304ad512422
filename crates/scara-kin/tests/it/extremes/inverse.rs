//! Positions to angles and back, at any scale, turn and distance.

use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use scara_kin::nalgebra::{Point2, RealField};
use scara_kin::{Arm, Elbow, InverseError, JointRange, Joints, Trig};

use super::machine::{Recipe, recipes};
use super::{angle, anything, at_least, double, epsilon, is_readable, single};
use crate::common::rounding;

/// Roundings of forward kinematics, in machine epsilons of reach and base distance.
const FORWARD: f64 = 8.0;

/// Reach and base distance.
pub(crate) fn span<T: RealField + Trig>(arm: &Arm<T>) -> f64 {
    let base = arm.base().translation.vector;
    double(arm.reach()) + double(base.x).hypot(double(base.y))
}

/// The tool of an arm with its base at the origin, in units of the reach, from double
/// precision and another library's sines.
pub(crate) fn tool(arm: &Arm<impl RealField + Trig>, shoulder: f64, elbow: f64) -> [f64; 2] {
    let reach = double(arm.reach());
    let (upper, fore) = (double(arm.upper()) / reach, double(arm.fore()) / reach);
    let ((s1, c1), (s2, c2)) = (shoulder.sin_cos(), elbow.sin_cos());
    [
        upper * c1 + fore * (c1 * c2 - s1 * s2),
        upper * s1 + fore * (s1 * c2 + c1 * s2),
    ]
}

fn distance<T: RealField + Trig>(a: Point2<T>, b: Point2<T>) -> f64 {
    (double(a.x) - double(b.x)).hypot(double(a.y) - double(b.y))
}

fn forward<T: RealField + Trig>(recipe: Recipe, shoulder: f64, elbow: f64) -> TestCaseResult {
    let arm = recipe.arm::<T>();
    let joints = Joints::new(single::<T>(shoulder), single(elbow));
    let (shoulder, elbow) = (double(joints.shoulder), double(joints.elbow));
    let point = arm.forward(joints);
    if shoulder.is_finite() && elbow.is_finite() {
        let [x, y] = tool(&arm, shoulder, elbow).map(|unit| unit * double(arm.reach()));
        let rotation = arm.base().rotation;
        let (re, im) = (double(rotation.re), double(rotation.im));
        let base = arm.base().translation;
        let dx = double(point.x) - (double(base.x) + (re * x - im * y));
        let dy = double(point.y) - (double(base.y) + (re * y + im * x));
        prop_assert!(
            dx.hypot(dy) <= FORWARD * epsilon::<T>() * span(&arm),
            "{dx} {dy}"
        );
    } else {
        prop_assert!(!double(point.x).is_finite() || !double(point.y).is_finite());
    }
    let from_base = arm.elbow_position(joints) - arm.base().translation.vector;
    if shoulder.is_finite() {
        let off = double(from_base.coords.norm()) - double(arm.upper());
        prop_assert!(off.abs() <= FORWARD * epsilon::<T>() * span(&arm));
    } else {
        prop_assert!(!double(from_base.x).is_finite());
    }
    let side = Elbow::of(&joints);
    prop_assert_eq!(side.is_some(), elbow.is_finite());
    if let Some(side) = side {
        let sin = elbow.sin();
        let is_right = sin.abs() <= epsilon::<T>() || (sin < 0.0) == (side == Elbow::Left);
        prop_assert!(is_right && side.other().other() == side && side.other() != side);
    }
    let change = joints - Joints::new(T::zero(), T::zero());
    prop_assert_eq!(double(change.x).to_bits(), shoulder.to_bits());
    Ok(())
}

fn is_right<T: RealField + Trig>(
    arm: &Arm<T>,
    point: Point2<T>,
    joints: Joints<T>,
) -> TestCaseResult {
    prop_assert!(arm.limits().contains(&joints), "{joints:?}");
    let miss = distance(arm.forward(joints), point);
    let rounding = rounding(arm, joints) + FORWARD * epsilon::<T>() * span(arm);
    prop_assert!(
        miss <= rounding,
        "{joints:?} misses by {miss:e}, {:e} of the reach",
        miss / double(arm.reach())
    );
    Ok(())
}

/// An error says what is so.
pub(crate) fn is_true<T: RealField + Trig>(
    arm: &Arm<T>,
    point: Point2<T>,
    error: &InverseError<T>,
) -> TestCaseResult {
    is_readable(error)?;
    let finite = point.x.is_finite() && point.y.is_finite();
    let from_base = distance(point, Point2::from(arm.base().translation.vector));
    let rounding = FORWARD * epsilon::<T>() * span(arm);
    match *error {
        InverseError::NotFinite { .. } => prop_assert!(!finite),
        InverseError::TooFar { distance, reach } => {
            prop_assert!(finite && distance.is_finite() && distance > reach);
            prop_assert!(from_base >= double(reach) - rounding);
        }
        InverseError::TooNear { distance, reach } => {
            prop_assert!(finite && distance < reach && from_base <= double(reach) + rounding);
        }
        InverseError::AnyAngle => {
            prop_assert!(arm.upper() == arm.fore() && from_base <= rounding);
        }
        InverseError::JointLimit {
            angle, min, max, ..
        } => {
            prop_assert!(angle < min || angle > max, "{error}");
        }
        InverseError::Previous { joints, largest } => {
            let inside = |angle: T| angle.abs() <= largest;
            prop_assert!(!inside(joints.shoulder) || !inside(joints.elbow));
        }
        _ => prop_assert!(false, "{error}"),
    }
    Ok(())
}

fn inverse<T: RealField + Trig>(
    arm: &Arm<T>,
    point: Point2<T>,
    previous: Joints<T>,
) -> TestCaseResult {
    let both = arm.inverse(point);
    match &both {
        Ok(solutions) => {
            prop_assert!((1..=2).contains(&solutions.iter().count()));
            for (elbow, joints) in solutions.iter() {
                prop_assert_eq!(solutions.get(elbow), Some(joints));
                is_right(arm, point, joints)?;
            }
        }
        Err(error) => is_true(arm, point, error)?,
    }
    for elbow in [Elbow::Right, Elbow::Left] {
        match arm.inverse_elbow(point, elbow) {
            Ok(joints) => {
                is_right(arm, point, joints)?;
                prop_assert!(both.is_ok_and(|both| both.get(elbow) == Some(joints)));
            }
            Err(error) => is_true(arm, point, &error)?,
        }
        match arm.inverse_elbow_near(point, elbow, previous) {
            Ok(joints) => is_right(arm, point, joints)?,
            Err(error) => is_true(arm, point, &error)?,
        }
    }
    let known = is_known(previous);
    // Wound up, more is within rounding.
    let limits = arm.limits();
    let is_wound = [limits.shoulder, limits.elbow]
        .map(|range| (double(range.min()) + double(range.max())) / 2.0)
        .into_iter()
        .chain([double(previous.shoulder), double(previous.elbow)])
        .any(|angle| angle.abs() > 10.0);
    match arm.inverse_nearest(point, previous) {
        Ok((_, joints)) => {
            is_right(arm, point, joints)?;
            prop_assert!(known && (is_wound || arm.is_reachable(point)));
        }
        Err(error) => {
            is_true(arm, point, &error)?;
            prop_assert!(!known || is_wound || !arm.is_reachable(point), "{error}");
        }
    }
    Ok(())
}

/// Whether a pose is one that an arm may have had.
fn is_known<T: RealField + Trig>(joints: Joints<T>) -> bool {
    let free = JointRange::unlimited();
    free.contains(joints.shoulder) && free.contains(joints.elbow)
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn tools_are_where_the_angles_say(
        recipe in recipes(),
        shoulder in prop_oneof![anything(), angle()],
        elbow in prop_oneof![anything(), angle()],
    ) {
        forward::<f64>(recipe, shoulder, elbow)?;
        forward::<f32>(recipe, shoulder, elbow)?;
    }

    #[test]
    fn any_point_is_reached_or_refused(
        recipe in recipes(),
        (x, y) in (anything(), anything()),
        (shoulder, elbow) in (anything(), anything()),
    ) {
        let previous = Joints::new(shoulder, elbow);
        inverse(&recipe.arm::<f64>(), Point2::new(x, y), previous)?;
        let previous = Joints::new(single(shoulder), single(elbow));
        inverse(&recipe.arm::<f32>(), Point2::new(single(x), single(y)), previous)?;
    }

    #[test]
    fn own_points_are_reached_at_any_scale_and_turn(
        recipe in recipes(),
        (shoulder, elbow) in (angle(), angle()),
    ) {
        own_points::<f64>(recipe, shoulder, elbow)?;
        own_points::<f32>(recipe, shoulder, elbow)?;
    }
}

fn own_points<T: RealField + Trig>(recipe: Recipe, shoulder: f64, elbow: f64) -> TestCaseResult {
    let arm = recipe.arm::<T>();
    // Into the ranges, so that most are within.
    let into =
        |range: &JointRange<T>, angle: f64| single::<T>(angle).max(range.min()).min(range.max());
    let limits = arm.limits();
    let pose = Joints::new(into(&limits.shoulder, shoulder), into(&limits.elbow, elbow));
    let point = arm.forward(pose);
    inverse(&arm, point, pose)?;
    match arm.inverse_nearest(point, pose) {
        Ok(_) => {}
        Err(error) => {
            let kept_out =
                matches!(error, InverseError::TooNear { .. }) && arm.keep_out() > T::zero();
            prop_assert!(kept_out, "{pose:?}: {error}");
        }
    }
    Ok(())
}
