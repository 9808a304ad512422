//! The unit of length is free: with all lengths ten, a hundred, a million times as large or
//! small, every length that comes back is so too, and every angle stays.

use core::f64::consts::PI;

use proptest::prelude::*;
use scara_kin::nalgebra::{Isometry2, Point2, RealField, Vector2};
use scara_kin::{
    Arm, Elbow, FollowError, InverseError, JointRange, Joints, Limits, TangentTool, Trig,
};
use test_support::at_least;

use crate::common::single;

/// Roundings of lengths that are a product with a power of ten, of a few hundred operations,
/// in machine epsilons.
const ROUNDING: f64 = 100.0;

/// One arm in two units of length.
#[derive(Debug, Clone, Copy)]
struct Pair<T: RealField> {
    arm: Arm<T>,
    scaled: Arm<T>,
    scale: T,
}

/// Link lengths, base coordinates and rotation, keep-out radius of an arm.
type Lengths = ([f64; 2], [f64; 3], f64);

fn lengths() -> impl Strategy<Value = Lengths> {
    let links = prop::array::uniform2(40.0..300.0f64);
    let base = (-400.0..400.0f64, -400.0..400.0f64, -PI..PI).prop_map(Into::into);
    (links, base, prop_oneof![Just(0.0), 0.0..30.0f64])
}

/// Poses that are not nearly straight or folded: there angles follow from positions with a loss
/// of digits.
fn pose() -> impl Strategy<Value = [f64; 2]> {
    (-PI..PI, 0.3..2.8f64, any::<bool>())
        .prop_map(|(shoulder, elbow, left)| [shoulder, if left { -elbow } else { elbow }])
}

impl<T: RealField + Trig> Pair<T> {
    fn new(lengths: Lengths, power: i32) -> Self {
        let scale = single::<T>(10f64.powi(power));
        let ([upper, fore], [x, y, turn], keep_out) = lengths;
        let range = JointRange::new(single(-20.0), single(15.0)).unwrap();
        let arm = |scale: T| {
            let at = Vector2::new(single::<T>(x), single(y)) * scale;
            Arm::new(single::<T>(upper) * scale, single::<T>(fore) * scale)
                .and_then(|arm| arm.with_base(Isometry2::new(at, single(turn))))
                .and_then(|arm| arm.with_keep_out(single::<T>(keep_out) * scale))
                .unwrap()
                .with_limits(Limits {
                    shoulder: range,
                    elbow: range,
                })
        };
        Self {
            arm: arm(T::one()),
            scaled: arm(scale),
            scale,
        }
    }

    /// `scaled` is `plain` in the other unit; `size` is what rounding is measured by.
    fn length(&self, plain: T, scaled: T, size: T) {
        let rounding = T::default_epsilon() * single(ROUNDING) * size;
        let off = scaled / self.scale - plain;
        assert!(off.abs() <= rounding, "{plain} {scaled} {off}");
    }

    fn vector(&self, plain: Vector2<T>, scaled: Vector2<T>, size: T) {
        self.length(plain.x, scaled.x, size);
        self.length(plain.y, scaled.y, size);
    }

    fn point(&self, plain: Point2<T>, scaled: Point2<T>) {
        self.vector(plain.coords, scaled.coords, self.span());
    }

    fn span(&self) -> T {
        self.arm.reach() + self.arm.base().translation.vector.norm()
    }
}

/// Angles or rates are the same.
fn same<T: RealField + Trig>(plain: [T; 2], scaled: [T; 2], size: T) {
    let rounding = T::default_epsilon() * single(ROUNDING) * size;
    for (plain, scaled) in plain.into_iter().zip(scaled) {
        assert!((plain - scaled).abs() <= rounding, "{plain} {scaled}");
    }
}

fn angles<T>(joints: Joints<T>) -> [T; 2] {
    [joints.shoulder, joints.elbow]
}

fn geometry<T: RealField + Trig>(pair: &Pair<T>) {
    let (arm, scaled) = (&pair.arm, &pair.scaled);
    for (a, b) in [
        (arm.upper(), scaled.upper()),
        (arm.fore(), scaled.fore()),
        (arm.reach(), scaled.reach()),
        (arm.inner_reach(), scaled.inner_reach()),
        (arm.keep_out(), scaled.keep_out()),
    ] {
        pair.length(a, b, pair.span());
    }
    let to_tolerance = arm.tolerance();
    pair.length(to_tolerance, scaled.tolerance(), to_tolerance);
    let base = |arm: &Arm<T>| arm.base().translation.vector;
    pair.vector(base(arm), base(scaled), pair.span());
}

fn positions<T: RealField + Trig>(pair: &Pair<T>, pose: [f64; 2]) {
    let (arm, scaled) = (&pair.arm, &pair.scaled);
    let joints = Joints::new(single::<T>(pose[0]), single(pose[1]));
    let point = arm.forward(joints);
    pair.point(point, scaled.forward(joints));
    pair.point(arm.elbow_position(joints), scaled.elbow_position(joints));
    // How many radians an epsilon of the lengths is worth.
    let worth = pair.span() / arm.singularity_distance(joints);
    let there = point * pair.scale;
    match (arm.inverse(point), scaled.inverse(there)) {
        (Ok(plain), Ok(scaled)) => {
            for ((elbow, a), (other, b)) in plain.iter().zip(scaled.iter()) {
                assert_eq!(elbow, other);
                same(angles(a), angles(b), worth);
            }
        }
        (Err(plain), Err(scaled)) => errors(pair, plain, scaled),
        (plain, scaled) => panic!("{plain:?} {scaled:?}"),
    }
    match (
        arm.inverse_nearest(point, joints),
        scaled.inverse_nearest(there, joints),
    ) {
        (Ok((elbow, plain)), Ok((other, scaled))) => {
            assert_eq!(elbow, other);
            same(angles(plain), angles(scaled), worth);
        }
        (Err(plain), Err(scaled)) => errors(pair, plain, scaled),
        (plain, scaled) => panic!("{plain:?} {scaled:?}"),
    }
    // Far beyond the reach.
    let beyond = Point2::new(pair.span() * single(9.0), T::zero());
    let plain = arm.inverse(beyond).unwrap_err();
    let scaled = scaled.inverse(beyond * pair.scale).unwrap_err();
    errors(pair, plain, scaled);
}

fn errors<T: RealField + Trig>(pair: &Pair<T>, plain: InverseError<T>, scaled: InverseError<T>) {
    use InverseError::{TooFar, TooNear};
    let lengths = |error| match error {
        TooFar { distance, reach } => (true, distance, reach),
        TooNear { distance, reach } => (false, distance, reach),
        other => panic!("{other}"),
    };
    let (is_far, distance, reach) = lengths(plain);
    let (is_also_far, other_distance, other_reach) = lengths(scaled);
    assert_eq!(is_far, is_also_far);
    pair.length(distance, other_distance, pair.span() + distance);
    pair.length(reach, other_reach, pair.span());
}

fn rates<T: RealField + Trig>(pair: &Pair<T>, pose: [f64; 2], given: [f64; 4]) {
    let (arm, scaled, scale) = (&pair.arm, &pair.scaled, pair.scale);
    let joints = Joints::new(single::<T>(pose[0]), single(pose[1]));
    let [a, b, c, d] = given.map(single::<T>);
    let (rates, others) = (Vector2::new(a, b), Vector2::new(c, d));
    let reach = arm.reach();
    let (plain, other) = (arm.jacobian(joints), scaled.jacobian(joints));
    for column in [0, 1] {
        pair.vector(
            plain.column(column).into(),
            other.column(column).into(),
            reach,
        );
    }
    let lever = arm.singularity_distance(joints);
    pair.length(lever, scaled.singularity_distance(joints), reach);
    let manipulability = scaled.manipulability(joints) / scale;
    pair.length(arm.manipulability(joints), manipulability, reach * reach);

    let velocity = arm.tool_velocity(joints, rates);
    let size = reach * single(100.0);
    pair.vector(velocity, scaled.tool_velocity(joints, rates), size);
    let acceleration = arm.tool_acceleration(joints, rates, others);
    pair.vector(
        acceleration,
        scaled.tool_acceleration(joints, rates, others),
        size * single(4.0),
    );

    let size = size / lever;
    let back = [
        arm.joint_rates(joints, velocity).unwrap(),
        scaled.joint_rates(joints, velocity * scale).unwrap(),
    ];
    same(back[0].into(), back[1].into(), size);
    let back = [
        arm.joint_accelerations(joints, rates, acceleration)
            .unwrap(),
        scaled
            .joint_accelerations(joints, rates, acceleration * scale)
            .unwrap(),
    ];
    same(back[0].into(), back[1].into(), size * single(4.0));

    let mut discs = [TangentTool::new(T::one()).unwrap(); 2];
    let [plain, other] = &mut discs;
    let plain = plain.follow(arm, joints, velocity).unwrap();
    let other = other.follow(scaled, joints, velocity * scale).unwrap();
    same([plain.tool_angle; 2], [other.tool_angle; 2], T::pi());
}

fn curves<T: RealField + Trig>(pair: &Pair<T>, from: [f64; 2], to: [f64; 2], tolerance: f64) {
    let (arm, scaled, scale) = (&pair.arm, &pair.scaled, pair.scale);
    let [from, to] = [from, to].map(|pose| Joints::new(single::<T>(pose[0]), single(pose[1])));
    let bound = arm.chord_bound(from, to);
    pair.length(bound, scaled.chord_bound(from, to), bound + arm.reach());
    let points = [from, to].map(|pose| arm.forward(pose));
    let there = points.map(|point| point * scale);
    let tolerance = arm.tolerance() + single::<T>(tolerance);
    let elbow = Elbow::of(&from).unwrap();
    let followed = [
        arm.follow_from(points, elbow, tolerance, from),
        scaled.follow_from(there, elbow, tolerance * scale, from),
    ];
    match followed {
        [Ok(plain), Ok(other)] => {
            assert_eq!(plain.remaining(), other.remaining());
            for (a, b) in plain.zip(other) {
                assert!(a.line == b.line && a.fraction == b.fraction);
                pair.point(a.point, b.point);
                let worth = pair.span() / arm.singularity_distance(a.joints);
                same(angles(a.joints), angles(b.joints), worth);
            }
        }
        [
            Err(FollowError::Unreachable { line, point, .. }),
            Err(FollowError::Unreachable {
                line: same,
                point: other,
                ..
            }),
        ]
        | [
            Err(FollowError::Singular { line, point, .. }),
            Err(FollowError::Singular {
                line: same,
                point: other,
                ..
            }),
        ] => {
            assert_eq!(line, same);
            pair.point(point, other);
        }
        [plain, other] => panic!("{:?} {:?}", plain.err(), other.err()),
    }
    let [plain, other] = [
        arm.follow(points, elbow, T::zero()).err(),
        scaled.follow(there, elbow, T::zero()).err(),
    ];
    if let (
        Some(FollowError::Tolerance { rounding: a, .. }),
        Some(FollowError::Tolerance { rounding: b, .. }),
    ) = (plain, other)
    {
        pair.length(a, b, a);
    }
}

proptest! {
    #![proptest_config(at_least(1000))]

    #[test]
    fn lengths_scale_and_angles_stay(
        lengths in lengths(),
        power in -6..=6,
        (from, to) in (pose(), pose()),
        given in prop::array::uniform4(-10.0..10.0f64),
        tolerance in (-2.0..1.0f64).prop_map(|exponent| 10f64.powf(exponent)),
    ) {
        let pair = Pair::<f64>::new(lengths, power);
        geometry(&pair);
        positions(&pair, from);
        rates(&pair, from, given);
        curves(&pair, from, to, tolerance);
        let pair = Pair::<f32>::new(lengths, power);
        geometry(&pair);
        positions(&pair, from);
        rates(&pair, from, given);
    }
}
