//! How far the platform leaves its curve while the arms run the cubics of a table.

use nalgebra::Vector3;
use path_timing::{Cubic, CurveMotion, Row, Span, TurnMotion};
use trig_kernels::{atan2, sin_cos};

use super::{DeltaPath, DeltaPathError, jumping};
use crate::arm::zip;
use crate::pose::{invert_rods, smallest_sine};
use crate::prepared::PreparedArm;
use crate::range::sqrt;
use crate::{Arm, ArmRange, Pose};

/// By how much an arm may pass an end of its range between two rows, in radians: rounding, and a path
/// that touches it.
const RANGE_SLACK: f64 = 1e-9;

/// √3, upwards.
const ROOT3: f64 = 1.732_050_807_568_877_4;

/// One arm on a segment.
struct Swing<'a> {
    prepared: &'a PreparedArm<f64>,
    angle: Cubic,
    /// The longest that D' can be, as a fraction of La.
    rate: f64,
    /// The largest that g⁗ / 2La can be.
    fourth: f64,
    /// The largest that D · dK/dθ can be, as a fraction of La.
    lever: f64,
}

impl<'a> Swing<'a> {
    /// `flip` brings the curve's vectors into the machine's frame.
    fn new(
        prepared: &'a PreparedArm<f64>,
        angle: Cubic,
        motion: &CurveMotion<'_, 3>,
        flip: impl Fn(Vector3<f64>) -> Vector3<f64>,
    ) -> Self {
        let theta = Cubic {
            q0: prepared.theta(angle.q0),
            q1: prepared.theta(angle.q1),
            v0: prepared.turn * angle.v0,
            v1: prepared.turn * angle.v1,
            ..angle
        };
        let (turn, upper) = (TurnMotion::new(&theta), prepared.upper);
        let (curve, arm) = (motion.derivatives(0.5), turn.derivatives(0.5));
        let [_, _, p3, p4] = *motion.longest();
        let [turning, _, k3, k4] = turn.longest();
        let (d3, d4) = (p3 + upper * k3, p4 + upper * k4);
        // The first two are known halfway, and change by the next from there.
        let [curve_first, curve_second] = curve;
        let [arm_first, arm_second] = arm;
        let pairs = [(curve_first, arm_first), (curve_second, arm_second)];
        let [first, second] = pairs.map(|(curve, [cos, sin])| {
            let arm = prepared.in_plane(sin * upper, -cos * upper);
            (flip(curve.into()) - arm).norm()
        });
        let d2 = second + d3 * 0.5;
        let d1 = first + d2 * 0.5;
        let swing = Self {
            prepared,
            angle: theta,
            rate: d1 / prepared.lower,
            fourth: 0.0,
            lever: 0.0,
        };
        let place = flip(motion.at(0.5).into());
        let rod = swing.rod(0.5, &place);
        let longest = rod.norm() + d1 * 0.5;
        let lever = rod
            .dot(&prepared.tangent(sin_cos(theta.position(0.5))))
            .abs();
        let lever = lever + (d1 + longest * turning) * upper * 0.5;
        let fourth = longest * d4 + 4.0 * d1 * d3 + 3.0 * d2 * d2;
        Self {
            fourth: fourth / prepared.lower,
            lever: lever / prepared.lower,
            ..swing
        }
    }

    /// D = P - K, the rod as the platform on its curve would have it.
    fn rod(&self, tau: f64, place: &Vector3<f64>) -> Vector3<f64> {
        place - self.prepared.centre(sin_cos(self.angle.position(tau)))
    }

    /// g / 2La = (|D|² - La²) / 2La
    fn miss(&self, tau: f64, place: &Vector3<f64>) -> f64 {
        let (length, lower) = (self.rod(tau, place).norm(), self.prepared.lower);
        (length - lower) * (length + lower) / (2.0 * lower)
    }
}

impl DeltaPath {
    /// The most by which the platform's centre leaves the curve on a segment of a table, in the unit
    /// of length; infinite where the segment is too long to know. For
    /// [`Table::plan_within`](path_timing::Table::plan_within).
    ///
    /// Proof. Let P(τ) run along the curve as in [`CurveMotion`], K the centres of the rods' spheres as
    /// the arms' cubics have them, D = P - K, and e the platform's distance from P. With
    /// g = |D|² - La², n = g/2La and B the matrix whose rows are D/La, the rods have their lengths where
    ///
    /// ```text
    /// B e = -(n + q)    |qᵢ| ≤ |e|² / 2La
    /// ```
    ///
    /// At both ends g and g' vanish, so |n| ≤ M τ² (1 - τ)²/24, and between nodes τ = k/16 n is linear but
    /// for M/24576, with
    ///
    /// ```text
    /// g⁗ = 2 (D · D⁗ + 4 D' · D‴ + 3 D" · D")    M ≥ max |g⁗| / 2La
    /// ```
    ///
    /// from the derivatives of P and K, the first two as they are halfway. B changes by at most β dτ, β the norm
    /// of all |D'|/La; with κ the Frobenius norm of its inverse halfway that of the inverse is at
    /// most κ' = κ / (1 - κ β/2) everywhere. With ν the largest norm of n, e, which begins at zero and
    /// is continuous, stays within
    ///
    /// ```text
    /// E = 2 κ' ν / (1 + √(1 - x))    x = 2 √3 κ'² ν / La ≤ 1
    /// ```
    ///
    /// where B + e/La is invertible, so that the assembly mode stays. At the nodes e is known by
    /// [`forward`](crate::Delta::forward). Between them, put in from both sides, it is linear but for
    ///
    /// ```text
    /// κ' (M/24576 + β E/32 + √3 E²/La)
    /// ```
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; 3]>) -> f64 {
        self.known(span)
            .map_or(f64::INFINITY, |known| known.departure)
    }

    /// The most by which the platform's centre leaves the curve where each arm is off its cubic by at most
    /// `off` radians, as a shaped motion is off the motion [`Shaped::delay_s`] earlier by
    /// [`Shaper::departure`]; in the unit of length, infinite where the segment is too long or the angles
    /// are too much to tell.
    ///
    /// Proof. As that of [`departure`](Self::departure), with the centres K moved by ΔK: what is missing from the rods
    /// grows by at most
    ///
    /// ```text
    /// |D · K'| δ / La + |D| Lb δ² / 2La + Lb² δ² / 2La
    /// ```
    ///
    /// and the rows of B change by Lb δ / La. What the inverse of B halfway makes of that is known for all
    /// signs of it.
    ///
    /// [`Shaped::delay_s`]: path_timing::Shaped::delay_s
    /// [`Shaper::departure`]: path_timing::Shaper::departure
    #[must_use]
    pub fn shifted_departure(&self, span: &Span<[f64; 3]>, off: [f64; 3]) -> f64 {
        let shifted = || {
            let known = self.known(span)?;
            let arms = zip(zip(self.delta.prepared().each_ref(), known.levers), off);
            let stretch = 1.0 + known.miss / known.lower;
            let missing = arms.map(|((prepared, lever), off)| {
                let moved = prepared.upper * off.abs();
                let square = moved * off.abs() * stretch + moved * moved / prepared.lower;
                (lever * off.abs() + square * 0.5, moved / prepared.lower)
            });
            let turned = Vector3::from(missing.map(|(_, turned)| turned)).norm();
            let rest = 1.0 - known.halfway * (known.rate * 0.5 + turned);
            if rest <= 0.0 {
                return None;
            }
            let [a, b, c] = zip(known.inverse, missing).map(|(column, (miss, _))| column * miss);
            // Whatever the signs of the three.
            let sums = [a + b + c, a + b - c, a - b + c, a - b - c];
            let sum = sums.iter().map(Vector3::norm).fold(0.0, f64::max);
            let kappa = known.halfway / rest;
            farthest(kappa, sum / rest + kappa * known.miss, known.lower)
        };
        shifted().map_or(f64::INFINITY, |farthest| farthest + self.delta.tolerance())
    }

    /// Whether the machine may run a segment: all arms within their ranges, and no rod out of the plane
    /// of its arm by more than its ball joints let it. How far out it is depends on the platform's
    /// place alone, which is known at the nodes of [`departure`](Self::departure) and linear between
    /// them but for what it departs by there and the curve's own bend.
    pub(super) fn check_span(&self, span: &Span<[f64; 3]>) -> Result<(), DeltaPathError> {
        let (delta, [from, to], s) = (&self.delta, &span.rows, span.s);
        let arms = Cubic::between(from, to).zip(delta.ranges()).zip(Arm::ALL);
        for ((cubic, range), arm) in arms {
            if let Some(angle) = beyond(range, &cubic) {
                return Err(DeltaPathError::Range {
                    s,
                    arm,
                    angle,
                    min: range.min(),
                    max: range.max(),
                });
            }
        }
        let Some(max) = delta.max_swivel() else {
            return Ok(());
        };
        let known = self.known(span).ok_or(DeltaPathError::TooCoarse { s })?;
        let arms = zip(delta.prepared().each_ref(), known.sides);
        for ((prepared, side), arm) in arms.into_iter().zip(Arm::ALL) {
            // Written so that NaN is refused too.
            let is_free = side <= prepared.max_side;
            if !is_free {
                let in_plane = (prepared.lower - side) * (prepared.lower + side);
                let swivel = atan2(side, sqrt(in_plane.max(0.0)));
                return Err(DeltaPathError::BallJoint {
                    s,
                    arm,
                    swivel,
                    max,
                });
            }
        }
        Ok(())
    }

    /// None where it cannot be known.
    fn known(&self, span: &Span<[f64; 3]>) -> Option<Known> {
        let (delta, [from, to]) = (&self.delta, &span.rows);
        let mut cubics = Cubic::between(from, to);
        let cubics = [cubics.next()?, cubics.next()?, cubics.next()?];
        let change = Vector3::from(to.position) - Vector3::from(from.position);
        if jumping(change).is_some() {
            return None;
        }
        let velocity = |s, row: &Row<[f64; 3]>| {
            let pose = Pose::new(delta, row.position.into(), self.centre(s));
            let velocity = pose.platform_velocity(row.velocity.into()).ok()?;
            Some(<[f64; 3]>::from(velocity))
        };
        let [start, end] = span.s;
        let (before, after) = (velocity(start, from)?, velocity(end, to)?);
        let motion = CurveMotion::new(&self.curve, span.s, [&before, &after], to.duration_s);
        let place = |tau| delta.flip(Vector3::from(motion.at(tau)));
        let halfway = place(0.5);
        let [first, second, third] = zip(delta.prepared().each_ref(), cubics);
        let swings = [first, second, third].map(|(prepared, cubic)| {
            Swing::new(prepared, cubic, &motion, |vector| delta.flip(vector))
        });
        let norm = |of: fn(&Swing<'_>) -> f64| Vector3::from(swings.each_ref().map(of)).norm();
        let (rate, fourth) = (norm(|swing| swing.rate), norm(|swing| swing.fourth));

        let rods = swings
            .each_ref()
            .map(|swing| swing.rod(0.5, &halfway) / swing.prepared.lower);
        // Nearer to a parallel singularity half the digits of κ would be lost.
        if smallest_sine(&rods.map(|rod| rod.normalize())) <= sqrt(f64::EPSILON) {
            return None;
        }
        let [a, b, c] = invert_rods(&rods);
        let halfway = sqrt(a.norm_squared() + b.norm_squared() + c.norm_squared());
        let rest = 1.0 - halfway * rate * 0.5;
        if rest <= 0.0 {
            return None;
        }
        let kappa = halfway / rest;
        let between = fourth * CurveMotion::<3>::BETWEEN;
        let misses = CurveMotion::<3>::NODES.map(|tau| {
            let place = place(tau);
            Vector3::from(swings.each_ref().map(|swing| swing.miss(tau, &place))).norm()
        });
        let miss = misses.into_iter().fold(0.0, f64::max) + between;
        let [l1, l2, l3] = delta.prepared().each_ref().map(|prepared| prepared.lower);
        let lower = l1.min(l2).min(l3);
        let all = farthest(kappa, kappa * miss, lower)?;
        let between = kappa * (between + rate * all / 32.0 + ROOT3 * all * all / lower);
        let platform = |tau| {
            let angles = Vector3::from(cubics.map(|cubic| cubic.position(tau)));
            let point = delta.forward(angles);
            point.map_or([f64::NAN; 3], |point| point.coords.into())
        };
        let departure = motion.departure_between(platform, 2.0 * kappa * fourth, between);
        let rounding = 2.0 * ROOT3 * kappa * delta.tolerance();
        let departure = departure + rounding;
        if departure.is_nan() {
            return None;
        }
        let known = Known {
            departure,
            sides: [0.0; 3],
            inverse: [a, b, c],
            halfway,
            rate,
            miss: miss + delta.tolerance(),
            lower,
            levers: swings.each_ref().map(|swing| swing.lever),
        };
        if delta.max_swivel().is_none() {
            return Some(known);
        }
        // Between nodes, and the curve's bend from one to the next: h²/8 of its second derivative.
        let [_, second, ..] = *motion.longest();
        let off = between + second * NODE * NODE / 8.0 + rounding;
        let ends = span.s.map(|s| self.curve.at(s).point);
        let nodes = CurveMotion::<3>::NODES.map(platform);
        let sides = delta.prepared().each_ref().map(|prepared| {
            let side = |place: &[f64; 3]| delta.flip((*place).into()).dot(&prepared.sideways());
            let places = ends.iter().chain(&nodes);
            places.fold(0.0, |most, place| larger_or_nan(most, side(place).abs())) + off
        });
        Some(Known { sides, ..known })
    }
}

/// What is known of a segment.
struct Known {
    /// The most by which the platform leaves the curve.
    departure: f64,
    /// How far each wrist comes out of the plane of its arm, where its ball joints have a limit.
    sides: [f64; 3],
    /// Columns of the inverse of B halfway, and κ.
    inverse: [Vector3<f64>; 3],
    halfway: f64,
    /// β
    rate: f64,
    /// ν
    miss: f64,
    /// The shortest La.
    lower: f64,
    levers: [f64; 3],
}

/// E: how far the platform is where it would be `off` but for the curvature of the rods' spheres; none
/// where it cannot be known.
fn farthest(kappa: f64, off: f64, lower: f64) -> Option<f64> {
    let x = 2.0 * ROOT3 * kappa * off / lower;
    // Written so that NaN is none.
    let is_near = x <= 1.0;
    is_near.then(|| 2.0 * off / (1.0 + sqrt(1.0 - x)))
}

/// From a node to the next, in durations of the segment.
const NODE: f64 = 0.0625;

fn larger_or_nan(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b }
}

/// The angle that is farthest beyond an end of the range, if one is.
fn beyond(range: &ArmRange, cubic: &Cubic) -> Option<f64> {
    let mut points = cubic.control_points().into_iter();
    if points.all(|point| range.min() <= point && point <= range.max()) {
        return None;
    }
    let [low, high] = cubic.extent();
    // Written so that NaN is beyond.
    let (is_above, is_below) = (
        low >= range.min() - RANGE_SLACK,
        high <= range.max() + RANGE_SLACK,
    );
    if is_above && is_below {
        return None;
    }
    let is_lower = range.min() - low > high - range.max();
    Some(if is_lower { low } else { high })
}
