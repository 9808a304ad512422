//! How far the tool leaves its curve on a segment, by power series of what it is off by.

use path_timing::{Cubic, CurveMotion};

use super::MachinePath;
use super::stretch::{ROUNDING, Stretch};
use crate::matrix::{Matrix, from_one, inverse, largest, norm, product};
use crate::model::Model;
use crate::{Gradient, Machine, Number};

/// Coefficients of the axes' Taylor models, and of the Jacobian's.
const K: usize = 8;
const SLOPES: usize = 4;

/// The largest of w |t|ᵏ from k = 1 on, with w = (1 - t²)², rounded up.
const SWINGS: [f64; SLOPES - 1] = [0.2863, 0.1482, 0.0917];

/// The most that the second derivatives of w tᵏ are.
const BENDS: [f64; SLOPES] = [8.0, 32.0, 56.0, 88.0];

/// From a node of [`CurveMotion`] to the next, in t, squared, over 8: what is left of a second
/// derivative between them.
const BETWEEN: f64 = 1.0 / 512.0;

/// How much of a bound may be what the series do not know; where it is more, nodes say less,
const UNKNOWN: f64 = 0.3;

/// but for what is no more than so many times rounding.
const ROUNDED: f64 = 100.0;

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// The bound of [`departure`](Self::departure) by power series; none where nodes may say much
    /// less.
    ///
    /// Proof. Along the segment, with t = 2τ - 1 and w = (1 - t²)², the axes are off by
    ///
    /// ```text
    /// ε = Σ dₖ tᵏ ± r = w (d₀ + d₁ t + d₆ t² + d₇ t³) + Σ lₖ tᵏ ± r
    /// ```
    ///
    /// with d from their Taylor models, l what is left, r with rounding. The tool is where J e = ε,
    /// J a mean of Jacobians from P, which goes forward on the path, to P + e, which are in its
    /// corridor, so that |e| is at most what that says, E. With Y about the inverse halfway
    /// e = Y ε + (I - Y J) e, and by Taylor models of all Jacobians within E of the curve I - Y J is
    /// C(t) = Σ Cₖ tᵏ, k from 1, but for ν. So with v₀ = Y d₀ and vₖ = Y (d₁, d₆, d₇)ₖ + Cₖ v₀ the
    /// tool is off by
    ///
    /// ```text
    /// e = w Σ vₖ tᵏ + Σ Y lₖ tᵏ + C (e - w v₀) ± (|Y| r + ν E)
    /// ```
    ///
    /// where e - w v₀ is at most the rest of this over 1 - |C|. Of the first sum [`CurveMotion`] says
    /// how far it is from the curve, with M = 384 Σ |vₖ|; all else is added.
    pub(super) fn departure_by_series(
        &self,
        motion: &CurveMotion<'_, N>,
        cubics: &[Cubic; N],
    ) -> Option<f64> {
        let corridor = &self.beside_of(motion)?.corridor;
        let apart = self.axes_apart(motion, cubics)?;
        let within = largest(&corridor.off(&apart.most)?);
        let turning = self.turning(motion, within)?;
        let size = turning.y.map(|row| row.map(f64::abs));
        let most = largest(&product(&size, &apart.most)) / turning.left();
        let most = most.min(within);

        let series = turning.series(&apart);
        let mut unknown = turning.unknown(&apart, &size, most);
        let swings = series.iter().skip(1).zip(SWINGS);
        let swings = swings.map(|(part, swing)| largest(&part.map(f64::abs)) * swing);
        let beside = swings.sum::<f64>() + largest(&unknown);
        let farthest = beside / (1.0 - largest(&turning.sums));
        for (unknown, sum) in unknown.iter_mut().zip(turning.sums) {
            *unknown += sum * farthest;
        }

        let unknown = norm(&unknown) * (1.0 + ROUNDING) + self.rounding;
        let bound = unknown + self.departure_of(motion, &series);
        // Written so that NaN is none.
        let is_known = unknown <= bound * UNKNOWN || bound <= self.rounding * ROUNDED;
        is_known.then_some(bound)
    }

    /// How far a tool that is off by w Σ vₖ tᵏ is from the curve at most.
    fn departure_of(&self, motion: &CurveMotion<'_, N>, series: &[[f64; N]; SLOPES]) -> f64 {
        let [halfway, ..] = series;
        let mut tool = motion.at(0.5);
        for (tool, off) in tool.iter_mut().zip(halfway) {
            *tool += off;
        }
        let sizes = series.map(|part| norm(&part));
        // Of the last parts, as many as there are weights.
        let sum = |weights: &[f64]| {
            let parts = sizes.iter().rev().zip(weights.iter().rev());
            parts.map(|(size, weight)| size * weight).sum::<f64>()
        };
        let fourth = 384.0 * sizes.iter().sum::<f64>();
        let (beside, between) = (sum(&SWINGS), sum(&BENDS) * BETWEEN);
        let off = |tau: f64| {
            let t = 2.0 * tau - 1.0;
            let mut factor = (1.0 - t * t) * (1.0 - t * t);
            let mut off = [0.0; N];
            for part in series {
                for (off, part) in off.iter_mut().zip(part) {
                    *off += part * factor;
                }
                factor *= t;
            }
            off
        };
        motion
            .departure_by_middle(&tool, fourth, |_| beside, between)
            .unwrap_or_else(|| motion.departure_by_difference(off, fourth, |_| between))
    }

    /// How far the cubics are off the axes' places along a segment.
    fn axes_apart(&self, motion: &CurveMotion<'_, N>, cubics: &[Cubic; N]) -> Option<AxesApart<N>> {
        let tool = self.series::<K>(motion);
        let models = self.machine.inverse(tool, self.branch).ok()?;
        let (mut coefficients, mut rests) = ([[0.0; N]; K], [0.0; N]);
        let axes = models.iter().zip(cubics).zip(&self.axes);
        for (number, ((model, cubic), axis)) in axes.enumerate() {
            let mut difference = difference(cubic, model);
            let [halfway, ..] = &mut difference;
            *halfway = axis.difference(*halfway);
            for (row, difference) in coefficients.iter_mut().zip(difference) {
                if let Some(place) = row.get_mut(number) {
                    *place = difference;
                }
            }
            let size = cubic.control_points().map(f64::abs).iter().sum::<f64>();
            if let Some(rest) = rests.get_mut(number) {
                *rest = model.rest() + (size + model.middle().abs()) * ROUNDING;
            }
        }
        Some(AxesApart::new(coefficients, rests))
    }

    /// How Jacobians within `most` of the curve change along a segment; none where one may be
    /// singular.
    fn turning(&self, motion: &CurveMotion<'_, N>, most: f64) -> Option<Turning<N>> {
        let tool = self.series(motion).map(|place| place.farther(most));
        let axes = self.machine.inverse(Gradient::variables(tool), self.branch);
        Turning::new(&axes.ok()?.map(|axis| *axis.slopes()))
    }

    fn series<const K: usize>(&self, motion: &CurveMotion<'_, N>) -> [Model<K>; N] {
        Stretch::new(motion, [0.0, 1.0], self.rounding).series(motion)
    }
}

/// How far axes are from where they should be along a segment.
struct AxesApart<const N: usize> {
    /// d₀, d₁, d₆ and d₇: the factors of w.
    factors: [[f64; N]; 4],
    /// l₂ to l₅
    left: [[f64; N]; 4],
    /// r
    rests: [f64; N],
    /// The most that each is off by.
    most: [f64; N],
}

impl<const N: usize> AxesApart<N> {
    fn new([d0, d1, d2, d3, d4, d5, d6, d7]: [[f64; N]; K], rests: [f64; N]) -> Self {
        let sum = |a: [f64; N], b: [f64; N], by: f64, c: [f64; N], factor: f64| {
            let mut sum = a;
            for (sum, (b, c)) in sum.iter_mut().zip(b.iter().zip(c)) {
                *sum += b * by + c * factor;
            }
            sum
        };
        let left = [
            sum(d2, d0, 2.0, d6, -1.0),
            sum(d3, d1, 2.0, d7, -1.0),
            sum(d4, d0, -1.0, d6, 2.0),
            sum(d5, d1, -1.0, d7, 2.0),
        ];
        let factors = [d0, d1, d6, d7];
        let mut most = rests;
        let weights = [1.0].into_iter().chain(SWINGS);
        let parts = factors.iter().zip(weights);
        for (part, weight) in parts.chain(left.iter().map(|left| (left, 1.0))) {
            for (most, part) in most.iter_mut().zip(part) {
                *most += part.abs() * weight;
            }
        }
        Self {
            factors,
            left,
            rests,
            most,
        }
    }
}

/// How Jacobians J change along a segment.
struct Turning<const N: usize> {
    /// Y
    y: Matrix<N>,
    /// ν
    rest: [f64; N],
    /// C₁ and so on.
    turns: [Matrix<N>; SLOPES - 1],
    /// The most that all of C is, by rows.
    sums: [f64; N],
}

impl<const N: usize> Turning<N> {
    fn new(jacobian: &[[Model<SLOPES>; N]; N]) -> Option<Self> {
        let y = inverse(jacobian.map(|row| row.map(Number::middle)))?;
        let mut turning = Self {
            y,
            rest: [0.0; N],
            turns: [[[0.0; N]; N]; SLOPES - 1],
            sums: [0.0; N],
        };
        let rows = turning.rest.iter_mut().zip(&mut turning.sums);
        for (number, ((rest, sum), row)) in rows.zip(from_one(&y, jacobian)).enumerate() {
            for (column, turn) in row.iter().enumerate() {
                let [here, others @ ..] = turn.coefficients();
                *rest += here.abs() + turn.rest();
                for (turn, other) in turning.turns.iter_mut().zip(others) {
                    *sum += other.abs();
                    if let Some(place) = turn.get_mut(number).and_then(|row| row.get_mut(column)) {
                        *place = *other;
                    }
                }
            }
        }
        // Written so that NaN is none.
        let is_regular = turning.left() > 0.0;
        is_regular.then_some(turning)
    }

    /// What 1 is more than all of I - Y J.
    fn left(&self) -> f64 {
        1.0 - largest(&self.sums) - largest(&self.rest)
    }

    /// v
    fn series(&self, apart: &AxesApart<N>) -> [[f64; N]; SLOPES] {
        let mut series = apart.factors.map(|factors| product(&self.y, &factors));
        let [halfway, others @ ..] = &mut series;
        for (part, turn) in others.iter_mut().zip(&self.turns) {
            for (part, turned) in part.iter_mut().zip(product(turn, halfway)) {
                *part += turned;
            }
        }
        series
    }

    /// Σ |Y lₖ| + |Y| r + ν E, with what the series is rounded by.
    fn unknown(&self, apart: &AxesApart<N>, size: &Matrix<N>, most: f64) -> [f64; N] {
        let mut unknown = product(size, &apart.rests);
        for (unknown, rest) in unknown.iter_mut().zip(self.rest) {
            *unknown += rest * most;
        }
        let rounding = product(size, &apart.most).map(|size| size * ROUNDING);
        let left = apart.left.iter().map(|left| product(&self.y, left));
        for part in left.chain([rounding]) {
            for (unknown, part) in unknown.iter_mut().zip(part) {
                *unknown += part.abs();
            }
        }
        unknown
    }
}

/// The Taylor coefficients in t of what a cubic differs by from an axis.
fn difference(cubic: &Cubic, axis: &Model<K>) -> [f64; K] {
    let (middle, way) = ((cubic.q0 + cubic.q1) * 0.5, cubic.q1 - cubic.q0);
    let [a, b] = [cubic.v0, cubic.v1].map(|speed| speed * (cubic.duration_s * 0.5));
    let [c0, c1, c2, c3, c4, c5, c6, c7] = *axis.coefficients();
    [
        middle + (a - b) * 0.25 - c0,
        way * 0.75 - (a + b) * 0.25 - c1,
        (b - a) * 0.25 - c2,
        (a + b - way) * 0.25 - c3,
        -c4,
        -c5,
        -c6,
        -c7,
    ]
}
