//! The arm on the cubics of a segment: how far the tool leaves its curve, and how far the joints
//! go.

use core::f64::consts::PI;

use nalgebra::{Point2, Vector2};
use path_timing::{Axes, Cubic, Curve, CurveMotion, Span, TurnMotion};
use trig_kernels::{sin_cos, sqrt};

use super::ArmPathError;
use crate::{Arm, Joint, JointRange, Joints, Limits};

/// By how much a joint may pass an end of its range between two rows, in radians: rounding, and a
/// path that touches it.
pub(super) const RANGE_SLACK: f64 = 1e-9;

/// Leibniz' weights of the fourth derivative of a product.
const LEIBNIZ: [f64; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];

/// Those of the fifth.
const LEIBNIZ_FIFTH: [f64; 6] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];

/// Both joints from one place of a curve to another, each on its cubic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Swing {
    /// Arc length of the curve at both ends.
    s: [f64; 2],
    shoulder: Cubic,
    elbow: Cubic,
}

impl Swing {
    /// The segment of a table of which `joints` takes those of the arm.
    pub(super) fn of<A: Axes>(span: &Span<A>, joints: impl Fn(A) -> [f64; 2]) -> Self {
        let [_, to] = &span.rows;
        let ends = (span.rows.each_ref()).map(|row| (joints(row.position), joints(row.velocity)));
        Self::new(span.s, ends, to.duration_s)
    }

    /// Between the arc lengths `s`, with the joints and their rates at both ends.
    pub(super) fn new(s: [f64; 2], ends: [([f64; 2], [f64; 2]); 2], duration_s: f64) -> Self {
        let [[q0, q1], [v0, v1]] = [ends.map(|end| end.0), ends.map(|end| end.1)];
        let cubic = |joint: fn([f64; 2]) -> f64| Cubic {
            q0: joint(q0),
            q1: joint(q1),
            v0: joint(v0),
            v1: joint(v1),
            duration_s,
        };
        Self {
            s,
            shoulder: cubic(|[shoulder, _]| shoulder),
            elbow: cubic(|[_, elbow]| elbow),
        }
    }

    /// Whether the arm may run it, its joints past an end of a range by `touch` at most.
    pub(super) fn check(&self, arm: &Arm, touch: f64) -> Result<(), ArmPathError> {
        if self.is_clear(arm) {
            return Ok(());
        }
        self.check_joints(arm, [0.0; 2], touch)?;
        let (s, radius) = (self.s, arm.keep_out());
        if radius == 0.0 {
            // No distance is less.
            return Ok(());
        }
        let [distance, _] = distances(arm, self.elbow.extent());
        if distance >= radius {
            return Ok(());
        }
        Err(ArmPathError::KeepOut {
            s,
            distance,
            radius,
        })
    }

    /// Whether the control points alone say that the arm may run it.
    fn is_clear(&self, arm: &Arm) -> bool {
        let within = |joint, cubic: &Cubic| {
            let range = arm.limits().range(joint);
            let mut points = cubic.control_points().into_iter();
            points.all(|point| range.min() <= point && point <= range.max())
        };
        arm.keep_out() <= (arm.upper() - arm.fore()).abs()
            && within(Joint::Shoulder, &self.shoulder)
            && within(Joint::Elbow, &self.elbow)
    }

    /// Whether both joints stay within their ranges, also where each is off by as much as said.
    fn check_joints(&self, arm: &Arm, off: [f64; 2], touch: f64) -> Result<(), ArmPathError> {
        let joints = [
            (Joint::Shoulder, &self.shoulder),
            (Joint::Elbow, &self.elbow),
        ];
        for ((joint, cubic), off) in joints.into_iter().zip(off) {
            let range = arm.limits().range(joint);
            let [low, high] = cubic.extent();
            let extent = [low - off, high + off];
            if let Some(angle) = beyond(range, extent, touch) {
                return Err(ArmPathError::Limit {
                    s: self.s,
                    joint,
                    angle,
                    min: range.min(),
                    max: range.max(),
                });
            }
        }
        Ok(())
    }

    /// Whether the joints stay within their ranges all along the curve itself: on the cubics, which
    /// they leave by no more than the tool leaves the place on the curve, times how fast they turn
    /// with it.
    pub(super) fn check_curve(
        &self,
        arm: &Arm,
        curve: &Curve<2>,
        [near, far]: [f64; 2],
    ) -> Result<(), ArmPathError> {
        let motion = Motion::new(self, arm, curve);
        let apart = motion.apart() + self.rounding(arm);
        let rates = fastest(arm, [near - apart, far + apart]);
        self.check_joints(arm, rates.map(|rate| rate * apart), RANGE_SLACK)
    }

    /// See [`ArmPath::departure`](super::ArmPath::departure).
    pub(super) fn departure(&self, arm: &Arm, curve: &Curve<2>) -> f64 {
        let motion = Motion::new(self, arm, curve);
        motion.departure() + self.rounding(arm)
    }

    fn ends(&self) -> [Joints; 2] {
        let (shoulder, elbow) = (&self.shoulder, &self.elbow);
        [
            Joints::new(shoulder.q0, elbow.q0),
            Joints::new(shoulder.q1, elbow.q1),
        ]
    }

    fn rounding(&self, arm: &Arm) -> f64 {
        let [start, end] = self.ends().map(|joints| arm.rounding(joints));
        start.max(end)
    }
}

/// The joint angle that is farthest beyond an end of the range, if one is.
fn beyond(range: &JointRange, [low, high]: [f64; 2], touch: f64) -> Option<f64> {
    // Written so that NaN is beyond.
    let (is_above, is_below) = (low >= range.min() - touch, high <= range.max() + touch);
    if is_above && is_below {
        return None;
    }
    let is_lower = range.min() - low > high - range.max();
    Some(if is_lower { low } else { high })
}

/// The least and the largest distance of the tool from the base while the elbow goes from one angle
/// to another: from straight to folded it falls.
fn distances(arm: &Arm, [low, high]: [f64; 2]) -> [f64; 2] {
    let [one, other] = [low, high].map(|angle| arm.tip(Joints::new(0.0, angle)).norm());
    let (near, far) = (one.min(other), one.max(other));
    if high - low >= PI {
        return [(arm.upper() - arm.fore()).abs(), arm.reach()];
    }
    if sin_cos(low).0 * sin_cos(high).0 > 0.0 {
        return [near, far];
    }
    if sin_cos((low + high) * 0.5).1 > 0.0 {
        [near, arm.reach()]
    } else {
        [(arm.upper() - arm.fore()).abs(), far]
    }
}

/// How fast both joints turn at most, in radians per unit of the tool's distance, where its
/// distance from the base is between two: infinite where the arm may be straight or folded.
///
/// ```text
/// |∇ shoulder| = l₂ / A    |∇ elbow| = r / A
/// A = l₁ l₂ |sin elbow| = ½ √((l₁ + l₂)² - r²) √(r² - (l₁ - l₂)²)
/// ```
///
/// A² is concave in r², so least at an end.
fn fastest(arm: &Arm, [near, far]: [f64; 2]) -> [f64; 2] {
    let (reach, folded) = (arm.reach(), (arm.upper() - arm.fore()).abs());
    let area = |r: f64| {
        let outer = sqrt(((reach - r) * (reach + r)).max(0.0));
        outer * sqrt(((r - folded) * (r + folded)).max(0.0)) * 0.5
    };
    // Written so that NaN is infinite.
    let is_inside = near > folded && far < reach;
    if !is_inside {
        return [f64::INFINITY; 2];
    }
    let area = area(near).min(area(far));
    [arm.fore(), far].map(|numerator| numerator / area)
}

/// What is known of the arm between two places of a curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Between {
    /// Arc length of both places.
    pub(super) s: [f64; 2],
    /// The nearest and the farthest that the tool can be from the base.
    pub(super) distances: [f64; 2],
    /// The most by which both joints can turn.
    turns: [f64; 2],
}

impl Between {
    /// The bounds between two places where the tool goes by `way` at most.
    pub(super) fn new(arm: &Arm, s: [f64; 2], distances: [f64; 2], way: f64) -> Self {
        Self {
            s,
            distances,
            turns: fastest(arm, distances).map(|rate| rate * way),
        }
    }

    pub(super) const fn turn(&self) -> f64 {
        let [shoulder, elbow] = self.turns;
        shoulder.max(elbow)
    }

    /// Whether both joints are within their ranges all along, because they cannot turn far enough
    /// from the joints at both ends.
    pub(super) fn holds(&self, limits: &Limits, [start, end]: [Joints; 2]) -> bool {
        let ends = [[start.shoulder, end.shoulder], [start.elbow, end.elbow]];
        let ranges = [&limits.shoulder, &limits.elbow];
        let mut all = ends.into_iter().zip(self.turns).zip(ranges);
        all.all(|(([from, to], turn), range)| {
            let middle = (from + to) * 0.5;
            beyond(
                range,
                [middle - turn * 0.5, middle + turn * 0.5],
                RANGE_SLACK,
            )
            .is_none()
        })
    }
}

/// The tool while the arm swings, and the place on the curve that goes with it.
struct Motion<'a> {
    arm: &'a Arm,
    reference: CurveMotion<'a, 2>,
    /// Length and direction of both links.
    links: [(f64, TurnMotion); 2],
    /// The longest that the tool's fourth derivative can be, and its fifth.
    longest: [f64; 2],
}

impl<'a> Motion<'a> {
    fn new(swing: &Swing, arm: &'a Arm, curve: &'a Curve<2>) -> Self {
        let (shoulder, elbow) = (swing.shoulder, swing.elbow);
        let [start, end] = swing.ends();
        let rates = [[shoulder.v0, elbow.v0], [shoulder.v1, elbow.v1]];
        let [before, after] = [(start, rates[0]), (end, rates[1])]
            .map(|(joints, rates)| <[f64; 2]>::from(arm.tool_velocity(joints, rates.into())));
        let duration_s = shoulder.duration_s;
        let forearm = Cubic {
            q0: shoulder.q0 + elbow.q0,
            q1: shoulder.q1 + elbow.q1,
            v0: shoulder.v0 + elbow.v0,
            v1: shoulder.v1 + elbow.v1,
            duration_s,
        };
        let links = [(arm.upper(), shoulder), (arm.fore(), forearm)]
            .map(|(length, angle)| (length, TurnMotion::new(&angle)));
        Self {
            arm,
            reference: CurveMotion::new(curve, swing.s, [&before, &after], duration_s),
            longest: longest(arm, &links, &elbow),
            links,
        }
    }

    fn tool(&self, tau: f64) -> [f64; 2] {
        let tip = self
            .links
            .iter()
            .fold(Vector2::zeros(), |tip, (length, link)| {
                tip + Vector2::from(link.at(tau)) * *length
            });
        (self.arm.base() * Point2::from(tip)).coords.into()
    }

    /// The most by which the tool leaves the curve.
    fn departure(&self) -> f64 {
        self.reference.departure(|tau| self.tool(tau), self.longest)
    }

    /// The most by which the tool is off the place on the curve that goes with it, along it too.
    fn apart(&self) -> f64 {
        let [.., own_fourth] = *self.reference.longest();
        let [fourth, _] = self.longest;
        let between = (own_fourth + fourth) * CurveMotion::<2>::BETWEEN;
        // Nothing is known of the place ahead.
        self.reference
            .departure_between(|tau| self.tool(tau), f64::INFINITY, |_| between)
    }
}

/// The longest that the tool's fourth derivative can be, and its fifth: the sum of both links', or,
/// where they nearly cancel, that of the product of the upper arm's direction and the tool as the
/// upper arm sees it.
fn longest(arm: &Arm, links: &[(f64, TurnMotion); 2], elbow: &Cubic) -> [f64; 2] {
    let [(upper, upper_arm), (fore, forearm)] = links;
    let [u1, u2, u3, u4] = upper_arm.longest();
    let u5 = upper_arm.longest_fifth();
    let [.., fourth] = forearm.longest();
    let sums = [
        upper * u4 + fore * fourth,
        upper * u5 + fore * forearm.longest_fifth(),
    ];
    let [_, distance] = distances(arm, elbow.extent());
    let elbow = TurnMotion::new(elbow);
    let [g1, g2, g3, g4] = elbow.longest().map(|turn| turn * fore);
    let g5 = elbow.longest_fifth() * fore;
    let upper_arm = [1.0, u1, u2, u3, u4, u5];
    let terms = |tool: &[f64], weights: &[f64]| {
        let terms = upper_arm.iter().zip(tool).zip(weights);
        terms.map(|((a, b), weight)| a * b * weight).sum::<f64>()
    };
    let [fourth, fifth] = sums;
    [
        fourth.min(terms(&[g4, g3, g2, g1, distance], &LEIBNIZ)),
        fifth.min(terms(&[g5, g4, g3, g2, g1, distance], &LEIBNIZ_FIFTH)),
    ]
}
