//! A point that runs along a curve while axes run their cubics, and how far a tool is from it.

use super::Curve;
use super::vector::{along, difference, dot, norm, scaled};
use crate::Cubic;
use crate::number::larger_or_nan;

/// A point on a curve whose parameter is a cubic of the time, over one segment of a table.
///
/// It says how far a tool can depart from the curve on that segment.
///
/// Proof. The parameter of this point is the cubic of the rows' own speeds and duration, whatever
/// these are: a table may stretch the duration by a κ of the segment. Both the tool's motion and
/// this one have the same place and velocity at both ends, so that their difference e and its first
/// derivative vanish there: e is the error of its own cubic Hermite interpolant, which is zero.
/// With the time as the fraction τ = 0..=1 of the segment and M the longest that e⁗ can be, known
/// from the derivatives of tool and curve,
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
/// within κ a²/2 of its tangent, κ its largest curvature. The tangent turns by at most ψ to the
/// next node. With N the largest part of e across the tangent at a node the tool is within
///
/// ```text
/// N + ψ E + κ E²/2 + M/24576
/// ```
///
/// of the curve, where the place ahead is still on the segment: at each τ at least τ²/2 of the
/// distance is done and (1 - τ)²/2 left, and |e| ≤ M τ² (1 - τ)²/24, so 12 times the distance must
/// be M or more.
///
/// Most segments need no node but that halfway. e is τ² (1 - τ)² times its divided difference at 0,
/// 0, 1, 1, τ, whose derivative is that at 0, 0, 1, 1, τ, τ: with F the longest that the fifth
/// derivative of e can be, at most F/120. So e is 16 τ² (1 - τ)² e(½) but for
///
/// ```text
/// τ² (1 - τ)² |τ - ½| F/120 ≤ F/13416
/// ```
///
/// across the tangent halfway, too, which turns by at most 16 ψ |τ - ½|. Where that is more than
/// an eighth above the least that the nodes can say, they are looked at.
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

/// The largest of τ² (1 - τ)² |τ - ½| / 120, where τ = ½ ± 1/√20, rounded up.
const BESIDE: f64 = 1.0 / 13_416.0;

/// The same of 16 τ² (1 - τ)² |τ - ½|.
const WEIGHTED: f64 = 1920.0 * BESIDE;

/// By how much the bound from the middle may be above the least that the nodes would say.
const CLOSE: f64 = 1.125;

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

    /// Whether at each τ at least τ²/2 of the distance is done, and at least (1 - τ)²/2 left: where
    /// the speeds at the ends are within 0 and 2.5 of the mean. A segment from rest or to rest has
    /// 2, a stretched one at most 2.4.
    fn comes_forward(cubic: &Cubic) -> bool {
        let distance = cubic.q1 - cubic.q0;
        let ends = [cubic.v0, cubic.v1].map(|speed| speed * cubic.duration_s);
        distance > 0.0 && ends.iter().all(|end| *end >= 0.0 && *end <= 2.5 * distance)
    }
}

/// The longest that derivatives 1 to 4 of C(u(τ)) can be, from those of C and the largest of u, by
/// Faà di Bruno.
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
        Self::of_parameter(
            curve,
            &Cubic {
                q0,
                q1,
                v0,
                v1,
                duration_s,
            },
        )
    }

    /// From the arc length `s[0]` to `s[1]` of the curve, evenly in the curve's own parameter.
    #[must_use]
    pub fn evenly(curve: &'a Curve<D>, s: [f64; 2]) -> Self {
        let [q0, q1] = s.map(|s| {
            let [u, ..] = curve.parameter(s);
            u
        });
        Self::of_parameter(
            curve,
            &Cubic {
                q0,
                q1,
                v0: q1 - q0,
                v1: q1 - q0,
                duration_s: 1.0,
            },
        )
    }

    fn of_parameter(curve: &'a Curve<D>, cubic: &Cubic) -> Self {
        let parameter = Parameter::new(cubic);
        let jet = curve.jet(parameter.at(0.5));
        let [fastest, ..] = parameter.largest;
        let half = fastest * 0.5;
        let longest = curve.longest(&jet, half);
        let ([_, first, ..], [_, second, ..]) = (&jet, longest);
        let slowest = norm(first) - half * second;
        let (turn, curvature, distance) = if slowest > 0.0 && Parameter::comes_forward(cubic) {
            let distance = (cubic.q1 - cubic.q0) * slowest;
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

    /// Whether the place is known to go forward all the way, and so to stay between both ends.
    #[must_use]
    pub fn goes_forward(&self) -> bool {
        self.distance > 0.0
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

    /// The place near τ as a power series of a power series.
    #[must_use]
    pub fn series(&self, tau: f64) -> MotionSeries<D> {
        let [_, _, c2, c3] = self.parameter.coefficients;
        let [first, _] = self.parameter.derivatives(tau);
        MotionSeries {
            derivatives: self.curve.jet(self.parameter.at(tau)),
            parameter: [first, c2 + 3.0 * c3 * tau, c3],
            longest_sixth: self.curve.longest_sixth(),
        }
    }

    /// The most by which a tool departs from the curve on the segment, from its place, a function
    /// of τ, and the longest that its fourth and its fifth derivative by τ can be; see
    /// [`CurveMotion`].
    #[must_use]
    pub fn departure(
        &self,
        tool: impl Fn(f64) -> [f64; D],
        [longest_fourth, longest_fifth]: [f64; 2],
    ) -> f64 {
        let [.., own_fourth] = self.longest;
        let fourth = own_fourth + longest_fourth;
        let between = fourth * BETWEEN;
        let fifth = self.fifth + longest_fifth;
        self.departure_by_middle(&tool(0.5), fourth, |_| fifth * BESIDE, between)
            .unwrap_or_else(|| self.departure_between(tool, fourth, |_| between))
    }

    /// The same as [`departure_between`](Self::departure_between) from the tool's place halfway
    /// alone; none where the nodes may say much less. `beside` is by how much e differs from 16 τ²
    /// (1 - τ)² e(½), as a function of |e(½)|.
    #[must_use]
    pub fn departure_by_middle(
        &self,
        tool: &[f64; D],
        fourth: f64,
        beside: impl Fn(f64) -> f64,
        between: f64,
    ) -> Option<f64> {
        let (apart, across) = self.apart(tool, 0.5);
        let beside = beside(apart);
        let all = apart + beside;
        // What the nodes would say at least.
        let (bound, least) = if fourth <= 12.0 * self.distance {
            let turning = self.turn / NODE * (WEIGHTED * apart + 0.5 * beside);
            let bent = 0.5 * self.curvature * all * all;
            (all.min(across + beside + turning + bent), across + between)
        } else {
            (all, apart + between)
        };
        // Written so that NaN is none.
        (bound <= CLOSE * least).then_some(bound)
    }

    /// How far a tool is from the place at τ, and how far across the tangent there.
    fn apart(&self, tool: &[f64; D], tau: f64) -> (f64, f64) {
        let [point, first, ..] = self.curve.jet(self.parameter.at(tau));
        length_and_across(&difference(tool, &point), &first)
    }

    /// The same where other things are known of the difference e of tool and curve: M, which may be
    /// any number for which |e| ≤ M τ² (1 - τ)²/24, and how far e is at most from linear between a
    /// node τ = k/16 and those next to it.
    #[must_use]
    pub fn departure_between(
        &self,
        tool: impl Fn(f64) -> [f64; D],
        fourth: f64,
        between: impl Fn(f64) -> f64,
    ) -> f64 {
        self.departure_at_nodes(|tau| self.apart(&tool(tau), tau), fourth, between)
    }

    /// The same from the difference e itself.
    #[must_use]
    pub fn departure_by_difference(
        &self,
        difference: impl Fn(f64) -> [f64; D],
        fourth: f64,
        between: impl Fn(f64) -> f64,
    ) -> f64 {
        let apart = |tau: f64| {
            let [_, first, ..] = self.curve.jet(self.parameter.at(tau));
            length_and_across(&difference(tau), &first)
        };
        self.departure_at_nodes(apart, fourth, between)
    }

    fn departure_at_nodes(
        &self,
        apart: impl Fn(f64) -> (f64, f64),
        fourth: f64,
        between: impl Fn(f64) -> f64,
    ) -> f64 {
        let (mut all, mut across) = (0.0_f64, 0.0_f64);
        for tau in NODES {
            let (apart, beside) = apart(tau);
            let between = between(tau);
            all = larger_or_nan(all, apart + between);
            across = larger_or_nan(across, beside + between);
        }
        // Written so that NaN stays.
        let is_known = fourth <= 12.0 * self.distance;
        if is_known {
            all.min(across + self.turn * all + 0.5 * self.curvature * all * all)
        } else {
            all
        }
    }

    /// Where a tool is compared with the curve, besides the ends of the segment: τ = k/16.
    pub const NODES: [f64; 15] = NODES;

    /// What is left between nodes of a function that is zero at both ends with its first
    /// derivative, as a fraction of the largest of its fourth.
    pub const BETWEEN: f64 = BETWEEN;

    /// By what a function that is zero at both ends with its first derivative differs at most from
    /// 16 τ² (1 - τ)² of its value halfway, as a fraction of the largest of its fifth.
    pub const BESIDE: f64 = BESIDE;

    /// The largest that 16 τ² (1 - τ)² |τ - ½| is.
    pub const WEIGHTED: f64 = WEIGHTED;
}

/// How long a vector is, and the part of it that is across another.
fn length_and_across<const D: usize>(vector: &[f64; D], other: &[f64; D]) -> (f64, f64) {
    let ahead = dot(vector, other) / dot(other, other);
    (norm(vector), norm(&along(vector, -ahead, other)))
}

/// Where a point that runs along a curve is near some τ₀: [`CurveMotion::series`].
///
/// ```text
/// P(τ) = Σ Pₖ uᵏ/k! + rest    u = u₁ h + u₂ h² + u₃ h³,  h = τ - τ₀    |rest| ≤ max |P₆| |u|⁶/720
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "all of a series")]
pub struct MotionSeries<const D: usize> {
    /// P₀ to P₅, by the curve's own parameter.
    pub derivatives: [[f64; D]; 6],
    /// u₁ to u₃
    pub parameter: [f64; 3],
    /// The longest that P₆ is anywhere.
    pub longest_sixth: f64,
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

    /// The longest that the fifth derivative by τ is on the segment.
    #[must_use]
    pub fn longest_fifth(&self) -> f64 {
        longest_fifth([1.0; 4], 1.0, self.parameter.largest)
    }
}

#[cfg(test)]
mod tests {
    use super::{BESIDE, WEIGHTED};

    #[test]
    fn weights_halfway_are_rounded_up() {
        let largest = (0..=10_000).fold(0.0_f64, |largest, k| {
            let tau = f64::from(k) / 10_000.0;
            let weight = tau * tau * (1.0 - tau) * (1.0 - tau);
            largest.max(weight * (tau - 0.5).abs())
        });
        assert!(largest / 120.0 <= BESIDE && largest / 120.0 > BESIDE * 0.9999);
        assert!(largest * 16.0 <= WEIGHTED);
    }
}
