//! Identities of poses, rotations, platforms and fits.

use core::f64::consts::{FRAC_PI_2, PI};

use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, Quaternion, UnitQuaternion, Vector3, Vector4};
use pose_pt::{
    Convention, FitError, Locator, LocatorAxis, Platform, PoseVector, angle_between,
    from_rotation_vector, rigid_fit, rotation_vector, rotation_vector_between, slerp, to_matrix,
};
use proptest::prelude::*;
use test_support::at_least;

/// A rotation made by three products, applied, and undone: 4.5 machine epsilons.
const ROUNDING: f64 = 1e-15;
/// The same in f32.
const ROUNDING_F32: f64 = ROUNDING / f64::EPSILON * f32::EPSILON as f64;

const CONVENTIONS: [Convention; 2] = [Convention::ExtrinsicXyz, Convention::IntrinsicXyz];

fn points(size: f64) -> impl Strategy<Value = Point3<f64>> {
    [-size..size, -size..size, -size..size].prop_map(|[x, y, z]| Point3::new(x, y, z))
}

/// Rotations all over, by four numbers of the same distribution.
fn rotations() -> impl Strategy<Value = UnitQuaternion<f64>> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0f64]
        .prop_filter("too short to have a direction", |q| {
            Vector4::from(*q).norm() > 0.1
        })
        .prop_map(|[w, x, y, z]| UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
}

fn poses() -> impl Strategy<Value = Isometry3<f64>> {
    (points(5000.0), rotations()).prop_map(|(p, q)| Isometry3::from_parts(p.coords.into(), q))
}

/// Angles with β crowded at ±π/2.
fn angles() -> impl Strategy<Value = PoseVector> {
    let near = (-17.0..0.0f64, prop::bool::ANY).prop_map(|(e, up)| {
        let beta = FRAC_PI_2 - 10f64.powf(e);
        if up { beta } else { -beta }
    });
    let beta = prop_oneof![
        -FRAC_PI_2..FRAC_PI_2,
        near,
        Just(FRAC_PI_2),
        Just(-FRAC_PI_2)
    ];
    (-PI..PI, beta, -PI..PI).prop_map(|(a, b, c)| PoseVector::new(1.0, 2.0, 3.0, a, b, c))
}

/// Directions of three axes, some degrees from a rotated frame, with errors of scale.
fn frames() -> impl Strategy<Value = Matrix3<f64>> {
    (rotations(), prop::array::uniform9(-0.1..0.1f64)).prop_map(|(q, skew)| {
        to_matrix(&q).matrix() * (Matrix3::identity() + Matrix3::from_row_slice(&skew))
    })
}

fn limits() -> [LocatorAxis; 3] {
    [LocatorAxis {
        min: -500.0,
        max: 500.0,
        speed: 50.0,
        acceleration: 200.0,
        jerk: None,
    }; 3]
}

/// Anchors at least a tenth of their extent wide.
fn anchors<const N: usize>() -> impl Strategy<Value = [Point3<f64>; N]> {
    prop::array::uniform::<_, N>(points(3000.0)).prop_filter("too narrow", |anchors| {
        rigid_fit(anchors, anchors).is_ok_and(|fit| fit.eigenvalue_gap > 2.0 * 300.0 * 300.0)
    })
}

fn platforms() -> impl Strategy<Value = Platform<4>> {
    let locator = (points(2000.0), frames());
    (anchors::<4>(), prop::array::uniform4(locator)).prop_filter_map(
        "refused",
        |(anchors, placed)| {
            let mut number = 0..4;
            let locators = anchors.map(|anchor| {
                let (origin, axes) = placed[number.next().unwrap()];
                Locator::new(anchor, origin, limits()).with_axes(axes)
            });
            Platform::new(locators).ok()
        },
    )
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn angles_come_back_as_their_lever_permits(vector in angles()) {
        for convention in CONVENTIONS {
            let resolved = PoseVector::from_isometry(&vector.to_isometry(convention), convention);
            prop_assert_eq!(resolved.vector.position(), vector.position());
            if vector.beta.abs() >= FRAC_PI_2 {
                prop_assert!(resolved.locked, "{resolved:?}");
                prop_assert!(resolved.vector.alpha.abs() < f64::MIN_POSITIVE);
            } else if !resolved.locked {
                let way = resolved.vector.angles() - vector.angles();
                let lever = ROUNDING / vector.beta.cos();
                let turn = |angle: f64| (angle - (angle / (2.0 * PI)).round() * 2.0 * PI).abs();
                prop_assert!(turn(way.x) <= 2.0 * lever, "{:e}", way.x);
                prop_assert!(way.y.abs() <= ROUNDING, "{:e}", way.y);
                prop_assert!(turn(way.z) <= 2.0 * lever, "{:e}", way.z);
            } else {
                prop_assert!(vector.beta.cos() < 2.0 * ROUNDING, "{:e}", vector.beta.cos());
            }
        }
    }

    #[test]
    fn near_a_previous_vector_nothing_jumps(vector in angles(), turns in [-2i8..3, -2i8..3]) {
        for convention in CONVENTIONS {
            let [a, c] = turns.map(|turns| f64::from(turns) * 2.0 * PI);
            let previous = PoseVector { alpha: vector.alpha + a, gamma: vector.gamma + c, ..vector };
            let pose = vector.to_isometry(convention);
            let resolved = PoseVector::from_isometry_near(&pose, convention, &previous);
            let way = (resolved.vector.angles() - previous.angles()).amax();
            let lever = if resolved.locked { 1.0 } else { vector.beta.cos().max(ROUNDING) };
            prop_assert!(way <= 16.0 * ROUNDING / lever, "{way:e} {resolved:?} {previous:?}");
        }
    }

    #[test]
    fn distances_are_kept(platform in platforms(), pose in poses()) {
        let at = platform.positions(&pose);
        for (anchor, point) in platform.anchors().iter().zip(&at) {
            for (other_anchor, other_point) in platform.anchors().iter().zip(&at) {
                let change = (point - other_point).norm() - (anchor - other_anchor).norm();
                // Of 5000 mm of translation and as much of anchor.
                prop_assert!(change.abs() <= 10_000.0 * ROUNDING, "{change:e}");
            }
        }
        let distance_error = platform.distance_error(&at).change;
        prop_assert!(distance_error.abs() <= 10_000.0 * ROUNDING, "{distance_error:e}");
    }

    #[test]
    fn pose_of_axes_is_the_pose(platform in platforms(), pose in poses()) {
        let body = platform.pose(&platform.axes(&pose)).unwrap();
        // Axis coordinates of 10 m, the anchors some hundred from the softest axis; skewed
        // frames cost a little.
        let lever = 10_000.0 / 300.0;
        let turn = angle_between(&body.pose.rotation, &pose.rotation);
        prop_assert!(turn <= 2.0 * lever * ROUNDING, "{turn:e}");
        let way = body.pose.translation.vector - pose.translation.vector;
        prop_assert!(way.norm() <= 5000.0 * 2.0 * lever * ROUNDING, "{:e}", way.norm());
        prop_assert!(body.rms <= 2.0 * 10_000.0 * ROUNDING, "{:e}", body.rms);
        prop_assert!(body.distance_error.change.abs() <= 4.0 * 10_000.0 * ROUNDING);
    }

    #[test]
    fn own_poses_at_the_ends_of_strokes_are_not_refused(
        platform in platforms(),
        pose in poses(),
        upper in prop::bool::ANY,
    ) {
        let axes = platform.axes(&pose);
        let mut ends = axes.iter();
        let locators = platform.locators().map(|mut locator| {
            for (limits, end) in locator.limits.iter_mut().zip(ends.next().unwrap()) {
                let (min, max) = if upper { (end - 9.0, *end) } else { (*end, end + 9.0) };
                *limits = LocatorAxis { min, max, speed: 50.0, acceleration: 200.0, jerk: None };
            }
            locator
        });
        let limited = Platform::new(locators).unwrap();
        let body = limited.pose(&axes).unwrap();
        let refused = limited.checked_axes(&body.pose);
        prop_assert!(refused.is_ok(), "{refused:?}");
    }

    #[test]
    fn axis_velocities_are_the_derivative(
        platform in platforms(),
        pose in poses(),
        linear in points(100.0),
        angular in points(0.5),
    ) {
        let (linear, angular) = (linear.coords, angular.coords);
        // Central differences: the third derivative's step² / 6, and rounding / step.
        const STEP: f64 = 1e-4;
        let at = |time: f64| {
            let turn = from_rotation_vector(&(angular * time));
            let place = pose.translation.vector + linear * time;
            platform.axes(&Isometry3::from_parts(place.into(), turn * pose.rotation))
        };
        let rates = platform.axis_velocities(&pose, &linear, &angular);
        let accelerations =
            platform.axis_accelerations(&pose, &Vector3::zeros(), &angular, &Vector3::zeros());
        let (before, now, after) = (at(-STEP), at(0.0), at(STEP));
        for ((((b, n), a), rate), acceleration) in
            before.iter().zip(&now).zip(&after).zip(&rates).zip(&accelerations)
        {
            let first = (a - b) / (2.0 * STEP);
            prop_assert!((first - rate).norm() < 1e-4, "{first:?} {rate:?}");
            let second = (a - n * 2.0 + b) / (STEP * STEP);
            prop_assert!((second - acceleration).norm() < 1e-2, "{second:?} {acceleration:?}");
        }
    }

    #[test]
    fn slerp_ends_are_exact_and_both_ways_meet(
        a in rotations(),
        b in rotations(),
        eighths in 0u8..=8,
    ) {
        let t = f64::from(eighths) / 8.0;
        prop_assert_eq!(slerp(&a, &b, 0.0), a);
        let end = slerp(&a, &b, 1.0);
        prop_assert!(end.as_vector() == b.as_vector() || end.as_vector() == &-b.as_vector());
        let (there, back) = (slerp(&a, &b, t), slerp(&b, &a, 1.0 - t));
        prop_assert!(
            there.as_vector() == back.as_vector() || there.as_vector() == &-back.as_vector()
        );
    }

    #[test]
    fn slerp_turns_at_constant_speed(
        a in rotations(),
        axis in points(1.0),
        exponent in -12.0..0.0f64,
        t in 0.0..=1.0f64,
    ) {
        prop_assume!(axis.coords.norm() > 0.1);
        let way = axis.coords.normalize() * (PI * 10f64.powf(exponent));
        let b = from_rotation_vector(&way) * a;
        let half = slerp(&a, &b, t);
        // The quaternions themselves are rounded to an epsilon; of the way from one to
        // the other no digit is lost.
        let exact = rotation_vector_between(&a, &b);
        let gone = rotation_vector_between(&a, &half);
        prop_assert!((gone - exact * t).norm() <= 2.0 * ROUNDING, "{:e}", (gone - exact * t).norm());
        prop_assert!((half.as_vector().norm() - 1.0).abs() <= ROUNDING);
        let angle = angle_between(&a, &b);
        prop_assert!((angle - exact.norm()).abs() <= ROUNDING * angle.max(f64::EPSILON));
    }

    #[test]
    fn rotation_vectors_come_back(axis in points(1.0), exponent in -300.0..0.0f64) {
        prop_assume!(axis.coords.norm() > 0.1);
        let vector = axis.coords.normalize() * (PI * 10f64.powf(exponent));
        let back = rotation_vector(&from_rotation_vector(&vector));
        prop_assert!((back - vector).norm() <= 2.0 * ROUNDING * vector.norm());
    }

    #[test]
    fn fits_move_with_their_points(
        a in anchors::<5>(),
        noise in prop::array::uniform5(points(20.0)),
        motion in poses(),
        other in poses(),
    ) {
        let mut noise = noise.iter();
        let b = a.map(|point| motion * point + noise.next().unwrap().coords);
        let fit = rigid_fit(&a, &b).unwrap();
        let moved = rigid_fit(&a, &b.map(|point| other * point)).unwrap();
        let started = rigid_fit(&a.map(|point| other * point), &b).unwrap();
        let back = rigid_fit(&b, &a).unwrap();
        for (found, wanted) in [
            (moved.motion, other * fit.motion),
            (started.motion, fit.motion * other.inverse()),
            (back.motion, fit.motion.inverse()),
        ] {
            let turn = angle_between(&found.rotation, &wanted.rotation);
            prop_assert!(turn <= 200.0 * ROUNDING, "{turn:e}");
            let way = (found.translation.vector - wanted.translation.vector).norm();
            prop_assert!(way <= 10_000.0 * 200.0 * ROUNDING, "{way:e}");
        }
        for other in [moved, started, back] {
            prop_assert!((other.rms - fit.rms).abs() <= 20_000.0 * ROUNDING);
        }
    }

    #[test]
    fn no_other_motion_fits_better(
        a in anchors::<4>(),
        b in anchors::<4>(),
        is_mirrored: bool,
        turn in points(1.0),
        exponent in -6.0..0.5f64,
    ) {
        // Mirror images, and points that have nothing to do with each other.
        let b = if is_mirrored { a.map(|p| Point3::new(-p.x, p.y, p.z)) } else { b };
        let fit = match rigid_fit(&a, &b) {
            Ok(fit) => fit,
            Err(FitError::Ambiguous { .. }) => return Ok(()),
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        let matrix = to_matrix(&fit.motion.rotation);
        prop_assert!((matrix.matrix().determinant() - 1.0).abs() <= 4.0 * ROUNDING);
        let sum = |motion: &Isometry3<f64>| {
            let pairs = a.iter().zip(&b);
            pairs.map(|(a, b)| (b - motion * a).norm_squared()).sum::<f64>()
        };
        let best = sum(&fit.motion);
        prop_assert!((best - 4.0 * fit.rms * fit.rms).abs() <= 8.0 * ROUNDING * 1e8);
        let turned = from_rotation_vector(&(turn.coords * 10f64.powf(exponent)));
        let mean = |points: &[Point3<f64>; 4]| {
            points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / 4.0
        };
        let rotation = turned * fit.motion.rotation;
        let translation = mean(&b) - rotation * mean(&a);
        let other = sum(&Isometry3::from_parts(translation.into(), rotation));
        prop_assert!(other >= best - 16.0 * ROUNDING * 1e8, "{other} {best}");
    }

    #[test]
    fn single_precision_agrees(platform in platforms(), pose in poses()) {
        let single = Platform::<4, f32>::new(platform.locators().map(|locator| {
            let limits = LocatorAxis { min: -500.0, max: 500.0, speed: 50.0, acceleration: 200.0, jerk: None };
            Locator::new(
                locator.anchor.cast(),
                locator.origin.cast(),
                [limits; 3],
            )
            .with_axes(locator.axes.cast())
        }))
        .unwrap();
        let axes = single.axes(&pose.cast());
        for (single, double) in axes.iter().zip(platform.axes(&pose)) {
            let miss = (single.cast::<f64>() - double).norm();
            prop_assert!(miss <= 4.0 * 20_000.0 * ROUNDING_F32, "{miss:e}");
        }
        let body = single.pose(&axes).unwrap();
        let lever = 10_000.0 / 300.0;
        let turn = angle_between(&body.pose.rotation.cast(), &pose.rotation);
        prop_assert!(turn <= 2.0 * lever * ROUNDING_F32, "{turn:e}");
        let way = body.pose.translation.vector.cast::<f64>() - pose.translation.vector;
        prop_assert!(way.norm() <= 5000.0 * 2.0 * lever * ROUNDING_F32, "{:e}", way.norm());
        let vector = PoseVector::from_isometry(&pose, Convention::ExtrinsicXyz).vector;
        let [a, b, c]: [f32; 3] = vector.angles().cast().into();
        let turned = PoseVector::new(0.0, 0.0, 0.0, a, b, c).to_quaternion(Convention::ExtrinsicXyz);
        let miss = angle_between(&turned.cast(), &pose.rotation);
        prop_assert!(miss <= 4.0 * ROUNDING_F32, "{miss:e}");
    }
}
