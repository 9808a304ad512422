//! Platforms: limits, distance error, fits, and what is refused.

mod fits;

use pose_pt::nalgebra::{Isometry3, Point3, Translation3, Vector3};
use pose_pt::{
    Axis, Convention, FitError, LimitError, Locator, LocatorAxis, Platform, PlatformError,
    PointSet, PoseVector,
};

/// Lengths of some metres in f64, after a fit: mm.
const ROUNDING_MM: f64 = 1e-11;

fn limits() -> [LocatorAxis; 3] {
    [LocatorAxis {
        min: -300.0,
        max: 300.0,
        speed: 20.0,
        acceleration: 100.0,
        jerk: None,
    }; 3]
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
            l.limits[0] = LocatorAxis {
                min: -10.0,
                max: far,
                speed: 20.0,
                acceleration: 100.0,
                jerk: None,
            };
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
                set: PointSet::To,
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
    let rating = |change: &dyn Fn(&mut LocatorAxis), wanted: &str| {
        let refused = with(0, |l| change(&mut l.limits[1])).unwrap_err();
        assert!(
            matches!(refused, E::Rating { locator: 0, axis: Axis::Y, name, .. } if name == wanted),
            "{refused}"
        );
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 5e-324, f64::MAX] {
        rating(&|l| l.speed = bad, "speed");
        rating(&|l| l.acceleration = bad, "acceleration");
        rating(&|l| l.jerk = Some(bad), "jerk");
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
fn memory_is_as_stated() {
    assert_eq!(size_of::<Platform<3>>(), 1168);
}
