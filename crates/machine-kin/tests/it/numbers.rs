//! Numbers: intervals beside exact arithmetic, jets and gradients beside each other and
//! differences.

use core::f64::consts::{PI, TAU};

use astro_float_num::{BigFloat, Consts, RoundingMode};
use machine_kin::{Gradient, Interval, Jet, Number, Refusal};
use proptest::prelude::*;

/// Bits of the exact arithmetic.
const BITS: usize = 320;

/// Of the last derivatives of functions of numbers of about 1.
const ROUNDING: f64 = 1e-9;

fn exact(x: f64) -> BigFloat {
    BigFloat::from_f64(x, BITS)
}

/// Whether an exact number is within an interval.
fn holds(interval: &Interval, value: &BigFloat) -> bool {
    interval.low().is_nan() || (exact(interval.low()) <= *value && *value <= exact(interval.high()))
}

/// Numbers of all sizes of machines, some of them 0, whole, or next to each other.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1e4..1e4_f64,
        2 => -1.0..1.0_f64,
        1 => (-40..40_i32, -1.0..1.0_f64).prop_map(|(power, x)| x * 10f64.powi(power)),
        1 => (-4..=4_i32).prop_map(f64::from),
    ]
}

fn any_interval() -> impl Strategy<Value = (Interval, [f64; 3])> {
    (any_number(), any_number(), 0.0..1.0_f64).prop_map(|(a, b, share)| {
        let (low, high) = (a.min(b), a.max(b));
        let inside = (low + (high - low) * share).clamp(low, high);
        (Interval::new(low, high), [low, inside, high])
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    /// What is computed of intervals holds what is computed exactly of numbers in them.
    #[test]
    fn intervals_hold_the_exact_numbers((a, xs) in any_interval(), (b, ys) in any_interval(), by in any_number()) {
        let to = RoundingMode::ToEven;
        for x in xs {
            let x = exact(x);
            for y in ys {
                let y = exact(y);
                prop_assert!(holds(&(a + b), &x.add(&y, BITS, to)));
                prop_assert!(holds(&(a - b), &x.sub(&y, BITS, to)));
                prop_assert!(holds(&(a * b), &x.mul(&y, BITS, to)));
                if !y.is_zero() {
                    prop_assert!(holds(&(a / b), &x.div(&y, BITS, to)));
                }
            }
            let number = exact(by);
            prop_assert!(holds(&(a + by), &x.add(&number, BITS, to)));
            prop_assert!(holds(&(a - by), &x.sub(&number, BITS, to)));
            prop_assert!(holds(&(a * by), &x.mul(&number, BITS, to)));
            prop_assert!(holds(&(-a), &x.neg()));
            if by != 0.0 {
                prop_assert!(holds(&(a / by), &x.div(&number, BITS, to)));
            }
            prop_assert!(holds(&a.squared(), &x.mul(&x, BITS, to)));
            prop_assert!(a.squared().low() >= 0.0);
            if let Ok(root) = a.root("") {
                prop_assert!(holds(&root, &x.sqrt(BITS, to)));
            }
        }
        prop_assert_eq!(a.root("").is_ok(), a.low() >= 0.0);
    }

    /// The same of sines and of arc tangents, which count but for whole turns.
    #[test]
    fn intervals_hold_the_exact_angles((a, xs) in any_interval(), (b, ys) in any_interval()) {
        let (to, mut consts) = (RoundingMode::ToEven, Consts::new().unwrap());
        let (sin, cos) = a.sin_cos();
        let angle = Interval::atan2(a, b, "");
        for x in xs {
            prop_assert!(holds(&sin, &exact(x).sin(BITS, to, &mut consts)));
            prop_assert!(holds(&cos, &exact(x).cos(BITS, to, &mut consts)));
            for y in ys {
                let Ok(angle) = angle else { continue };
                // The exact angle of (y, x), and the turn at which it is in the interval.
                let direction = x.atan2(y);
                let turns = ((angle.middle() - direction) / TAU).round();
                let off = direction + turns * TAU;
                prop_assert!(angle.low() - 1e-14 <= off && off <= angle.high() + 1e-14, "{angle:?} {off}");
            }
        }
        let may_be_0 = |x: &Interval| x.low() <= 0.0 && x.high() >= 0.0;
        prop_assert_eq!(angle.is_err(), may_be_0(&a) && may_be_0(&b));
    }

    /// Jets of a function of a parameter are its derivatives: beside those of the same function by
    /// a jet that begins elsewhere, as a Taylor series says.
    #[test]
    fn jets_are_taylor_series(at in -1.0..1.0_f64, step in -0.01..0.01_f64) {
        let jet = function(Jet::<f64, 9>::new([at, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])).unwrap();
        let there = function(Jet::<f64, 5>::new([at + step, 1.0, 0.0, 0.0, 0.0])).unwrap();
        // The k-th coefficient there is the sum of binomials times those here.
        for (k, there) in there.coefficients().iter().enumerate() {
            let mut sum = 0.0;
            for (n, here) in jet.coefficients().iter().enumerate().skip(k) {
                let whole = |number: usize| f64::from(u32::try_from(number).unwrap());
                let factors = (0..k).map(|j| whole(n - j) / whole(k - j));
                let binomial: f64 = factors.product();
                sum += binomial * here * step.powi((n - k).try_into().unwrap());
            }
            prop_assert!((sum - there).abs() < 1e-6 * (1.0 + there.abs()), "{k}: {sum} {there}");
        }
        // The first two are those of a gradient.
        let [x] = Gradient::variables([at]);
        let gradient = function(x).unwrap();
        let [value, slope, ..] = jet.coefficients();
        prop_assert!((gradient.value() - value).abs() < ROUNDING);
        prop_assert!((gradient.slopes()[0] - slope).abs() < ROUNDING * (1.0 + slope.abs()));
    }

    /// Jets of intervals hold those of numbers in them.
    #[test]
    fn jets_of_intervals_hold_jets(at in -1.0..1.0_f64, width in 0.0..0.01_f64, share in 0.0..1.0_f64) {
        let zero = Interval::from(0.0);
        let around = Interval::new(at, at + width);
        let wide = function(Jet::new([around, Interval::from(1.0), zero, zero, zero])).unwrap();
        let inside = (at + width * share).min(around.high());
        let narrow = function(Jet::<f64, 5>::new([inside, 1.0, 0.0, 0.0, 0.0])).unwrap();
        for (wide, narrow) in wide.coefficients().iter().zip(narrow.coefficients()) {
            let slack = 1e-12 * (1.0 + narrow.abs());
            prop_assert!(wide.low() - slack <= *narrow && *narrow <= wide.high() + slack);
        }
    }
}

/// All functions of a number, in their ranges for -1 to 1.
fn function<T: Number>(x: T) -> Result<T, Refusal> {
    let (sin, cos) = (x * 2.0 + 0.3).sin_cos();
    let root = (sin + 2.0).root("")?;
    let angle = T::atan2(sin + x.squared(), cos * 0.5 + 3.0, "")?;
    Ok((root * angle - x / (cos + 2.5)) / 1.5 + -x)
}

#[test]
fn what_is_not_known_stays_so() {
    let zero = Interval::new(-1.0, 1.0);
    let unknown = Interval::from(1.0) / zero;
    for result in [
        unknown,
        unknown + 1.0,
        unknown * 0.0,
        -unknown,
        unknown.squared(),
        unknown / 2.0,
    ] {
        assert!(
            result.low().is_nan() && result.high().is_nan(),
            "{result:?}"
        );
    }
    assert!(unknown.root("").is_err() && unknown.is_positive("").is_err());
    assert!(Interval::atan2(unknown, zero, "").is_err());
    let (sin, _) = unknown.sin_cos();
    assert_eq!((sin.low(), sin.high()), (-1.0, 1.0));
    let huge = Interval::new(1e200, 1e300);
    assert!((huge * huge).high().is_nan());
    assert!(Interval::new(1.0, 0.0).low().is_nan());
}

#[test]
fn refusals_say_what_and_by_how_much() {
    let [x, y] = Gradient::variables([30.0, 40.0]);
    // A rod of 45 is too short by about 5.
    let refusal = (-(x.squared() + y.squared()) + 45.0 * 45.0).root("the rod is too short");
    assert_eq!(
        refusal.unwrap_err().to_string(),
        "the rod is too short, by 4.75"
    );
    let refusal = (x - 31.5)
        .require_positive("left of the frame")
        .unwrap_err();
    assert_eq!(refusal.to_string(), "left of the frame, by 1.5");
    let undecided = Interval::new(-1.0, 1.0)
        .root("the rod is too short")
        .unwrap_err();
    assert_eq!(undecided.to_string(), "the rod is too short, or may");
    assert!(f64::NAN.root("").is_err() && Number::is_positive(f64::NAN, "").is_err());
    assert!(<f64 as Number>::atan2(0.0, 0.0, "").is_err());
    assert!(
        (Interval::atan2(Interval::new(-1.0, 1.0), Interval::new(-2.0, -1.0), "")
            .unwrap()
            .middle()
            .abs()
            - PI)
            .abs()
            < 1e-9
    );
}
