//! Calibration: what was changed is found again, and what cannot be found is said.

#[path = "../../benches/kinematics/eleven.rs"]
mod eleven;

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{CalibrationError, Delta, Measured, Parameter, Quantity};
use eleven::eleven;

use crate::common::thesis::thesis;

/// Up to a degree and a millimetre, as a machine from a workshop has them.
const OFF: [f64; 11] = [
    0.015, -0.01, 0.007, 0.8, -0.6, 0.3, 0.01, -0.012, 0.005, 0.5, -0.4,
];

fn real() -> Delta {
    let mut arms = *thesis().arms();
    for ((arm, zero), lower) in arms.iter_mut().zip(&OFF[..3]).zip(&OFF[3..6]) {
        arm.zero += zero;
        arm.lower += lower;
        arm.azimuth += OFF[8];
        arm.base += OFF[9];
        arm.upper += OFF[10];
    }
    arms[1].azimuth += OFF[6];
    arms[2].azimuth += OFF[7];
    thesis().with_arms(arms).unwrap()
}

/// Evenly spread numbers, and ones that look like noise of standard deviation 1.
fn spread(k: u32, step: f64) -> f64 {
    (f64::from(k) * step).fract()
}

fn noise(k: u32, axis: u32) -> f64 {
    // Three uniform numbers of width 2 sum to variance 1.
    let seed = k * 3 + axis;
    (1..4u32)
        .map(|n| {
            let mixed = (seed * 4 + n).wrapping_mul(2_654_435_761);
            let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(2_246_822_519);
            f64::from(mixed ^ (mixed >> 13)) / f64::from(u32::MAX) * 2.0 - 1.0
        })
        .sum()
}

/// Points all over a cylinder, measured with `sigma` mm of noise in each direction.
fn measured(count: u32, sigma: f64) -> Vec<Measured> {
    (0..count)
        .map(|k| {
            let radius = 110.0 * spread(k, 0.754_877_666).sqrt();
            let heading = 6.3 * spread(k, 0.569_840_291);
            let z = -300.0 + 110.0 * spread(k, 0.438_579_021);
            let point = Point3::new(radius * heading.cos(), radius * heading.sin(), z);
            let off = Vector3::new(noise(k, 0), noise(k, 1), noise(k, 2)) * sigma;
            Measured {
                angles: real().inverse(point).unwrap(),
                point: point + off,
            }
        })
        .collect()
}

/// Without noise all digits but those lost to the conditioning (about 1e-3) come back.
#[test]
fn exact_points_give_the_geometry_back() {
    let found = thesis().calibrate(eleven(), &measured(60, 0.0)).unwrap();
    for (change, off) in found.changes().iter().zip(OFF) {
        assert!((change - off).abs() < 1e-9, "{change} for {off}");
    }
    assert_eq!(found.rank(), 11);
    assert!(found.largest() < 1e-10 && found.iterations() < 12);
    assert_eq!(found.undetermined().count(), 0);
    assert_eq!(found.null_space().count(), 0);
}

/// With 0.02 mm of noise each parameter comes back within four of its stated deviations, and the
/// machine is exact to 0.02 mm where nothing was measured.
#[test]
fn noisy_points_give_the_machine_back() {
    let found = thesis().calibrate(eleven(), &measured(60, 0.02)).unwrap();
    for ((change, off), deviation) in found.changes().iter().zip(OFF).zip(found.deviations()) {
        let deviation = deviation.unwrap();
        assert!(
            (change - off).abs() < 4.0 * deviation,
            "{change} for {off} ± {deviation}"
        );
    }
    // √3 × 0.02, less what eleven parameters take up.
    assert!((0.025..0.04).contains(&found.rms()), "{}", found.rms());
    assert!(found.largest() < 0.1);
    let before = Point3::new(70.0, -60.0, -270.0);
    let reached = real()
        .forward(found.machine().inverse(before).unwrap())
        .unwrap();
    let raw = real().forward(thesis().inverse(before).unwrap()).unwrap();
    assert!(
        (reached - before).norm() < 0.02,
        "{}",
        (reached - before).norm()
    );
    assert!((raw - before).norm() > 0.5, "{}", (raw - before).norm());
}

/// The radii of base and platform show in their difference alone.
#[test]
fn what_points_cannot_tell_is_named() {
    let parameters = [
        Parameter::common(Quantity::Base),
        Parameter::common(Quantity::Platform),
        Parameter::common(Quantity::Lower),
    ];
    let found = thesis().calibrate(parameters, &measured(60, 0.02)).unwrap();
    assert_eq!(found.rank(), 2);
    assert!(found.conditioning() < 1e-12);
    let undetermined: Vec<Parameter> = found.undetermined().collect();
    assert_eq!(undetermined, parameters[..2]);
    let free: Vec<[f64; 3]> = found.null_space().collect();
    assert_eq!(free.len(), 1);
    assert!((free[0][0] - free[0][1]).abs() < 1e-9 && free[0][2].abs() < 1e-9);
    assert!(free[0][0].abs() > 1e-3);
    let [base, platform, lower] = found.deviations();
    assert!(base.is_none() && platform.is_none() && lower.is_some());
    assert_eq!(parameters[1].to_string(), "platform radius of all arms");
}

/// One pose, however often measured, gives three numbers.
#[test]
fn one_pose_gives_three_numbers() {
    let one = measured(1, 0.0)[0];
    let found = thesis().calibrate(eleven(), &[one; 20]).unwrap();
    assert_eq!(found.rank(), 3);
    assert_eq!(found.null_space().count(), 8);
    assert!(found.largest() < 1e-9);
    for free in found.null_space() {
        let mut arms = *found.machine().arms();
        let nudge = 1e-5;
        for ((arm, zero), lower) in arms.iter_mut().zip(&free[..3]).zip(&free[3..6]) {
            arm.zero += zero * nudge;
            arm.lower += lower * nudge;
            arm.azimuth += free[8] * nudge;
            arm.base += free[9] * nudge;
            arm.upper += free[10] * nudge;
        }
        arms[1].azimuth += free[6] * nudge;
        arms[2].azimuth += free[7] * nudge;
        let moved = found.machine().with_arms(arms).unwrap();
        let (a, b) = (
            found.machine().forward(one.angles),
            moved.forward(one.angles),
        );
        // The second order of the nudge is left.
        let moved = (a.unwrap() - b.unwrap()).norm();
        assert!(moved < 1e-6, "{moved:e} {free:?}");
    }
}

#[test]
fn bad_measurements_are_named() {
    let good = measured(4, 0.0);
    assert_eq!(
        thesis()
            .calibrate(eleven(), &good[..3])
            .unwrap_err()
            .to_string(),
        "3 measured points are too few for 11 parameters: 4 at least"
    );
    let mut bad = good.clone();
    bad[2].point.y = f64::NAN;
    assert_eq!(
        thesis().calibrate(eleven(), &bad),
        Err(CalibrationError::NotFinite { index: 2 })
    );
    // Its square is not a number any more.
    bad[2].point.y = 1e200;
    assert_eq!(
        thesis().calibrate(eleven(), &bad),
        Err(CalibrationError::NotFinite { index: 2 })
    );
    let mut bad = good;
    bad[1].angles.z = f64::INFINITY;
    assert!(matches!(
        thesis().calibrate(eleven(), &bad),
        Err(CalibrationError::Impossible { index: 1, .. })
    ));
}

/// Frame and zero are kept, and the same numbers are found in them.
#[test]
fn other_frames_calibrate_alike() {
    use delta_kin::{Positive, ZAxis};
    let (turned, real) = (
        thesis().with_z(ZAxis::Down).with_positive(Positive::Inward),
        real().with_z(ZAxis::Down).with_positive(Positive::Inward),
    );
    let measured: Vec<Measured> = measured(60, 0.0)
        .into_iter()
        .map(|m| {
            let point = Point3::new(m.point.x, m.point.y, -m.point.z);
            let angles = real.inverse(point).unwrap();
            Measured { angles, point }
        })
        .collect();
    let found = turned.calibrate(eleven(), &measured).unwrap();
    for (change, off) in found.changes().iter().zip(OFF) {
        assert!((change - off).abs() < 1e-9, "{change} for {off}");
    }
}
