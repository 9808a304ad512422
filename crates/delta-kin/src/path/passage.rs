//! A segment of a table: the platform on its curve, the arms on their cubics, and how far they are
//! apart.
//!
//! Names and proof are those of [`DeltaPath::departure`].

use nalgebra::Vector3;
use path_timing::{Cubic, CurveMotion, Row, Span, TurnMotion};
use trig_kernels::sin_cos;

use super::{DeltaPath, jumping};
use crate::Pose;
use crate::arm::zip;
use crate::pose::{invert_rods, smallest_sine};
use crate::prepared::PreparedArm;
use crate::range::sqrt;

/// √3, upwards.
const ROOT3: f64 = 1.732_050_807_568_877_4;

/// From a node to the next, in durations of the segment.
const NODE: f64 = 0.0625;

/// One arm on a segment.
struct Swing<'a> {
    prepared: &'a PreparedArm<f64>,
    angle: Cubic,
    /// The longest that D' can be, as a fraction of La.
    rate: f64,
    /// The largest that g⁗ / 2La can be, and its derivative.
    fourth: f64,
    fifth: f64,
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
        let d5 = motion.longest_fifth() + upper * turn.longest_fifth();
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
            fifth: 0.0,
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
        let fifth = longest * d5 + 5.0 * d1 * d4 + 10.0 * d2 * d3;
        Self {
            fourth: fourth / prepared.lower,
            fifth: fifth / prepared.lower,
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

/// A segment on which something is known of the platform.
pub(super) struct Passage<'a> {
    path: &'a DeltaPath,
    s: [f64; 2],
    motion: CurveMotion<'a, 3>,
    cubics: [Cubic; 3],
    swings: [Swing<'a>; 3],
    /// P halfway, in the machine's frame.
    middle: Vector3<f64>,
    /// Columns of the inverse of B halfway, and κ.
    inverse: [Vector3<f64>; 3],
    halfway: f64,
    /// κ'
    kappa: f64,
    /// β
    rate: f64,
    /// M and F.
    fourth: f64,
    fifth: f64,
    /// The shortest La.
    lower: f64,
}

impl<'a> Passage<'a> {
    /// None where nothing can be told.
    pub(super) fn new(path: &'a DeltaPath, span: &Span<[f64; 3]>) -> Option<Self> {
        let (delta, [from, to]) = (&path.delta, &span.rows);
        let cubics = cubics(&span.rows);
        let change = Vector3::from(to.position) - Vector3::from(from.position);
        if jumping(change).is_some() {
            return None;
        }
        let velocity = |s, row: &Row<[f64; 3]>| {
            let pose = Pose::new(delta, row.position.into(), path.centre(s));
            let velocity = pose.platform_velocity(row.velocity.into()).ok()?;
            Some(<[f64; 3]>::from(velocity))
        };
        let [start, end] = span.s;
        let (before, after) = (velocity(start, from)?, velocity(end, to)?);
        let motion = CurveMotion::new(&path.curve, span.s, [&before, &after], to.duration_s);
        let middle = delta.flip(Vector3::from(motion.at(0.5)));
        let arms = zip(delta.prepared().each_ref(), cubics);
        let swings = arms.map(|(prepared, cubic)| {
            Swing::new(prepared, cubic, &motion, |vector| delta.flip(vector))
        });
        let norm = |of: fn(&Swing<'_>) -> f64| Vector3::from(swings.each_ref().map(of)).norm();
        let rate = norm(|swing| swing.rate);
        let (fourth, fifth) = (norm(|swing| swing.fourth), norm(|swing| swing.fifth));
        let rods = (swings.each_ref()).map(|swing| swing.rod(0.5, &middle) / swing.prepared.lower);
        // Nearer to a parallel singularity half the digits of κ would be lost.
        if smallest_sine(&rods.map(|rod| rod.normalize())) <= sqrt(f64::EPSILON) {
            return None;
        }
        let inverse = invert_rods(&rods);
        let halfway = sqrt(inverse.iter().map(Vector3::norm_squared).sum());
        let rest = 1.0 - halfway * rate * 0.5;
        let [l1, l2, l3] = delta.prepared().each_ref().map(|prepared| prepared.lower);
        (rest > 0.0).then(|| Self {
            path,
            s: span.s,
            kappa: halfway / rest,
            fourth,
            fifth,
            lower: l1.min(l2).min(l3),
            motion,
            cubics,
            swings,
            middle,
            inverse,
            halfway,
            rate,
        })
    }

    /// The most by which the platform's centre leaves the curve.
    pub(super) fn departure(&self) -> Option<f64> {
        let all = self.farthest()?;
        // What stands for the largest fourth derivative of the departure.
        let fourth = 2.0 * self.kappa * self.fourth;
        let (between, square) = (self.between(all), ROOT3 * all * all / self.lower);
        let beside = |middle| {
            let turned = self.rate * CurveMotion::<3>::WEIGHTED * (middle + self.rounding());
            self.kappa * (self.fifth * CurveMotion::<3>::BESIDE + turned + square)
        };
        let middle = self.platform(0.5);
        let departure = (self.motion)
            .departure_by_middle(&middle, fourth, beside, between)
            .unwrap_or_else(|| {
                let platform = |tau| self.platform(tau);
                self.motion.departure_between(platform, fourth, |_| between)
            });
        Some(departure + self.rounding()).filter(|departure| !departure.is_nan())
    }

    /// The same where each arm is off its cubic, in radians.
    pub(super) fn shifted(&self, off: [f64; 3]) -> Option<f64> {
        let delta = &self.path.delta;
        let known = self.largest_miss() + delta.tolerance();
        let stretch = 1.0 + known / self.lower;
        let missing = zip(self.swings.each_ref(), off).map(|(swing, off)| {
            let moved = swing.prepared.upper * off.abs();
            let square = moved * off.abs() * stretch + moved * moved / swing.prepared.lower;
            let missing = swing.lever * off.abs() + square * 0.5;
            (missing, moved / swing.prepared.lower)
        });
        let turned = Vector3::from(missing.map(|(_, turned)| turned)).norm();
        let rest = 1.0 - self.halfway * (self.rate * 0.5 + turned);
        if rest <= 0.0 {
            return None;
        }
        let [a, b, c] = zip(self.inverse, missing).map(|(column, (miss, _))| column * miss);
        // Whatever the signs of the three.
        let sums = [a + b + c, a + b - c, a - b + c, a - b - c];
        let sum = sums.iter().map(Vector3::norm).fold(0.0, f64::max);
        let kappa = self.halfway / rest;
        farthest(kappa, sum / rest + kappa * known, self.lower)
    }

    /// How far each wrist comes beside the plane of its arm, at most: what it is at the ends, and
    /// what the platform can go from the nearer one.
    ///
    /// ```text
    /// |P(τ) - P(end)| ≤ max |P'| / 2
    /// ```
    pub(super) fn sides_by_ends(&self) -> Option<[f64; 3]> {
        let [first, ..] = *self.motion.longest();
        let off = self.farthest()? + first * 0.5 + self.rounding();
        Some(self.sides_of(&self.ends(), off))
    }

    /// The same, by what is known between.
    pub(super) fn sides(&self) -> Option<[f64; 3]> {
        // Between nodes, and the curve's bend from one to the next: h²/8 of its second derivative.
        let [_, second, ..] = *self.motion.longest();
        let off = self.between(self.farthest()?) + second * NODE * NODE / 8.0 + self.rounding();
        let nodes = CurveMotion::<3>::NODES.map(|tau| self.platform(tau));
        let [ends, nodes] = [&self.ends()[..], &nodes[..]].map(|places| self.sides_of(places, off));
        let sides = zip(ends, nodes).map(|(end, node)| larger_or_nan(end, node));
        Some(sides).filter(|sides| !sides.iter().any(|side| side.is_nan()))
    }

    fn ends(&self) -> [[f64; 3]; 2] {
        self.s.map(|s| self.path.curve.at(s).point)
    }

    /// The largest of some places, and so much more.
    fn sides_of(&self, places: &[[f64; 3]], more: f64) -> [f64; 3] {
        let delta = &self.path.delta;
        delta.prepared().each_ref().map(|prepared| {
            let side = |place: &[f64; 3]| delta.flip((*place).into()).dot(&prepared.sideways());
            let sides = places.iter().map(|place| side(place).abs());
            sides.fold(0.0, larger_or_nan) + more
        })
    }

    /// E
    fn farthest(&self) -> Option<f64> {
        farthest(self.kappa, self.kappa * self.largest_miss(), self.lower)
    }

    /// How far the departure is at most from linear between the nodes.
    fn between(&self, all: f64) -> f64 {
        let turned = self.rate * all / 32.0;
        let fourth = self.fourth * CurveMotion::<3>::BETWEEN;
        self.kappa * (fourth + turned + ROOT3 * all * all / self.lower)
    }

    /// ν
    fn largest_miss(&self) -> f64 {
        let misses = (self.swings.each_ref()).map(|swing| swing.miss(0.5, &self.middle));
        let by_middle = Vector3::from(misses).norm() + self.fifth * CurveMotion::<3>::BESIDE;
        by_middle.min(self.fourth / 384.0)
    }

    /// Where the platform is.
    fn platform(&self, tau: f64) -> [f64; 3] {
        let angles = Vector3::from(self.cubics.map(|cubic| cubic.position(tau)));
        let point = self.path.delta.forward(angles);
        point.map_or([f64::NAN; 3], |point| point.coords.into())
    }

    fn rounding(&self) -> f64 {
        2.0 * ROOT3 * self.kappa * self.path.delta.tolerance()
    }
}

/// The cubics of the arms from a row to the next.
pub(super) fn cubics([from, to]: &[Row<[f64; 3]>; 2]) -> [Cubic; 3] {
    let velocities = zip(from.velocity, to.velocity);
    zip(zip(from.position, to.position), velocities).map(|((q0, q1), (v0, v1))| Cubic {
        q0,
        q1,
        v0,
        v1,
        duration_s: to.duration_s,
    })
}

/// E: how far the platform is where it would be `off` but for the curvature of the rods' spheres;
/// none where it cannot be told.
fn farthest(kappa: f64, off: f64, lower: f64) -> Option<f64> {
    let x = 2.0 * ROOT3 * kappa * off / lower;
    // Written so that NaN is none.
    let is_near = x <= 1.0;
    is_near.then(|| 2.0 * off / (1.0 + sqrt(1.0 - x)))
}

fn larger_or_nan(a: f64, b: f64) -> f64 {
    if b <= a || a.is_nan() { a } else { b }
}
