//! The tangent tool, and the drives.

use core::f64::consts::PI;

use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use scara_kin::nalgebra::{RealField, Vector2};
use scara_kin::{DriveAngles, DriveSense, Drives, JointRange, Joints, TangentTool, Trig};

use super::machine::{Recipe, recipes};
use super::{angle, anything, at_least, double, epsilon, is_readable, single, smallest};

fn largest_angle<T: RealField + Trig>() -> f64 {
    double(JointRange::<T>::unlimited().max())
}

fn tangent<T: RealField + Trig>(
    recipe: Recipe,
    corner: f64,
    start: f64,
    curve: &[[f64; 4]],
) -> TestCaseResult {
    let arm = recipe.arm::<T>();
    let disc = match TangentTool::new(single::<T>(corner)) {
        Ok(disc) => disc,
        Err(error) => {
            let is_good = double(single::<T>(corner)) > 0.0;
            prop_assert!(!is_good);
            return is_readable(&error);
        }
    };
    let mut disc = match disc.starting_at(single(start)) {
        Ok(disc) => disc,
        Err(error) => {
            let is_good = double(single::<T>(start)).abs() <= largest_angle::<T>();
            prop_assert!(!is_good);
            return is_readable(&error);
        }
    };
    for [shoulder, elbow, x, y] in curve {
        let joints = Joints::new(single::<T>(*shoulder), single(*elbow));
        let direction = Vector2::new(single::<T>(*x), single(*y));
        let before = disc;
        match disc.follow(&arm, joints, direction) {
            Ok(turn) => {
                let tool_angle = double(turn.tool_angle);
                prop_assert!(
                    turn.tool_angle == disc.tool_angle()
                        && tool_angle.abs() <= largest_angle::<T>()
                );
                let angles = [double(joints.shoulder), double(joints.elbow), tool_angle];
                let size: f64 = angles.into_iter().map(f64::abs).sum();
                let rounding = 4.0 * epsilon::<T>() * (size + PI);
                let heading = double(direction.y).atan2(double(direction.x));
                let base = arm.base().rotation;
                let base = double(base.im).atan2(double(base.re));
                let off = angles.into_iter().sum::<f64>() + base - heading;
                prop_assert!((off / 2.0).sin().abs() <= rounding, "{off}");
                let change = tool_angle - double(before.tool_angle());
                prop_assert!(change.abs() <= PI + rounding, "{change}");
                let corner = turn.corner.map_or(0.0, double);
                prop_assert!(corner.abs() <= PI + rounding, "{corner}");
            }
            Err(error) => {
                is_readable(&error)?;
                prop_assert_eq!(disc, before);
            }
        }
        if x.is_nan() {
            disc.lift();
        }
    }
    Ok(())
}

/// Which nothing is rounded by.
const RATIO: f64 = 0.5;

fn drives<T: RealField + Trig>(settings: [f64; 3], joints: [f64; 2]) -> TestCaseResult {
    let [zero1, zero2, coupling] = settings.map(single::<T>);
    let [shoulder, elbow] = joints.map(single::<T>);
    let zero = Joints::new(zero1, zero2);
    let drives = Drives::default()
        .with_senses(DriveSense::Reversed, DriveSense::Forward)
        .with_zero(zero)
        .and_then(|drives| drives.with_ratios([T::one(), single(RATIO)]))
        .and_then(|drives| drives.with_coupling(coupling));
    let drives = match drives {
        Ok(drives) => drives,
        Err(error) => {
            let inside = |value: &f64| double(single::<T>(*value)).abs() <= largest_angle::<T>();
            prop_assert!(!settings.iter().all(inside));
            return is_readable(&error);
        }
    };
    prop_assert!(drives.zero() == zero && drives.coupling() == coupling);
    prop_assert_eq!(drives.senses(), (DriveSense::Reversed, DriveSense::Forward));
    let kept = [T::one(), single(RATIO)];
    prop_assert!(drives.ratios().into_iter().eq(kept));
    let joints = Joints::new(shoulder, elbow);
    let angles = drives.from_joints(joints);
    let back = drives.to_joints(angles);
    let terms = [shoulder, zero1, elbow, zero2].map(|term| double(term).abs());
    let turned = double(coupling).abs() * (terms[0] + terms[1]);
    let size: f64 = terms.into_iter().sum::<f64>() + turned;
    let known = double(shoulder).is_finite() && double(elbow).is_finite();
    if !known {
        let DriveAngles { shoulder, elbow } = angles;
        prop_assert!(!double(shoulder).is_finite() || !double(elbow).is_finite());
    } else if double(back.elbow).is_finite() {
        let rounding = 4.0 * epsilon::<T>() * size + smallest::<T>();
        let off = (back - joints).map(double).amax();
        prop_assert!(off <= rounding, "{off} {rounding}");
        let direct = double(shoulder).mul_add(double(coupling), double(elbow)) - double(zero2);
        let off = double(angles.elbow) * RATIO - direct;
        prop_assert!(off.abs() <= rounding || !direct.is_finite(), "{off}");
    } else {
        prop_assert!(size >= double(T::max_value().unwrap()) / 2.0);
    }
    Ok(())
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn the_disc_is_tangent_or_refuses(
        recipe in recipes(),
        corner in prop_oneof![anything(), 0.0..4.0f64],
        start in prop_oneof![1 => anything(), 9 => angle()],
        curve in prop::collection::vec(
            prop::array::uniform4(prop_oneof![1 => anything(), 3 => angle()]),
            1..10,
        ),
    ) {
        tangent::<f64>(recipe, corner, start, &curve)?;
        tangent::<f32>(recipe, corner, start, &curve)?;
    }

    #[test]
    fn drives_are_right_or_not_finite(
        settings in prop::array::uniform3(prop_oneof![1 => anything(), 3 => angle()]),
        joints in prop::array::uniform2(prop_oneof![anything(), angle()]),
    ) {
        drives::<f64>(settings, joints)?;
        drives::<f32>(settings, joints)?;
    }
}
