//! Paths keep their tolerance and their rates, over the whole workspace.

use core::f64::consts::FRAC_PI_2;

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{PlatformPath, SpeedLimits};
use proptest::prelude::*;
use test_support::at_least;

use crate::common::thesis::{directions, thesis};

/// Points of a cylinder in which the whole machine moves.
fn points() -> impl Strategy<Value = Point3<f64>> {
    (0.0..1.0f64, -3.2..3.2f64, -300.0..-180.0f64).prop_map(|(share, heading, z)| {
        let radius = 120.0 * share.sqrt();
        Point3::new(radius * heading.cos(), radius * heading.sin(), z)
    })
}

/// The distance of a point from a path, found by halving round the nearest of many points.
fn off_path(path: &PlatformPath, point: Point3<f64>, near: f64, reach: f64) -> f64 {
    let distance = |share: f64| (path.point_at(share).unwrap() - point).norm();
    let (mut low, mut high) = ((near - reach).max(0.0), (near + reach).min(1.0));
    for _ in 0..60 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if distance(a) < distance(b) {
            high = b;
        } else {
            low = a;
        }
    }
    distance(low)
}

proptest! {
    #![proptest_config(at_least(100))]

    #[test]
    fn paths_keep_their_tolerance_and_rates(
        (from, to) in (points(), points()),
        tolerance in (-3.0..0.0f64).prop_map(|e| 10f64.powf(e)),
        turn in prop_oneof![Just(0.0), -7.0..7.0f64],
    ) {
        let delta = thesis().with_zero(FRAC_PI_2).unwrap();
        let path = if turn == 0.0 {
            PlatformPath::line(from, to).unwrap()
        } else {
            // Round the base's axis, in a plane that tilts with the ends.
            let centre = Point3::new(0.0, 0.0, from.z);
            prop_assume!((from - centre).norm() > 1.0);
            PlatformPath::arc(from, centre, Vector3::z(), turn).unwrap()
        };
        let limits = SpeedLimits::new(500.0, [2.0, 2.0, 1.5]).unwrap();
        let follow = delta.follow(path, tolerance, limits);
        prop_assume!(follow.is_ok());
        let follow = follow.unwrap();
        let count = follow.remaining();
        let waypoints: Vec<_> = follow.collect();
        prop_assert_eq!(waypoints.len() as u64, count);
        prop_assert!((waypoints[0].point - path.point_at(0.0).unwrap()).norm() == 0.0);
        prop_assert!((waypoints.last().unwrap().point - path.point_at(1.0).unwrap()).norm() == 0.0);
        let length: f64 = waypoints.iter().map(|w| w.length).sum();
        prop_assert!((length - path.length()).abs() <= 1e-9 * path.length().max(1.0));
        for pair in waypoints.windows(2) {
            let way = pair[1].angles - pair[0].angles;
            let rates = way.abs() / pair[1].duration_s;
            prop_assert!(rates.x <= 2.0 + 1e-12 && rates.y <= 2.0 + 1e-12 && rates.z <= 1.5 + 1e-12);
            let feed = pair[1].length / pair[1].duration_s;
            prop_assert!(feed <= 500.0 + 1e-9);
            // And no slower than one of them asks for.
            let shares = [feed / 500.0, rates.x / 2.0, rates.y / 2.0, rates.z / 1.5];
            prop_assert!(shares.iter().any(|share| *share > 1.0 - 1e-12), "{:?}", shares);
            for share in [0.1, 0.25, 0.5, 0.6, 0.9] {
                let at = delta.forward(pair[0].angles + way * share).unwrap();
                let step = pair[1].fraction - pair[0].fraction;
                let near = pair[0].fraction + share * step;
                let off = off_path(&path, at, near, step);
                prop_assert!(off <= tolerance, "{off:e} > {tolerance:e}");
            }
        }
    }

    #[test]
    fn the_bound_is_above_the_truth_and_near_it(from in points(), way in directions(), size in 0.1..30.0f64) {
        let delta = thesis();
        let ends = (delta.pose_at(from), delta.pose_at(from + way * size));
        prop_assume!(ends.0.is_ok() && ends.1.is_ok());
        let (a, b) = (ends.0.unwrap(), ends.1.unwrap());
        let mut worst = 0f64;
        for step in 0..=100u8 {
            let share = f64::from(step) / 100.0;
            let angles = a.angles() + (b.angles() - a.angles()) * share;
            let line = a.point() + (b.point() - a.point()) * share;
            worst = worst.max((delta.forward(angles).unwrap() - line).norm());
        }
        if let Some(bound) = delta.chord_bound(&a, &b) {
            prop_assert!(worst <= bound + delta.tolerance(), "{worst} {bound}");
            // Short steps far from the edges, where the departure is not zero by chance.
            if size < 3.0 && a.serial_distance().1 > 60.0 {
                prop_assert!(bound <= 20.0 * worst.max(1e-4), "{worst} {bound}");
            }
        } else {
            prop_assert!(size > 3.0 || a.serial_distance().1 < 60.0);
        }
    }
}
