//! Identities of the kinematics, over the whole workspace, its rims and its centre.

use core::f64::consts::PI;

use proptest::prelude::*;
use scara_kin::nalgebra::{Isometry2, Point2, Vector2};
use scara_kin::{
    Arm, DriveSense, Drives, Elbow, InverseError, JointRange, Joints, Limits, TangentTool,
};
use test_support::at_least;

use crate::common::{departure, engraver};

/// `forward(inverse(p))` against p, in units of reach plus base distance, for arms and points at
/// random; the worst are found and bounded in `accuracy.rs`.
const ROUND_TRIP: f64 = 1e-15;
/// The same in f32: as many units in the last place.
const ROUND_TRIP_F32: f32 = 1e-15 / 2.22e-16 * 1.19e-7;
/// Rates there and back, times the conditioning of the Jacobian.
const RATES: f64 = 1e-14;
/// A few roundings of an angle of up to some turns.
const ANGLE: f64 = 1e-14;

fn arms() -> impl Strategy<Value = Arm> {
    (0.0..4.0f64, -3.0..3.0f64)
        .prop_map(|(size, ratio)| Arm::new(10f64.powf(size), 10f64.powf(size + ratio)).unwrap())
}

fn equal_arms() -> impl Strategy<Value = Arm> {
    (0.0..4.0f64).prop_map(|size| Arm::new(10f64.powf(size), 10f64.powf(size)).unwrap())
}

/// Fractions of the distance from the inner to the outer rim, crowded at both.
fn fractions() -> impl Strategy<Value = f64> {
    prop_oneof![
        0.0..=1.0f64,
        (-17.0..0.0f64).prop_map(|e| 10f64.powf(e)),
        (-17.0..0.0f64).prop_map(|e| 1.0 - 10f64.powf(e)),
        Just(0.0),
        Just(1.0),
    ]
}

fn at(arm: &Arm, fraction: f64, heading: f64) -> Point2<f64> {
    let (inner, outer) = (arm.inner_reach(), arm.reach());
    let r = inner + fraction * (outer - inner);
    Point2::new(r * heading.cos(), r * heading.sin())
}

fn joints() -> impl Strategy<Value = Joints> {
    (-PI..PI, -PI..PI).prop_map(|(shoulder, elbow)| Joints::new(shoulder, elbow))
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn forward_undoes_inverse(
        arm in prop_oneof![arms(), equal_arms()],
        fraction in fractions(),
        heading in -PI..PI,
    ) {
        let point = at(&arm, fraction, heading);
        match arm.inverse(point) {
            Ok(solutions) => for (elbow, joints) in solutions.iter() {
                prop_assert!(Elbow::of(&joints) == Some(elbow) || joints.elbow.sin().abs() < 1e-15);
                let miss = (arm.forward(joints) - point).norm() / arm.reach();
                prop_assert!(miss <= ROUND_TRIP, "{miss:e}");
            },
            Err(error) => prop_assert_eq!(error, InverseError::AnyAngle),
        }
    }

    #[test]
    fn forward_undoes_inverse_in_f32(fraction in 0.0..=1.0f32, heading in -3.1..3.1f32) {
        let arm = Arm::new(132.0f32, 132.0).unwrap();
        let r = fraction * arm.reach();
        let point = Point2::new(r * heading.cos(), r * heading.sin());
        prop_assume!(r > 0.0);
        for (_, joints) in arm.inverse(point).unwrap().iter() {
            let miss = (arm.forward(joints) - point).norm() / arm.reach();
            prop_assert!(miss <= ROUND_TRIP_F32, "{miss:e}");
        }
    }

    #[test]
    fn forward_undoes_inverse_on_a_base(
        arm in arms(),
        fraction in fractions(),
        heading in -PI..PI,
        (x, y, turn) in (-1e4..1e4f64, -1e4..1e4f64, -PI..PI),
    ) {
        let base = Isometry2::new(Vector2::new(x, y), turn);
        let placed = arm.with_base(base).unwrap();
        let point = base * at(&arm, fraction, heading);
        let span = arm.reach() + base.translation.vector.norm();
        for (_, joints) in placed.inverse(point).unwrap().iter() {
            let miss = (placed.forward(joints) - point).norm() / span;
            prop_assert!(miss <= 2.0 * ROUND_TRIP, "{miss:e}");
        }
    }

    #[test]
    fn own_points_within_limits_are_never_refused(
        arm in prop_oneof![arms(), equal_arms()],
        (low1, wide1, low2, wide2) in (-4.0..3.0f64, 0.1..7.0f64, -4.0..3.0f64, 0.1..7.0f64),
        (fraction1, fraction2) in (0.0..=1.0f64, fractions()),
    ) {
        let limits = Limits {
            shoulder: JointRange::new(low1, low1 + wide1).unwrap(),
            elbow: JointRange::new(low2, low2 + wide2).unwrap(),
        };
        let inside = Joints::new(
            (low1 + fraction1 * wide1).min(limits.shoulder.max()),
            (low2 + fraction2 * wide2).min(limits.elbow.max()),
        );
        let arm = arm.with_limits(limits);
        let tip = arm.forward(inside);
        let back = arm.inverse_nearest(tip, inside);
        prop_assert!(back.is_ok(), "{back:?}");
        let (_, back) = back.unwrap();
        prop_assert!(limits.contains(&back), "{back:?}");
        prop_assert!((arm.forward(back) - tip).norm() <= arm.tolerance());
    }

    #[test]
    fn nearest_is_nearest(
        arm in prop_oneof![arms(), equal_arms()],
        (fraction, heading) in (0.01..1.0f64, -PI..PI),
        (shoulder, elbow) in (-10.0..10.0f64, -10.0..10.0f64),
    ) {
        let previous = Joints::new(shoulder, elbow);
        let point = at(&arm, fraction, heading);
        let solutions = arm.inverse(point).unwrap();
        let (_, nearest) = arm.inverse_nearest(point, previous).unwrap();
        let best = solutions
            .iter()
            .flat_map(|(_, j)| (-3..=3).flat_map(move |a| (-3..=3).map(move |b| {
                Joints::new(
                    j.shoulder + f64::from(a) * 2.0 * PI,
                    j.elbow + f64::from(b) * 2.0 * PI,
                )
            })))
            .map(|j| (j - previous).amax())
            .fold(f64::INFINITY, f64::min);
        prop_assert!(((nearest - previous).amax() - best).abs() < ANGLE);
    }

    #[test]
    fn rates_there_and_back(
        arm in arms(),
        joints in joints(),
        turn in -PI..PI,
        rates in (-10.0..10.0f64, -10.0..10.0f64),
        bent in (-10.0..10.0f64, -10.0..10.0f64),
    ) {
        prop_assume!(joints.elbow.sin().abs() > 1e-3);
        let arm = arm.with_base(Isometry2::rotation(turn)).unwrap();
        let (rates, bent) = (Vector2::new(rates.0, rates.1), Vector2::new(bent.0, bent.1));
        let conditioning = arm.reach().powi(2) / arm.manipulability(joints);
        let back = arm.joint_rates(joints, arm.tool_velocity(joints, rates)).unwrap();
        prop_assert!((back - rates).norm() <= RATES * conditioning * rates.norm());

        let pull = arm.tool_acceleration(joints, rates, bent);
        let back = arm.joint_accelerations(joints, rates, pull).unwrap();
        let size = rates.norm_squared() * 4.0 + bent.norm();
        prop_assert!((back - bent).norm() <= RATES * conditioning * size);
    }

    #[test]
    fn velocity_and_acceleration_are_derivatives(
        joints in joints(),
        rates in (-1.0..1.0f64, -1.0..1.0f64),
        bent in (-1.0..1.0f64, -1.0..1.0f64),
    ) {
        const H: f64 = 1e-4;
        /// Truncation H²·l/6 of central differences, and rounding l·ε/H².
        const SLOPE: f64 = 1e-5;
        let arm = Arm::new(132.0, 97.0).unwrap();
        let (rates, bent) = (Vector2::new(rates.0, rates.1), Vector2::new(bent.0, bent.1));
        let after = |t: f64| {
            let change = rates * t + bent * (t * t / 2.0);
            arm.forward(Joints::new(joints.shoulder + change.x, joints.elbow + change.y))
        };
        let velocity = (after(H) - after(-H)) / (2.0 * H);
        prop_assert!((velocity - arm.tool_velocity(joints, rates)).norm() < SLOPE);
        let pull = (after(H) - after(0.0) - (after(0.0) - after(-H))) / (H * H);
        prop_assert!((pull - arm.tool_acceleration(joints, rates, bent)).norm() < 1e-4);
    }

    #[test]
    fn chord_bound_holds_and_is_close(
        arm in arms(),
        from in joints(),
        (d1, d2) in (-1.5..1.5f64, -1.5..1.5f64),
        scale in -3.0..0.0f64,
    ) {
        let scale = 10f64.powf(scale);
        let (d1, d2) = (d1 * scale, d2 * scale);
        let to = Joints::new(from.shoulder + d1, from.elbow + d2);
        let (a, b) = (arm.forward(from), arm.forward(to));
        let worst = departure(&arm, (from, to), [a, b], 200);
        let bound = arm.chord_bound(from, to);
        prop_assert!(worst <= bound + arm.tolerance(), "{worst} {bound}");
        let turns = d1.abs().powi(3).max((d1 + d2).abs().powi(3));
        let drift = arm.reach() * turns;
        let full = arm.reach() * d1.abs().max((d1 + d2).abs()).powi(2);
        if full <= (b - a).norm() {
            // First-order truth: bound and departure differ by third order only.
            prop_assert!(bound <= worst * 1.01 + drift + arm.tolerance(), "{worst} {bound}");
        }
    }

    #[test]
    fn following_keeps_the_tolerance(
        (fraction_a, fraction_b) in (0.02..1.0f64, 0.02..1.0f64),
        (heading_a, heading_b) in (-PI..PI, -PI..PI),
        right in any::<bool>(),
        tolerance in -3.0..0.0f64,
    ) {
        let arm = engraver();
        let tolerance = 10f64.powf(tolerance);
        let (a, b) = (at(&arm, fraction_a, heading_a), at(&arm, fraction_b, heading_b));
        let elbow = if right { Elbow::Right } else { Elbow::Left };
        let waypoints = arm.follow([a, b], elbow, tolerance).unwrap();
        prop_assert_eq!(waypoints.remaining(), waypoints.clone().count() as u64);
        let first = waypoints.clone().next().unwrap();
        prop_assert!((arm.forward(first.joints) - a).norm() <= arm.tolerance());
        let mut before: Option<Joints> = None;
        let mut last = a;
        for waypoint in waypoints {
            last = arm.forward(waypoint.joints);
            prop_assert!((last - waypoint.point).norm() <= arm.tolerance());
            if let Some(from) = before {
                let off = departure(&arm, (from, waypoint.joints), [a, b], 50);
                prop_assert!(off <= tolerance, "{off} > {tolerance}");
            }
            before = Some(waypoint.joints);
        }
        prop_assert!((last - b).norm() <= arm.tolerance());
    }

    #[test]
    fn drives_there_and_back(
        joints in joints(),
        zero in joints(),
        coupling in -2.0..2.0f64,
        (reverse1, reverse2) in (any::<bool>(), any::<bool>()),
    ) {
        let sense = |reversed| if reversed { DriveSense::Reversed } else { DriveSense::Forward };
        let drives = Drives::default()
            .with_zero(zero).unwrap()
            .with_senses(sense(reverse1), sense(reverse2))
            .with_coupling(coupling).unwrap();
        let back = drives.to_joints(drives.from_joints(joints));
        prop_assert!((back - joints).amax() < ANGLE);
    }

    #[test]
    fn the_disc_stays_tangent_and_never_jumps(
        turn in -PI..PI,
        poses in prop::collection::vec((joints(), -PI..PI), 1..20),
    ) {
        let arm = engraver().with_base(Isometry2::rotation(turn)).unwrap();
        let mut disc = TangentTool::new(0.3).unwrap();
        let mut before = 0.0;
        for (joints, heading) in poses {
            let direction = Vector2::new(heading.cos(), heading.sin());
            let angle = disc.follow(&arm, joints, direction).unwrap().tool_angle;
            let off = angle + turn + joints.shoulder + joints.elbow - heading;
            prop_assert!((off - (off / (2.0 * PI)).round() * 2.0 * PI).abs() < ANGLE);
            prop_assert!((angle - before).abs() <= PI + ANGLE);
            before = angle;
        }
    }
}
