//! Pose vectors: the two conventions of [Alignment 2010], and gimbal lock.

use pose_pt::nalgebra::{Matrix3, Rotation3, Vector3};
use pose_pt::{Convention, PoseVector, angle_between};

/// The printed matrix and the words beside it are two conventions.
#[test]
fn the_two_conventions_differ() {
    let angle = |degrees: [f64; 3]| {
        let [alpha, beta, gamma] = degrees.map(f64::to_radians);
        let vector = PoseVector::new(0.0, 0.0, 0.0, alpha, beta, gamma);
        let [fixed, moving] = [Convention::ExtrinsicXyz, Convention::IntrinsicXyz]
            .map(|convention| vector.to_quaternion(convention));
        angle_between(&fixed, &moving)
    };
    assert!((angle([30.0, 20.0, 45.0]).to_degrees() - 28.75).abs() < 0.005);
    // A point 3 m from the axis of the difference.
    let way_mm = 3000.0 * angle([0.1, 0.1, 0.1]);
    assert!((way_mm - 0.016).abs() < 0.0005, "{way_mm}");
    assert_eq!(Convention::default(), Convention::ExtrinsicXyz);
}

/// [Alignment 2010], row by row.
#[test]
fn the_printed_matrix() {
    let (alpha, beta, gamma) = (0.3f64, -0.5f64, 1.1f64);
    let [(sa, ca), (sb, cb), (sg, cg)] = [alpha, beta, gamma].map(f64::sin_cos);
    let printed = Matrix3::new(
        cg * cb,
        -sg * ca + cg * sb * sa,
        sg * sa + cg * sb * ca,
        sg * cb,
        cg * ca + sg * sb * sa,
        -cg * sa + sg * sb * ca,
        -sb,
        cb * sa,
        cb * ca,
    );
    let vector = PoseVector::new(0.0, 0.0, 0.0, alpha, beta, gamma);
    let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
    let (x, y, z) = (
        about(Vector3::x_axis(), alpha),
        about(Vector3::y_axis(), beta),
        about(Vector3::z_axis(), gamma),
    );
    for (convention, wanted) in [
        (Convention::ExtrinsicXyz, z * y * x),
        (Convention::IntrinsicXyz, x * y * z),
    ] {
        let matrix = vector.to_rotation(convention);
        assert!((matrix.matrix() - wanted.matrix()).amax() < 1e-15);
    }
    let matrix = vector.to_rotation(Convention::ExtrinsicXyz);
    assert!((matrix.matrix() - printed).amax() < 1e-15);
}

#[test]
fn gimbal_lock_is_reported_and_the_free_angle_chosen() {
    for convention in [Convention::ExtrinsicXyz, Convention::IntrinsicXyz] {
        for beta in [90.0f64, -90.0].map(f64::to_radians) {
            let vector = PoseVector::new(0.0, 0.0, 0.0, 0.3, beta, 0.2);
            let pose = vector.to_isometry(convention);
            let found = PoseVector::from_isometry(&pose, convention);
            assert!(found.locked);
            assert!(found.cos_beta < 1e-15);
            assert_eq!(found.vector.alpha.to_bits(), 0.0f64.to_bits());
            let near = PoseVector::from_isometry_near(&pose, convention, &vector);
            assert!(near.locked);
            assert!((near.vector.angles() - vector.angles()).amax() < 1e-15);
        }
    }
    let free = PoseVector::new(0.0, 0.0, 0.0, 0.3, 1.5, 0.2).to_isometry(Convention::ExtrinsicXyz);
    assert!(!PoseVector::from_isometry(&free, Convention::ExtrinsicXyz).locked);
}
