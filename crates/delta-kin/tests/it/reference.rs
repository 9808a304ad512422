//! Every row of the reference cases: solutions of 60-digit arithmetic.

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    Arm, AssemblyMode, Delta, Dimensions, ElbowSide, ForwardError, InverseError, Pose,
};

use crate::common::reach::reach_margins;

const CASES: &str = include_str!("../data/delta.csv");

/// By how much a rod misses its length at the computed angle, in machine epsilons of the span:
/// the rounding of an angle of up to π on the upper arm, and that of the check itself.
const LENGTH_ERROR: f64 = 4.0;

/// Angle error times the arm's lever, in machine epsilons of the span: what the angle's error
/// does to the rod's length.
const ANGLE_ERROR: f64 = 4.0;

/// Position error of `forward`, in machine epsilons of the span, times the conditioning.
const POSITION_ERROR: f64 = 4.0;

struct Row<'a> {
    fields: Vec<&'a str>,
}

impl Row<'_> {
    fn number(&self, column: usize) -> f64 {
        self.fields[column].parse().unwrap()
    }

    fn numbers(&self, column: usize) -> Vector3<f64> {
        Vector3::from([0, 1, 2].map(|k| self.number(column + k)))
    }

    fn delta(&self) -> Delta {
        let [base, platform, lower, upper] = [3, 4, 5, 6].map(|k| self.number(k));
        Delta::new(Dimensions {
            base,
            platform,
            upper,
            lower,
        })
        .unwrap()
    }

    fn point(&self) -> Point3<f64> {
        self.numbers(7).into()
    }

    fn id(&self) -> &str {
        self.fields[0]
    }

    fn is(&self, direction: &str, status: &str) -> bool {
        self.fields[1] == direction && self.fields[10] == status
    }
}

fn rows() -> impl Iterator<Item = Row<'static>> {
    CASES.lines().skip(1).map(|line| Row {
        fields: line.split(',').collect(),
    })
}

/// The place in the lower and in the upper assembly mode.
fn both(delta: &Delta, angles: Vector3<f64>) -> Result<[Point3<f64>; 2], ForwardError> {
    let upper = delta.with_assembly_mode(AssemblyMode::Upper);
    Ok([delta.forward(angles)?, upper.forward(angles)?])
}

/// The pose with all elbows as named, in the assembly mode that has it.
fn pose(delta: &Delta, point: Point3<f64>, elbow: ElbowSide) -> Pose {
    let delta = delta.with_working_mode([elbow; 3]);
    let upper = delta.with_assembly_mode(AssemblyMode::Upper);
    delta
        .pose_at(point)
        .or_else(|_| upper.pose_at(point))
        .unwrap()
}

#[test]
fn every_row_is_answered() {
    let mut counted = 0;
    for row in rows() {
        let delta = row.delta();
        match (row.fields[1], row.fields[10]) {
            ("ik", "ok") => assert!(delta.inverse(row.point()).is_ok(), "row {}", row.id()),
            ("ik", "unreachable") => assert!(delta.inverse(row.point()).is_err()),
            ("fk", "ok") => assert!(both(&delta, row.numbers(13)).is_ok()),
            other => panic!("row {}: {other:?}", row.id()),
        }
        counted += 1;
    }
    assert_eq!(counted, CASES.lines().count() - 1);
}

#[test]
fn unreachable_rows_name_an_arm_that_cannot() {
    for row in rows().filter(|row| row.is("ik", "unreachable")) {
        let (delta, mask) = (row.delta(), row.fields[11].as_bytes());
        let (arm, by) = match delta.inverse(row.point()) {
            Err(InverseError::TooFar { arm, by } | InverseError::TooNear { arm, by }) => (arm, by),
            other => panic!("row {}: {other:?}", row.id()),
        };
        let margins = reach_margins(delta.arms(), row.point());
        for ((each, reaches), margin) in Arm::ALL.into_iter().zip(mask).zip(&margins) {
            assert_eq!(*margin > 0.0, *reaches == b'1', "row {}: {each}", row.id());
            assert!(each != arm || *reaches == b'0', "row {}", row.id());
        }
        assert!((by + margins.min()).abs() <= delta.tolerance());
    }
}

#[test]
fn angles_are_exact_to_the_arms_lever() {
    let (mut worst_angle, mut worst_length) = (0f64, 0f64);
    for row in rows().filter(|row| row.is("ik", "ok")) {
        let delta = row.delta();
        for (elbow, column) in [(ElbowSide::Out, 13), (ElbowSide::In, 16)] {
            let pose = pose(&delta, row.point(), elbow);
            let errors = pose.angles() - row.numbers(column);
            let unit = f64::EPSILON * delta.span();
            for (error, lever) in errors.iter().zip(&pose.levers()) {
                let turns = (error / core::f64::consts::TAU).round();
                let shift = ((error - turns * core::f64::consts::TAU) * lever).abs();
                assert!(shift <= ANGLE_ERROR * unit, "row {}: {shift:e}", row.id());
                worst_angle = worst_angle.max(shift / unit);
            }
            for rod in pose.rods() {
                let miss = (rod.norm() - 1.0).abs() * row.number(5);
                assert!(miss <= LENGTH_ERROR * unit, "row {}: {miss:e}", row.id());
                worst_length = worst_length.max(miss / unit);
            }
        }
    }
    println!("worst {worst_angle} (angle), {worst_length} (length) epsilons of the span");
}

#[test]
fn both_assemblies_are_exact_to_their_conditioning() {
    let mut worst = 0f64;
    for row in rows().filter(|row| row.is("fk", "ok")) {
        let delta = row.delta();
        let [lower, upper] = both(&delta, row.numbers(13)).unwrap();
        let pose = delta.pose_of(row.numbers(13)).unwrap();
        let unit = f64::EPSILON * delta.span() / pose.parallel_distance();
        for (found, column) in [(lower, 19), (upper, 22)] {
            let error = (found.coords - row.numbers(column)).norm();
            assert!(
                error <= POSITION_ERROR * unit,
                "row {}: {error:e}, {}",
                row.id(),
                error / unit
            );
            worst = worst.max(error / unit);
        }
    }
    println!("worst {worst} epsilons of the span, times the conditioning");
}

#[test]
fn forward_of_inverse_is_the_point() {
    let mut worst = 0f64;
    for row in rows().filter(|row| row.is("ik", "ok")) {
        let (delta, point) = (row.delta(), row.point());
        for elbows in [ElbowSide::Out, ElbowSide::In] {
            let pose = pose(&delta, point, elbows);
            let found = both(&delta, pose.angles()).unwrap();
            let error = found.map(|place| (place - point).norm());
            let error = error[0].min(error[1]);
            let unit = f64::EPSILON * delta.span() / pose.parallel_distance();
            assert!(
                error <= 2.0 * POSITION_ERROR * unit,
                "row {}: {error:e}, {}",
                row.id(),
                error / unit
            );
            worst = worst.max(error / unit);
        }
    }
    println!("worst {worst} epsilons of the span, times the conditioning");
}
