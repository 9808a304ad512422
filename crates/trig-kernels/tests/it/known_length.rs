//! Angles of vectors whose length is known: accuracy, special values, lanes.

use core::f64::consts::PI;

use trig_kernels::{Trig, atan2, atan2_of_length, atan2_of_length_lanes};

use crate::common::double_double::{Reference, last_place, wide};
use crate::common::worst::{Random, Worst, single};

/// In units of the last place: what is documented.
const LIMIT: f64 = 4.0;
const COUNT: u32 = 100_000;

/// One over the length, off by up to `off` of it.
fn inverse_length(random: &mut Random, [x, y]: [f64; 2], off: f64) -> f64 {
    (1.0 + random.signed() * off) / x.hypot(y)
}

#[test]
fn f32_is_within_four_units() {
    let mut worst = Worst::default();
    for part in 0..8 {
        let mut random = Random::new(part);
        for round in 0..COUNT {
            let [x, y] = random.vector(part).map(single);
            // As near as rounding, as may be, and wrong.
            let off = [0.0, 2f64.powi(-13), 1e-2][round as usize % 3];
            let per = single(inverse_length(&mut random, [x, y].map(f64::from), off));
            let angle = atan2_of_length(y, x, per);
            worst.see_f32(angle, f64::from(y).atan2(f64::from(x)), (y, x, per));
        }
    }
    println!("f32 atan2_of_length: {worst}");
    assert!(worst.error <= LIMIT, "{worst}");
}

#[test]
fn f64_is_within_four_units() {
    let reference = Reference::new();
    let mut worst = Worst::default();
    for part in 0..8 {
        let mut random = Random::new(part);
        for round in 0..COUNT {
            let [x, y] = random.vector(part);
            let off = [0.0, 2f64.powi(-28), 1e-2][round as usize % 3];
            let per = inverse_length(&mut random, [x, y], off);
            let angle = atan2_of_length(y, x, per);
            let (sin, cos) = reference.sin_cos(angle);
            let across = wide(y).times(cos).minus(wide(x).times(sin));
            let error = (across.high / x.hypot(y)).abs() / last_place(angle);
            worst.see(error, (y, x, per));
        }
    }
    println!("f64 atan2_of_length: {worst}");
    assert!(worst.error <= LIMIT, "{worst}");
}

#[test]
fn signs_axes_and_wrong_lengths() {
    for zero in [0.0, -0.0_f64] {
        assert_eq!(
            atan2_of_length(zero, 3.0, 1.0 / 3.0).to_bits(),
            zero.to_bits()
        );
        assert_eq!(
            atan2_of_length(zero, -3.0, 1.0 / 3.0).to_bits(),
            PI.copysign(zero).to_bits()
        );
        assert_eq!(
            atan2_of_length(2.0, zero, 0.5).to_bits(),
            (PI / 2.0).to_bits()
        );
        assert_eq!(
            atan2_of_length(-2.0, zero, 0.5).to_bits(),
            (-PI / 2.0).to_bits()
        );
    }
    // What is no length, or that of another vector, is as if none were known.
    for (y, x) in [
        (3.0, 4.0),
        (0.0, 0.0),
        (-0.0, -1.0),
        (1e-300, 1e300),
        (f64::INFINITY, 1.0),
    ] {
        for per in [0.0, 0.1, 1.0, f64::INFINITY, f64::NAN, 1e300] {
            let found = atan2_of_length(y, x, per);
            assert_eq!(
                found.to_bits(),
                atan2::<f64>(y, x).to_bits(),
                "{y} {x} {per}"
            );
        }
    }
    assert!(atan2_of_length(f64::NAN, 1.0, 1.0).is_nan());
}

#[test]
fn lanes_are_the_single_function() {
    fn check<T: Trig + PartialEq + core::fmt::Debug>(vectors: [[T; 3]; 8]) {
        let [y, x, per] = [0, 1, 2].map(|k| vectors.map(|vector| vector[k]));
        let lanes = atan2_of_length_lanes(y, x, per);
        let alone = vectors.map(|[y, x, per]| atan2_of_length(y, x, per));
        assert_eq!(lanes, alone);
    }
    for part in 0..400 {
        let mut random = Random::new(part);
        let vectors = [(); 8].map(|()| {
            let [x, y] = random.vector(part);
            // Now and then a length that is wrong.
            let off = if random.bits().is_multiple_of(31) {
                0.5
            } else {
                0.0
            };
            [y, x, inverse_length(&mut random, [x, y], off)]
        });
        check(vectors);
        check(vectors.map(|vector| vector.map(single)));
    }
}
