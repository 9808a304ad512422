//! A point that runs along a curve while axes run their cubics, to the fifth derivative.

use super::vector::{along, difference, dot, norm, scaled};
use super::{Curve, Jet};
use crate::Cubic;
use crate::number::larger_or_nan;

/// A point on a curve whose parameter is a cubic of the time, over one segment of a table.
///
/// It says how far a tool can depart from the curve on that segment. Both the tool's motion and
/// this one have the same place and velocity at both ends, so that their difference e and its first
/// derivative vanish there. With the time as the fraction τ = 0..=1 of the segment
///
/// ```text
/// |e(τ)| ≤ τ² (1 - τ)² / 24 · max |e⁗|  ≤  max |e⁗| / 384
/// max |e⁗| ≤ max over τ = 1/6, 1/2, 5/6 of |e⁗(τ)| + max |e⁗'| / 6
/// ```
///
/// Of e only the part across the curve counts: where the tool is ahead by a, the curve there is
/// within κ a²/2 of its tangent. The direction across turns on the segment by at most ψ from
/// halfway, and κ is the largest curvature. With E the bound of |e| and N that of its part across
/// the tangent halfway, the tool is within
///
/// ```text
/// N + ψ E + κ E² / 2
/// ```
///
/// of the curve, where the tool ahead is still on the segment: the parameter has come at least
/// τ²/2 of its way, so 32 E must be within the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveMotion<'a, const D: usize> {
    curve: &'a Curve<D>,
    parameter: Parameter,
    longest: [f64; 5],
    /// Unit tangent halfway.
    tangent: [f64; D],
    /// ψ, in radians.
    turn: f64,
    /// κ
    curvature: f64,
    /// Length of the way, 0 where its part behind the tool is not known.
    way: f64,
}

/// Where the fourth derivative is looked at, and how far from there the segment reaches.
const LOOKS: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
const REACH: f64 = 1.0 / 6.0;

/// A cubic of the time, by the fraction of the segment.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Parameter {
    /// Coefficients of 1, τ, τ², τ³.
    coefficients: [f64; 4],
    /// The largest that derivatives 1 to 3 are.
    largest: [f64; 3],
}

impl Parameter {
    fn new(cubic: &Cubic) -> Self {
        let way = cubic.q1 - cubic.q0;
        let [a, b] = [cubic.v0, cubic.v1].map(|speed| speed * cubic.duration_s);
        let (c2, c3) = (3.0 * way - 2.0 * a - b, a + b - 2.0 * way);
        Self {
            coefficients: [cubic.q0, a, c2, c3],
            largest: [
                a.abs().max(b.abs()).max((3.0 * way - a - b).abs()),
                (2.0 * c2).abs().max((2.0 * c2 + 6.0 * c3).abs()),
                (6.0 * c3).abs(),
            ],
        }
    }

    fn at(&self, tau: f64) -> f64 {
        let [c0, c1, c2, c3] = self.coefficients;
        c0 + tau * (c1 + tau * (c2 + tau * c3))
    }

    /// Derivatives 1 to 3.
    fn derivatives(&self, tau: f64) -> [f64; 3] {
        let [_, c1, c2, c3] = self.coefficients;
        [
            c1 + tau * (2.0 * c2 + tau * 3.0 * c3),
            2.0 * c2 + 6.0 * c3 * tau,
            6.0 * c3,
        ]
    }

    /// Whether at each τ at least τ²/2 of the way is done, and at least (1 - τ)²/2 left: where the
    /// speeds at the ends are within 0 and 2.5 of the mean. A segment from rest or to rest has 2.
    fn comes_forward(cubic: &Cubic) -> bool {
        let way = cubic.q1 - cubic.q0;
        let ends = [cubic.v0, cubic.v1].map(|speed| speed * cubic.duration_s);
        way > 0.0 && ends.iter().all(|end| *end >= 0.0 && *end <= 2.5 * way)
    }
}

/// What derivatives 1 to 5 of C(u(τ)) have of those of C, one row each, by Faà di Bruno; u⁗ = 0.
fn weights([u1, u2, u3]: [f64; 3]) -> [[f64; 5]; 5] {
    let square = u1 * u1;
    [
        [u1, 0.0, 0.0, 0.0, 0.0],
        [u2, square, 0.0, 0.0, 0.0],
        [u3, 3.0 * u1 * u2, square * u1, 0.0, 0.0],
        [
            0.0,
            3.0 * u2 * u2 + 4.0 * u1 * u3,
            6.0 * square * u2,
            square * square,
            0.0,
        ],
        [
            0.0,
            10.0 * u2 * u3,
            15.0 * u1 * u2 * u2 + 10.0 * square * u3,
            10.0 * square * u1 * u2,
            square * square * u1,
        ],
    ]
}

/// The derivatives of C(u(τ)).
fn composed<const D: usize>(jet: &Jet<D>, derivatives: [f64; 3]) -> Jet<D> {
    let [point, rest @ ..] = jet;
    let mut result = [*point; 6];
    for (result, weights) in result.iter_mut().skip(1).zip(weights(derivatives)) {
        let terms = rest.iter().zip(weights);
        *result = terms.fold([0.0; D], |sum, (derivative, weight)| {
            along(&sum, weight, derivative)
        });
    }
    result
}

/// The longest that the derivatives of C(u(τ)) can be.
fn composed_longest(longest: [f64; 5], largest: [f64; 3]) -> [f64; 5] {
    weights(largest).map(|weights| {
        let terms = longest.iter().zip(weights);
        terms.map(|(longest, weight)| longest * weight).sum()
    })
}

impl<'a, const D: usize> CurveMotion<'a, D> {
    /// From the arc length `s[0]` to `s[1]` of the curve in `duration_s`, with the given velocities
    /// of the tool at both ends, of which the part along the curve counts.
    #[must_use]
    pub fn new(
        curve: &'a Curve<D>,
        s: [f64; 2],
        velocities: [&[f64; D]; 2],
        duration_s: f64,
    ) -> Self {
        let end = |s: f64, velocity| {
            let [u, ..] = curve.parameter(s);
            let [_, first, ..] = curve.jet(u);
            [u, dot(velocity, &first) / dot(&first, &first)]
        };
        let ([from, to], [before, after]) = (s, velocities);
        let ([q0, v0], [q1, v1]) = (end(from, before), end(to, after));
        let cubic = Cubic {
            q0,
            q1,
            v0,
            v1,
            duration_s,
        };
        let parameter = Parameter::new(&cubic);
        let jet = curve.jet(parameter.at(0.5));
        let [fastest, ..] = parameter.largest;
        let half = fastest * 0.5;
        let longest = curve.longest(&jet, half);
        let ([_, first, ..], [_, second, ..]) = (&jet, longest);
        let speed = norm(first);
        let slowest = speed - half * second;
        let (turn, curvature, way) = if slowest > 0.0 && Parameter::comes_forward(&cubic) {
            let way = (q1 - q0) * slowest;
            (half * second / slowest, second / (slowest * slowest), way)
        } else {
            (0.0, 0.0, 0.0)
        };
        Self {
            curve,
            parameter,
            longest: composed_longest(longest, parameter.largest),
            tangent: scaled(first, 1.0 / speed),
            turn,
            curvature,
            way,
        }
    }

    /// The place on the curve at τ, and its derivatives 1 to 5 by τ.
    #[must_use]
    pub fn at(&self, tau: f64) -> [[f64; D]; 6] {
        let jet = self.curve.jet(self.parameter.at(tau));
        composed(&jet, self.parameter.derivatives(tau))
    }

    /// The longest that derivatives 1 to 5 by τ are on the segment.
    #[must_use]
    pub const fn longest(&self) -> &[f64; 5] {
        &self.longest
    }

    /// The most by which a tool departs from the curve on the segment, from the fourth derivative of
    /// its place by τ, a function of τ, and the longest that its fifth can be; see [`CurveMotion`].
    #[must_use]
    pub fn departure(&self, fourth: impl Fn(f64) -> [f64; D], longest_fifth: f64) -> f64 {
        let [.., own_fifth] = self.longest;
        let change = (own_fifth + longest_fifth) * REACH;
        let (mut all, mut across) = (0.0_f64, 0.0_f64);
        for tau in LOOKS {
            let [.., own_fourth, _] = self.at(tau);
            let apart = difference(&fourth(tau), &own_fourth);
            let ahead = dot(&apart, &self.tangent);
            all = larger_or_nan(all, norm(&apart));
            across = larger_or_nan(across, norm(&along(&apart, -ahead, &self.tangent)));
        }
        let [all, across] = [all, across].map(|fourth| (fourth + change) / 384.0);
        // Written so that NaN stays.
        let is_known = 32.0 * all <= self.way;
        if is_known {
            all.min(across + self.turn * all + 0.5 * self.curvature * all * all)
        } else {
            all
        }
    }
}

/// A unit vector of the plane that turns while its angle runs a cubic: what a link of an arm does,
/// but for its length, over one segment of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnMotion {
    parameter: Parameter,
}

impl TurnMotion {
    /// The unit vector at the angle `angle`, in radians.
    #[must_use]
    pub fn new(angle: &Cubic) -> Self {
        Self {
            parameter: Parameter::new(angle),
        }
    }

    /// The vector and its derivatives 1 to 5 by τ, the fraction of the segment's time.
    #[must_use]
    pub fn at(&self, tau: f64) -> [[f64; 2]; 6] {
        let (sin, cos) = libm::sincos(self.parameter.at(tau));
        let (out, forward) = ([cos, sin], [-sin, cos]);
        let (inward, back) = (scaled(&out, -1.0), scaled(&forward, -1.0));
        let jet = [out, forward, inward, back, out, forward];
        composed(&jet, self.parameter.derivatives(tau))
    }

    /// The longest that derivatives 1 to 5 by τ are on the segment.
    #[must_use]
    pub fn longest(&self) -> [f64; 5] {
        composed_longest([1.0; 5], self.parameter.largest)
    }
}
