//! Calibration: what was changed is found again, and what cannot be found is said.

use proptest::prelude::*;
use scara_kin::Parameter::{
    self, BaseAngle, BaseX, BaseY, Coupling, ElbowRatio, ElbowZero, Fore, ShoulderRatio,
    ShoulderZero, Upper,
};
use scara_kin::nalgebra::{Isometry2, Point2, Vector2};
use scara_kin::{Arm, CalibrationError, DriveAngles, DrivenArm, Drives, Joints, Measured};

const SEVEN: [Parameter; 7] = [
    Upper,
    Fore,
    ShoulderZero,
    ElbowZero,
    ElbowRatio,
    BaseX,
    BaseY,
];

/// What a workshop leaves: a millimetre, a degree, a belt's ratio.
const OFF: [f64; 7] = [0.9, -0.7, 0.011, -0.016, 0.006, 1.0, -0.9];

fn drawn() -> DrivenArm {
    DrivenArm {
        arm: Arm::new(132.0, 132.0).unwrap(),
        drives: Drives::default(),
    }
}

/// The drawn arm with links, zeros, the elbow's ratio and the base off by so much.
fn changed(by: [f64; 7]) -> DrivenArm {
    let [upper, fore, shoulder, elbow, ratio, x, y] = by;
    DrivenArm {
        arm: Arm::new(132.0 + upper, 132.0 + fore)
            .and_then(|arm| arm.with_base(Isometry2::translation(x, y)))
            .unwrap(),
        drives: Drives::default()
            .with_zero(Joints::new(shoulder, elbow))
            .and_then(|drives| drives.with_ratios([1.0, 1.0 + ratio]))
            .unwrap(),
    }
}

/// Evenly spread numbers in 0..1.
fn spread(k: u32, step: f64) -> f64 {
    (f64::from(k) * step).fract()
}

/// Looks like noise of standard deviation 1: three uniform numbers of width 2.
fn noise(k: u32) -> f64 {
    let uniform = (1..4_u32).map(|n| {
        let mixed = (k * 4 + n).wrapping_mul(2_654_435_761);
        let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(2_246_822_519);
        f64::from(mixed ^ (mixed >> 13)) / f64::from(u32::MAX) * 2.0 - 1.0
    });
    uniform.sum()
}

/// Angles all over the workspace, with both elbows.
fn angles(k: u32) -> DriveAngles {
    let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    DriveAngles {
        shoulder: -1.5 + 4.0 * spread(k, 0.754_877_666),
        elbow: side * (0.5 + 2.0 * spread(k, 0.569_840_291)),
    }
}

/// Points of an arm with `sigma` of noise in x and y.
fn measured(real: &DrivenArm, points: core::ops::Range<u32>, sigma: f64) -> Vec<Measured> {
    let point = |k: u32| {
        let drives = angles(k);
        let off = Vector2::new(noise(2 * k), noise(2 * k + 1)) * sigma;
        Measured {
            drives,
            point: real.forward(drives) + off,
        }
    };
    points.map(point).collect()
}

/// Root mean square of the distances between two arms' tools over the workspace.
fn tool_error(a: &DrivenArm, b: &DrivenArm) -> f64 {
    let squares =
        (1000..2000).map(|k| (a.forward(angles(k)) - b.forward(angles(k))).norm_squared());
    (squares.sum::<f64>() / 1000.0).sqrt()
}

/// What the residuals' last digits allow, with the conditioning (above 1e-2) to spare.
const EXACT: f64 = 1e-9;

#[test]
fn exact_points_give_the_arm_back() {
    let found = drawn()
        .calibrate(SEVEN, &measured(&changed(OFF), 0..20, 0.0))
        .unwrap();
    for (change, off) in found.changes().iter().zip(OFF) {
        assert!((change - off).abs() < EXACT, "{change} for {off}");
    }
    assert_eq!((found.rank(), found.undetermined().count()), (7, 0));
    assert!(found.largest() < EXACT && found.iterations() < 10);
}

/// The figure: 20 points of 0.02 mm noise. `-- --nocapture` prints what it finds.
#[test]
fn twenty_noisy_points_are_worth_a_hundredth_of_a_millimetre() {
    let real = changed(OFF);
    let (mut errors, mut within) = (Vec::new(), 0);
    for set in 0..20 {
        let points = measured(&real, 20 * set..20 * set + 20, 0.02);
        let found = drawn().calibrate(SEVEN, &points).unwrap();
        errors.push(tool_error(found.machine(), &real));
        let all = found.changes().iter().zip(OFF).zip(found.deviations());
        for ((change, off), deviation) in all {
            let deviation = deviation.unwrap();
            assert!((change - off).abs() < 5.0 * deviation);
            within += u32::from((change - off).abs() < deviation);
        }
        assert!(found.conditioning() > 1e-2, "{}", found.conditioning());
        // √2 × 0.02, less what seven parameters take up, times 0.6 to 1.4.
        assert!((0.015..0.036).contains(&found.rms()), "{}", found.rms());
    }
    errors.sort_by(f64::total_cmp);
    let before = tool_error(&drawn(), &real);
    println!(
        "{before:.3} mm before, {:.4} median, {:.4} worst",
        errors[10], errors[19]
    );
    assert!((1.8..2.5).contains(&before) && errors[10] < 0.013 && errors[19] < 0.02);
    // Two in three of 140 lie within one standard deviation, as stated deviations have to.
    assert!((75..=115).contains(&within), "{within} of 140");
}

#[test]
fn what_points_cannot_tell_is_named() {
    let parameters = [ShoulderZero, BaseAngle, Upper];
    let points = measured(&changed(OFF), 0..20, 0.02);
    let found = drawn().calibrate(parameters, &points).unwrap();
    assert_eq!(found.rank(), 2);
    let undetermined: Vec<_> = found.undetermined().collect();
    assert_eq!(undetermined, [ShoulderZero, BaseAngle]);
    let [shoulder, base, upper] = found.deviations();
    assert!(shoulder.is_none() && base.is_none() && upper.is_some());
    let free: Vec<_> = found.null_space().collect();
    assert_eq!(free.len(), 1);
    assert!((free[0][0] + free[0][1]).abs() < EXACT && free[0][0].abs() > 1e-3);
    assert_eq!(BaseAngle.to_string(), "base angle");
}

/// One pose, however often measured, gives two numbers.
#[test]
fn one_pose_gives_two_numbers() {
    let one = measured(&changed(OFF), 1..2, 0.0)[0];
    let found = drawn().calibrate(SEVEN, &[one; 20]).unwrap();
    assert_eq!((found.rank(), found.null_space().count()), (2, 5));
    assert!(found.largest() < EXACT);
}

#[test]
fn bad_measurements_are_named() {
    let good = measured(&drawn(), 0..4, 0.0);
    let refused = |points: &[Measured]| drawn().calibrate(SEVEN, points).unwrap_err();
    assert_eq!(
        refused(&good[..3]).to_string(),
        "3 measured points are too few for 7 parameters: 4 at least"
    );
    for wrong in [f64::NAN, f64::INFINITY, -1e200] {
        let mut bad = good.clone();
        bad[2].point.y = wrong;
        assert_eq!(refused(&bad), CalibrationError::NotFinite { index: 2 });
        let mut bad = good.clone();
        bad[1].drives.elbow = wrong;
        assert_eq!(refused(&bad), CalibrationError::NotFinite { index: 1 });
    }
    assert!(drawn().calibrate([], &[]).is_ok());
}

#[test]
fn what_is_no_ratio_is_refused() {
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9, 1e9] {
        let refused = Drives::default().with_ratios([1.0, wrong]).unwrap_err();
        let said = refused.to_string();
        assert!(
            said.contains(" of the elbow is not within 1.49012e-8..="),
            "{said}"
        );
    }
}

/// A point that the arm can never have measured ends in a bad fit that is seen, not in a panic.
#[test]
fn nonsense_fits_badly() {
    let far = Measured {
        drives: angles(3),
        point: Point2::new(1e6, -2e6),
    };
    let mut points = measured(&drawn(), 0..20, 0.0);
    points[7] = far;
    match drawn().calibrate([Upper, Fore, ElbowZero], &points) {
        Ok(found) => assert!(found.largest() > 1e5),
        Err(error) => assert!(
            matches!(error, CalibrationError::NotConverged { .. }),
            "{error}"
        ),
    }
}

proptest! {
    /// Any arm, drives and errors of up to some hundredths: the tool is where the real one is, also
    /// where nothing was measured.
    #[test]
    fn any_arm_is_found_again(
        lengths in prop::array::uniform2(50.0..500.0_f64),
        base in prop::array::uniform3(-3.0..3.0_f64),
        ratios in prop::array::uniform2(0.02..3.0_f64),
        coupling in -1.0..1.0_f64,
        off in prop::array::uniform9(-0.02..0.02_f64),
    ) {
        let base = Isometry2::new(Vector2::new(base[0], base[1]) * 100.0, base[2]);
        let arm = |[upper, fore]: [f64; 2]| Arm::new(upper, fore)?.with_base(base);
        let drawn = DrivenArm {
            arm: arm(lengths).unwrap(),
            drives: Drives::default().with_ratios(ratios).unwrap().with_coupling(coupling).unwrap(),
        };
        let [upper, fore, shoulder, elbow, ratio1, ratio2, more, x, y] = off;
        let real = DrivenArm {
            arm: Arm::new(lengths[0] * (1.0 + upper), lengths[1] * (1.0 + fore))
                .and_then(|arm| {
                    let at = base.translation.vector + Vector2::new(x, y) * 100.0;
                    arm.with_base(Isometry2::from_parts(at.into(), base.rotation))
                })
                .unwrap(),
            drives: Drives::default()
                .with_zero(Joints::new(shoulder, elbow))
                .and_then(|drives| drives.with_ratios([ratios[0] + ratios[0] * ratio1, ratios[1] * (1.0 + ratio2)]))
                .and_then(|drives| drives.with_coupling(coupling + more))
                .unwrap(),
        };
        // The joints' range is the same, whatever the ratios.
        let at = |k: u32| {
            let DriveAngles { shoulder, elbow } = angles(k);
            drawn.drives.from_joints(Joints::new(shoulder, elbow))
        };
        let points: Vec<_> = (0..30)
            .map(|k| Measured { drives: at(k), point: real.forward(at(k)) })
            .collect();
        let all = [Upper, Fore, ShoulderZero, ElbowZero, ShoulderRatio, ElbowRatio, Coupling, BaseX, BaseY];
        let found = drawn.calibrate(all, &points).unwrap();
        prop_assert_eq!(found.rank(), 9);
        for k in 1000..1050 {
            let distance = (found.machine().forward(at(k)) - real.forward(at(k))).norm();
            prop_assert!(distance < EXACT * arm(lengths).unwrap().reach(), "{} mm", distance);
        }
    }
}
