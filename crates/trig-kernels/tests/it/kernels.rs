//! Accuracy, special values and symmetries, in seconds. All angles and vectors that there is time
//! for are in `exhaustive.rs`.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use trig_kernels::{Trig, atan2, atan2_lanes, sin_cos, sin_cos_lanes};

use crate::common::bits;
use crate::common::double_double::{Reference, Wide, last_place, wide};
use crate::common::worst::{Random, Worst, single};

/// In units of the last place: what the README promises.
const LIMIT: f64 = 0.85;
const COMMON_F32: f64 = 12_867.0;
const COMMON_F64: f64 = 105_414_357.0;
const COUNT: u32 = 50_000;

/// Lines of `data/angles.csv`: the digits of the angle's bits, its sine and cosine.
fn table() -> impl Iterator<Item = (&'static str, [Wide; 2])> {
    let lines = include_str!("../data/angles.csv").lines().skip(1);
    lines.map(|line| {
        let (bits, numbers) = line.split_once(',').expect("five columns");
        let numbers: Vec<f64> = numbers.split(',').map(|n| n.parse().unwrap()).collect();
        let [a, b, c, d] = numbers[..] else {
            panic!("five columns")
        };
        (bits, [(a, b), (c, d)].map(|(high, low)| Wide { high, low }))
    })
}

#[test]
fn sine_and_cosine_of_hard_angles_of_any_size() {
    let mut worst = Worst::default();
    for (bits, [sin, cos]) in table() {
        if bits.len() == 8 {
            let x = f32::from_bits(u32::from_str_radix(bits, 16).unwrap());
            let found = sin_cos(x);
            worst.see_f32(found.0, sin.high, x);
            worst.see_f32(found.1, cos.high, x);
        } else {
            let x = f64::from_bits(u64::from_str_radix(bits, 16).unwrap());
            let found = sin_cos(x);
            worst.see_f64(found.0, sin, x);
            worst.see_f64(found.1, cos, x);
        }
    }
    assert!(worst.error <= LIMIT, "{worst}");
}

/// The reference of the tests against the table.
#[test]
fn the_reference_has_95_bits() {
    let reference = Reference::new();
    let mut seen = 0;
    for (bits, exact) in table().filter(|(bits, _)| bits.len() == 16) {
        let x = f64::from_bits(u64::from_str_radix(bits, 16).unwrap());
        if x < 2f64.powi(27) {
            let (sin, cos) = reference.sin_cos(x);
            for (found, exact) in [sin, cos].into_iter().zip(exact) {
                let error = (found.high - exact.high) + (found.low - exact.low);
                assert!(error.abs() <= 2f64.powi(-95) * exact.high.abs(), "{x}");
            }
            seen += 1;
        }
    }
    assert!(seen > 50);
}

#[test]
fn random_angles_and_vectors_of_f32() {
    let (mut angles, mut vectors) = (Worst::default(), Worst::default());
    for part in 0..4 {
        let mut random = Random::new(part);
        for _ in 0..COUNT {
            let x = single(random.angle(part, COMMON_F32));
            let (sin, cos) = sin_cos(x);
            let (sin_exact, cos_exact) = f64::from(x).sin_cos();
            angles.see_f32(sin, sin_exact, x);
            angles.see_f32(cos, cos_exact, x);
            let [x, y] = random.vector(part).map(single);
            vectors.see_f32(atan2(y, x), f64::from(y).atan2(f64::from(x)), (y, x));
        }
    }
    assert!(angles.error <= LIMIT, "{angles}");
    assert!(vectors.error <= LIMIT, "{vectors}");
}

#[test]
fn random_angles_and_vectors_of_f64() {
    let reference = Reference::new();
    let (mut angles, mut vectors) = (Worst::default(), Worst::default());
    for part in 0..4 {
        let mut random = Random::new(part);
        for _ in 0..COUNT {
            let x = random.angle(part, COMMON_F64);
            let (sin, cos) = sin_cos(x);
            let (sin_exact, cos_exact) = reference.sin_cos(x);
            angles.see_f64(sin, sin_exact, x);
            angles.see_f64(cos, cos_exact, x);
            let [x, y] = random.vector(part);
            let angle = atan2(y, x);
            // What is left of the vector's angle when it is turned back by the one found.
            let (sin, cos) = reference.sin_cos(angle);
            let across = wide(y).times(cos).minus(wide(x).times(sin));
            let error = (across.high / x.hypot(y)).abs() / last_place(angle);
            vectors.see(error, (y, x));
        }
    }
    assert!(angles.error <= LIMIT, "{angles}");
    assert!(vectors.error <= LIMIT, "{vectors}");
}

#[test]
fn sine_and_cosine_of_special_values() {
    for zero in [0.0_f64, -0.0] {
        let (sin, cos) = sin_cos(zero);
        assert_eq!(sin.to_bits(), zero.to_bits());
        assert_eq!(cos.to_bits(), 1.0_f64.to_bits());
        let (sin, cos) = sin_cos(single(zero));
        assert_eq!(sin.to_bits(), single(zero).to_bits());
        assert_eq!(cos.to_bits(), 1.0_f32.to_bits());
    }
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (sin, cos) = sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan());
        let (sin, cos) = sin_cos(single(x));
        assert!(sin.is_nan() && cos.is_nan());
    }
    // Tiny angles are their own sines.
    for x in [f64::MIN_POSITIVE, 5e-324, -1e-310, 1e-300, -1e-20] {
        assert_eq!(sin_cos(x), (x, 1.0));
        assert_eq!(sin_cos(single(x)), (single(x), 1.0));
    }
}

/// IEEE 754-2019, section 9.2.1: atan2.
#[test]
fn atan2_of_special_values() {
    const INF: f64 = f64::INFINITY;
    let cases = [
        (0.0, 0.0, 0.0),
        (0.0, -0.0, PI),
        (0.0, 1.0, 0.0),
        (0.0, -1.0, PI),
        (0.0, INF, 0.0),
        (0.0, -INF, PI),
        (1.0, 0.0, FRAC_PI_2),
        (1.0, -0.0, FRAC_PI_2),
        (INF, 0.0, FRAC_PI_2),
        (INF, -1.0, FRAC_PI_2),
        (INF, INF, FRAC_PI_4),
        (INF, -INF, 3.0 * FRAC_PI_4),
        (1.0, INF, 0.0),
        (1.0, -INF, PI),
        (1.0, 1.0, FRAC_PI_4),
        (1.0, -1.0, 3.0 * FRAC_PI_4),
        (1e-300, -1.0, PI),
        (1.0, 1e-300, FRAC_PI_2),
        (1e300, 1e300, FRAC_PI_4),
        (5e-324, 5e-324, FRAC_PI_4),
        (5e-324, 1.0, 5e-324),
        (1e-310, 1.0, 1e-310),
    ];
    for (y, x, angle) in cases {
        for sign in [1.0, -1.0] {
            let (y, angle) = (sign * y, sign * angle);
            assert_eq!(atan2(y, x).to_bits(), angle.to_bits(), "{y}, {x}");
            let found: f32 = atan2(single(y), single(x));
            // 1e300 and 5e-324 are infinite and zero in f32.
            if single(y).is_finite() && (y == 0.0) == (single(y) == 0.0) {
                assert_eq!(found.to_bits(), single(angle).to_bits(), "{y}, {x} in f32");
            }
        }
    }
    for (y, x) in [
        (f64::NAN, 1.0),
        (1.0, f64::NAN),
        (f64::NAN, INF),
        (0.0, f64::NAN),
    ] {
        assert!(atan2(y, x).is_nan());
        assert!(atan2(single(y), single(x)).is_nan());
    }
}

/// The angle is odd in y, and any power of two is common to both sides.
#[test]
fn atan2_is_symmetric() {
    let mut random = Random::new(3);
    for part in 0..COUNT {
        let [x, y] = random.vector(part);
        let angle = atan2(y, x);
        assert_eq!(atan2(-y, x).to_bits(), (-angle).to_bits());
        for power in [-900, -400, -40, 40, 400, 900] {
            let scale = 2f64.powi(power);
            assert_eq!(
                atan2(y * scale, x * scale).to_bits(),
                angle.to_bits(),
                "{y}, {x}"
            );
        }
    }
}

#[test]
fn sine_is_odd_and_cosine_even() {
    let mut random = Random::new(5);
    for part in 0..COUNT {
        for x in [
            random.angle(part, COMMON_F64),
            random.angle(part, COMMON_F64) * 1e7,
        ] {
            let ((sin, cos), (sin_minus, cos_minus)) = (sin_cos(x), sin_cos(-x));
            assert_eq!(
                (sin.to_bits(), cos.to_bits()),
                ((-sin_minus).to_bits(), cos_minus.to_bits())
            );
        }
    }
}

/// Lanes give the bits of the single functions, with a rare one among them too.
fn check_lanes<T: Trig + PartialEq + core::fmt::Debug, const L: usize>(numbers: &[[T; 2]; 9]) {
    let x: [T; L] = core::array::from_fn(|lane| numbers[lane][0]);
    let y: [T; L] = core::array::from_fn(|lane| numbers[lane][1]);
    assert_eq!(
        atan2_lanes(y, x),
        core::array::from_fn(|lane| atan2(y[lane], x[lane]))
    );
    let single = x.map(sin_cos);
    let (sin, cos) = sin_cos_lanes(x);
    assert_eq!(sin, single.map(|(sin, _)| sin));
    assert_eq!(cos, single.map(|(_, cos)| cos));
}

#[test]
fn lanes_are_the_single_functions() {
    let mut random = Random::new(9);
    for part in 0..500_usize {
        let mut numbers: [[f64; 2]; 9] = core::array::from_fn(|_| random.vector(0));
        if part % 2 == 0 {
            let place = part / 2 % 9;
            numbers[place] = [
                [1e12, 0.0],
                [0.0, -0.0],
                [-1e200, 1e-200],
                [f64::MAX, f64::MAX],
            ][part / 18 % 4];
        }
        let singles = numbers.map(|pair| pair.map(|v| single(v.clamp(-1e38, 1e38))));
        check_lanes::<f64, 1>(&numbers);
        check_lanes::<f64, 2>(&numbers);
        check_lanes::<f64, 3>(&numbers);
        check_lanes::<f64, 8>(&numbers);
        check_lanes::<f64, 9>(&numbers);
        check_lanes::<f32, 1>(&singles);
        check_lanes::<f32, 3>(&singles);
        check_lanes::<f32, 8>(&singles);
        check_lanes::<f32, 9>(&singles);
    }
}

/// Code that is generic over nalgebra's numbers and asks for [`Trig`] besides: its methods stay
/// unambiguous, and the functions of this crate are called by name.
#[test]
fn beside_real_field() {
    fn tip<T: nalgebra::RealField + Trig>(length: T, angle: T) -> [T; 2] {
        let (sin, cos) = sin_cos(angle);
        assert!((angle.sin() - sin).abs() <= T::default_epsilon());
        [length * cos, length * sin]
    }
    let [x, y] = tip(132.0, 0.75_f64);
    assert!((atan2(y, x) - 0.75).abs() <= f64::EPSILON);
    let [x, y] = tip(132.0, 0.75_f32);
    assert!((atan2(y, x) - 0.75).abs() <= f32::EPSILON);
}

/// The same on every target: these were found on x86-64 with SSE2, AVX2 and AVX-512, Cortex-M4F and
/// Cortex-M0+. A change of the kernels that changes them is a change of what users compute.
#[test]
fn the_bits_are_those_of_every_target() {
    assert_eq!(
        bits::hashes().map(|hash| format!("{hash:016x}")),
        ["5c1fab0c59257af6", "3464ff38541b2e77"]
    );
}
