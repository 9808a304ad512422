//! A change of the unit of length changes every length that comes out by the same factor, and
//! nothing else.

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    Arm, ArmGeometry, ArmRange, AssemblyMode, CalibrationError, Delta, Dimensions, ElbowSide,
    FollowError, ForwardError, InverseError, Measured, Parameter, PlatformPath, Pose, Quantity,
    SpeedLimits, WorkspaceError,
};
use proptest::prelude::*;
use test_support::at_least;

use crate::common::uneven::{modes, uneven_arms};

/// What rounding of the numbers that go in does to those that come out, in units of their own
/// size or the span's, where no singularity and no edge is near.
const ROUNDING: f64 = 1e-9;

/// What is asked of a machine, in its first unit.
#[derive(Debug, Clone)]
struct Case {
    arms: [ArmGeometry; 3],
    assembly_mode: AssemblyMode,
    working_mode: [ElbowSide; 3],
    angles: [f64; 3],
    other: [f64; 3],
    is_limited: bool,
}

fn cases() -> impl Strategy<Value = Case> {
    (
        uneven_arms(),
        modes(),
        prop::array::uniform3(-3.1..3.1f64),
        prop::array::uniform3(-0.05..0.05f64),
        any::<bool>(),
    )
        .prop_map(
            |(arms, (assembly_mode, working_mode), angles, other, is_limited)| Case {
                arms,
                assembly_mode,
                working_mode,
                angles,
                other,
                is_limited,
            },
        )
}

/// Everything that comes out: a name, a value and the power of length that it is.
#[derive(Debug, Default)]
struct Answers(Vec<(String, f64, i32)>);

impl Answers {
    fn number(&mut self, name: &str, value: f64, power: i32) {
        self.0.push((name.into(), value, power));
    }

    fn numbers<'a>(&mut self, name: &str, values: impl IntoIterator<Item = &'a f64>, power: i32) {
        for value in values {
            self.number(name, *value, power);
        }
    }

    /// What is not a number has to be the same.
    fn word(&mut self, word: &str) {
        self.number(word, 0.0, 0);
    }

    fn refusal(&mut self, error: &InverseError) {
        match error {
            InverseError::TooFar { arm, by } => self.number(&format!("{arm} too far"), *by, 1),
            InverseError::TooNear { arm, by } => self.number(&format!("{arm} too near"), *by, 1),
            other => self.word(&other.to_string()),
        }
    }
}

impl Case {
    fn delta(&self, unit: f64) -> Option<Delta> {
        let arms = self.arms.map(|arm| ArmGeometry {
            base: arm.base * unit,
            platform: arm.platform * unit,
            upper: arm.upper * unit,
            lower: arm.lower * unit,
            ..arm
        });
        let delta = Delta::from_arms(arms).ok()?;
        let delta = delta
            .with_assembly_mode(self.assembly_mode)
            .with_working_mode(self.working_mode);
        if !self.is_limited {
            return Some(delta);
        }
        let range = |angle: f64| ArmRange::new(angle - 1.0, angle + 0.5).unwrap();
        Some(
            delta
                .with_ranges(self.angles.map(range))
                .with_ball_joints(1.2)
                .unwrap(),
        )
    }

    fn answers(&self, unit: f64) -> Option<Answers> {
        let delta = self.delta(unit)?;
        let mut answers = Answers::default();
        answers.number("span", delta.span(), 1);
        answers.number("tolerance", delta.tolerance(), 1);
        let angles = Vector3::from(self.angles);
        let pose = match delta.pose_of(angles) {
            Ok(pose) => pose,
            Err(ForwardError::Apart { arm, by }) => {
                answers.number(&format!("{arm} apart"), by, 1);
                return Some(answers);
            }
            Err(other) => {
                answers.word(&other.to_string());
                return Some(answers);
            }
        };
        // Near singularities and edges rounding decides.
        let is_clear = |pose: &Pose| {
            pose.parallel_distance() > 0.05 && pose.serial_distance().1 > 0.02 * delta.span()
        };
        if !is_clear(&pose) {
            return Some(answers);
        }
        pose_answers(&pose, unit, &mut answers);
        // Out of the unit, as a user has it in his drawing.
        let at = |x: f64, y: f64, z: f64| {
            let span = delta.span() / unit;
            Point3::new(x * span, y * span, z * span) * unit
        };
        for point in [pose.point(), at(0.1, -0.05, -0.4), at(0.9, 0.1, 0.1)] {
            match delta.pose_at(point) {
                Ok(pose) if is_clear(&pose) => {
                    answers.numbers("inverse", &pose.angles(), 0);
                    answers.number("clearance", delta.clearance(point), 1);
                }
                Ok(_) => {}
                Err(error) => answers.refusal(&error),
            }
        }
        let to = delta.pose_of(angles + Vector3::from(self.other) / 10.0);
        if let Ok(to) = to
            && is_clear(&to)
        {
            match delta.chord_bound(&pose, &to) {
                Some(bound) => answers.number("chord bound", bound, 1),
                None => answers.word("no chord bound"),
            }
        }
        Some(answers)
    }
}

fn pose_answers(pose: &Pose, unit: f64, answers: &mut Answers) {
    answers.numbers("point", &pose.point().coords, 1);
    answers.numbers(
        "elbows",
        pose.elbows().iter().flat_map(|elbow| elbow.iter()),
        1,
    );
    answers.numbers("rods", pose.rods().iter().flat_map(|rod| rod.iter()), 0);
    answers.numbers("levers", &pose.levers(), 1);
    answers.number("serial", pose.serial_distance().1, 1);
    answers.number("parallel", pose.parallel_distance(), 0);
    answers.numbers("jacobian", &pose.jacobian().unwrap(), 1);
    answers.number("manipulability", pose.manipulability().unwrap(), 3);
    let vector = Vector3::new(0.3, -0.2, 0.7);
    answers.numbers("velocity", &pose.platform_velocity(vector).unwrap(), 1);
    answers.numbers("rates", &pose.joint_rates(vector * unit).unwrap(), 0);
    answers.numbers("torques", &pose.holding_torques(vector).unwrap(), 1);
    answers.numbers("rod forces", &pose.rod_forces(vector).unwrap(), 0);
}

/// What is slower to ask: paths, slices, the largest cylinder, a calibration.
fn slow_answers(delta: &Delta, unit: f64) -> Answers {
    let mut answers = Answers::default();
    let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z) * unit;
    let line = PlatformPath::line(at(80.0, 20.0, -280.0), at(-70.0, 30.0, -250.0)).unwrap();
    let arc = PlatformPath::arc(
        at(80.0, 20.0, -280.0),
        at(0.0, 0.0, -280.0),
        Vector3::z() * unit,
        4.0,
    )
    .unwrap();
    let limits = SpeedLimits::new(200.0 * unit, [3.0; 3]).unwrap();
    for path in [line, arc] {
        answers.number("length", path.length(), 1);
        answers.numbers("place", &path.point_at(0.3).unwrap().coords, 1);
        for waypoint in delta.follow(path, 0.05 * unit, limits).unwrap() {
            answers.numbers("angles", &waypoint.angles, 0);
            answers.numbers("waypoint", &waypoint.point.coords, 1);
            answers.number("fraction", waypoint.fraction, 0);
            answers.number("step", waypoint.length, 1);
            answers.number("duration", waypoint.duration_s, 0);
        }
    }
    let out = PlatformPath::line(at(0.0, 0.0, -280.0), at(400.0, 0.0, -280.0)).unwrap();
    match delta.follow(out, 0.05 * unit, limits) {
        Err(FollowError::Unreachable {
            fraction, point, ..
        }) => {
            answers.number("unreachable", fraction, 0);
            answers.numbers("unreachable", &point.coords, 1);
        }
        other => panic!("{other:?}"),
    }
    match delta.follow(line, 1e-13 * unit, limits) {
        Err(FollowError::Tolerance { rounding, .. }) => answers.number("rounding", rounding, 1),
        other => panic!("{other:?}"),
    }
    let heights = [-290.0 * unit, -230.0 * unit];
    let radius = delta.largest_cylinder(heights, 4.0 * unit).unwrap();
    answers.number("cylinder", radius, 1);
    match delta.largest_cylinder(heights, 0.0) {
        Err(WorkspaceError::Resolution { min, .. }) => answers.number("resolution", min, 1),
        other => panic!("{other:?}"),
    }
    let flat = delta.horizontal_slice(-260.0 * unit, 7).unwrap();
    let upright = delta.vertical_slice(0.4, -260.0 * unit, 7).unwrap();
    for point in flat.chain(upright) {
        answers.numbers("outline", &point.coords, 1);
    }
    calibration_answers(delta, unit, &mut answers);
    answers
}

fn calibration_answers(drawn: &Delta, unit: f64, answers: &mut Answers) {
    let mut arms = *drawn.arms();
    arms[1].zero += 0.01;
    arms[2].lower += 0.4 * unit;
    let real = drawn.with_arms(arms).unwrap();
    let measured: Vec<Measured> = (0..30)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * 2.4).sin_cos();
            let z = -240.0 - 2.0 * f64::from(k);
            let point = Point3::new(80.0 * cos, 80.0 * sin, z) * unit;
            Measured {
                angles: real.inverse(point).unwrap(),
                point: point + Vector3::new(cos, sin * cos, -sin) * (0.02 * unit),
            }
        })
        .collect();
    let parameters = [
        (Parameter::of(Quantity::Zero, Arm::Second), 0),
        (Parameter::of(Quantity::Lower, Arm::Third), 1),
        (Parameter::common(Quantity::Base), 1),
        (Parameter::common(Quantity::Platform), 1),
        (Parameter::common(Quantity::Azimuth), 0),
    ];
    let found = drawn
        .calibrate(parameters.map(|(parameter, _)| parameter), &measured)
        .unwrap();
    for (k, (parameter, power)) in parameters.into_iter().enumerate() {
        answers.number(&parameter.to_string(), found.changes()[k], power);
        match found.deviations()[k] {
            Some(deviation) => answers.number("deviation", deviation, power),
            None => answers.word("no deviation"),
        }
        for free in found.null_space() {
            // To a sign, which is rounding's.
            answers.number("null space", free[k] * free[2], power + 1);
        }
    }
    answers.number("rms", found.rms(), 1);
    answers.number("largest", found.largest(), 1);
    answers.number("rank", f64::from(u8::try_from(found.rank()).unwrap()), 0);
    answers.number("conditioning", found.conditioning() + 1.0, 0);
    answers.number(
        "undetermined",
        f64::from(u8::try_from(found.undetermined().count()).unwrap()),
        0,
    );
    let arms = found.machine().arms().map(|arm| arm.lower);
    answers.numbers("lower", &arms, 1);
    // One measurement cannot fit: the rms of what is left at the start.
    let far = Measured {
        angles: measured[0].angles,
        point: measured[0].point * 2.0,
    };
    match drawn.calibrate([Parameter::common(Quantity::Azimuth)], &[far; 3]) {
        Ok(found) => answers.number("far", found.rms(), 1),
        Err(CalibrationError::NotConverged { rms, .. }) => answers.number("far", rms, 1),
        Err(other) => answers.word(&other.to_string()),
    }
}

fn same(one: &Answers, other: &Answers, unit: f64, span: f64, rounding: f64) -> Result<(), String> {
    if one.0.len() != other.0.len() {
        return Err(format!("{} answers, {}", one.0.len(), other.0.len()));
    }
    for ((name, value, power), (again, scaled, _)) in one.0.iter().zip(&other.0) {
        let wanted = value * unit.powi(*power);
        let size = value.abs().max(span.powi(*power)) * unit.powi(*power);
        if name != again || (scaled - wanted).abs() > rounding * size {
            return Err(format!(
                "{name} {wanted:e}, {again} {scaled:e} in 1/{unit:e}"
            ));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(at_least(1000))]

    /// 10^-6 to 10^6 units to the drawing's, to rounding; and by powers of two, to the last bit.
    #[test]
    fn lengths_scale_and_nothing_else_does(case in cases(), k in -6..=6i32, j in -60..=60i32) {
        let Some(one) = case.answers(1.0) else {
            return Ok(());
        };
        let span = case.delta(1.0).map_or(1.0, |delta| delta.span());
        for (unit, rounding) in [(10f64.powi(k), ROUNDING), (2f64.powi(j), 0.0)] {
            let other = case.answers(unit).unwrap();
            prop_assert_eq!(same(&one, &other, unit, span, rounding), Ok(()));
        }
    }
}

#[test]
fn paths_workspace_and_calibration_scale() {
    let delta = |unit: f64| {
        Delta::new(Dimensions {
            base: 42.0 * unit,
            platform: 18.0 * unit,
            upper: 120.0 * unit,
            lower: 243.0 * unit,
        })
        .unwrap()
        .with_range(ArmRange::new(-0.5, 2.2).unwrap())
    };
    let one = slow_answers(&delta(1.0), 1.0);
    for k in -6..=6 {
        for (unit, rounding) in [(10f64.powi(k), ROUNDING), (2f64.powi(10 * k), 0.0)] {
            let other = slow_answers(&delta(unit), unit);
            assert_eq!(same(&one, &other, unit, 423.0, rounding), Ok(()));
        }
    }
}
