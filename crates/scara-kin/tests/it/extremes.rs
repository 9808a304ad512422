//! Every public function with numbers that no machine has: not finite, negative, as large and
//! as small as there are. What comes back is an error, is not finite itself, or is right.

mod curves;
mod dynamics;
mod inverse;
mod machine;
mod names;
#[cfg(feature = "path-timing")]
mod paths;
mod rates;
mod tools;

use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use scara_kin::nalgebra::RealField;
use test_support::at_least;

use crate::common::{double, epsilon, single};

/// Any number at all, those that go wrong most often.
fn anything() -> impl Strategy<Value = f64> {
    prop_oneof![
        prop::num::f64::ANY,
        prop::sample::select(vec![
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            0.0,
            -0.0,
            5e-324,
            1e-45,
            -1e-40,
            1e-300,
            -1e300,
            1e300,
            f64::MAX,
            -3.4e38,
        ]),
        -10.0..10.0f64,
        any_size(-12.0, 12.0),
    ]
}

/// Both signs, 10^least to 10^most.
fn any_size(least: f64, most: f64) -> impl Strategy<Value = f64> {
    (least..most, any::<bool>()).prop_map(|(exponent, negative)| {
        let size = 10f64.powf(exponent);
        if negative { -size } else { size }
    })
}

/// Angles within a turn, straight and folded ones among them, at any number of turns.
fn angle() -> impl Strategy<Value = f64> {
    use core::f64::consts::PI;
    let within_a_turn = prop_oneof![
        -PI..PI,
        Just(0.0),
        Just(PI),
        Just(-PI),
        any_size(-17.0, 0.0)
    ];
    (within_a_turn, prop_oneof![Just(0.0), any_size(0.0, 7.1)])
        .prop_map(|(angle, turns)| angle + turns.round() * 2.0 * PI)
}

/// The power of two that every number is below.
fn largest<T: RealField>() -> f64 {
    double(T::max_value().unwrap()).log2()
}

/// A few of the smallest numbers that there are.
fn smallest<T: RealField>() -> f64 {
    16.0 * (2.0 - largest::<T>()).exp2() * epsilon::<T>()
}

/// A message that a person reads: short, and without the digits of 1e300.
fn is_readable(error: &dyn core::error::Error) -> TestCaseResult {
    let message = error.to_string();
    prop_assert!(message.len() < 200, "{message}");
    let digits = |c: char| c.is_ascii_digit();
    let longest = message.split(|c| !digits(c)).map(str::len).max();
    prop_assert!(longest.is_none_or(|longest| longest <= 11), "{message}");
    Ok(())
}
