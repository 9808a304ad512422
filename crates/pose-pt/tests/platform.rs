//! Platforms: limits, distance error, calibration, and what is refused.
#![cfg(test)]

use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, Vector3};
use pose_pt::{
    Axis, AxisLimits, CalibrationError, Convention, FitError, LimitError, Locator, Platform,
    PlatformError, PoseVector, Side, angle_between, calibrate, rigid_fit,
};

/// Lengths of some metres in f64, after a fit: mm.
const ROUNDING_MM: f64 = 1e-11;

fn limits() -> [AxisLimits; 3] {
    [AxisLimits::new(-300.0, 300.0, 20.0, 100.0); 3]
}

/// Three locators under a panel of 3 m by 2 m; each is at zero where the panel is at rest.
fn locators() -> [Locator; 3] {
    [
        [-1500.0, -1000.0, 0.0],
        [1500.0, -1000.0, 50.0],
        [0.0, 1000.0, -20.0],
    ]
    .map(|anchor| Locator::new(anchor.into(), anchor.into(), limits()))
}

fn panel() -> Platform<3> {
    Platform::new(locators()).unwrap()
}

/// The locators with one of them changed.
fn with(number: usize, change: impl Fn(&mut Locator)) -> Result<Platform<3>, PlatformError> {
    let mut locators = locators();
    change(&mut locators[number]);
    Platform::new(locators)
}

#[test]
fn a_lift_moves_all_third_axes() {
    let pose = PoseVector::new(1.0, 2.0, 3.0, 0.0, 0.0, 0.0).to_isometry(Convention::ExtrinsicXyz);
    for axes in panel().checked_axes(&pose).unwrap() {
        assert!((axes - Vector3::new(1.0, 2.0, 3.0)).norm() < ROUNDING_MM);
    }
    assert!((panel().largest_anchor_distance() - 3000.0f64.hypot(50.0)).abs() < ROUNDING_MM);
}

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

#[test]
fn a_stroke_left_is_named_with_its_margin() {
    let pose = Isometry3::from(Translation3::new(0.0, -310.0, 299.0));
    let refused = panel().checked_axes(&pose);
    let Err(LimitError::Stroke {
        locator,
        axis,
        value,
        min,
        max,
        by,
    }) = refused
    else {
        panic!("{refused:?}");
    };
    assert_eq!((locator, axis, min, max), (0, Axis::Y, -300.0, 300.0));
    assert!((value + 310.0).abs() < ROUNDING_MM);
    assert!((by - 10.0).abs() < ROUNDING_MM);
    assert_eq!(
        refused.unwrap_err().to_string(),
        "locator 0, axis Y: -310 is 10 beyond the stroke -300..=300"
    );

    // The worst of several: the panel tilts about X, its far edges leave their strokes.
    let tilted =
        PoseVector::new(0.0, 0.0, 100.0, 0.3, 0.0, 0.0).to_isometry(Convention::ExtrinsicXyz);
    let refused = panel().checked_axes(&tilted);
    assert!(
        matches!(
            refused,
            Err(LimitError::Stroke {
                locator: 2,
                axis: Axis::Z,
                ..
            })
        ),
        "{refused:?}"
    );
}

#[test]
fn a_pose_of_axes_at_their_ends_is_not_refused() {
    let platform = panel();
    for ends in [-300.0, 300.0] {
        let body = platform.pose(&[Vector3::repeat(ends); 3]).unwrap();
        let axes = platform.checked_axes(&body.pose).unwrap();
        for axes in axes {
            assert!((axes - Vector3::repeat(ends)).norm() < ROUNDING_MM);
        }
    }
    let beyond = Isometry3::from(Translation3::new(300.0 + 1e-9, 0.0, 0.0));
    assert!(platform.checked_axes(&beyond).is_err());
}

/// A far end does not make the near one soft.
#[test]
fn each_end_of_a_stroke_is_as_sharp_as_the_other() {
    for far in [1e15, 1e300, f64::MAX] {
        let platform = with(1, |l| {
            l.limits[0] = AxisLimits::new(-10.0, far, 20.0, 100.0);
        });
        let refused = platform
            .unwrap()
            .checked_axes(&Isometry3::from(Translation3::new(-10.0 - 1e-9, 0.0, 0.0)));
        assert!(
            matches!(refused, Err(LimitError::Stroke { locator: 1, .. })),
            "{far:e}: {refused:?}"
        );
    }
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    let platform = panel();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut axes = [Vector3::zeros(); 3];
        axes[1].z = bad;
        assert!(matches!(
            platform.check_axes(&axes),
            Err(LimitError::NotFinite {
                locator: 1,
                axis: Axis::Z,
                ..
            })
        ));
        assert!(matches!(
            platform.pose(&axes),
            Err(FitError::Coordinate {
                side: Side::To,
                point: 1,
                ..
            })
        ));
        let pose = Isometry3::from(Translation3::new(bad, 0.0, 0.0));
        assert!(matches!(
            platform.checked_axes(&pose),
            Err(LimitError::NotFinite { locator: 0, .. })
        ));
    }
}

#[test]
fn what_makes_no_platform_is_named() {
    use PlatformError as E;
    let refused = with(1, |l| l.limits[2].speed = 0.0).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "locator 1, axis Z: speed is 0, not within 1e-50..=1e50"
    );
    let rating = |change: &dyn Fn(&mut AxisLimits), wanted: &str| {
        let refused = with(0, |l| change(&mut l.limits[1])).unwrap_err();
        assert!(
            matches!(refused, E::Rating { locator: 0, axis: Axis::Y, name, .. } if name == wanted),
            "{refused}"
        );
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 5e-324, f64::MAX] {
        rating(&|l| l.speed = bad, "speed");
        rating(&|l| l.acceleration = bad, "acceleration");
        rating(&|l| *l = l.with_jerk(bad), "jerk");
    }
    for (min, max) in [
        (1.0, 1.0),
        (1.0, 0.0),
        (f64::NAN, 1.0),
        (0.0, f64::INFINITY),
    ] {
        let refused = with(2, |l| (l.limits[0].min, l.limits[0].max) = (min, max));
        assert!(matches!(
            refused,
            Err(E::Stroke {
                locator: 2,
                axis: Axis::X,
                ..
            })
        ));
    }
    for bad in [f64::NAN, f64::INFINITY, 1e200] {
        for (change, wanted) in [
            (
                &(|l: &mut Locator| l.anchor.y = bad) as &dyn Fn(&mut Locator),
                "anchor",
            ),
            (&|l| l.origin.z = bad, "origin"),
            (&|l| l.axes.m21 = bad, "axis direction"),
        ] {
            let refused = with(1, change).unwrap_err();
            assert!(
                matches!(refused, E::Coordinate { locator: 1, name, .. } if name == wanted),
                "{refused}"
            );
        }
    }
    let refused = with(1, |l| l.axes.m22 = 3.0);
    assert!(matches!(
        refused,
        Err(E::AxisLength {
            locator: 1,
            axis: Axis::Y,
            ..
        })
    ));
    let refused = with(2, |l| l.axes.set_column(2, &Vector3::new(0.6, 0.8, 0.05)));
    assert!(matches!(refused, Err(E::DependentAxes { locator: 2, .. })));
}

#[test]
fn anchors_must_span_a_plane() {
    let refused = with(2, |l| l.anchor = Point3::new(1500.0, -1000.0, 50.0));
    assert!(matches!(
        refused,
        Err(PlatformError::Coincident {
            first: 1,
            second: 2,
            ..
        })
    ));
    let refused = with(2, |l| l.anchor = Point3::new(0.0, -1000.0, 25.0));
    assert!(matches!(refused, Err(PlatformError::Collinear { .. })));
    // A micrometre beside the line is a pose, though a soft one.
    assert!(with(2, |l| l.anchor = Point3::new(0.0, -999.999, 25.0)).is_ok());
}

#[test]
fn three_to_ten_locators() {
    fn ring<const N: usize>() -> Result<Platform<N>, PlatformError> {
        let mut angle = 0.0f64;
        Platform::new([(); N].map(|()| {
            angle += 0.6;
            let anchor = Point3::new(1000.0 * angle.cos(), 1000.0 * angle.sin(), 0.0);
            Locator::new(anchor, Point3::origin(), limits())
        }))
    }
    let count = |locators| PlatformError::Count { locators, max: 10 };
    assert_eq!(ring::<0>(), Err(count(0)));
    assert_eq!(ring::<2>(), Err(count(2)));
    assert!(ring::<3>().is_ok());
    assert!(ring::<10>().is_ok());
    assert_eq!(ring::<11>(), Err(count(11)));
}

#[test]
fn distance_error_names_the_two_locators_and_its_sign() {
    let platform = panel();
    let mut axes = [Vector3::zeros(); 3];
    axes[1].x = 0.3;
    let body = platform.pose(&axes).unwrap();
    assert_eq!(body.distance_error.locators, [0, 1]);
    // Pulled along a side that rises by 50 in 3000.
    let change = 0.3 * 3000.0 / 3000.0f64.hypot(50.0);
    assert!((body.distance_error.change - change).abs() < 1e-7);
    assert!((body.distance_error.distance - 3000.0f64.hypot(50.0)).abs() < ROUNDING_MM);
    // Half of it is on either side of the body, one outwards each.
    assert!(body.residuals[1].x > 0.1 && body.residuals[0].x < -0.1);
    let total: Vector3<f64> = body.residuals.iter().sum();
    assert!(total.norm() < ROUNDING_MM);
    axes[1].x = -0.3;
    assert!(platform.pose(&axes).unwrap().distance_error.change < -0.29);
}

#[test]
fn points_that_determine_no_motion_are_refused() {
    let line = [0.0, 1.0, 3.0].map(|x| Point3::new(x * 1000.0, x * 200.0, 7.0));
    let plane = locators().map(|locator| locator.anchor);
    let fit = |a: &[Point3<f64>], b: &[Point3<f64>]| rigid_fit(a, b).unwrap_err();
    let side =
        |wanted| move |error| matches!(error, FitError::Collinear { side, .. } if side == wanted);
    assert!(side(Side::From)(fit(&line, &plane)));
    assert!(side(Side::To)(fit(&plane, &line)));
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
            side: Side::From,
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

#[test]
fn memory_is_as_stated() {
    assert_eq!(size_of::<Platform<3>>(), 1168);
}
