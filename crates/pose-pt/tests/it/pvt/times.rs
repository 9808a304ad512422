//! How near PVT tables are to the shortest time: closed forms, and a fine phase plane.

use super::check_motion;
use crate::support::moves::{ALL, from_rest};
use crate::support::platform::{ACCELERATION, SPEED, panel, panel_with};
use crate::support::table::{Cut, plan, points_of};
use path_timing::Knot;
use pose_pt::{Interpolation, LocatorAxis, Platform, PosePath};
use proptest::prelude::*;

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
            let path = PosePath::new(&poses, kind).unwrap();
            let mut knots = [Knot::default(); 257];
            let table = plan(&platform, &path, Cut::Into(256), &mut knots).unwrap();
            let ratio = table.duration_s() / seconds;
            println!("{way} mm: {ratio}");
            assert!((0.97..1.002).contains(&ratio), "{way}: {ratio}");
        }
    }
}

#[test]
fn a_straight_move_with_jerk_takes_the_closed_form() {
    let jerk = 100.0;
    let platform = panel_with(LocatorAxis {
        min: -1500.0,
        max: 1500.0,
        speed: SPEED,
        acceleration: ACCELERATION,
        jerk: Some(jerk),
    });
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
        let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
        let mut knots = [Knot::default(); 65];
        let table = plan(&platform, &path, Cut::Into(64), &mut knots).unwrap();
        let ratio = table.duration_s() / seconds;
        println!("{way} mm: {ratio}");
        assert!((0.97..1.002).contains(&ratio), "{way}: {ratio}");
        let points = points_of(table.rows());
        assert_eq!(points.len(), 65);
        check_motion(&platform, &points, table.duration_s());
    }
}

/// Where the body turns far, its hardest place does not slow down the whole way. What the axes
/// need without a limit of jerk is the least that they can need with one.
#[test]
fn jerk_costs_a_turn_little() {
    let limits = LocatorAxis {
        min: -9000.0,
        max: 9000.0,
        speed: 20.0,
        acceleration: 50.0,
        jerk: None,
    };
    for (turn, way, jerk, most) in [
        (0.5, 500.0, 25.0, 1.02),
        (0.5, 500.0, 100.0, 1.01),
        (1.0, 0.0, 100.0, 1.01),
        (1.5, 500.0, 1000.0, 1.005),
        (2.6, 500.0, 1000.0, 1.005),
    ] {
        let poses = from_rest([way, 0.0, 0.0], [0.0, 0.0, turn]);
        let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
        let mut knots = [Knot::default(); 513];
        let mut plan = |platform: &Platform<3>| {
            let table = plan(platform, &path, Cut::Into(512), &mut knots).unwrap();
            let points = points_of(table.rows());
            check_motion(platform, &points, table.duration_s());
            table.duration_s()
        };
        let least = plan(&panel_with(limits));
        let jerky = LocatorAxis {
            jerk: Some(jerk),
            ..limits
        };
        let ratio = plan(&panel_with(jerky)) / least;
        println!("turn by {turn}, {way} mm, jerk {jerk}: {ratio}");
        assert!(
            (1.0..most).contains(&ratio),
            "{turn}, {way}, {jerk}: {ratio}"
        );
    }
}

/// Moves whose optimum a fine phase plane gives.
#[test]
fn no_slower_than_the_optimum_by_a_thousandth() {
    let slow = LocatorAxis {
        min: -9000.0,
        max: 9000.0,
        speed: 10.0,
        acceleration: 25.0,
        jerk: None,
    };
    // No speed is reached: the accelerations of a turning body decide.
    let fast = LocatorAxis {
        min: -9000.0,
        max: 9000.0,
        speed: 1e5,
        acceleration: 25.0,
        jerk: None,
    };
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
            let path = PosePath::new(&poses, kind).unwrap();
            let leg = path.leg(0).unwrap();
            let mut knots = vec![Knot::default(); 4001];
            let optimum = crate::support::optimum::seconds(&platform, &leg, 40_000);
            let table = plan(&platform, &path, Cut::Into(4000), &mut knots).unwrap();
            let ratio = table.duration_s() / optimum;
            println!("{name}, {kind:?}: {} s, {ratio}", table.duration_s());
            assert!((0.97..1.002).contains(&ratio), "{name}: {ratio}");
        }
    }
}

/// At the points where an axis turns back at its full acceleration, two of three speeds that limits
/// allow are far below the highest one.
#[test]
fn near_the_optimum_of_a_turn_of_126_degrees() {
    let platform = panel_with(LocatorAxis {
        min: -9000.0,
        max: 9000.0,
        speed: 1e5,
        acceleration: ACCELERATION,
        jerk: None,
    });
    let poses = from_rest([0.3, -0.9, 0.0], [0.3, -0.9, 2.2]);
    for kind in ALL {
        let path = PosePath::new(&poses, kind).unwrap();
        let optimum = crate::support::optimum::seconds(&platform, &path.leg(0).unwrap(), 40_000);
        for (segments, max) in [(1000, 1.0005), (16_000, 1.000_15)] {
            let mut knots = vec![Knot::default(); 16_001];
            let table = plan(&platform, &path, Cut::Into(segments), &mut knots).unwrap();
            let ratio = table.duration_s() / optimum;
            println!("{kind:?}, {segments} segments: {ratio}");
            assert!((0.999..max).contains(&ratio), "{ratio}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Axes that turn back, at any speed.
    #[test]
    fn near_the_optimum_of_any_turn(
        translation in prop::array::uniform3(-500.0..500.0),
        turn in prop::array::uniform3(-1.2..1.2),
        kind in 0..4_usize, speed in 20.0..1e5,
    ) {
        let platform = panel_with(LocatorAxis { min: -9000.0, max: 9000.0, speed, acceleration: ACCELERATION, jerk: None });
        let poses = from_rest(translation, turn);
        let path = PosePath::new(&poses, ALL[kind]).unwrap();
        let optimum = crate::support::optimum::seconds(&platform, &path.leg(0).unwrap(), 8000);
        let mut knots = [Knot::default(); 1001];
        let table = plan(&platform, &path, Cut::Into(1000), &mut knots)
            .unwrap();
        let ratio = table.duration_s() / optimum;
        prop_assert!((0.97..1.002).contains(&ratio), "{ratio}");
    }
}

#[test]
fn a_pure_turn_takes_the_closed_form() {
    // A turn about the first locator: the axis Y of the second moves like a pendulum, and for
    // a small angle as on a line: by 4000 mm times the angle.
    let platform = panel();
    let angle = 0.002_f64;
    let poses = from_rest([0.0; 3], [0.0, 0.0, angle]);
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 201];
    let table = plan(&platform, &path, Cut::Into(200), &mut knots).unwrap();
    let seconds = 4000.0 * angle / SPEED + SPEED / ACCELERATION;
    let ratio = table.duration_s() / seconds;
    assert!((0.97..1.002).contains(&ratio), "{ratio}");
}
