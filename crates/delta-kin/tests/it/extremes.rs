//! Every public function with anything: NaN, infinities, negative sizes, the largest and the least
//! numbers. It answers rightly or with an error; nothing that comes out is not a number.

use delta_kin::nalgebra::{self, Point3, RealField, Vector3};
use delta_kin::{
    Arm, ArmGeometry, ArmRange, AssemblyMode, Delta, Dimensions, ElbowSide, InverseError, Measured,
    Parameter, PlatformPath, Pose, Positive, Quantity, SpeedLimits, Trig, ZAxis,
};
use proptest::prelude::*;
use test_support::at_least;

/// By how much rods may miss their lengths, in machine epsilons of the span: what is taken as on an
/// edge, and rounding.
const ROD: f64 = 16.0 + 4.0;
/// What `forward` of an answer may be off, three such rods, in the same over the sine of the rods,
/// where that is above so many roots of the machine epsilon.
const ROUND_TRIP: f64 = 1.8 * ROD;
const SINGULAR: f64 = 64.0;

/// Numbers as they come from a broken file, a dead sensor or a division by zero.
fn anything() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        f64::NAN,
        f64::INFINITY,
        f64::MAX,
        1e300,
        1e160,
        1e77,
        1e39,
        1e30,
        f64::EPSILON,
        1e-30,
        1e-46,
        1e-160,
        1e-310,
        f64::MIN_POSITIVE,
        5e-324,
        0.0,
        1.0,
    ]);
    let signed = (special, any::<bool>())
        .prop_map(|(value, is_negative)| if is_negative { -value } else { value });
    prop_oneof![
        2 => signed,
        1 => -400.0..400.0f64,
        1 => -4.0..4.0f64,
    ]
}

/// Numbers in the order in which they are asked for.
struct Source(Vec<f64>, usize);

impl Source {
    fn next<T: RealField>(&mut self) -> T {
        self.1 += 1;
        nalgebra::convert(self.0[self.1 % self.0.len()])
    }

    fn vector<T: RealField>(&mut self) -> Vector3<T> {
        Vector3::new(self.next(), self.next(), self.next())
    }

    /// One time in four anything, else as given.
    fn mostly<T: RealField>(&mut self, usual: f64) -> T {
        let is_odd = self.next::<f64>().to_bits().is_multiple_of(4);
        if is_odd {
            self.next()
        } else {
            nalgebra::convert(usual)
        }
    }

    fn pick<A: Copy>(&mut self, choices: &[A]) -> A {
        let bits = self.next::<f64>().to_bits();
        let at = usize::try_from((bits ^ (bits >> 29)) % 1024).unwrap();
        choices[at % choices.len()]
    }
}

fn wide<T: RealField>(value: T) -> f64 {
    nalgebra::try_convert(value).unwrap()
}

fn finite<'a, T: RealField>(values: impl IntoIterator<Item = &'a T>) -> Result<(), TestCaseError> {
    for value in values {
        prop_assert!(value.is_finite(), "{value}");
    }
    Ok(())
}

/// An answer is finite, and so are the numbers of a refusal, unless they were given: a refusal can
/// be read.
fn read<A, E: core::error::Error>(answer: Result<A, E>) -> Option<A> {
    answer
        .inspect_err(|error| assert!(error.to_string().len() < 300, "{error}"))
        .ok()
}

fn machine<T: RealField + Trig>(numbers: &mut Source) -> Option<Delta<T>> {
    let size = numbers.pick(&[1.0, 1.0, 1e-6, 1e6, 1e-37, 1e30, 1e75]);
    let lengths = [0.42, 0.18, 1.2, 2.43].map(|length| length * size);
    let mut arms = Arm::ALL.map(|arm| {
        let [base, platform, upper, lower] = lengths.map(nalgebra::convert);
        ArmGeometry::nominal(
            arm,
            Dimensions {
                base,
                platform,
                upper,
                lower,
            },
        )
    });
    // One in two machines has one odd number.
    if numbers.pick(&[true, false]) {
        let (odd, arm) = (numbers.next(), numbers.pick(&[0, 1, 2]));
        let arm = &mut arms[arm];
        *match numbers.pick(&[0, 1, 2, 3, 4, 5]) {
            0 => &mut arm.azimuth,
            1 => &mut arm.base,
            2 => &mut arm.platform,
            3 => &mut arm.upper,
            4 => &mut arm.lower,
            _ => &mut arm.zero,
        } = odd;
    }
    let mut delta = read(Delta::from_arms(arms))?
        .with_z(numbers.pick(&[ZAxis::Up, ZAxis::Down]))
        .with_positive(numbers.pick(&[Positive::Outward, Positive::Inward]))
        .with_assembly_mode(numbers.pick(&[AssemblyMode::Lower, AssemblyMode::Upper]))
        .with_working_mode([0; 3].map(|_| numbers.pick(&[ElbowSide::Out, ElbowSide::In])));
    delta = read(delta.with_zero(numbers.mostly(0.3))).unwrap_or(delta);
    delta = read(delta.with_ball_joints(numbers.mostly(1.5))).unwrap_or(delta);
    if let Some(range) = read(ArmRange::new(numbers.mostly(-3.0), numbers.mostly(3.1))) {
        prop_assert_range(&range, numbers);
        delta = delta.with_range(range);
    }
    Some(delta)
}

fn prop_assert_range<T: RealField + Trig>(range: &ArmRange<T>, numbers: &mut Source) {
    assert!(range.min() < range.max() && (range.max() - range.min()).is_finite());
    let angle: T = numbers.next();
    assert_eq!(
        range.contains(angle),
        angle >= range.min() && angle <= range.max()
    );
}

/// What is promised of a pose: it meets its lengths, and `forward` of it is where it is.
fn is_right<T: RealField + Trig>(delta: &Delta<T>, pose: &Pose<T>) -> Result<(), TestCaseError> {
    let epsilon = wide(T::default_epsilon());
    // Of angles many turns from zero their own rounding counts.
    let tolerance = wide(delta.tolerance());
    let unit = (wide(delta.span()) * epsilon).max(tolerance / 16.0);
    for (rod, arm) in pose.rods().iter().zip(delta.arms()) {
        let miss = (wide(rod.norm()) - 1.0).abs() * wide(arm.lower);
        prop_assert!(miss <= ROD * unit, "{}", miss / unit);
    }
    finite(&pose.angles())?;
    finite(&pose.point().coords)?;
    finite(pose.elbows().iter().flat_map(|elbow| elbow.iter()))?;
    finite(&pose.levers())?;
    finite([&pose.serial_distance().1, &pose.parallel_distance()])?;
    let sine = wide(pose.parallel_distance());
    prop_assert!((0.0..1.0 + 1e-5).contains(&sine));
    let made = delta.forward(pose.angles());
    prop_assert!(made.is_ok(), "{made:?}");
    if sine > SINGULAR * epsilon.sqrt() {
        let apart = wide((made.unwrap_or(pose.point()) - pose.point()).norm());
        prop_assert!(apart * sine <= ROUND_TRIP * unit, "{}", apart * sine / unit);
    }
    Ok(())
}

fn statics<T: RealField + Trig>(pose: &Pose<T>, numbers: &mut Source) -> Result<(), TestCaseError> {
    if let Some(jacobian) = read(pose.jacobian()) {
        finite(&jacobian)?;
    }
    if let Some(manipulability) = read(pose.manipulability()) {
        finite([&manipulability])?;
    }
    let vector = numbers.vector();
    let is_given = vector.iter().all(T::is_finite);
    for answer in [
        pose.platform_velocity(vector),
        pose.joint_rates(vector),
        pose.holding_torques(vector),
        pose.rod_forces(vector),
    ] {
        if let Some(answer) = read(answer) {
            prop_assert!(is_given);
            finite(&answer)?;
        }
    }
    Ok(())
}

fn follows<T: RealField + Trig>(
    delta: &Delta<T>,
    near: Point3<T>,
    numbers: &mut Source,
) -> Result<(), TestCaseError> {
    let span = wide(delta.span());
    let to = Point3::new(
        numbers.mostly(wide(near.x)),
        numbers.mostly(wide(near.y) + 0.01 * span),
        numbers.mostly(wide(near.z)),
    );
    let centre = Point3::new(near.x, near.y + numbers.mostly(0.02 * span), near.z);
    let axis = Vector3::new(
        numbers.mostly(0.0),
        numbers.mostly(0.0),
        numbers.mostly(1.0),
    );
    let arc = PlatformPath::arc(near, centre, axis, numbers.mostly(0.7));
    let limits = SpeedLimits::new(
        numbers.mostly(span),
        [
            numbers.mostly(3.0),
            numbers.mostly(3.0),
            numbers.mostly(3.0),
        ],
    );
    let mut tolerance: T = numbers.mostly(1e-3 * span);
    // As fine as this is refused, or takes a minute of waypoints.
    let is_fine = wide(tolerance) < 1e-6 * span;
    if is_fine && wide(tolerance) > 64.0 * wide(delta.tolerance()) {
        tolerance = nalgebra::convert(1e-6 * span);
    }
    for path in [PlatformPath::line(near, to), arc]
        .into_iter()
        .filter_map(read)
    {
        finite([&path.length()])?;
        let share: T = numbers.mostly(0.5);
        if let Some(place) = path.point_at(share) {
            prop_assert!(share >= T::zero() && share <= T::one());
            finite(&place.coords)?;
        }
        let Some(limits) = read(limits) else { continue };
        let Some(follow) = read(delta.follow(path, tolerance, limits)) else {
            continue;
        };
        let expected = follow.remaining();
        let mut count = 0;
        for waypoint in follow.take(1000) {
            finite(&waypoint.angles)?;
            finite(&waypoint.point.coords)?;
            finite([&waypoint.fraction, &waypoint.length, &waypoint.duration_s])?;
            prop_assert!(waypoint.duration_s >= T::zero());
            prop_assert_eq!(delta.inverse(waypoint.point).ok(), Some(waypoint.angles));
            count += 1;
        }
        prop_assert_eq!(count, expected.min(1000));
    }
    Ok(())
}

fn reaches<T: RealField + Trig>(
    delta: &Delta<T>,
    point: Point3<T>,
    numbers: &mut Source,
) -> Result<(), TestCaseError> {
    let clearance = delta.clearance(point);
    finite([&clearance])?;
    prop_assert!(clearance >= T::zero());
    prop_assert!(clearance <= T::zero() || delta.is_reachable(point));
    let span = wide(delta.span());
    let z: T = numbers.mostly(wide(point.z));
    let flat = delta.horizontal_slice(z, 3);
    let upright = delta.vertical_slice(numbers.mostly(0.5), z, 3);
    let slices = [
        read(flat).map(Vec::from_iter),
        read(upright).map(Vec::from_iter),
    ];
    for slice in slices.into_iter().flatten() {
        prop_assert_eq!(slice.len(), 3);
        for edge in slice {
            prop_assert!(delta.is_reachable(edge), "{edge}");
        }
    }
    let heights = [z, numbers.mostly(wide(point.z) - 0.01 * span)];
    let resolution = numbers.mostly(span / 64.0);
    if let Some(radius) = read(delta.largest_cylinder(heights, resolution)) {
        for (x, height) in [(radius, heights[0]), (-radius, heights[1])] {
            let rim = Point3::new(x, T::zero(), height);
            prop_assert!(delta.is_reachable(rim), "{rim}");
        }
    }
    Ok(())
}

fn calibrates(delta: &Delta, pose: &Pose, numbers: &mut Source) -> Result<(), TestCaseError> {
    let good = Measured {
        angles: pose.angles(),
        point: pose.point(),
    };
    let mut measured = [good; 4];
    measured[1].point.x += delta.span() * 1e-3;
    if numbers.pick(&[true, false]) {
        measured[2].point.y = numbers.next();
        measured[3].angles.z = numbers.mostly(good.angles.z);
    }
    let parameters = [
        Parameter::of(Quantity::Zero, Arm::First),
        Parameter::common(Quantity::Lower),
    ];
    if let Some(found) = read(delta.calibrate(parameters, &measured)) {
        finite(found.changes())?;
        finite([&found.rms(), &found.largest(), &found.conditioning()])?;
        finite(found.deviations().iter().flatten())?;
        finite(found.null_space().flatten().collect::<Vec<_>>().iter())?;
        prop_assert!(found.rank() + found.null_space().count() == 2);
        prop_assert!(found.rms() <= found.largest() * (1.0 + 1e-6));
    }
    let none = delta.calibrate([], &measured);
    if let Some(found) = read(none) {
        prop_assert_eq!(found.rank(), 0);
        finite([&found.rms(), &found.conditioning()])?;
    }
    Ok(())
}

/// Angles as they are, or anything.
fn angles<T: RealField + Trig>(delta: &Delta<T>, numbers: &mut Source) -> Vector3<T> {
    let zero = wide(delta.arms()[0].zero);
    Vector3::new(
        numbers.mostly(1.0 - zero),
        numbers.mostly(0.8 - zero),
        numbers.mostly(1.1 - zero),
    )
}

fn calibration(numbers: &mut Source) -> Result<(), TestCaseError> {
    let Some(delta) = machine::<f64>(numbers) else {
        return Ok(());
    };
    let angles = angles(&delta, numbers);
    match read(delta.pose_of(angles)) {
        Some(pose) => calibrates(&delta, &pose, numbers),
        None => Ok(()),
    }
}

fn everything<T: RealField + Trig>(numbers: &mut Source) -> Result<(), TestCaseError> {
    let Some(delta) = machine::<T>(numbers) else {
        return Ok(());
    };
    finite([&delta.span(), &delta.tolerance()])?;
    let angles = angles(&delta, numbers);
    let point = match read(delta.pose_of(angles)) {
        Some(pose) => {
            is_right(&delta, &pose)?;
            statics(&pose, numbers)?;
            pose.point()
        }
        None => Point3::origin(),
    };
    let odd = Point3::new(
        numbers.mostly(wide(point.x)),
        numbers.mostly(wide(point.y)),
        numbers.mostly(wide(point.z)),
    );
    for point in [point, odd] {
        match delta.pose_at(point) {
            Ok(pose) => {
                is_right(&delta, &pose)?;
                statics(&pose, numbers)?;
                if let Some(bound) = delta.chord_bound(&pose, &pose) {
                    finite([&bound])?;
                }
            }
            Err(InverseError::TooFar { by, .. } | InverseError::TooNear { by, .. }) => {
                finite([&by])?;
            }
            Err(other) => drop(read::<(), _>(Err(other))),
        }
        follows(&delta, point, numbers)?;
        reaches(&delta, point, numbers)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(at_least(256))]

    #[test]
    fn anything_is_answered_rightly_or_refused(numbers in prop::collection::vec(anything(), 97)) {
        everything::<f64>(&mut Source(numbers.clone(), 0))?;
        everything::<f32>(&mut Source(numbers.clone(), 0))?;
        calibration(&mut Source(numbers, 0))?;
    }
}
