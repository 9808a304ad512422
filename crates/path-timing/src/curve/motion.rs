//! A point that runs along a curve while axes run their cubics, and how far a tool is from it.

use super::Curve;
use super::vector::{along, difference, dot, norm, scaled};
use crate::Cubic;
use crate::number::larger_or_nan;

/// A point on a curve whose parameter is a cubic of the time, over one segment of a table.
///
/// It says how far a tool can depart from the curve on that segment.
///
/// Proof. Both the tool's motion and this one have the same place and velocity at both ends, so that
/// their difference e and its first derivative vanish there: e is the error of its own cubic Hermite
/// interpolant, which is zero. With the time as the fraction τ = 0..=1 of the segment and M the longest that e⁗ can be, known from the
/// derivatives of tool and curve,
///
/// ```text
/// |e| ≤ M/384    |e"| ≤ M/12
/// ```
///
/// (Birkhoff and Priver, Hermite interpolation errors for derivatives, 1967). From one node
/// τ = k/16 to the next e is linear but for h²/8 · M/12 = M/24576, so that its largest value at the
/// nodes and this are a bound E of |e| everywhere.
///
/// Of e only the part across the curve counts: where the tool is ahead by a, the curve there is
/// within κ a²/2 of its tangent, κ its largest curvature. The tangent turns by at most ψ to the next
/// node. With N the largest part of e across the tangent at a node the tool is within
///
/// ```text
/// N + ψ E + κ E²/2 + M/24576
/// ```
///
/// of the curve, where the place ahead is still on the segment: at each τ at least τ²/2 of the distance
/// is done and (1 - τ)²/2 left, and |e| ≤ M τ² (1 - τ)²/24, so 12 times the distance must be M or more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveMotion<'a, const D: usize> {
    curve: &'a Curve<D>,
    parameter: Parameter,
    longest: [f64; 4],
    /// The longest that the fifth derivative is.
    fifth: f64,
    /// ψ, in radians.
    turn: f64,
    /// κ
    curvature: f64,
    /// Distance that the tool covers, 0 where a part of it is not known.
    distance: f64,
}

/// Nodes between the ends of a segment.
const NODES: [f64; 15] = [
    0.0625, 0.125, 0.1875, 0.25, 0.3125, 0.375, 0.4375, 0.5, 0.5625, 0.625, 0.6875, 0.75, 0.8125,
    0.875, 0.9375,
];

/// From a node to the next.
const NODE: f64 = 0.0625;

/// What is left between nodes, as a fraction of M.
const BETWEEN: f64 = 1.0 / 24_576.0;

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
        let distance = cubic.q1 - cubic.q0;
        let [a, b] = [cubic.v0, cubic.v1].map(|speed| speed * cubic.duration_s);
        let (c2, c3) = (3.0 * distance - 2.0 * a - b, a + b - 2.0 * distance);
        Self {
            coefficients: [cubic.q0, a, c2, c3],
            largest: [
                a.abs().max(b.abs()).max((3.0 * distance - a - b).abs()),
                (2.0 * c2).abs().max((2.0 * c2 + 6.0 * c3).abs()),
                (6.0 * c3).abs(),
            ],
        }
    }

    fn at(&self, tau: f64) -> f64 {
        let [c0, c1, c2, c3] = self.coefficients;
        c0 + tau * (c1 + tau * (c2 + tau * c3))
    }

    /// The first two derivatives.
    fn derivatives(&self, tau: f64) -> [f64; 2] {
        let [_, c1, c2, c3] = self.coefficients;
        [
            c1 + tau * (2.0 * c2 + tau * 3.0 * c3),
            2.0 * c2 + 6.0 * c3 * tau,
        ]
    }

    /// Whether at each τ at least τ²/2 of the distance is done, and at least (1 - τ)²/2 left: where the
    /// speeds at the ends are within 0 and 2.5 of the mean. A segment from rest or to rest has 2.
    fn comes_forward(cubic: &Cubic) -> bool {
        let distance = cubic.q1 - cubic.q0;
        let ends = [cubic.v0, cubic.v1].map(|speed| speed * cubic.duration_s);
        distance > 0.0 && ends.iter().all(|end| *end >= 0.0 && *end <= 2.5 * distance)
    }
}

/// The longest that derivatives 1 to 4 of C(u(τ)) can be, from those of C and the largest of u, by Faà
/// di Bruno.
fn longest_composed(longest: [f64; 4], [u1, u2, u3]: [f64; 3]) -> [f64; 4] {
    let [c1, c2, c3, c4] = longest;
    let square = u1 * u1;
    [
        c1 * u1,
        c2 * square + c1 * u2,
        c3 * square * u1 + 3.0 * c2 * u1 * u2 + c1 * u3,
        c4 * square * square + 6.0 * c3 * square * u2 + c2 * (3.0 * u2 * u2 + 4.0 * u1 * u3),
    ]
}

/// The longest that the fifth can be.
fn longest_fifth([_, c2, c3, c4]: [f64; 4], c5: f64, [u1, u2, u3]: [f64; 3]) -> f64 {
    let square = u1 * u1;
    let third = 15.0 * u1 * u2 * u2 + 10.0 * square * u3;
    c5 * square * square * u1 + 10.0 * (c4 * square * u1 * u2 + c2 * u2 * u3) + c3 * third
}

/// The first two derivatives of C(u(τ)) from those of C.
fn composed<const D: usize>(
    first: &[f64; D],
    second: &[f64; D],
    [u1, u2]: [f64; 2],
) -> [[f64; D]; 2] {
    [
        scaled(first, u1),
        along(&scaled(second, u1 * u1), u2, first),
    ]
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
        let slowest = norm(first) - half * second;
        let (turn, curvature, distance) = if slowest > 0.0 && Parameter::comes_forward(&cubic) {
            let distance = (q1 - q0) * slowest;
            let turn = fastest * NODE * second / slowest;
            (turn, second / (slowest * slowest), distance)
        } else {
            (0.0, 0.0, 0.0)
        };
        Self {
            curve,
            parameter,
            longest: longest_composed(longest, parameter.largest),
            fifth: longest_fifth(longest, curve.longest_fifth(&jet), parameter.largest),
            turn,
            curvature,
            distance,
        }
    }

    /// The place on the curve at τ.
    #[must_use]
    pub fn at(&self, tau: f64) -> [f64; D] {
        let [point, ..] = self.curve.jet(self.parameter.at(tau));
        point
    }

    /// The first two derivatives of the place by τ.
    #[must_use]
    pub fn derivatives(&self, tau: f64) -> [[f64; D]; 2] {
        let [_, first, second, ..] = self.curve.jet(self.parameter.at(tau));
        composed(&first, &second, self.parameter.derivatives(tau))
    }

    /// The place and its first four derivatives by τ.
    #[must_use]
    pub fn jet(&self, tau: f64) -> [[f64; D]; 5] {
        let [place, c1, c2, c3, c4, _] = self.curve.jet(self.parameter.at(tau));
        let [u1, u2] = self.parameter.derivatives(tau);
        let [.., u3] = self
            .parameter
            .coefficients
            .map(|coefficient| 6.0 * coefficient);
        let [first, second] = composed(&c1, &c2, [u1, u2]);
        let (square, cube) = (u1 * u1, u1 * u1 * u1);
        let third = along(&scaled(&c3, cube), 3.0 * u1 * u2, &c2);
        let fourth = along(&scaled(&c4, cube * u1), 6.0 * square * u2, &c3);
        [
            place,
            first,
            second,
            along(&third, u3, &c1),
            along(&fourth, 3.0 * u2 * u2 + 4.0 * u1 * u3, &c2),
        ]
    }

    /// The longest that derivatives 1 to 4 by τ are on the segment.
    #[must_use]
    pub const fn longest(&self) -> &[f64; 4] {
        &self.longest
    }

    /// The longest that the fifth derivative by τ is on the segment.
    #[must_use]
    pub const fn longest_fifth(&self) -> f64 {
        self.fifth
    }

    /// The most by which a tool departs from the curve on the segment, from its place, a function
    /// of τ, and the longest that its fourth derivative by τ can be; see [`CurveMotion`].
    #[must_use]
    pub fn departure(&self, tool: impl Fn(f64) -> [f64; D], longest_fourth: f64) -> f64 {
        let [.., own_fourth] = self.longest;
        let fourth = own_fourth + longest_fourth;
        self.departure_between(tool, fourth, fourth * BETWEEN)
    }

    /// The same where other things are known of the difference e of tool and curve: M, which may be
    /// any number for which |e| ≤ M τ² (1 - τ)²/24, and how far e is at most from linear between the
    /// nodes τ = k/16.
    #[must_use]
    pub fn departure_between(
        &self,
        tool: impl Fn(f64) -> [f64; D],
        fourth: f64,
        between: f64,
    ) -> f64 {
        let (mut all, mut across) = (0.0_f64, 0.0_f64);
        for tau in NODES {
            let [point, first, ..] = self.curve.jet(self.parameter.at(tau));
            let apart = difference(&tool(tau), &point);
            let ahead = dot(&apart, &first) / dot(&first, &first);
            all = larger_or_nan(all, norm(&apart));
            across = larger_or_nan(across, norm(&along(&apart, -ahead, &first)));
        }
        let all = all + between;
        // Written so that NaN stays.
        let is_known = fourth <= 12.0 * self.distance;
        if is_known {
            all.min(across + between + self.turn * all + 0.5 * self.curvature * all * all)
        } else {
            all
        }
    }

    /// Where a tool is compared with the curve, besides the ends of the segment: τ = k/16.
    pub const NODES: [f64; 15] = NODES;

    /// What is left between nodes of a function that is zero at both ends with its first derivative,
    /// as a fraction of the largest of its fourth.
    pub const BETWEEN: f64 = BETWEEN;
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

    /// Cosine and sine of the angle at τ, the fraction of the segment's time.
    #[must_use]
    pub fn at(&self, tau: f64) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.parameter.at(tau));
        [cos, sin]
    }

    /// The first two derivatives of cosine and sine by τ.
    #[must_use]
    pub fn derivatives(&self, tau: f64) -> [[f64; 2]; 2] {
        let [cos, sin] = self.at(tau);
        composed(&[-sin, cos], &[-cos, -sin], self.parameter.derivatives(tau))
    }

    /// The longest that derivatives 1 to 4 by τ are on the segment.
    #[must_use]
    pub fn longest(&self) -> [f64; 4] {
        longest_composed([1.0; 4], self.parameter.largest)
    }
}
