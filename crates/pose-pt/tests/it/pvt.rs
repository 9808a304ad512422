//! PVT tables: what the controller will run, checked from outside.

mod blends;
mod refusals;
mod times;

use crate::support::table::{Cut, Point, plan, points_of};
use path_timing::{Knot, PlanError};
use pose_pt::{LocatorAxis, Platform, PosePath};
use proptest::prelude::*;

use crate::support::limits::{LIMIT, check_limits};
use crate::support::moves::{ALL, from_rest, poses};
use crate::support::platform::{ACCELERATION, panel_with, pose, skewed};

/// Positions of some metres rounded off.
const ROUNDING: f64 = 1e-11;

/// Limits that are kept, rest at both ends, times that add up, and velocities that belong to a
/// rigid motion; how far the limits are used.
fn check_motion<const N: usize>(
    platform: &Platform<N>,
    points: &[Point<N>],
    duration_s: f64,
) -> [f64; 3] {
    let used = check_limits(platform, points);
    for end in [points.first().unwrap(), points.last().unwrap()] {
        assert!(end.velocities.iter().all(|v| v.amax() == 0.0));
    }
    assert!((points.last().unwrap().time_s - duration_s).abs() < 1e-9);
    for pair in points.windows(2) {
        let step = pair[1].time_s - pair[0].time_s;
        assert!(step > 0.0 && (step - pair[1].segment_s).abs() < 1e-9 * (1.0 + step));
    }
    for point in points {
        let positions = platform.locator_positions(&point.axes);
        let mut speeds = point.velocities;
        for (locator, speed) in platform.locators().iter().zip(&mut speeds) {
            *speed = locator.axes * *speed;
        }
        for i in 0..N {
            for j in 0..i {
                let (apart, speed) = (positions[i] - positions[j], speeds[i] - speeds[j]);
                assert!(apart.dot(&speed).abs() < 1e-9 * apart.norm());
            }
        }
    }
    used
}

#[test]
fn poses_on_the_way_are_stops() {
    let platform = skewed();
    let poses = [
        pose([0.0; 3], [0.0; 3]),
        pose([5.0, 0.0, 0.0], [0.0, 0.0, 0.01]),
        pose([5.0, 0.0, 0.0], [0.0, 0.0, 0.01]),
        pose([5.0, -5.0, 0.0], [0.0, 0.0, 0.02]),
    ];
    for kind in ALL {
        let path = PosePath::new(&poses, kind).unwrap();
        let mut knots = [Knot::default(); 202];
        let table = plan(&platform, &path, Cut::Into(100), &mut knots).unwrap();
        let points = points_of(table.rows());
        assert_eq!((points.len(), table.len()), (201, 201));
        assert!(points[100].velocities.iter().all(|v| v.amax() == 0.0));
        for (number, pose) in [(0, poses[0]), (100, poses[1]), (200, poses[3])] {
            let wanted = platform.axes(&pose);
            for (got, wanted) in points[number].axes.iter().zip(wanted) {
                assert!((got - wanted).amax() < ROUNDING);
            }
        }
        check_motion(&platform, &points, table.duration_s());
    }
}

/// Moves at the edge of what can be told apart, and limits far apart.
#[test]
fn tiny_moves_and_odd_limits_give_finite_tables() {
    let odd = [
        LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: 1e-3,
            acceleration: 1e6,
            jerk: None,
        },
        LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: 1e6,
            acceleration: 1e-3,
            jerk: None,
        },
        LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: 10.0,
            acceleration: 25.0,
            jerk: Some(1e9),
        },
        LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: 10.0,
            acceleration: 25.0,
            jerk: Some(1e-2),
        },
        LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: 1e30,
            acceleration: 1e-30,
            jerk: Some(1e30),
        },
        LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: 1e-30,
            acceleration: 1e30,
            jerk: Some(1e30),
        },
        LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: 1e30,
            acceleration: 1e30,
            jerk: Some(1e-30),
        },
    ];
    for limits in odd {
        let platform = panel_with(limits);
        for (way, turn) in [
            (1e-6, 0.0),
            (0.0, 1e-9),
            (1e-13, 1e-15),
            (100.0, 1e-12),
            (1e-9, 0.3),
        ] {
            let poses = from_rest([way, 0.0, -way], [0.0, turn, turn]);
            for kind in ALL {
                let path = PosePath::new(&poses, kind).unwrap();
                let mut knots = [Knot::default(); 33];
                let table = plan(&platform, &path, Cut::Into(32), &mut knots);
                // What rounding is most of may be too coarse to be known.
                if let Err(PlanError::TooCoarse { .. }) = table {
                    continue;
                }
                let table = table.unwrap();
                let mut last = 0.0;
                for point in points_of(table.rows()).into_iter().skip(1) {
                    assert!(
                        point.time_s > last && point.time_s.is_finite(),
                        "{kind:?} {way} {turn}"
                    );
                    assert!(
                        point
                            .velocities
                            .iter()
                            .all(|v| v.amax() <= limits.speed * LIMIT)
                    );
                    last = point.time_s;
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(160))]

    #[test]
    fn limits_are_never_passed(
        poses in poses(), kind in 0..4_usize, segments in 7..120_u32,
        jerk in prop::option::of(20.0..2000.0),
        speed in 1.0..1000.0, skew in any::<bool>(),
    ) {
        let mut limits = LocatorAxis { min: -1500.0, max: 1500.0, speed, acceleration: ACCELERATION, jerk: None };
        limits.jerk = jerk;
        let platform = if skew { skewed() } else { panel_with(limits) };
        let path = PosePath::new(&poses, ALL[kind]).unwrap();
        let mut knots = [Knot::default(); 121];
        let table = plan(&platform, &path, Cut::Into(segments), &mut knots)
            .unwrap();
        let points = points_of(table.rows());
        prop_assert_eq!(points.len(), table.len());
        let used = check_motion(&platform, &points, table.duration_s());
        // Something is at its limit.
        prop_assert!(used.iter().any(|share| *share > 0.99), "{:?}", used);
    }
}
