//! Mistakes of other implementations, each shown to be one, and that it is not made here.

use core::f64::consts::FRAC_PI_2;

use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, Quaternion, UnitQuaternion, Vector3};
use pose_pt::{
    Convention, NotARotation, PoseVector, angle_between, from_matrix, from_rotation_vector,
    rigid_fit, rotation_vector_between, slerp, to_matrix,
};

/// A handful of roundings in f64.
const ROUNDING: f64 = 1e-15;

fn turned(a: &UnitQuaternion<f64>, angle: f64) -> UnitQuaternion<f64> {
    from_rotation_vector(&(Vector3::new(2.0, -1.0, 2.0) / 3.0 * angle)) * a
}

fn start() -> UnitQuaternion<f64> {
    from_rotation_vector(&Vector3::new(0.3, -0.4, 1.2))
}

/// Largest difference of two quaternions up to their sign.
fn miss(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>) -> f64 {
    let (a, b) = (a.as_vector(), b.as_vector());
    (a - b).amax().min((a + b).amax())
}

/// An arc cosine of the dot product loses half of the digits of close rotations.
#[test]
fn slerp_of_close_rotations_keeps_its_digits() {
    let mut theirs_worst = 0f64;
    for step in 1..200 {
        let a = start();
        let angle = f64::from(step) * 1e-9;
        let (b, wanted) = (turned(&a, angle), turned(&a, angle * 0.3));
        assert!(miss(&slerp(&a, &b, 0.3), &wanted) <= ROUNDING, "{angle:e}");
        let theirs = a.try_slerp(&b, 0.3, 0.0).unwrap_or(a);
        theirs_worst = theirs_worst.max(miss(&theirs, &wanted));
    }
    assert!(
        theirs_worst > 1e-10,
        "nalgebra is right to {theirs_worst:e}"
    );
}

#[test]
fn the_angle_between_close_rotations_keeps_its_digits() {
    for exponent in -15..0 {
        let angle = 10f64.powi(exponent);
        let (a, b) = (start(), turned(&start(), angle));
        assert!(
            (angle_between(&a, &b) - angle).abs() <= ROUNDING,
            "{angle:e}"
        );
        let way = rotation_vector_between(&a, &b).normalize();
        // The quaternions are rounded: their difference is, relative to its length.
        let rounding = ROUNDING / angle;
        assert!((way - Vector3::new(2.0, -1.0, 2.0) / 3.0).amax() <= rounding);
    }
}

/// An arc sine loses half of the digits near ±90°.
#[test]
fn angles_near_gimbal_lock_rebuild_the_matrix() {
    let mut theirs_worst = 0f64;
    for exponent in 1..17 {
        let beta = FRAC_PI_2 - 10f64.powi(-exponent);
        let vector = PoseVector::new(0.0, 0.0, 0.0, -1.3, beta, 0.9);
        let pose = vector.to_isometry(Convention::ExtrinsicXyz);
        let wanted = vector.to_rotation(Convention::ExtrinsicXyz);
        let found = PoseVector::from_isometry(&pose, Convention::ExtrinsicXyz).vector;
        let ours = found.to_rotation(Convention::ExtrinsicXyz);
        assert!(
            (ours.matrix() - wanted.matrix()).amax() <= 2.0 * ROUNDING,
            "{exponent}"
        );
        let (alpha, beta, gamma) = wanted.euler_angles();
        let theirs = PoseVector::new(0.0, 0.0, 0.0, alpha, beta, gamma);
        let theirs = theirs.to_rotation(Convention::ExtrinsicXyz);
        theirs_worst = theirs_worst.max((theirs.matrix() - wanted.matrix()).amax());
    }
    assert!(theirs_worst > 1e-9, "nalgebra is right to {theirs_worst:e}");
}

/// Interpolating to a quaternion of the other sign must not go the long way round.
#[test]
fn the_shorter_arc_is_taken() {
    let (a, b) = (start(), turned(&start(), 0.2));
    let negated = UnitQuaternion::new_unchecked(-b.into_inner());
    assert!(miss(&slerp(&a, &negated, 0.5), &turned(&a, 0.1)) <= ROUNDING);
    assert!((angle_between(&a, &negated) - 0.2).abs() <= ROUNDING);
    // Twice the same, and half a turn apart: no division by zero.
    assert_eq!(slerp(&a, &a, 0.4), a);
    let opposite = UnitQuaternion::new_unchecked(Quaternion::new(0.0, 1.0, 0.0, 0.0));
    let half = slerp(&UnitQuaternion::identity(), &opposite, 0.5);
    assert!((half.i - 0.5f64.sqrt()).abs() <= ROUNDING && (half.w - half.i).abs() <= ROUNDING);
}

/// A fit by a matrix of squares loses twice the digits of a narrow set.
#[test]
fn narrow_sets_lose_digits_once_not_twice() {
    let motion = Isometry3::from_parts(Vector3::new(30.0, -20.0, 10.0).into(), start());
    for exponent in 0..12 {
        let width = 1000.0 * 10f64.powi(-exponent);
        let a = [
            Point3::new(-1000.0, 0.0, 0.0),
            Point3::new(1000.0, width, 0.0),
            Point3::new(0.0, -width, 0.0),
        ];
        // Along an axis of the coordinates, and across all three.
        for placed in [a, a.map(|point| start() * point)] {
            let b = placed.map(|point| motion * point);
            let fit = rigid_fit(&placed, &b).unwrap();
            let turn = angle_between(&fit.motion.rotation, &motion.rotation);
            assert!(
                turn <= 2.0 * ROUNDING * 1000.0 / width,
                "{width:e}: {turn:e}"
            );
        }
    }
}

/// The best orthogonal matrix may be a reflection; the best rotation is another one.
#[test]
fn a_mirror_image_is_met_by_a_rotation() {
    let a = [
        [1.0, 0.2, 0.1],
        [-0.5, 2.0, 0.3],
        [0.1, -0.7, 3.0],
        [0.4, 0.1, -1.0],
    ];
    let mirrored = a.map(|[x, y, z]| Point3::new(x, y, -z));
    let fit = rigid_fit(&a.map(Point3::from), &mirrored).unwrap();
    let determinant: f64 = to_matrix(&fit.motion.rotation).matrix().determinant();
    assert!((determinant - 1.0).abs() <= ROUNDING);
    assert!(fit.rms > 0.1);
}

/// A matrix that is no rotation must not become one in silence.
#[test]
fn matrices_that_are_no_rotations_are_refused() {
    let rotation = *to_matrix(&start()).matrix();
    assert!(miss(&from_matrix(&rotation, 0.0).unwrap(), &start()) <= ROUNDING);
    let mirrored = -rotation;
    assert!(matches!(
        from_matrix(&mirrored, 0.0),
        Err(NotARotation { determinant, .. }) if determinant < -0.9
    ));
    let mut bad = rotation;
    bad.m23 = f64::NAN;
    assert!(matches!(
        from_matrix(&bad, 1.0),
        Err(NotARotation { departure, .. }) if departure.is_finite()
    ));
    assert!(from_matrix(&(rotation * 1.01), 1e-3).is_err());
    // Printed to four decimals.
    let printed = rotation.map(|entry| (entry * 1e4).round() / 1e4);
    assert!(from_matrix(&printed, 0.0).is_err());
    let near = from_matrix(&printed, 1e-3).unwrap();
    assert!(angle_between(&near, &start()) < 1e-4);
    // However much is allowed, a matrix without a nearest rotation is none, and one of any size
    // has the one that it has.
    assert!(from_matrix(&rotation, f64::NAN).is_err());
    for singular in [Matrix3::zeros(), Matrix3::from_element(0.5)] {
        assert!(from_matrix(&singular, f64::INFINITY).is_err());
    }
    for size in [5e-324, 1e-300, 1e-160, 0.2, 3.0, 1e160, 1e300] {
        let flat = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)) * size;
        let found = from_matrix(&flat, f64::INFINITY).unwrap();
        assert!(
            (to_matrix(&found).matrix() * size - flat).amax() <= ROUNDING * size,
            "{size:e}"
        );
    }
    // All four ways of choosing the largest component, half turns among them.
    for half_turn in [
        Vector3::new(1.0, 1.0, 1.0),
        Vector3::new(1.0, -1.0, -1.0),
        Vector3::new(-1.0, 1.0, -1.0),
        Vector3::new(-1.0, -1.0, 1.0),
    ] {
        let matrix = Matrix3::from_diagonal(&half_turn);
        let turned = from_matrix(&matrix, 0.0).unwrap();
        assert!((to_matrix(&turned).matrix() - matrix).amax() <= ROUNDING);
    }
}
