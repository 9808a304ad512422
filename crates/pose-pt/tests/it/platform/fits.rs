//! Fits of points and of locators' frames: what is found, and what is refused.

use pose_pt::nalgebra::{Matrix3, Point3, Vector3};
use pose_pt::{CalibrationError, FitError, Locator, PointSet, calibrate, rigid_fit};

use super::{ROUNDING_MM, limits, locators};

#[test]
fn points_that_determine_no_motion_are_refused() {
    let line = [0.0, 1.0, 3.0].map(|x| Point3::new(x * 1000.0, x * 200.0, 7.0));
    let plane = locators().map(|locator| locator.anchor);
    let fit = |a: &[Point3<f64>], b: &[Point3<f64>]| rigid_fit(a, b).unwrap_err();
    let set =
        |wanted| move |error| matches!(error, FitError::Collinear { set, .. } if set == wanted);
    assert!(set(PointSet::From)(fit(&line, &plane)));
    assert!(set(PointSet::To)(fit(&plane, &line)));
    for (error, words) in [
        (fit(&line, &plane), "the moved points are on a line: "),
        (fit(&plane, &line), "the met points are on a line: "),
    ] {
        assert!(error.to_string().starts_with(words), "{error}");
    }
    let same = [Point3::new(1.0, 2.0, 3.0); 3];
    assert!(matches!(
        fit(&same, &plane),
        FitError::Coincident {
            set: PointSet::From,
            ..
        }
    ));
    assert_eq!(fit(&plane, &plane[..2]), FitError::Count { from: 3, to: 2 });
    assert_eq!(fit(&plane[..2], &plane[..2]), FitError::TooFew { count: 2 });
    // A regular tetrahedron and its mirror image: many rotations fit equally well.
    let corners = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let mirrored = corners.map(|[x, y, z]| Point3::new(-x, y, z));
    assert!(matches!(
        fit(&corners.map(Point3::from), &mirrored),
        FitError::Ambiguous { .. }
    ));
    assert_eq!(rigid_fit(&plane, &plane).unwrap().rank, 2);
    let solid = corners.map(Point3::from);
    assert_eq!(rigid_fit(&solid, &solid).unwrap().rank, 3);
}

/// An oblique frame with errors of scale, as a laser tracker would find it.
fn oblique() -> Locator {
    let axes = Matrix3::new(1.0001, 0.002, 0.0, -0.001, 0.9998, 0.003, 0.0005, 0.0, 1.0);
    let origin = Point3::new(1200.0, -300.0, 800.0);
    Locator::new(Point3::origin(), origin, limits()).with_axes(axes)
}

#[test]
fn a_frame_is_found_from_measured_points() {
    let locator = oblique();
    let positions = [
        [0.0, 0.0, 0.0],
        [250.0, 0.0, 0.0],
        [0.0, 250.0, 0.0],
        [0.0, 0.0, 250.0],
        [-100.0, 200.0, 30.0],
    ]
    .map(Vector3::from);
    let points = positions.map(|axes| locator.position(&axes));
    let frame = calibrate(&positions, &points).unwrap();
    assert!((frame.axes - locator.axes).amax() < 1e-14);
    assert!((frame.origin - locator.origin).norm() < ROUNDING_MM);
    assert!(frame.max_residual < ROUNDING_MM);
    let placed =
        Locator::new(Point3::origin(), Point3::origin(), limits()).with_calibration(&frame);
    assert_eq!((placed.axes, placed.origin), (frame.axes, frame.origin));
    let x = Vector3::new(1.0001f64, -0.001, 0.0005).norm();
    assert!((frame.scales().x - x).abs() < 1e-14);
    // X and Y: 0.002 · 1.0001 - 0.001 · 0.9998 more than square to each other.
    let dot: f64 = 1.0001 * 0.002 - 0.001 * 0.9998;
    assert!((frame.squareness_errors().z + dot).abs() < 1e-6);

    // One point 0.1 mm off is seen.
    let mut wrong = points;
    wrong[4].y += 0.1;
    let frame = calibrate(&positions, &wrong).unwrap();
    assert!(frame.max_residual > 0.01 && frame.rms < frame.max_residual);
}

#[test]
fn axes_that_were_not_moved_are_missed() {
    let locator = oblique();
    let rank = |positions: [[f64; 3]; 5]| {
        let positions = positions.map(Vector3::from);
        let points = positions.map(|axes| locator.position(&axes));
        match calibrate(&positions, &points) {
            Err(CalibrationError::Rank {
                rank,
                width,
                needed,
            }) => {
                assert!(width <= needed);
                rank
            }
            other => panic!("{other:?}"),
        }
    };
    let [a, b, c] = [[100.0, 0.0, 5.0], [0.0, 70.0, 5.0], [30.0, 20.0, 5.0]];
    assert_eq!(rank([a, b, c, a, b]), 2);
    assert_eq!(rank([a, b, a, b, a]), 1);
    assert_eq!(rank([a; 5]), 0);
    let (few, points) = ([Vector3::<f64>::zeros(); 3], [Point3::origin(); 3]);
    assert_eq!(
        calibrate(&few, &points),
        Err(CalibrationError::TooFew { count: 3 })
    );
    assert!(matches!(
        calibrate(&few, &points[..2]),
        Err(CalibrationError::Count { .. })
    ));
    let bad = [Vector3::new(0.0, f64::NAN, 0.0); 4];
    assert!(matches!(
        calibrate(&bad, &[Point3::origin(); 4]),
        Err(CalibrationError::Coordinate { point: 0, .. })
    ));
}
