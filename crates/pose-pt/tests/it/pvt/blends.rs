//! Poses that are passed without a stop: how far from them, how fast, and what is refused.

use crate::support::table::{Cut, Point, bound, plan, points_of};
use path_timing::Knot;
use pose_pt::nalgebra::Isometry3;
use pose_pt::{
    Blend, Convention, Interpolation, LocatorAxis, Platform, PosePath, PosePathError, PoseVector,
    angle_between,
};
use proptest::prelude::*;

use super::check_motion;
use crate::support::cubic::between;
use crate::support::platform::{ACCELERATION, SPEED, panel, panel_with, pose, skewed};

const BLEND: Blend = Blend {
    distance: 2.0,
    rotation_rad: 0.004,
};

/// Interpolations that have blends.
const KINDS: [Interpolation; 3] = [
    Interpolation::Straight,
    Interpolation::Vector(Convention::ExtrinsicXyz),
    Interpolation::Vector(Convention::IntrinsicXyz),
];

fn corners() -> [Isometry3<f64>; 4] {
    [
        pose([0.0; 3], [0.0; 3]),
        pose([120.0, 10.0, 0.0], [0.02, -0.01, 0.05]),
        pose([150.0, 140.0, 30.0], [0.03, 0.04, 0.0]),
        pose([40.0, 180.0, -20.0], [-0.02, 0.01, -0.06]),
    ]
}

/// The table through the corners with the same blend at both.
fn rounded<const N: usize>(
    platform: &Platform<N>,
    kind: Interpolation,
    blend: Blend,
    segmentation: Cut,
) -> (Vec<Point<N>>, f64, f64) {
    let (poses, blends) = (corners(), [blend; 2]);
    let path = PosePath::new(&poses, kind).unwrap();
    let path = path.with_blends(&blends).unwrap();
    let mut knots = vec![Knot::default(); 2000];
    let table = plan(platform, &path, segmentation, &mut knots).unwrap();
    (
        points_of(table.rows()),
        table.duration_s(),
        bound(platform, &table),
    )
}

/// How far a pose is from a path, as a fraction of a blend: the larger of both of its bounds, at
/// the best point of the path.
fn off(path: &PosePath<'_>, found: &Isometry3<f64>, blend: &Blend) -> f64 {
    const SAMPLES: u32 = 200;
    let at = |leg: usize, s: f64| {
        let wanted = path.leg(leg).unwrap().pose(s);
        let distance = (wanted.translation.vector - found.translation.vector).norm();
        let angle = angle_between(&wanted.rotation, &found.rotation);
        (distance / blend.distance).max(angle / blend.rotation_rad)
    };
    (0..path.legs())
        .map(|leg| {
            let samples = (0..=SAMPLES).map(|k| f64::from(k) / f64::from(SAMPLES));
            let best = samples
                .min_by(|a, b| at(leg, *a).total_cmp(&at(leg, *b)))
                .unwrap();
            let step = 1.0 / f64::from(SAMPLES);
            let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(1.0));
            for _ in 0..50 {
                let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                if at(leg, a) < at(leg, b) {
                    high = b;
                } else {
                    low = a;
                }
            }
            at(leg, low)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Positions of some metres, rounded off in a fit, against 4 mrad.
const ROUNDING: f64 = 1e-9;

#[test]
fn poses_are_passed_within_their_tolerance_and_limits_without_a_stop() {
    for platform in [panel(), skewed()] {
        for kind in KINDS {
            let segmentation = Cut::Into(60);
            let (points, duration_s, _) = rounded(&platform, kind, BLEND, segmentation);
            check_motion(&platform, &points, duration_s);
            let inner = &points[1..points.len() - 1];
            assert!(
                inner
                    .iter()
                    .all(|it| it.velocities.iter().any(|v| v.norm() > 0.0))
            );
            let poses = corners();
            let path = PosePath::new(&poses, kind).unwrap();
            let worst = points.iter().map(|point| {
                let found = platform.pose(&point.axes).unwrap().pose;
                off(&path, &found, &BLEND)
            });
            let worst = worst.fold(0.0, f64::max);
            // A point near the middle of a blend uses what is allowed: the pairing of the bound is
            // not the nearest one, of right angles it is off by √2.
            assert!((0.4..1.0 + ROUNDING).contains(&worst), "{kind:?}: {worst}");
            let (_, stops_s, _) = rounded(&platform, kind, Blend::STOP, segmentation);
            println!("{kind:?}: {duration_s:.3} s, with stops {stops_s:.3} s");
            // Each stop takes 0.4 s and more, of which corners leave some.
            assert!(duration_s < stops_s - 0.4, "{duration_s} {stops_s}");
        }
    }
}

#[test]
fn the_distance_error_is_kept_in_blends_too() {
    for allowed in [0.01, 1e-4] {
        let segmentation = Cut::Within(allowed);
        let (points, _, bound) = rounded(&skewed(), KINDS[0], BLEND, segmentation);
        assert!(bound <= allowed, "{bound}");
        for pair in points.windows(2) {
            for step in 0..=20 {
                let [axes, ..] = between(&pair[0], &pair[1], f64::from(step) / 20.0);
                let error = skewed().distance_error(&skewed().locator_positions(&axes));
                assert!(error.change.abs() <= bound + super::ROUNDING);
            }
        }
    }
}

/// Two legs in one line, and one leg of the same length.
#[test]
fn a_pose_on_a_line_costs_nothing() {
    let ends = [pose([0.0; 3], [0.0; 3]), pose([300.0, 0.0, 0.0], [0.0; 3])];
    let poses = [ends[0], pose([100.0, 0.0, 0.0], [0.0; 3]), ends[1]];
    let platform = panel();
    let mut knots = [Knot::default(); 1000];
    let mut seconds = |path: &PosePath<'_>| {
        let table = plan(&platform, path, Cut::Into(200), &mut knots);
        table.unwrap().duration_s()
    };
    let one = seconds(&PosePath::new(&ends, Interpolation::Straight).unwrap());
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let two = seconds(&path.with_blends(&[BLEND]).unwrap());
    assert!((two / one - 1.0).abs() < 1e-3, "{one} {two}");
    assert!(seconds(&path) > 1.01 * one);
}

/// Where only the position changes its direction, no rotation need be allowed, and the other way
/// round.
#[test]
fn a_part_that_does_not_change_needs_no_tolerance() {
    let poses = [
        pose([0.0; 3], [0.0; 3]),
        pose([100.0, 0.0, 0.0], [0.0; 3]),
        pose([100.0, 100.0, 0.0], [0.0; 3]),
    ];
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let platform = panel();
    let seconds = |distance, rotation_rad| {
        let blend = [Blend {
            distance,
            rotation_rad,
        }];
        let mut knots = [Knot::default(); 500];
        let path = path.with_blends(&blend).unwrap();
        let table = plan(&platform, &path, Cut::Into(100), &mut knots);
        table.unwrap().duration_s()
    };
    assert!(seconds(1.0, 0.0) < 0.99 * seconds(0.0, 1.0));
    assert!((seconds(0.0, 1.0) - seconds(0.0, 0.0)).abs() < 1e-9);
}

#[test]
fn blends_with_a_limit_of_jerk_are_passed() {
    let limits = LocatorAxis {
        min: -1500.0,
        max: 1500.0,
        speed: SPEED,
        acceleration: ACCELERATION,
        jerk: Some(200.0),
    };
    let platform = panel_with(limits);
    let allowed = 0.01;
    for segmentation in [Cut::Into(40), Cut::Within(allowed)] {
        let (points, seconds, error) = rounded(&platform, KINDS[0], BLEND, segmentation);
        let (_, stopped_s, _) = rounded(&platform, KINDS[0], Blend::STOP, segmentation);
        println!(
            "{seconds} s, with stops {stopped_s} s, {} points",
            points.len()
        );
        assert!(seconds < stopped_s, "{seconds} {stopped_s}");
        let stops = points.iter().filter(|point| {
            let velocities = point.velocities.iter().flatten();
            velocities.copied().all(|velocity| velocity == 0.0)
        });
        assert_eq!(stops.count(), 2);
        check_motion(&platform, &points, seconds);
        assert!(segmentation == Cut::Into(40) || error <= allowed);
    }
}

#[test]
fn wrong_blends_are_named() {
    let poses = corners();
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let error = path.with_blends(&[BLEND]).unwrap_err();
    assert_eq!(error, PosePathError::Blends { given: 1, poses: 2 });
    let bad = Blend {
        distance: -0.5,
        ..BLEND
    };
    let error = path.with_blends(&[BLEND, bad]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "tolerance -0.5 of the blend at pose 2 is not a number from 0"
    );
    let bad = Blend {
        rotation_rad: f64::NAN,
        ..BLEND
    };
    let error = path.with_blends(&[bad, BLEND]).unwrap_err();
    assert!(
        matches!(error, PosePathError::Blend { pose: 1, .. }),
        "{error}"
    );
    let screw = PosePath::new(&poses, Interpolation::Screw).unwrap();
    assert_eq!(
        screw.with_blends(&[BLEND; 2]),
        Err(PosePathError::ScrewBlend)
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Any legs, also still ones, and any tolerances: within them and within all limits.
    #[test]
    fn any_blends_keep_what_they_promise(
        positions in prop::collection::vec(prop::array::uniform3(-300.0..300.0), 3..6),
        turns in prop::collection::vec(prop::array::uniform3(-0.4..0.4), 6),
        blends in prop::collection::vec((0.0..5.0, 0.0..0.05), 4),
        kind in 0..3_usize, repeated in any::<bool>(),
    ) {
        let platform = skewed();
        let mut vectors: Vec<_> = positions
            .iter()
            .zip(&turns)
            .map(|([x, y, z], [a, b, c])| PoseVector::new(*x, *y, *z, *a, *b, *c))
            .collect();
        if repeated {
            vectors[1] = vectors[0];
        }
        let poses: Vec<_> = vectors
            .iter()
            .map(|vector| vector.to_isometry(Convention::ExtrinsicXyz))
            .collect();
        let path = PosePath::new(&poses, KINDS[kind]).unwrap();
        let blends: Vec<_> = blends[..poses.len() - 2]
            .iter()
            .map(|(distance, rotation_rad)| Blend { distance: *distance, rotation_rad: *rotation_rad })
            .collect();
        let blended = path.with_blends(&blends).unwrap();
        let mut knots = vec![Knot::default(); 1000];
        let table = plan(&platform, &blended, Cut::Into(40), &mut knots)
            .unwrap();
        let points = points_of(table.rows());
        check_motion(&platform, &points, table.duration_s());
        let widest = blends.iter().fold(Blend { distance: 1e-9, rotation_rad: 1e-9 }, |a, b| Blend {
            distance: a.distance.max(b.distance),
            rotation_rad: a.rotation_rad.max(b.rotation_rad),
        });
        for point in points.iter().step_by(7) {
            let found = platform.pose(&point.axes).unwrap().pose;
            let off = off(&path, &found, &widest);
            prop_assert!(off < 1.0 + 1e-6, "{off}");
        }
    }
}
