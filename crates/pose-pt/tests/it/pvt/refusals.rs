//! PVT tables that are refused: the error names what is wrong.

use super::ROUNDING;
use crate::support::moves::from_rest;
use crate::support::platform::{ACCELERATION, SPEED, panel_with, pose};
use crate::support::table::{Cut, plan, points_of};
use path_timing::{Knot, PlanError};
use pose_pt::nalgebra::Point3;
use pose_pt::{
    Axis, BodyPathError, Interpolation, LimitError, Locator, LocatorAxis, Platform, PosePath,
};

/// A swing by ±0.3 rad carries the first two locators out to 1000 mm in its middle, where three
/// segments have no point: 989.5 mm are the next.
#[test]
fn a_stroke_left_between_points_is_named() {
    let poses = [-0.3, 0.3].map(|turn| pose([0.0; 3], [0.0, 0.0, turn]));
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let plan = |min: f64, max: f64| {
        let limits = LocatorAxis {
            min,
            max,
            speed: SPEED,
            acceleration: ACCELERATION,
            jerk: None,
        };
        let wide = LocatorAxis {
            min: -2000.0,
            max: 2000.0,
            speed: SPEED,
            acceleration: ACCELERATION,
            jerk: None,
        };
        let anchors = [[1000.0, 0.0, 0.0], [-1000.0, 0.0, 0.0], [0.0, 1000.0, 0.0]];
        let platform = Platform::new(
            anchors
                .map(|anchor| Locator::new(anchor.into(), Point3::origin(), [limits, wide, wide])),
        );
        let mut knots = [Knot::default(); 4];
        let table =
            plan(&platform.unwrap(), &path, Cut::Into(3), &mut knots).map(|table| table.len());
        table.map_err(|error| match error {
            PlanError::Path {
                reason:
                    BodyPathError::Leg {
                        leg: 0,
                        part,
                        reason:
                            LimitError::Stroke {
                                locator,
                                axis: Axis::X,
                                value,
                                min,
                                max,
                                by,
                            },
                    },
                ..
            } => {
                assert!(part > 0.2 && part < 0.8, "{part}");
                assert!((by - (min - value).max(value - max)).abs() < ROUNDING);
                // From rest to rest of three segments, at the extremes of their speeds.
                assert!((value.abs() - 1000.0).abs() < 3.0, "{value}");
                locator
            }
            other => panic!("{other}"),
        })
    };
    assert_eq!(plan(-2000.0, 997.0), Err(0));
    assert_eq!(plan(-997.0, 2000.0), Err(1));
    assert_eq!(plan(-1003.0, 1003.0), Ok(4));
}

#[test]
fn wrong_input_is_named() {
    let platform = panel_with(LocatorAxis {
        min: -100.0,
        max: 100.0,
        speed: SPEED,
        acceleration: ACCELERATION,
        jerk: None,
    });
    let poses = from_rest([30.0, 0.0, 0.0], [0.0; 3]);
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 64];
    let error = plan(&platform, &path, Cut::Into(64), &mut knots).unwrap_err();
    let wanted = PlanError::Memory {
        needed: 65,
        available: 64,
    };
    assert_eq!(error, wanted);
    let error = plan(&platform, &path, Cut::Into(2), &mut []).unwrap_err();
    assert!(matches!(
        error,
        PlanError::Memory {
            needed: 3,
            available: 0
        }
    ));

    let error = plan(&platform, &path, Cut::Into((1 << 24) + 1), &mut knots).unwrap_err();
    let max = 1 << 24;
    assert_eq!(error, PlanError::TooFine { leg: 0, max });

    let turning = from_rest([0.0; 3], [0.0, 0.0, 0.02]);
    let turning = PosePath::new(&turning, Interpolation::Straight).unwrap();
    let few = &mut knots[..9];
    let error = plan(&platform, &turning, Cut::Within(1e-6), few).unwrap_err();
    let PlanError::Memory {
        needed,
        available: 9,
    } = error
    else {
        panic!("{error}");
    };
    let mut enough = vec![Knot::default(); needed];
    plan(&platform, &turning, Cut::Within(1e-6), &mut enough).unwrap();
    // Below what positions round off no number of segments is enough.
    let error = plan(&platform, &turning, Cut::Within(1e-14), &mut enough).unwrap_err();
    assert!(
        matches!(
            error,
            PlanError::Memory { .. } | PlanError::Indistinct { .. } | PlanError::TooFine { .. }
        ),
        "{error}"
    );

    let far = from_rest([0.0, 0.0, 130.0], [0.0; 3]);
    let far = PosePath::new(&far, Interpolation::Straight).unwrap();
    let error = plan(&platform, &far, Cut::Into(20), &mut knots).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("from pose 0 to the next, at 0.740973 of the way: locator 0, axis Z"),
        "{error}"
    );
    let PlanError::Path {
        reason:
            BodyPathError::Leg {
                leg: 0,
                part,
                reason,
            },
        ..
    } = error
    else {
        panic!("{error}");
    };
    // At 100 of 130 mm, and at most a segment before.
    assert!(part > 0.65 && part < 100.0 / 130.0, "{part}");
    assert!(matches!(
        reason,
        LimitError::Stroke {
            locator: 0,
            max: 100.0,
            ..
        }
    ));

    let table = plan(&platform, &path, Cut::Into(8), &mut knots).unwrap();
    for scale in [0.0, -1.0, 1.1, f64::NAN, 1e-310] {
        assert!(matches!(
            table.at_speed(scale),
            Err(PlanError::SpeedScale { .. })
        ));
    }
    let slower = table.at_speed(0.5).unwrap();
    assert!(
        (points_of(slower.rows()).into_iter().last().unwrap().time_s - 2.0 * table.duration_s())
            .abs()
            < 1e-12
    );
}
