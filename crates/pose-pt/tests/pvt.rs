//! PVT tables: what the controller will run, checked from outside.
#![cfg(test)]

#[path = "support/cubic.rs"]
mod cubic;
#[path = "support/moves.rs"]
mod moves;
#[path = "support/optimum.rs"]
mod optimum;
#[path = "support/platform.rs"]
mod support;

use cubic::between;
use moves::{ALL, from_rest, poses};
use pose_pt::nalgebra::{Point3, Vector3};
use pose_pt::{
    Axis, AxisLimits, Interpolation, Knot, LimitError, Locator, Path, PlanError, Platform,
    PvtPoint, PvtTable, Segmentation,
};
use proptest::prelude::*;
use support::{ACCELERATION, SPEED, panel, panel_with, pose, skewed};

/// Times and positions of some metres rounded off, in limits that a reader recomputes.
const LIMIT: f64 = 1.0 + 1e-9;

/// Positions of some metres rounded off.
const ROUNDING: f64 = 1e-11;

/// The largest shares of the limits of speed, acceleration and jerk.
fn shares<const N: usize>(platform: &Platform<N>, points: &[PvtPoint<N>]) -> [f64; 3] {
    let mut shares = [0.0_f64; 3];
    let mut before = [Vector3::<f64>::zeros(); N];
    let mut before_s = 0.0;
    for pair in points.windows(2) {
        let [from, to] = pair else { unreachable!() };
        let [_, _, starts, jerks] = between(from, to, 0.0);
        let mean_s = (before_s + to.segment_s) / 2.0;
        for (number, locator) in platform.locators().iter().enumerate() {
            for (axis, limits) in locator.limits.iter().enumerate() {
                for place in 0..=16 {
                    let [_, speeds, accelerations, _] = between(from, to, f64::from(place) / 16.0);
                    shares[0] = shares[0].max(speeds[number][axis].abs() / limits.speed);
                    let acceleration = accelerations[number][axis].abs();
                    shares[1] = shares[1].max(acceleration / limits.acceleration);
                }
                if let Some(limit) = limits.jerk {
                    let step = (starts[number][axis] - before[number][axis]).abs() / mean_s;
                    shares[2] = shares[2].max(step / limit);
                    shares[2] = shares[2].max(jerks[number][axis].abs() / limit);
                }
            }
        }
        before = between(from, to, 1.0)[2];
        before_s = to.segment_s;
    }
    // And at the end, where all stands still.
    for (locator, before) in platform.locators().iter().zip(&before) {
        for (limits, before) in locator.limits.iter().zip(before.iter()) {
            if let Some(limit) = limits.jerk {
                shares[2] = shares[2].max(before.abs() / (before_s / 2.0) / limit);
            }
        }
    }
    shares
}

/// Rest at both ends, times that add up, and velocities that belong to a rigid motion.
fn check_motion<const N: usize>(platform: &Platform<N>, points: &[PvtPoint<N>], duration_s: f64) {
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
}

#[test]
fn a_straight_move_takes_the_closed_form() {
    let platform = panel();
    // A ramp takes 0.4 s and 2 mm.
    for (way, seconds) in [
        (100.0, 10.0 + 0.4),
        (4.0, 0.8),
        (3.0, 2.0 * (3.0 / ACCELERATION).sqrt()),
    ] {
        let poses = from_rest([0.0, -way, 0.0], [0.0; 3]);
        for kind in ALL {
            let path = Path::new(&poses, kind).unwrap();
            let mut knots = [Knot::default(); 257];
            let table =
                PvtTable::plan(&platform, &path, Segmentation::segments(256), &mut knots).unwrap();
            let share = table.duration_s() / seconds;
            println!("{way} mm: {share}");
            assert!((0.999_999..1.001).contains(&share), "{way}: {share}");
        }
    }
}

#[test]
fn a_straight_move_with_jerk_takes_the_closed_form() {
    let jerk = 100.0;
    let platform =
        panel_with(AxisLimits::new(-1500.0, 1500.0, SPEED, ACCELERATION).with_jerk(jerk));
    let rise = ACCELERATION / jerk;
    // Whole S-curve; acceleration reached but not the speed; only jerk counts.
    let short: f64 = 0.5;
    for (way, seconds) in [
        (100.0, 100.0 / SPEED + SPEED / ACCELERATION + rise),
        (
            8.0 * (8.0 / ACCELERATION + rise),
            2.0 * (8.0 / ACCELERATION + rise),
        ),
        (short, 4.0 * (short / (2.0 * jerk)).cbrt()),
    ] {
        let poses = from_rest([0.0, way, 0.0], [0.0; 3]);
        let path = Path::new(&poses, Interpolation::Straight).unwrap();
        let mut knots = [Knot::default(); 65];
        let table =
            PvtTable::plan(&platform, &path, Segmentation::segments(64), &mut knots).unwrap();
        let share = table.duration_s() / seconds;
        println!("{way} mm: {share}");
        assert!((0.999_999..1.001).contains(&share), "{way}: {share}");
        let points: Vec<_> = table.points().collect();
        assert_eq!(points.len(), 65);
        let shares = shares(&platform, &points);
        assert!(shares.iter().all(|share| *share < LIMIT), "{shares:?}");
        check_motion(&platform, &points, table.duration_s());
    }
}

/// Where the body turns far, its hardest place does not slow down the whole way. What the axes
/// need without a limit of jerk is the least that they can need with one.
#[test]
fn jerk_costs_a_turn_little() {
    let limits = AxisLimits::new(-9000.0, 9000.0, 20.0, 50.0);
    for (turn, way, jerk, most) in [
        (0.5, 500.0, 25.0, 1.02),
        (0.5, 500.0, 100.0, 1.01),
        (1.0, 0.0, 100.0, 1.01),
        (1.5, 500.0, 1000.0, 1.005),
        (2.6, 500.0, 1000.0, 1.005),
    ] {
        let poses = from_rest([way, 0.0, 0.0], [0.0, 0.0, turn]);
        let path = Path::new(&poses, Interpolation::Straight).unwrap();
        let mut knots = [Knot::default(); 513];
        let mut plan = |platform: &Platform<3>| {
            let table =
                PvtTable::plan(platform, &path, Segmentation::segments(512), &mut knots).unwrap();
            let points: Vec<_> = table.points().collect();
            let shares = shares(platform, &points);
            assert!(shares.iter().all(|share| *share < LIMIT), "{shares:?}");
            check_motion(platform, &points, table.duration_s());
            table.duration_s()
        };
        let least = plan(&panel_with(limits));
        let share = plan(&panel_with(limits.with_jerk(jerk))) / least;
        println!("turn by {turn}, {way} mm, jerk {jerk}: {share}");
        assert!(
            (1.0..most).contains(&share),
            "{turn}, {way}, {jerk}: {share}"
        );
    }
}

/// Moves whose optimum a fine phase plane gives.
#[test]
fn no_slower_than_the_optimum_by_a_thousandth() {
    let slow = AxisLimits::new(-9000.0, 9000.0, 10.0, 25.0);
    // No speed is reached: the accelerations of a turning body decide.
    let fast = AxisLimits::new(-9000.0, 9000.0, 1e5, 25.0);
    for (name, limits, poses) in [
        ("small turn", slow, from_rest([0.0; 3], [0.0, 0.0, 0.02])),
        ("large turn", slow, from_rest([0.0; 3], [0.0, 0.0, 1.5])),
        ("free turn", fast, from_rest([0.0; 3], [0.0, 0.0, 1.5])),
        (
            "adjustment",
            slow,
            from_rest([30.0, -12.0, 7.0], [0.01, -0.02, 0.03]),
        ),
        (
            "turn and slide",
            fast,
            from_rest([900.0, -500.0, 70.0], [0.1, -0.2, 1.3]),
        ),
    ] {
        let platform = panel_with(limits);
        for kind in ALL {
            let path = Path::new(&poses, kind).unwrap();
            let leg = path.leg(0).unwrap();
            let mut knots = vec![Knot::default(); 4001];
            let optimum = optimum::seconds(&platform, &leg, 40_000);
            let table =
                PvtTable::plan(&platform, &path, Segmentation::segments(4000), &mut knots).unwrap();
            let share = table.duration_s() / optimum;
            println!("{name}, {kind:?}: {} s, {share}", table.duration_s());
            assert!((0.999..1.001).contains(&share), "{name}: {share}");
        }
    }
}

/// At the points where an axis turns back at its full acceleration, two of three speeds that limits
/// allow are far below the highest one.
#[test]
fn near_the_optimum_of_a_turn_of_126_degrees() {
    let platform = panel_with(AxisLimits::new(-9000.0, 9000.0, 1e5, ACCELERATION));
    let poses = from_rest([0.3, -0.9, 0.0], [0.3, -0.9, 2.2]);
    for kind in ALL {
        let path = Path::new(&poses, kind).unwrap();
        let optimum = optimum::seconds(&platform, &path.leg(0).unwrap(), 40_000);
        for (segments, most) in [(1000, 1.0005), (16_000, 1.000_05)] {
            let mut knots = vec![Knot::default(); 16_001];
            let table = PvtTable::plan(
                &platform,
                &path,
                Segmentation::segments(segments),
                &mut knots,
            )
            .unwrap();
            let share = table.duration_s() / optimum;
            println!("{kind:?}, {segments} segments: {share}");
            assert!((0.999..most).contains(&share), "{share}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Axes that turn back on the way, at any speed.
    #[test]
    fn near_the_optimum_of_any_turn(
        translation in prop::array::uniform3(-500.0..500.0),
        turn in prop::array::uniform3(-1.2..1.2),
        kind in 0..4_usize, speed in 20.0..1e5,
    ) {
        let platform = panel_with(AxisLimits::new(-9000.0, 9000.0, speed, ACCELERATION));
        let poses = from_rest(translation, turn);
        let path = Path::new(&poses, ALL[kind]).unwrap();
        let optimum = optimum::seconds(&platform, &path.leg(0).unwrap(), 8000);
        let mut knots = [Knot::default(); 1001];
        let table = PvtTable::plan(&platform, &path, Segmentation::segments(1000), &mut knots)
            .unwrap();
        let share = table.duration_s() / optimum;
        prop_assert!((0.999..1.001).contains(&share), "{share}");
    }
}

#[test]
fn a_pure_turn_takes_the_closed_form() {
    // A turn about the first locator: the axis Y of the second moves like a pendulum, and for
    // a small angle as on a line: by 4000 mm times the angle.
    let platform = panel();
    let angle = 0.002_f64;
    let poses = from_rest([0.0; 3], [0.0, 0.0, angle]);
    let path = Path::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 201];
    let table = PvtTable::plan(&platform, &path, Segmentation::segments(200), &mut knots).unwrap();
    let seconds = 4000.0 * angle / SPEED + SPEED / ACCELERATION;
    let share = table.duration_s() / seconds;
    assert!((0.999..1.001).contains(&share), "{share}");
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
        let path = Path::new(&poses, kind).unwrap();
        let mut knots = [Knot::default(); 202];
        let table =
            PvtTable::plan(&platform, &path, Segmentation::segments(100), &mut knots).unwrap();
        let points: Vec<_> = table.points().collect();
        assert_eq!((points.len(), table.len()), (201, 201));
        assert!(points[100].velocities.iter().all(|v| v.amax() == 0.0));
        for (number, pose) in [(0, poses[0]), (100, poses[1]), (200, poses[3])] {
            let wanted = platform.axes(&pose);
            for (got, wanted) in points[number].axes.iter().zip(wanted) {
                assert!((got - wanted).amax() < ROUNDING);
            }
        }
        let shares = shares(&platform, &points);
        assert!(shares.iter().all(|share| *share < LIMIT), "{shares:?}");
        check_motion(&platform, &points, table.duration_s());
    }
}

/// A swing by ±0.3 rad carries the first two locators out to 1000 mm in its middle, where three
/// segments have no point: 989.5 mm are the next.
#[test]
fn a_stroke_left_between_points_is_named() {
    let poses = [-0.3, 0.3].map(|turn| pose([0.0; 3], [0.0, 0.0, turn]));
    let path = Path::new(&poses, Interpolation::Straight).unwrap();
    let plan = |min: f64, max: f64| {
        let limits = AxisLimits::new(min, max, SPEED, ACCELERATION);
        let wide = AxisLimits::new(-2000.0, 2000.0, SPEED, ACCELERATION);
        let anchors = [[1000.0, 0.0, 0.0], [-1000.0, 0.0, 0.0], [0.0, 1000.0, 0.0]];
        let platform = Platform::new(
            anchors
                .map(|anchor| Locator::new(anchor.into(), Point3::origin(), [limits, wide, wide])),
        );
        let mut knots = [Knot::default(); 4];
        let table = PvtTable::plan(
            &platform.unwrap(),
            &path,
            Segmentation::segments(3),
            &mut knots,
        )
        .map(|table| table.len());
        table.map_err(|error| match error {
            PlanError::Limit {
                leg: 0,
                point: 2,
                reason:
                    LimitError::Stroke {
                        locator,
                        axis: Axis::X,
                        value,
                        min,
                        max,
                        by,
                    },
            } => {
                assert!((by - (min - value).max(value - max)).abs() < ROUNDING);
                assert!((value.abs() - 1000.0).abs() < 0.1, "{value}");
                locator
            }
            other => panic!("{other}"),
        })
    };
    assert_eq!(plan(-2000.0, 997.0), Err(0));
    assert_eq!(plan(-997.0, 2000.0), Err(1));
    assert_eq!(plan(-1000.1, 1000.1), Ok(4));
}

#[test]
fn wrong_input_is_named() {
    let platform = panel_with(AxisLimits::new(-100.0, 100.0, SPEED, ACCELERATION));
    let poses = from_rest([30.0, 0.0, 0.0], [0.0; 3]);
    let path = Path::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 64];
    let error =
        PvtTable::plan(&platform, &path, Segmentation::segments(64), &mut knots).unwrap_err();
    let wanted = PlanError::TooManyPoints {
        needed: 65,
        available: 64,
    };
    assert_eq!(error, wanted);
    let error = PvtTable::plan(&platform, &path, Segmentation::segments(2), &mut []).unwrap_err();
    assert!(matches!(
        error,
        PlanError::TooManyPoints {
            needed: 3,
            available: 0
        }
    ));

    let error = PvtTable::plan(
        &platform,
        &path,
        Segmentation::segments((1 << 24) + 1),
        &mut [],
    )
    .unwrap_err();
    let max = 1 << 24;
    assert_eq!(error, PlanError::TooFine { leg: 0, max });

    let turning = from_rest([0.0; 3], [0.0, 0.0, 0.02]);
    let turning = Path::new(&turning, Interpolation::Straight).unwrap();
    let few = &mut knots[..9];
    let error = PvtTable::plan(
        &platform,
        &turning,
        Segmentation::max_distance_error(1e-6),
        few,
    )
    .unwrap_err();
    let PlanError::TooManyPoints {
        needed,
        available: 9,
    } = error
    else {
        panic!("{error}");
    };
    let mut enough = vec![Knot::default(); needed];
    PvtTable::plan(
        &platform,
        &turning,
        Segmentation::max_distance_error(1e-6),
        &mut enough,
    )
    .unwrap();
    let error = PvtTable::plan(
        &platform,
        &turning,
        Segmentation::max_distance_error(1e-14),
        &mut enough,
    )
    .unwrap_err();
    assert!(
        matches!(error, PlanError::DistanceError { allowed: 1e-14, .. }),
        "{error}"
    );

    let far = from_rest([0.0, 0.0, 130.0], [0.0; 3]);
    let far = Path::new(&far, Interpolation::Straight).unwrap();
    let error =
        PvtTable::plan(&platform, &far, Segmentation::segments(20), &mut knots).unwrap_err();
    let PlanError::Limit {
        leg: 0,
        point,
        reason,
    } = error
    else {
        panic!("{error}");
    };
    assert!((13..17).contains(&point));
    assert!(matches!(
        reason,
        LimitError::Stroke {
            locator: 0,
            max: 100.0,
            ..
        }
    ));

    let table = PvtTable::plan(&platform, &path, Segmentation::segments(8), &mut knots).unwrap();
    for scale in [0.0, -1.0, 1.1, f64::NAN, 1e-310] {
        assert!(matches!(
            table.at_speed_scale(scale),
            Err(PlanError::SpeedScale { .. })
        ));
    }
    let slower = table.at_speed_scale(0.5).unwrap();
    assert!((slower.points().last().unwrap().time_s - 2.0 * table.duration_s()).abs() < 1e-12);
}

/// Moves at the edge of what can be told apart, and limits far apart.
#[test]
fn tiny_moves_and_odd_limits_give_finite_tables() {
    let odd = [
        AxisLimits::new(-1500.0, 1500.0, 1e-3, 1e6),
        AxisLimits::new(-1500.0, 1500.0, 1e6, 1e-3),
        AxisLimits::new(-1500.0, 1500.0, 10.0, 25.0).with_jerk(1e9),
        AxisLimits::new(-1500.0, 1500.0, 10.0, 25.0).with_jerk(1e-2),
        AxisLimits::new(-1500.0, 1500.0, 1e30, 1e-30).with_jerk(1e30),
        AxisLimits::new(-1500.0, 1500.0, 1e-30, 1e30).with_jerk(1e30),
        AxisLimits::new(-1500.0, 1500.0, 1e30, 1e30).with_jerk(1e-30),
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
                let path = Path::new(&poses, kind).unwrap();
                let mut knots = [Knot::default(); 33];
                let table =
                    PvtTable::plan(&platform, &path, Segmentation::segments(32), &mut knots)
                        .unwrap();
                let mut last = 0.0;
                for point in table.points().skip(1) {
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
        let mut limits = AxisLimits::new(-1500.0, 1500.0, speed, ACCELERATION);
        limits.jerk = jerk;
        let platform = if skew { skewed() } else { panel_with(limits) };
        let path = Path::new(&poses, ALL[kind]).unwrap();
        let mut knots = [Knot::default(); 121];
        let table = PvtTable::plan(&platform, &path, Segmentation::segments(segments), &mut knots)
            .unwrap();
        let points: Vec<_> = table.points().collect();
        prop_assert_eq!(points.len(), table.len());
        let shares = shares(&platform, &points);
        prop_assert!(shares.iter().all(|share| *share < LIMIT), "{:?}", shares);
        // Something is at its limit.
        prop_assert!(shares.iter().any(|share| *share > 0.99), "{:?}", shares);
        check_motion(&platform, &points, table.duration_s());
    }
}
