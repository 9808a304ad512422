//! Jacobian, speeds and accelerations, at any scale.

use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use scara_kin::nalgebra::{Matrix2, RealField, Vector2};
use scara_kin::{Arm, Joints, RatesError, Trig};

use super::inverse::tool;
use super::machine::{Recipe, recipes};
use super::{angle, anything, at_least, double, epsilon, is_readable, largest, single, smallest};

/// Roundings of a product of Jacobian and rates, in machine epsilons.
const PRODUCT: f64 = 32.0;

/// A number and a power of two: what would overflow in double precision does not.
#[derive(Clone, Copy)]
struct Scaled {
    vector: Vector2<f64>,
    /// Power of two that `vector`, of about 1, is to be multiplied by.
    exponent: f64,
}

impl Scaled {
    fn new(vector: Vector2<f64>) -> Self {
        let largest = vector.amax();
        if largest == 0.0 {
            return Self {
                vector,
                exponent: 0.0,
            };
        }
        let exponent = largest.log2().floor();
        // In two parts: 2¹⁰⁷⁴ is no number.
        let half = (exponent / 2.0).floor();
        let vector = vector * (-half).exp2() * (half - exponent).exp2();
        Self { vector, exponent }
    }
}

/// The reach as a number of about 1 and a power of two.
fn reach<T: RealField + Trig>(arm: &Arm<T>) -> (f64, f64) {
    let exponent = double(arm.reach()).log2().floor();
    (double(arm.reach()) * (-exponent).exp2(), exponent)
}

/// The Jacobian with lengths in units of the reach.
fn jacobian<T: RealField + Trig>(arm: &Arm<T>, shoulder: f64, elbow: f64) -> Matrix2<f64> {
    let [x, y] = tool(arm, shoulder, elbow);
    let unit = double(arm.upper()) / double(arm.reach());
    let (fx, fy) = (x - unit * shoulder.cos(), y - unit * shoulder.sin());
    let rotation = arm.base().rotation;
    let (re, im) = (double(rotation.re), double(rotation.im));
    Matrix2::new(re, -im, im, re) * Matrix2::new(-y, -fy, x, fx)
}

fn finite<const N: usize>(values: [f64; N]) -> bool {
    values.iter().all(|value| value.is_finite())
}

/// Whether `value` is what `exact` · 2^exponent rounds to within `allowed` · 2^exponent and
/// `least`, or is not finite because that is too large.
fn is_right<T: RealField + Trig>(
    value: Vector2<T>,
    exact: Vector2<f64>,
    exponent: f64,
    allowed: f64,
    least: f64,
) -> TestCaseResult {
    let value = value.map(double);
    if !finite([value.x, value.y]) {
        let is_large = exponent > largest::<T>() - 8.0;
        prop_assert!(is_large, "{value} for {exact} 2^{exponent}");
        return Ok(());
    }
    let half = (exponent / 2.0).floor();
    let unit = value * (-half).exp2() * (half - exponent).exp2();
    let least = (least.log2() - exponent).exp2();
    prop_assert!(
        (unit - exact).amax() <= allowed + least,
        "{unit} for {exact}"
    );
    Ok(())
}

fn statics<T: RealField + Trig>(recipe: Recipe, shoulder: f64, elbow: f64) -> TestCaseResult {
    let arm = recipe.arm::<T>();
    let joints = Joints::new(single::<T>(shoulder), single(elbow));
    let (shoulder, elbow) = (double(joints.shoulder), double(joints.elbow));
    let found = arm.jacobian(joints).map(double) / double(arm.reach());
    let (det, distance) = (arm.manipulability(joints), arm.singularity_distance(joints));
    if !finite([shoulder, elbow]) {
        prop_assert!(!found.iter().all(|entry| entry.is_finite()));
        prop_assert!(elbow.is_finite() || !double(det).is_finite());
        prop_assert!(!double(distance).is_finite());
        return Ok(());
    }
    let exact = jacobian(&arm, shoulder, elbow);
    let rounding = PRODUCT * epsilon::<T>();
    prop_assert!((found - exact).amax() <= rounding, "{found} {exact}");
    let reach = double(arm.reach());
    let lever = double(arm.upper()) / reach * (double(arm.fore()) / reach);
    let det = double(det) / reach / reach;
    prop_assert!((det - lever * elbow.sin().abs()).abs() <= rounding * lever);
    let smaller = exact.singular_values().min();
    prop_assert!((double(distance) / reach - smaller).abs() <= rounding);
    Ok(())
}

fn velocity<T: RealField + Trig>(recipe: Recipe, numbers: [f64; 6]) -> TestCaseResult {
    let arm = recipe.arm::<T>();
    let [shoulder, elbow, a, b, c, d] = numbers.map(single::<T>);
    let joints = Joints::new(shoulder, elbow);
    let (rates, accelerations) = (Vector2::new(a, b), Vector2::new(c, d));
    let [shoulder, elbow, a, b, c, d] = numbers.map(|number| double(single::<T>(number)));
    let velocity = arm.tool_velocity(joints, rates);
    let acceleration = arm.tool_acceleration(joints, rates, accelerations);
    let (unit, power) = reach(&arm);
    let allowed = PRODUCT * epsilon::<T>();
    if finite([shoulder, elbow, a, b]) {
        let scaled = Scaled::new(Vector2::new(a, b));
        let exact = jacobian(&arm, shoulder, elbow) * scaled.vector * unit;
        let exponent = scaled.exponent + power;
        is_right(velocity, exact, exponent, allowed, smallest::<T>())?;
    } else {
        prop_assert!(!finite([double(velocity.x), double(velocity.y)]));
    }
    if finite([shoulder, elbow, a, b, c, d, double(rates.x + rates.y)]) {
        let turns = Scaled::new(Vector2::new(a, a + b));
        let bent = Scaled::new(Vector2::new(c, d));
        // The larger part to about 1.
        let exponent = (2.0 * turns.exponent).max(bent.exponent);
        let upper = double(arm.upper()) / double(arm.reach());
        let [x, y] = tool(&arm, shoulder, elbow);
        let links = [
            Vector2::new(shoulder.cos(), shoulder.sin()) * upper,
            Vector2::new(x - upper * shoulder.cos(), y - upper * shoulder.sin()),
        ];
        let turn = turns.vector;
        let local = links[0] * turn.x * turn.x + links[1] * turn.y * turn.y;
        let rotation = arm.base().rotation;
        let (re, im) = (double(rotation.re), double(rotation.im));
        let centripetal = Matrix2::new(re, -im, im, re) * local;
        let bent_part = (bent.exponent - exponent).exp2();
        let exact = jacobian(&arm, shoulder, elbow) * bent.vector * bent_part
            - centripetal * (2.0 * turns.exponent - exponent).exp2();
        let allowed = 4.0 * allowed;
        let least = smallest::<T>() * (1.0 + turns.exponent.exp2());
        is_right(acceleration, exact * unit, exponent + power, allowed, least)?;
    } else {
        prop_assert!(!finite([double(acceleration.x), double(acceleration.y)]));
    }
    Ok(())
}

fn back<T: RealField + Trig>(recipe: Recipe, numbers: [f64; 6]) -> TestCaseResult {
    let arm = recipe.arm::<T>();
    let [shoulder, elbow, a, b, c, d] = numbers.map(single::<T>);
    let joints = Joints::new(shoulder, elbow);
    let (rates, wanted) = (Vector2::new(a, b), Vector2::new(c, d));
    // Of a pose near a singular one the conditioning takes digits away.
    let conditioning = double(arm.reach()) / double(arm.singularity_distance(joints));
    let (unit, power) = reach(&arm);
    match arm.joint_rates(joints, wanted) {
        Ok(rates) => {
            let rates = Scaled::new(rates.map(double));
            let exact = jacobian(&arm, double(shoulder), double(elbow)) * rates.vector * unit;
            let allowed = PRODUCT * epsilon::<T>() * conditioning;
            // The rates may be as small as there are.
            let least = smallest::<T>() * (1.0 + double(arm.reach()));
            is_right(wanted, exact, rates.exponent + power, allowed, least)?;
        }
        Err(error) => is_true(&arm, joints, [elbow, shoulder, c, d], conditioning, &error)?,
    }
    match arm.joint_accelerations(joints, rates, wanted) {
        Ok(accelerations) => {
            prop_assert!(finite([double(accelerations.x), double(accelerations.y)]));
            let again = arm.tool_acceleration(joints, rates, accelerations);
            let scale = [
                arm.jacobian(joints).map(double).norm() * accelerations.map(double).norm(),
                double(arm.reach()) * (double(a).abs() + double(b).abs()).powi(2),
                wanted.map(double).norm(),
            ];
            let scale = scale.into_iter().fold(0.0, f64::max);
            let off = (again - wanted).map(double).norm();
            let least = smallest::<T>() * (1.0 + double(arm.reach()));
            let allowed = PRODUCT * epsilon::<T>() * conditioning * scale + least;
            prop_assert!(
                off <= allowed || !off.is_finite() || !allowed.is_finite(),
                "{off}"
            );
        }
        Err(error) => is_true(&arm, joints, [a, b, c, d], conditioning, &error)?,
    }
    Ok(())
}

/// An error says what is so.
fn is_true<T: RealField + Trig>(
    arm: &Arm<T>,
    joints: Joints<T>,
    given: [T; 4],
    conditioning: f64,
    error: &RatesError<T>,
) -> TestCaseResult {
    is_readable(error)?;
    match *error {
        RatesError::Singular { elbow } => {
            let rounding = 4.0 * epsilon::<T>() * double(elbow).abs().max(1.0);
            prop_assert!(double(elbow).sin().abs() <= rounding);
        }
        RatesError::NotFinite { value, .. } => {
            prop_assert!(!value.is_finite());
            let given = given.map(double);
            let (shoulder, elbow) = (double(joints.shoulder), double(joints.elbow));
            if finite(given) && finite([shoulder, elbow]) {
                // Too large.
                let given = given.into_iter().map(f64::abs).fold(1.0, f64::max).log2();
                let (_, power) = reach(arm);
                let most = 2.0 * given + conditioning.log2() + power.abs();
                prop_assert!(most > largest::<T>() - 8.0);
            }
        }
        _ => prop_assert!(false, "{error}"),
    }
    Ok(())
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn jacobians_are_right_at_any_scale(
        recipe in recipes(),
        shoulder in prop_oneof![anything(), angle()],
        elbow in prop_oneof![anything(), angle()],
    ) {
        statics::<f64>(recipe, shoulder, elbow)?;
        statics::<f32>(recipe, shoulder, elbow)?;
    }

    #[test]
    fn speeds_are_right_or_not_finite(
        recipe in recipes(),
        joints in prop::array::uniform2(prop_oneof![1 => anything(), 3 => angle()]),
        rest in prop::array::uniform4(anything()),
    ) {
        let ([shoulder, elbow], [a, b, c, d]) = (joints, rest);
        velocity::<f64>(recipe, [shoulder, elbow, a, b, c, d])?;
        velocity::<f32>(recipe, [shoulder, elbow, a, b, c, d])?;
    }

    #[test]
    fn joint_speeds_are_right_or_refused(
        recipe in recipes(),
        joints in prop::array::uniform2(prop_oneof![1 => anything(), 3 => angle()]),
        rest in prop::array::uniform4(anything()),
    ) {
        let ([shoulder, elbow], [a, b, c, d]) = (joints, rest);
        back::<f64>(recipe, [shoulder, elbow, a, b, c, d])?;
        back::<f32>(recipe, [shoulder, elbow, a, b, c, d])?;
    }
}
