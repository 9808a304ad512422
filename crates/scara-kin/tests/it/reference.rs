//! Every row of the reference cases: solutions of 60-digit arithmetic.

use scara_kin::nalgebra::{Point2, Vector2};
use scara_kin::{Arm, Elbow, InverseError, Joints};

const CASES: &str = include_str!("../data/scara.csv");

/// Tip error of the inverse alone, in units of the reach: half a unit in the last
/// place of two angles of up to π, and the rounding inside.
const TIP_ERROR: f64 = 4e-16;

/// Tip error of `forward(inverse(p))`, in units of the reach.
const ROUND_TRIP: f64 = 1e-15;

/// Relative error of the determinant, times its own conditioning: the angle's rounding.
const DETERMINANT: f64 = 1e-15;

/// 2π to 32 digits.
const TAU: Exact = Exact {
    high: core::f64::consts::TAU,
    low: 2.449_293_598_294_706_4e-16,
};

/// A number of more digits than an `f64` holds: the sum of two.
#[derive(Clone, Copy)]
struct Exact {
    high: f64,
    low: f64,
}

impl Exact {
    /// The low part comes from the decimal digits behind those of `high`.
    fn parse(text: &str) -> Self {
        let high: f64 = text.parse().unwrap();
        // All decimal digits of a double are exact: subtract digit by digit.
        let (wanted, have) = (digits(text), digits(&format!("{high:.60e}")));
        Self {
            high,
            low: wanted.minus(&have),
        }
    }

    /// `computed` less this, whole turns aside.
    fn error_of(self, computed: f64) -> f64 {
        let error = computed - self.high;
        let turns = (error / TAU.high).round();
        (error - turns * TAU.high) - turns * TAU.low - self.low
    }
}

/// A decimal number of at most a few whole digits, in units of 1e-35.
struct Decimal(i128);

fn digits(text: &str) -> Decimal {
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let exponent: i32 = exponent.parse().unwrap();
    let negative = mantissa.starts_with('-');
    let mantissa = mantissa.trim_start_matches('-');
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let point = i32::try_from(whole.len()).unwrap() + exponent;
    let all: Vec<u8> = whole.bytes().chain(fraction.bytes()).collect();
    let mut value = 0i128;
    for place in 0..point + 35 {
        let index = usize::try_from(place).ok();
        let digit = index
            .and_then(|index| all.get(index))
            .map_or(0, |d| d - b'0');
        value = value * 10 + i128::from(digit);
    }
    Decimal(if negative { -value } else { value })
}

impl Decimal {
    #[expect(clippy::cast_precision_loss, reason = "the difference is small")]
    fn minus(&self, other: &Self) -> f64 {
        (self.0 - other.0) as f64 * 1e-35
    }
}

struct Row<'a> {
    fields: Vec<&'a str>,
}

impl Row<'_> {
    fn number(&self, column: usize) -> f64 {
        self.fields[column].parse().unwrap()
    }

    fn arm(&self) -> Arm {
        Arm::new(self.number(2), self.number(3)).unwrap()
    }

    fn point(&self) -> Point2<f64> {
        Point2::new(self.number(4), self.number(5))
    }
}

fn rows() -> impl Iterator<Item = Row<'static>> {
    CASES.lines().skip(1).map(|line| Row {
        fields: line.split(',').collect(),
    })
}

/// Distance between the tips of the computed and of the exact joints: the Jacobian and,
/// where it is singular, the second derivative.
fn tip_error(arm: &Arm, joints: Joints, shoulder: Exact, elbow: Exact) -> f64 {
    let (d1, d2) = (
        shoulder.error_of(joints.shoulder),
        elbow.error_of(joints.elbow),
    );
    let first = arm.tool_velocity(joints, Vector2::new(d1, d2));
    let second = arm.tool_acceleration(joints, Vector2::new(d1, d2), Vector2::zeros());
    (first + second * 0.5).norm()
}

#[test]
fn every_row_is_answered() {
    let mut counted = 0;
    for row in rows() {
        let (arm, status) = (row.arm(), row.fields[6]);
        match (status, arm.inverse(row.point())) {
            ("ok", Ok(_))
            | ("too_far", Err(InverseError::TooFar { .. }))
            | ("too_near", Err(InverseError::TooNear { .. }))
            | ("degenerate", Err(InverseError::AnyAngle)) => counted += 1,
            (_, answer) => panic!("row {}: {status}, but {answer:?}", row.fields[0]),
        }
    }
    assert_eq!(counted, CASES.lines().count() - 1);
}

#[test]
fn gaps_are_reported() {
    for row in rows() {
        let (gap, arm) = (row.number(7), row.arm());
        let found = match arm.inverse(row.point()) {
            Err(InverseError::TooFar { distance, reach }) => distance - reach,
            Err(InverseError::TooNear { distance, reach }) => reach - distance,
            _ => continue,
        };
        assert!(
            (found - gap).abs() <= arm.tolerance(),
            "row {}: {found} for {gap}",
            row.fields[0]
        );
    }
}

#[test]
fn both_elbows_are_within_4e_16_of_the_reach() {
    let mut worst = 0f64;
    for row in rows().filter(|row| row.fields[6] == "ok") {
        let (arm, solutions) = (row.arm(), row.arm().inverse(row.point()).unwrap());
        for (elbow, column) in [(Elbow::Right, 8), (Elbow::Left, 10)] {
            let joints = solutions.get(elbow).unwrap();
            let shoulder = Exact::parse(row.fields[column]);
            let angle = Exact::parse(row.fields[column + 1]);
            let error = tip_error(&arm, joints, shoulder, angle) / arm.reach();
            assert!(error <= TIP_ERROR, "row {}: {error:e}", row.fields[0]);
            worst = worst.max(error);
        }
    }
    println!("worst tip error {worst:e} of the reach");
}

#[test]
fn forward_of_inverse_is_the_point() {
    for row in rows().filter(|row| row.fields[6] == "ok") {
        let (arm, point) = (row.arm(), row.point());
        for (elbow, joints) in arm.inverse(point).unwrap().iter() {
            let error = (arm.forward(joints) - point).norm() / arm.reach();
            assert!(
                error <= ROUND_TRIP,
                "row {} {elbow:?}: {error:e}",
                row.fields[0]
            );
        }
    }
}

#[test]
fn determinants_agree() {
    for row in rows().filter(|row| row.fields[6] == "ok") {
        let (arm, wanted) = (row.arm(), row.number(12));
        let joints = Joints::new(row.number(8), row.number(9));
        let det = arm.jacobian(joints).determinant();
        let scale = arm.upper() * arm.fore();
        assert!((det - wanted).abs() <= DETERMINANT * arm.reach().powi(2).max(scale));
        assert!((arm.manipulability(joints) - wanted).abs() <= DETERMINANT * scale);
    }
}
