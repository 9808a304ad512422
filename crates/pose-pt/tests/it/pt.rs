//! PT tables: points, times, distance error, errors.

use pose_pt::nalgebra::{Isometry3, Vector3};
use pose_pt::{
    Axis, Convention, Interpolation, LimitError, LocatorAxis, Platform, PosePath, PosePathError,
    PoseVector, PtError, PtPoint, PtTable, Segmentation,
};
use proptest::prelude::*;
use twofloat::TwoFloat;

use crate::support::distance_error::{distance_error, measured};
use crate::support::moves::{ALL, from_rest, poses};
use crate::support::platform::{SPEED, panel, panel_with, pose, skewed};

/// Rounding of coordinates of some metres.
const ROUNDING: f64 = 1e-11;

/// Rigid distances, relative.
const RIGID: f64 = 1e-13;

/// Distances between locators, against those of the anchors.
fn rigid<const N: usize>(platform: &Platform<N>, axes: &[Vector3<f64>; N]) -> f64 {
    distance_error(platform, axes) / platform.largest_anchor_distance()
}

/// The axes on a segment that is run straight.
fn straight<const N: usize>(from: &PtPoint<N>, to: &PtPoint<N>, share: f64) -> [Vector3<f64>; N] {
    let mut axes = from.axes;
    for (axes, to) in axes.iter_mut().zip(&to.axes) {
        *axes += (to - *axes) * share;
    }
    axes
}

#[test]
fn all_kinds_meet_the_poses_and_keep_the_body_rigid() {
    let poses = [
        pose([0.0; 3], [0.0; 3]),
        pose([30.0, -12.0, 7.0], [0.02, -0.05, 0.15]),
        pose([10.0, 5.0, -9.0], [-0.1, 0.03, -0.2]),
    ];
    for platform in [panel(), skewed()] {
        for kind in ALL {
            let path = PosePath::new(&poses, kind).unwrap();
            let table = PtTable::plan(&platform, &path, Segmentation::segments(700)).unwrap();
            let points: Vec<_> = table.points().collect();
            assert_eq!(points.len(), 1401);
            assert_eq!(table.len(), 1401);
            for (number, pose) in [(0, poses[0]), (700, poses[1]), (1400, poses[2])] {
                let off = platform.axes(&pose);
                for (got, wanted) in points[number].axes.iter().zip(off) {
                    assert!((got - wanted).amax() < ROUNDING, "{kind:?} {number}");
                }
            }
            for (number, point) in points.iter().enumerate() {
                assert!(rigid(&platform, &point.axes) < RIGID, "{kind:?}");
                assert_eq!(table.axes(number).unwrap(), point.axes);
            }
            assert!(table.axes(1401).is_none());
        }
    }
}

/// The points are those of the leg's own poses, found without recurrence.
#[test]
fn points_follow_the_leg() {
    let poses = [
        pose([1.0, 2.0, 3.0], [0.1, 0.0, 0.3]),
        pose([130.0, -12.0, 7.0], [0.2, -0.15, 1.15]),
    ];
    let platform = panel_with(LocatorAxis {
        min: -9000.0,
        max: 9000.0,
        speed: 1.0,
        acceleration: 1.0,
        jerk: None,
    });
    for kind in ALL {
        let path = PosePath::new(&poses, kind).unwrap();
        let leg = path.leg(0).unwrap();
        let table = PtTable::plan(&platform, &path, Segmentation::segments(333)).unwrap();
        for (number, point) in (0..).zip(table.points()) {
            let wanted = platform.axes(&leg.pose(f64::from(number) / 333.0));
            for (got, wanted) in point.axes.iter().zip(wanted) {
                assert!((got - wanted).amax() < ROUNDING, "{kind:?} {number}");
            }
        }
    }
}

#[test]
fn the_slowest_axis_runs_at_its_rated_speed() {
    for platform in [panel(), skewed()] {
        let poses = from_rest([30.0, -12.0, 7.0], [0.0, 0.02, 0.03]);
        let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
        let table = PtTable::plan(&platform, &path, Segmentation::segments(100)).unwrap();
        let points: Vec<_> = table.points().collect();
        for pair in points.windows(2) {
            let [from, to] = pair else { unreachable!() };
            let mut fastest = 0.0_f64;
            for (number, locator) in platform.locators().iter().enumerate() {
                for (axis, limits) in locator.limits.iter().enumerate() {
                    let way = (to.axes[number][axis] - from.axes[number][axis]).abs();
                    fastest = fastest.max(way / to.segment_s / limits.speed);
                }
            }
            assert!((fastest - 1.0).abs() < 1e-14, "{fastest}");
            assert!((to.time_s - from.time_s - to.segment_s).abs() < 1e-12);
        }
        let last = points.last().unwrap().time_s;
        assert_eq!(table.duration_s().to_bits(), last.to_bits());
    }
}

#[test]
fn steps_are_smaller_than_the_accuracy() {
    let platform = panel();
    let poses = from_rest([10.0, 0.0, 0.0], [0.0; 3]);
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let table = PtTable::plan(&platform, &path, Segmentation::steps(0.01, 1e-4)).unwrap();
    assert_eq!(table.len(), 1002);
    assert!((table.duration_s() - 10.0 / SPEED).abs() < 1e-12);
    let poses = from_rest([0.1, 0.0, 0.0], [0.0, 0.0, 0.05]);
    let path = PosePath::new(&poses, Interpolation::Screw).unwrap();
    let table = PtTable::plan(&platform, &path, Segmentation::steps(0.01, 1e-4)).unwrap();
    assert_eq!(table.len(), 502);
}

/// 4.27 m, 0.01 mm: 0.248° between points.
#[test]
fn distance_error_of_the_panel() {
    let anchors_apart = 0.248_f64.to_radians();
    let platform = panel();
    let turn = 4.0 * anchors_apart;
    let poses = from_rest([0.0; 3], [0.0, 0.0, turn]);
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let table = PtTable::plan(&platform, &path, Segmentation::max_distance_error(0.01)).unwrap();
    let points: Vec<_> = table.points().collect();
    let (bound, measured) = (
        table.distance_error_bound(),
        measured(&platform, &points, straight),
    );
    assert!(bound <= 0.01 && measured <= bound * (1.0 + 1e-9));
    assert!(measured > bound * 0.999);
    assert_eq!(table.len(), 5);
}

#[test]
fn a_stroke_passed_between_the_ends_is_named() {
    // Half a turn of 100 mm about the first locator, seen as two poses: in between the
    // others swing far out.
    let limits = LocatorAxis {
        min: -600.0,
        max: 600.0,
        speed: 10.0,
        acceleration: 25.0,
        jerk: None,
    };
    let platform = panel_with(limits);
    let poses = [
        PoseVector::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        PoseVector::new(0.0, 0.0, 0.0, 0.0, 0.0, core::f64::consts::TAU),
    ];
    let path = PosePath::of_vectors(&poses, Convention::ExtrinsicXyz).unwrap();
    let error = PtTable::plan(&platform, &path, Segmentation::segments(360)).unwrap_err();
    let PtError::Limit {
        leg: 0,
        point,
        reason,
    } = error
    else {
        panic!("{error}");
    };
    let LimitError::Stroke {
        locator: 1,
        axis: Axis::Y,
        value,
        max,
        by,
        ..
    } = reason
    else {
        panic!("{reason}");
    };
    assert!((value - max - by).abs() < ROUNDING);
    // sin(point°) 4000 passes 600 mm after 8.63°.
    assert_eq!(point, 9);
}

#[test]
fn wrong_input_is_named() {
    let platform = panel();
    let good = from_rest([1.0, 0.0, 0.0], [0.0; 3]);
    let one = PosePath::new(&good[..1], Interpolation::Straight).unwrap_err();
    assert_eq!(one, PosePathError::TooFew { poses: 1 });
    let bad = [good[0], pose([f64::NAN, 0.0, 0.0], [0.0; 3])];
    let bad = PosePath::new(&bad, Interpolation::Screw).unwrap_err();
    assert_eq!(
        bad.to_string(),
        "coordinate NaN of pose 1 is not within ±1e50"
    );
    let far = [good[0], pose([0.0, -1e160, 0.0], [0.0; 3])];
    let far = PosePath::new(&far, Interpolation::Straight).unwrap_err();
    assert_eq!(
        far.to_string(),
        "coordinate -1e160 of pose 1 is not within ±1e50"
    );
    let half = [good[0], pose([0.0; 3], [0.0, core::f64::consts::PI, 0.0])];
    let half = PosePath::new(&half, Interpolation::Straight).unwrap_err();
    assert!(matches!(half, PosePathError::HalfTurn { pose: 0, .. }));

    let path = PosePath::new(&good, Interpolation::Straight).unwrap();
    for segmentation in [
        Segmentation::segments(0),
        Segmentation::max_distance_error(0.0),
        Segmentation::max_distance_error(f64::NAN),
        Segmentation::steps(-1.0, 1.0),
        Segmentation::steps(1.0, f64::INFINITY),
    ] {
        let error = PtTable::plan(&platform, &path, segmentation).unwrap_err();
        assert!(matches!(error, PtError::Segmentation { .. }), "{error}");
    }
    let error = PtTable::plan(&platform, &path, Segmentation::steps(1e-12, 1.0)).unwrap_err();
    assert!(matches!(error, PtError::TooFine { leg: 0, .. }), "{error}");
    let table = PtTable::plan(&platform, &path, Segmentation::segments(512)).unwrap();
    let error = PtError::TooManyPoints {
        needed: 513,
        available: 512,
    };
    assert_eq!(table.fits(512), Err(error));
    assert_eq!(table.fits(513), Ok(()));
}

#[test]
fn a_body_that_stays_is_one_point() {
    let still = [pose([1.0; 3], [0.1; 3]); 3];
    let platform = panel_with(LocatorAxis {
        min: -9000.0,
        max: 9000.0,
        speed: 1.0,
        acceleration: 1.0,
        jerk: None,
    });
    for kind in ALL {
        let path = PosePath::new(&still, kind).unwrap();
        let table =
            PtTable::plan(&platform, &path, Segmentation::max_distance_error(0.01)).unwrap();
        assert_eq!(table.points().count(), 1);
        let moved = [
            still[0],
            still[0],
            pose([2.0; 3], [0.1; 3]),
            pose([2.0; 3], [0.1; 3]),
        ];
        let path = PosePath::new(&moved, kind).unwrap();
        let table = PtTable::plan(&platform, &path, Segmentation::segments(3)).unwrap();
        assert_eq!(table.points().count(), 4);
        assert_eq!(table.len(), 4);
    }
}

/// Points that have the same numbers are no points.
#[test]
fn points_that_cannot_be_told_apart_are_refused() {
    let platform = panel();
    let poses = [
        pose([1000.0, 0.0, 0.0], [0.0; 3]),
        pose([1000.0 + 1e-11, 0.0, 0.0], [0.0; 3]),
    ];
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    assert_eq!(
        PtTable::plan(&platform, &path, Segmentation::segments(10))
            .unwrap()
            .len(),
        11
    );
    let error = PtTable::plan(&platform, &path, Segmentation::segments(1000)).unwrap_err();
    assert!(
        matches!(error, PtError::Indistinct { leg: 0, .. }),
        "{error}"
    );
    // A way that no axis sees is none: each is at 500 mm.
    let platform = Platform::new(panel().locators().map(|mut locator| {
        locator.origin -= Vector3::new(0.0, 500.0, 0.0);
        locator
    }))
    .unwrap();
    let poses = [0.0, 1e-14, 1.0].map(|y| pose([0.0, y, 0.0], [0.0; 3]));
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    assert_eq!(
        PtTable::plan(&platform, &path, Segmentation::segments(3))
            .unwrap()
            .len(),
        4
    );
}

/// A tenth of a million points, and times as exact as one of them.
#[test]
fn times_lose_nothing_to_rounding() {
    let platform = panel();
    let poses = [
        Isometry3::identity(),
        Isometry3::translation(100.0, 30.0, -20.0),
    ];
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let table = PtTable::plan(&platform, &path, Segmentation::segments(100_000)).unwrap();
    let exact = table
        .points()
        .fold(TwoFloat::from(0.0), |sum, point| sum + point.segment_s);
    let off = f64::from(exact - table.duration_s()).abs();
    assert!(off <= table.duration_s() * f64::EPSILON, "{off}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_distance_error_never_passes_the_allowed_one(
        poses in poses(), kind in 0..4_usize, allowed in 0.001..0.5,
    ) {
        for platform in [panel(), skewed()] {
            let path = PosePath::new(&poses, ALL[kind]).unwrap();
            let table = PtTable::plan(&platform, &path, Segmentation::max_distance_error(allowed))
                .unwrap();
            let points: Vec<_> = table.points().collect();
            let bound = table.distance_error_bound();
            let measured = measured(&platform, &points, straight);
            prop_assert!(bound <= allowed * (1.0 + 1e-12));
            prop_assert!(measured <= bound + ROUNDING, "{} {}", measured, bound);
            prop_assert!(bound <= 3.0 * measured + ROUNDING, "{} {}", measured, bound);
            // One segment fewer does not keep it.
            let segments = u32::try_from(table.len() - 2).unwrap();
            if segments > 0 && kind < 2 {
                let coarse = PtTable::plan(&platform, &path, Segmentation::segments(segments))
                    .unwrap();
                prop_assert!(coarse.distance_error_bound() > allowed);
            }
        }
    }
}
