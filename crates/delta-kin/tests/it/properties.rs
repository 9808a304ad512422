//! Identities of the kinematics, over the whole workspace and its rim.

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    Arm, ArmGeometry, ArmRange, AssemblyMode, Delta, Dimensions, ElbowSide, InverseError, Pose,
    ZAxis,
};
use proptest::prelude::*;
use test_support::at_least;

use crate::common::reach::reach_margins;
use crate::common::thesis::{directions, thesis};
use crate::common::uneven::{modes, uneven_arms};

/// `forward(inverse(p))` against p, in machine epsilons of the span, times the conditioning.
const ROUND_TRIP: f64 = 16.0;
/// The promise where no singularity is near, relative to the span.
const PROMISE: f64 = 1e-12;
/// Rates there and back, times the conditioning of the Jacobian.
const RATES: f64 = 1e-13;

/// Machines of all proportions, each arm a little different.
fn machines() -> impl Strategy<Value = Delta> {
    let arm = || {
        (
            0.95..1.05f64,
            0.95..1.05f64,
            0.95..1.05f64,
            -0.1..0.1f64,
            -0.5..0.5f64,
        )
    };
    (
        -1.0..3.0f64,
        (0.05..1.5f64, 0.05..1.0f64, 1.2..3.0f64),
        [arm(), arm(), arm()],
    )
        .prop_map(|(size, (base, platform, lower), off)| {
            let size = 10f64.powf(size);
            let mut arms = Arm::ALL.map(|arm| {
                ArmGeometry::nominal(
                    arm,
                    Dimensions {
                        base: base * size,
                        platform: platform * size,
                        upper: size,
                        lower: lower * size,
                    },
                )
            });
            for (arm, (base, upper, lower, azimuth, zero)) in arms.iter_mut().zip(off) {
                arm.base *= base;
                arm.upper *= upper;
                arm.lower *= lower;
                arm.azimuth += azimuth;
                arm.zero += zero;
            }
            Delta::from_arms(arms).unwrap()
        })
}

fn thetas() -> impl Strategy<Value = Vector3<f64>> {
    [-0.6..2.6f64, -0.6..2.6f64, -0.6..2.6f64].prop_map(Vector3::from)
}

/// Distances from an edge, from a tenth down to nothing.
fn gaps() -> impl Strategy<Value = f64> {
    prop_oneof![
        0.0..0.1f64,
        (-17.0..-1.0f64).prop_map(|e| 10f64.powf(e)),
        Just(0.0),
    ]
}

/// The working mode of a pose, however it was made.
fn working_mode(pose: &Pose) -> [ElbowSide; 3] {
    <[f64; 3]>::from(pose.levers()).map(|lever| {
        if lever > 0.0 {
            ElbowSide::In
        } else {
            ElbowSide::Out
        }
    })
}

/// The machine in its two assembly modes.
fn assembled(delta: &Delta) -> [Delta; 2] {
    [AssemblyMode::Lower, AssemblyMode::Upper].map(|mode| delta.with_assembly_mode(mode))
}

/// The last place on a ray that is within reach, and the first one beyond.
fn rim(delta: &Delta, from: Point3<f64>, direction: Vector3<f64>) -> (f64, f64) {
    let (mut inside, mut outside) = (0.0, 4.0 * delta.span());
    for _ in 0..56 {
        let middle = f64::midpoint(inside, outside);
        if reach_margins(delta.arms(), from + direction * middle).min() >= 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    (inside, outside)
}

/// One assembly mode answers, with angles whose `forward` is the point; the other refuses.
fn round_trip(delta: &Delta, point: Point3<f64>) -> Result<(), TestCaseError> {
    let poses = assembled(delta).map(|delta| (delta, delta.pose_at(point)));
    let mut answered = 0;
    for (delta, pose) in poses {
        let pose = match pose {
            Ok(pose) => pose,
            Err(InverseError::OtherAssembly { assembly_mode, .. }) => {
                prop_assert_eq!(assembly_mode, delta.assembly_mode().other());
                continue;
            }
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        answered += 1;
        // Where the rods lie in a plane no digit is left.
        prop_assume!(pose.parallel_distance() > 1e-7);
        let made = delta
            .forward(pose.angles())
            .map_err(|error| TestCaseError::fail(error.to_string()))?;
        let miss = (made - point).norm() / delta.span();
        let condition = pose.parallel_distance().recip();
        prop_assert!(
            miss <= ROUND_TRIP * f64::EPSILON * condition,
            "{miss:e} {condition}"
        );
        prop_assert!(miss <= PROMISE || condition > 100.0, "{miss:e}");
    }
    prop_assert_eq!(answered, 1);
    Ok(())
}

/// Whether the elbows, moved inward by the platform's radius, go round counter-clockwise as seen
/// from above.
fn turning(delta: &Delta, pose: &Pose) -> bool {
    let mut centres = pose.elbows().map(|elbow| elbow.coords);
    for (centre, arm) in centres.iter_mut().zip(delta.arms()) {
        *centre -= Vector3::new(arm.azimuth.cos(), arm.azimuth.sin(), 0.0) * arm.platform;
    }
    let [a, b, c] = centres;
    (b - a).cross(&(c - a)).z > 0.0
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn forward_undoes_inverse(delta in machines(), thetas in thetas(), (mode, elbows) in modes()) {
        for made in assembled(&delta).map(|delta| delta.forward(thetas)) {
            prop_assume!(made.is_ok());
            let delta = delta.with_assembly_mode(mode).with_working_mode(elbows);
            round_trip(&delta, made.unwrap())?;
        }
    }

    /// Points anywhere: in front of and behind the base, in reach or not.
    #[test]
    fn what_is_answered_is_where_forward_is(
        arms in uneven_arms(),
        direction in directions(),
        share in 0.0..0.8f64,
        (mode, elbows) in modes(),
    ) {
        let delta = Delta::from_arms(arms).unwrap();
        let delta = delta.with_assembly_mode(mode).with_working_mode(elbows);
        let point = Point3::from(direction * (share * delta.span()));
        prop_assume!(reach_margins(delta.arms(), point).min() > 0.0);
        round_trip(&delta, point)?;
    }

    #[test]
    fn inverse_undoes_forward(delta in machines(), thetas in thetas()) {
        for delta in assembled(&delta) {
            let pose = delta.pose_of(thetas);
            prop_assume!(pose.is_ok());
            let pose = pose.unwrap();
            let delta = delta.with_working_mode(working_mode(&pose));
            let back = delta.inverse(pose.point()).unwrap() - thetas;
            for (way, lever) in back.iter().zip(&pose.levers()) {
                let way = way - (way / core::f64::consts::TAU).round() * core::f64::consts::TAU;
                let shift = (way * lever).abs() / delta.span();
                let condition = pose.parallel_distance().recip();
                prop_assert!(shift <= ROUND_TRIP * f64::EPSILON * condition, "{shift:e} {condition}");
            }
        }
    }

    #[test]
    fn the_rim_is_sharp(
        delta in machines(),
        thetas in thetas(),
        direction in directions(),
        gap in gaps(),
    ) {
        let from = delta.forward(thetas);
        prop_assume!(from.is_ok());
        let from = from.unwrap();
        let (inside, outside) = rim(&delta, from, direction);
        let is_reached = |answer: &Result<_, InverseError>| {
            matches!(answer, Ok(_) | Err(InverseError::OtherAssembly { .. }))
        };
        prop_assert!(is_reached(&delta.inverse(from + direction * inside)));
        let within = from + direction * (inside * (1.0 - gap));
        if reach_margins(delta.arms(), within).min() >= 0.0 {
            round_trip(&delta, within)?;
        }
        let beyond = from + direction * (outside + gap * delta.span());
        let margin = reach_margins(delta.arms(), beyond).min();
        match delta.inverse(beyond) {
            Err(InverseError::TooFar { by, .. } | InverseError::TooNear { by, .. }) => {
                prop_assert!(by > delta.tolerance() && (by + margin).abs() <= delta.tolerance());
            }
            other => {
                // The margin's own rounding is not the crate's.
                let rounding = 4.0 * f64::EPSILON * delta.span();
                prop_assert!(
                    is_reached(&other) && margin >= -delta.tolerance() - rounding,
                    "{other:?} {margin:e}"
                );
            }
        }
    }

    #[test]
    fn own_points_within_limits_are_never_refused(
        delta in machines(),
        (low, wide) in (-1.0..1.0f64, 0.1..3.0f64),
        shares in (0.0..=1.0f64, gaps(), gaps()).prop_map(|(a, b, c)| [a, b, 1.0 - c]),
    ) {
        let range = ArmRange::new(low, low + wide).unwrap();
        let angles = Vector3::from(shares).map(|share| (low + share * wide).min(range.max()));
        let pose = delta.pose_of(angles);
        prop_assume!(pose.is_ok());
        let pose = pose.unwrap();
        prop_assume!(pose.parallel_distance() > 0.1);
        // Stretched, an arm has both elbows, and rounding chooses.
        prop_assume!(pose.serial_distance().1 > 1e-3 * delta.span());
        let limited = delta.with_range(range).with_working_mode(working_mode(&pose));
        let back = limited.inverse(pose.point());
        prop_assert!(back.is_ok(), "{back:?}");
        prop_assert!(back.unwrap().iter().all(|angle| range.contains(*angle)));
    }

    #[test]
    fn lower_is_the_smaller_z(delta in machines(), thetas in thetas(), down in any::<bool>()) {
        let z = if down { ZAxis::Down } else { ZAxis::Up };
        if let [Ok(lower), Ok(upper)] = assembled(&delta.with_z(z)).map(|delta| delta.forward(thetas)) {
            let apart = if down { lower.z - upper.z } else { upper.z - lower.z };
            prop_assert!(apart >= -delta.tolerance(), "{lower} {upper}");
        }
    }

    /// Along a way of the arms on which the rods come nowhere near a plane, nor the plane of the
    /// elbows upright, the platform moves without a jump.
    #[test]
    fn an_assembly_mode_is_kept_without_a_singularity(
        delta in machines(),
        (from, to) in (prop::array::uniform3(-3.1..3.1f64), prop::array::uniform3(-3.1..3.1f64)),
    ) {
        let (from, to) = (Vector3::from(from), Vector3::from(to));
        let mut last: Option<Pose> = None;
        for step in 0..=400u16 {
            let share = f64::from(step) / 400.0;
            let pose = delta.pose_of(from + (to - from) * share).ok();
            let pose = pose.filter(|pose| pose.parallel_distance() > 0.2);
            let order = |pose: &Pose| turning(&delta, pose);
            if let (Some(last), Some(pose)) = (&last, &pose)
                && order(last) == order(pose)
            {
                // Elbows move by at most 1/400 of two turns of the upper arm, the platform by
                // that over the sine, which itself is not constant.
                let jump = (pose.point() - last.point()).norm();
                prop_assert!(jump <= 0.3 * delta.span(), "{} {}", last.point(), pose.point());
            }
            last = pose;
        }
    }

    #[test]
    fn jacobian_is_the_derivative(delta in machines(), thetas in thetas(), rates in directions()) {
        let pose = delta.pose_of(thetas);
        prop_assume!(pose.is_ok());
        let pose = pose.unwrap();
        prop_assume!(pose.parallel_distance() > 0.1);
        prop_assume!(pose.serial_distance().1 > 0.01 * delta.span());
        let velocity = pose.platform_velocity(rates).unwrap();
        let step = 1e-6;
        let (a, b) = (delta.forward(thetas + rates * step), delta.forward(thetas - rates * step));
        prop_assume!(a.is_ok() && b.is_ok());
        let slope = (a.unwrap() - b.unwrap()) / (2.0 * step);
        prop_assert!((velocity - slope).norm() <= 1e-6 * delta.span(), "{velocity} {slope}");

        let back = pose.joint_rates(velocity).unwrap();
        prop_assert!((back - rates).norm() <= RATES * 1000.0, "{back}");
        // Virtual work: what the torques do is what the force does.
        let force = Vector3::new(1.0, -2.0, 3.0);
        let torques = pose.holding_torques(force).unwrap();
        let work = torques.dot(&rates) + force.dot(&velocity);
        prop_assert!(work.abs() <= RATES * delta.span() * 1000.0, "{work:e}");
        let forces = pose.rod_forces(force).unwrap();
        let sum: Vector3<f64> = pose.rods().iter().zip(&forces).map(|(rod, f)| rod * *f).sum();
        prop_assert!((sum + force).norm() <= RATES * 100.0);
        let det = pose.jacobian().unwrap().determinant().abs();
        let manipulability = pose.manipulability().unwrap();
        prop_assert!((det - manipulability).abs() <= 1e-9 * manipulability);
    }

    #[test]
    fn single_precision_keeps_its_digits(thetas in [0.1..1.9f32, 0.1..1.9f32, 0.1..1.9f32]) {
        let delta = Delta::<f32>::new(Dimensions { base: 42.0, platform: 18.0, upper: 120.0, lower: 243.0 }).unwrap();
        let exact = thesis();
        let point = delta.forward(Vector3::from(thetas));
        prop_assume!(point.is_ok());
        let point = point.unwrap();
        let wide = exact.forward(Vector3::from(thetas).cast()).unwrap();
        let pose = exact.pose_at(wide).unwrap();
        let bound = ROUND_TRIP * f64::from(f32::EPSILON) / pose.parallel_distance() * exact.span();
        prop_assert!((point.cast::<f64>() - wide).norm() <= bound);
        let back = delta.forward(delta.inverse(point).unwrap()).unwrap();
        prop_assert!((back - point).cast::<f64>().norm() <= bound);
        let angles = delta.inverse(point).unwrap().cast::<f64>();
        let off = (angles - exact.inverse(point.cast()).unwrap()).component_mul(&pose.levers());
        prop_assert!(off.amax() <= ROUND_TRIP * f64::from(f32::EPSILON) * exact.span());
    }
}
