//! Arms at the ends of every range, and what the settings refuse.

use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use scara_kin::nalgebra::{Complex, Isometry2, RealField, Translation2, UnitComplex, Vector2};
use scara_kin::{Arm, GeometryError, JointRange, Joints, Limits, Trig};

use super::{angle, any_size, anything, at_least, double, epsilon, is_readable, single};

/// What an arm is made of; what its number type refuses is moved to the end of its range.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recipe {
    /// Position of the upper arm in the range of lengths, on a scale of logarithms.
    upper: f64,
    /// Decimal logarithm of forearm by upper arm.
    ratio: f64,
    /// Base coordinates in units of the reach, and rotation.
    base: (f64, f64, f64),
    /// Middle and half the width of shoulder and elbow range.
    shoulder: Option<(f64, f64)>,
    elbow: Option<(f64, f64)>,
    /// Keep-out radius in units of the reach.
    keep_out: f64,
}

pub(crate) fn recipes() -> impl Strategy<Value = Recipe> {
    let ratio = prop_oneof![Just(0.0), -1.0..1.0f64, -13.0..13.0f64];
    let coordinate = || prop_oneof![Just(0.0), -1.0..1.0f64, any_size(-20.0, 12.0)];
    let base = (
        coordinate(),
        coordinate(),
        prop_oneof![Just(0.0), -4.0..4.0f64],
    );
    let range = || prop::option::of((angle(), prop_oneof![0.1..8.0f64, any_size(-6.0, 3.0)]));
    let keep_out = prop_oneof![4 => Just(0.0), 1 => 0.0..1.0f64];
    (0.0..1.0f64, ratio, base, range(), range(), keep_out).prop_map(
        |(upper, ratio, base, shoulder, elbow, keep_out)| Recipe {
            upper,
            ratio,
            base,
            shoulder,
            elbow,
            keep_out,
        },
    )
}

impl Recipe {
    pub(crate) fn arm<T: RealField + Trig>(self) -> Arm<T> {
        let (min, max) = link_range(Arm::<T>::new(T::zero(), T::one()));
        let upper = (min.ln() * single(1.0 - self.upper) + max.ln() * single(self.upper)).exp();
        let upper = upper.max(min).min(max);
        let (min, max) = link_range(Arm::<T>::new(upper, T::zero()));
        let fore = (upper * single(10f64.powf(self.ratio))).max(min).min(max);
        let arm = Arm::new(upper, fore).unwrap();
        let reach = arm.reach();
        let (x, y, turn) = self.base;
        let base = Isometry2::new(
            Vector2::new(reach * single(x), reach * single(y)),
            single(turn),
        );
        let arm = arm.with_base(base).unwrap_or(arm);
        let limits = Limits {
            shoulder: range(self.shoulder),
            elbow: range(self.elbow),
        };
        let arm = arm.with_limits(limits);
        arm.with_keep_out(reach * single(self.keep_out))
            .unwrap_or(arm)
    }
}

fn link_range<T: RealField + Trig>(refused: Result<Arm<T>, GeometryError<T>>) -> (T, T) {
    match refused {
        Err(GeometryError::LinkLength { min, max, .. }) => (min, max),
        other => panic!("{other:?}"),
    }
}

fn range<T: RealField + Trig>(recipe: Option<(f64, f64)>) -> JointRange<T> {
    let free = JointRange::unlimited();
    recipe.map_or(free, |(middle, half)| {
        let (middle, half) = (single::<T>(middle), single::<T>(half.abs()));
        JointRange::new(middle - half, middle + half).unwrap_or(free)
    })
}

fn settings<T: RealField + Trig>(recipe: Recipe, values: [f64; 6]) -> TestCaseResult {
    let [a, b, c, d, e, f] = values.map(single::<T>);
    let largest = double(JointRange::<T>::unlimited().max());
    match Arm::new(a, b) {
        Ok(arm) => {
            let (upper, fore) = (double(arm.upper()), double(arm.fore()));
            prop_assert!(upper > 0.0 && fore > 0.0 && (upper * fore).is_finite());
            prop_assert!(double(arm.tolerance()) < upper.min(fore));
        }
        Err(error) => is_readable(&error)?,
    }
    let arm = recipe.arm::<T>();
    prop_assert!(arm.tolerance() < arm.upper().min(arm.fore()));
    let rotation = UnitComplex::new_unchecked(Complex::new(c, d));
    match arm.with_base(Isometry2::from_parts(Translation2::new(a, b), rotation)) {
        Ok(arm) => {
            let (x, y) = (arm.base().translation.x, arm.base().translation.y);
            prop_assert!(x == a && y == b);
            let rotation = arm.base().rotation;
            let length = double(rotation.re.hypot(rotation.im));
            prop_assert!((length - 1.0).abs() <= 2.0 * epsilon::<T>());
            prop_assert!(arm.tolerance() < arm.upper().min(arm.fore()));
        }
        Err(error) => is_readable(&error)?,
    }
    match JointRange::new(e, f) {
        Ok(range) => {
            prop_assert!(range.min() == e && range.max() == f && e < f);
            prop_assert!(double(e).abs() <= largest && double(f).abs() <= largest);
            prop_assert!(range.contains(e) && range.contains(f));
            prop_assert_eq!(range.contains(a), a >= e && a <= f);
            let limits = Limits {
                shoulder: range,
                ..Limits::unlimited()
            };
            let limited = arm.with_limits(limits);
            prop_assert_eq!(limited.limits(), &limits);
            let joints = Joints::new(a, b);
            let contained = range.contains(a) && double(b).abs() <= largest;
            prop_assert_eq!(limits.contains(&joints), contained);
        }
        Err(error) => is_readable(&error)?,
    }
    match arm.with_keep_out(c) {
        Ok(arm) => {
            prop_assert!(arm.keep_out() == c && c >= T::zero());
            prop_assert!(arm.inner_reach() >= c && arm.inner_reach() < arm.reach());
        }
        Err(error) => is_readable(&error)?,
    }
    Ok(())
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn settings_are_right_or_refused(
        recipe in recipes(),
        values in prop::array::uniform6(anything()),
    ) {
        settings::<f64>(recipe, values)?;
        settings::<f32>(recipe, values)?;
    }
}
