//! PVT tables: limits in exact arithmetic.

use std::env;

use crate::support::table::{Cut, Point, plan, points_of};
use path_timing::{FeedCeiling, Knot};
use pose_pt::{LocatorAxis, Platform, PosePath};
use proptest::prelude::*;

use crate::support::exact::Exact;
use crate::support::moves::{ALL, from_rest, poses};
use crate::support::platform::{ACCELERATION, SPEED, panel, panel_with, pose, skewed};

/// Where segments are short, the rounding of the numbers that a controller gets is seen in the
/// accelerations that it makes of them.
#[test]
fn limits_hold_to_the_last_digit() {
    let turn = [0.01, 0.02, 0.05];
    let jerk = LocatorAxis {
        min: -1500.0,
        max: 1500.0,
        speed: SPEED,
        acceleration: ACCELERATION,
        jerk: Some(100.0),
    };
    let cuts = [(40, 0), (1024, 1), (8192, 2), (20_000, 3)];
    let are_all = env::var_os("ALL_CUTS").is_some();
    for (name, platform) in [
        ("panel", panel()),
        ("jerk", panel_with(jerk)),
        ("skewed", skewed()),
    ] {
        // The last with a stop on the way, which two legs would round each by itself.
        let by = |way: f64| pose([900.0 + way, -700.0, 300.0 - way], [0.0, 0.0, 1e-3 * way]);
        for poses in [
            &from_rest([20.0, -5.0, 3.0], turn)[..],
            &from_rest([0.01, 0.0, 0.0], [0.0; 3]),
            &[by(0.0), by(0.01), by(-0.03)],
        ] {
            // The fine ones for one platform on one leg, for all where that is asked for.
            let is_fine = are_all || name == "jerk" && poses.len() == 2;
            let cuts = if is_fine { &cuts[..] } else { &cuts[..2] };
            for &(segments, kind) in cuts {
                let path = PosePath::new(poses, ALL[kind]).unwrap();
                let mut knots = vec![Knot::default(); 40_002];
                let table = plan(&platform, &path, Cut::Into(segments), &mut knots);
                let table = table.unwrap();
                let slower = table.at_speed(1.0 - f64::EPSILON).unwrap();
                let mut ceilings = vec![FeedCeiling::default(); table.len()];
                let run = slower.playback(1.0, &mut ceilings).unwrap();
                let excess = [
                    exact_excess(&platform, &points_of(table.rows())),
                    exact_excess(&platform, &points_of(slower.rows())),
                    exact_excess(&platform, &points_of(run)),
                ];
                assert!(
                    excess.iter().all(|of| *of <= 0.0),
                    "{name}, {segments}: {excess:?}"
                );
            }
        }
    }
}

/// The most by which an acceleration or a jerk of what the controller gets is above its limit, as
/// a share of it, in exact arithmetic.
fn exact_excess(platform: &Platform<3>, points: &[Point<3>]) -> f64 {
    let mut worst = f64::MIN;
    for pair in points.windows(2) {
        let [from, to] = pair else { unreachable!() };
        for (number, axis) in (0..9).map(|number| (number / 3, number % 3)) {
            let limits = platform.locators()[number].limits[axis];
            let [q0, q1] = [from, to].map(|point| Exact::from(point.axes[number][axis]));
            let [v0, v1] = [from, to].map(|point| Exact::from(point.velocities[number][axis]));
            let [two, four, six] = [2.0, 4.0, 6.0].map(Exact::from);
            let (time, way) = (Exact::from(to.segment_s), six * (q1 - q0));
            let allowed = Exact::from(limits.acceleration) * time * time;
            for asked in [
                way - (four * v0 + two * v1) * time,
                (two * v0 + four * v1) * time - way,
            ] {
                worst = worst.max(share_above(asked, allowed));
            }
            if let Some(limit) = limits.jerk {
                let asked = six * (v0 + v1) * time - (way + way);
                worst = worst.max(share_above(asked, Exact::from(limit) * time * time * time));
            }
        }
    }
    worst
}

fn share_above(asked: Exact, allowed: Exact) -> f64 {
    let above = asked.abs() - allowed;
    above.value() / allowed.value()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn limits_hold_to_the_last_digit_on_any_way(
        first in poses(), second in poses(), kind in 0..4_usize, segments in 7..400_u32,
        jerk in prop::option::of(20.0..2000.0), speed in 1.0..1000.0, scale in 0.1..1.0,
    ) {
        let mut limits = LocatorAxis { min: -1500.0, max: 1500.0, speed, acceleration: ACCELERATION, jerk: None };
        limits.jerk = jerk;
        let platform = panel_with(limits);
        let poses = [first, second].concat();
        let path = PosePath::new(&poses, ALL[kind]).unwrap();
        let mut knots = vec![Knot::default(); 1203];
        let table = plan(&platform, &path, Cut::Into(segments), &mut knots)
            .unwrap();
        let table = table.at_speed(scale).unwrap();
        let excess = exact_excess(&platform, &points_of(table.rows()));
        prop_assert!(excess <= 0.0, "{excess:e}");
    }
}
