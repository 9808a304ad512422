//! How far the tool leaves its curve while the axes run the cubics of a table.

use path_timing::{Cubic, CurveMotion, Row, Span};

use super::MachinePath;
use super::stretch::{ROUNDING, Stretch};
use crate::matrix::{Enclosure, Matrix, both, inverse, larger_or_nan, largest, norm, product};
use crate::{Interval, Machine, Number};

/// Nodes between the ends of a segment.
const NODES: usize = 15;

/// Shortest pieces of a segment that are looked at, as parts of it.
pub(super) const FINEST: u32 = 64;

/// Pieces whose slopes are known better than this are not halved.
const GOOD: f64 = 0.05;

/// Pieces are not halved where what their fourth derivatives leave between nodes is a smaller part than
/// this of what nodes are off by.
const SMALL: f64 = 0.1;

/// What is left between nodes, as a part of the largest fourth derivative.
const BETWEEN: f64 = CurveMotion::<1>::BETWEEN;

/// How far, as a part of 1 and of itself, a row may be from the path.
const SAME: f64 = 1e-6;

/// The cubics of all axes on a segment.
#[expect(clippy::indexing_slicing, reason = "axes are below N")]
pub(super) fn cubics<const N: usize>(span: &Span<[f64; N]>) -> [Cubic; N] {
    let [from, to] = &span.rows;
    core::array::from_fn(|axis| Cubic {
        q0: from.position[axis],
        q1: to.position[axis],
        v0: from.velocity[axis],
        v1: to.velocity[axis],
        duration_s: to.duration_s,
    })
}

/// Asks for pieces of a segment one after the other, from those of a `1 / coarsest` down to those of a
/// `1 / finest` where one is not known (`None`), or not known well (`false`) and can be halved. None
/// where some is not known.
pub(super) fn pieces(
    coarsest: u32,
    finest: u32,
    mut ask: impl FnMut([f64; 2], bool) -> Option<bool>,
) -> Option<()> {
    let (mut at, mut size) = (0, finest.div_euclid(coarsest));
    while at < finest {
        let end = at.saturating_add(size);
        let part = [at, end].map(|end| f64::from(end) / f64::from(finest));
        match ask(part, size > 1) {
            Some(true) => at = end,
            _ if size > 1 => size /= 2,
            _ => return None,
        }
    }
    Some(())
}

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// The most by which the tool leaves the curve on a segment of a table, in the unit of length;
    /// infinite where the segment is too long to tell. For
    /// [`Table::plan_within`](path_timing::Table::plan_within).
    ///
    /// Proof. Let P(τ) run along the curve as in [`CurveMotion`], q the inverse on the path's branch, c
    /// the cubics of the axes, and e the tool's distance from P. At both ends the axes are on the path
    /// with its velocity, so c are the Hermite cubics of q(P(τ)), and with ε = c - q(P)
    ///
    /// ```text
    /// |ε| ≤ max |d⁴q/dτ⁴| τ² (1 - τ)²/24,   linear between nodes τ = k/16 but for max |d⁴q/dτ⁴|/24576
    /// ```
    ///
    /// where the derivative is enclosed by jets of intervals. The tool is where q(P + e) = c, that is
    /// J e = ε with J the mean of the inverse's Jacobian from P to P + e. Where the enclosure of all
    /// Jacobians within a radius of the curve is regular, and what it says of e is within that radius,
    /// Newton's map takes the box round P into itself and contracts: there is one such place, and since
    /// it moves continuously from the start it is the tool, on its branch.
    ///
    /// At the nodes e is found by Newton's step and what that leaves of ε, by intervals. Between nodes,
    /// J e = ε put in from both sides, e is linear but for what the enclosure makes of M/24576 and of the
    /// change of J times the largest e. The rest is [`CurveMotion`].
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; N]>) -> f64 {
        self.known(span).unwrap_or(f64::INFINITY)
    }

    fn known(&self, span: &Span<[f64; N]>) -> Option<f64> {
        let ([start, end], [from, to]) = (span.s, &span.rows);
        let (before, after) = (self.velocity(start, from)?, self.velocity(end, to)?);
        let motion = CurveMotion::new(&self.curve, span.s, [&before, &after], to.duration_s);
        let nodes = self.nodes(&motion, &cubics(span))?;
        let fourth = self.fourth(&motion, &nodes)?;
        let mut errors = nodes.errors;
        for (error, fourth) in errors.iter_mut().zip(&fourth) {
            *error += fourth * BETWEEN;
        }
        let mut radius = nodes.off.map(|off| off * 1.5 + self.rounding);
        for _ in 0..4 {
            let (enclosure, changes) = self.slopes_within(&motion, &radius)?;
            let off = enclosure.off(&errors);
            // Written so that NaN is none.
            if off.iter().zip(&radius).all(|(off, radius)| off <= radius) {
                let fourth = norm(&enclosure.off(&fourth));
                let changed = norm(&enclosure.between(&changes, largest(&nodes.off)));
                let between = fourth * BETWEEN + changed + norm(&enclosure.off(&nodes.rests));
                let tool = |tau| nodes.tool(tau);
                let departure = motion.departure_between(tool, fourth, between);
                let departure = departure + self.rounding;
                return (!departure.is_nan()).then_some(departure);
            }
            radius = off.map(|off| off * 1.25 + self.rounding);
        }
        None
    }

    /// The velocity of the tool at an end that is on the path.
    fn velocity(&self, s: f64, row: &Row<[f64; N]>) -> Option<[f64; N]> {
        let (positions, slopes) = self.slopes_at(self.curve.at(s).point).ok()?;
        let apart = self.apart(&row.position, &positions);
        let mut pairs = apart.iter().zip(&row.position);
        // Written so that NaN is apart.
        let is_on_path = pairs.all(|(apart, at)| apart.abs() <= SAME * (1.0 + at.abs()));
        is_on_path.then(|| Some(product(&inverse(slopes)?, &row.velocity)))?
    }

    /// The largest that the fourth derivatives of the axes can be; known well where it matters less than
    /// what the nodes are off by.
    fn fourth(&self, motion: &CurveMotion<'_, N>, nodes: &Nodes<N>) -> Option<[f64; N]> {
        let mut largest = [0.0; N];
        let enough = norm(&nodes.off) * SMALL + self.rounding;
        pieces(1, FINEST, |part, can_halve| {
            let jets = Stretch::new(motion, part, self.rounding).jets();
            let axes = self.machine.inverse(jets, self.branch).ok()?;
            let fourth = axes.map(|axis| {
                let [.., fourth] = *axis.coefficients();
                fourth.magnitude() * 24.0
            });
            if fourth.iter().any(|fourth| !fourth.is_finite()) {
                return None;
            }
            let between = fourth.map(|fourth| fourth * BETWEEN);
            if can_halve && norm(&product(&nodes.inverse, &between)) > enough {
                return Some(false);
            }
            for (largest, fourth) in largest.iter_mut().zip(fourth) {
                *largest = larger_or_nan(*largest, fourth);
            }
            Some(true)
        })?;
        Some(largest)
    }

    fn nodes(&self, motion: &CurveMotion<'_, N>, cubics: &[Cubic; N]) -> Option<Nodes<N>> {
        let mut nodes = Nodes {
            tools: [[0.0; N]; NODES],
            off: [0.0; N],
            errors: [0.0; N],
            rests: [0.0; N],
            inverse: [[0.0; N]; N],
        };
        for (tau, tool) in CurveMotion::<N>::NODES.into_iter().zip(&mut nodes.tools) {
            let place = motion.at(tau);
            let (axes, slopes) = self.slopes_at(place).ok()?;
            let positions = cubics.map(|cubic| cubic.position(tau));
            let errors = self.apart(&positions, &axes);
            let inverse = inverse(slopes)?;
            let off = product(&inverse, &errors);
            for (most, row) in nodes.inverse.iter_mut().zip(&inverse) {
                raise(most, row);
            }
            *tool = place;
            for (tool, off) in tool.iter_mut().zip(off) {
                *tool += off;
            }
            let rests = self.rests(tool, &positions)?;
            raise(&mut nodes.off, &off);
            raise(&mut nodes.errors, &errors);
            raise(&mut nodes.rests, &rests);
        }
        // What the positions on the cubics are rounded by, and those at the places on the curve.
        for (rest, cubic) in nodes.rests.iter_mut().zip(cubics) {
            let size = cubic.control_points().map(f64::abs).iter().sum::<f64>();
            *rest += size * ROUNDING;
        }
        for (error, rest) in nodes.errors.iter_mut().zip(nodes.rests) {
            *error += rest;
        }
        Some(nodes)
    }

    /// What is left between the axes of a tool and the positions that they have.
    fn rests(&self, tool: &[f64; N], positions: &[f64; N]) -> Option<[f64; N]> {
        let place = tool.map(Interval::from);
        let axes = self.machine.inverse(place, self.branch).ok()?;
        let mut rests = [0.0; N];
        let pairs = axes.into_iter().zip(positions).zip(&self.axes);
        for (rest, ((found, position), axis)) in rests.iter_mut().zip(pairs) {
            let apart = found - *position;
            let turned = axis.difference(apart.middle()) - apart.middle();
            *rest = (apart + turned).magnitude();
        }
        Some(rests)
    }

    /// What the Jacobians within a radius of the curve are, and the most that they change by.
    fn slopes_within(
        &self,
        motion: &CurveMotion<'_, N>,
        radius: &[f64; N],
    ) -> Option<(Enclosure<N>, Matrix<N>)> {
        let mut known: Option<Enclosure<N>> = None;
        let mut changes = [[0.0; N]; N];
        pieces(1, FINEST, |part, can_halve| {
            let stretch = Stretch::new(motion, part, self.rounding);
            let around = self.around(&stretch, radius).ok()?;
            let enclosure = Enclosure::new(&around.slopes)?;
            if can_halve && enclosure.spread() > GOOD {
                return Some(false);
            }
            changes = both(&changes, &around.changes, 0.0, larger_or_nan);
            known = Some(known.map_or(enclosure, |known| known.and(&enclosure)));
            Some(true)
        })?;
        Some((known?, changes))
    }
}

/// Takes the larger sizes.
fn raise<const N: usize>(most: &mut [f64; N], values: &[f64; N]) {
    for (most, value) in most.iter_mut().zip(values) {
        *most = larger_or_nan(*most, value.abs());
    }
}

/// What is known at the nodes.
struct Nodes<const N: usize> {
    /// The tool, but for what the rests make of it.
    tools: [[f64; N]; NODES],
    /// The most that it is off the curve by in each coordinate.
    off: [f64; N],
    /// The most that each axis is off by at a place of the curve.
    errors: [f64; N],
    /// The most that each axis is off by at the tool.
    rests: [f64; N],
    /// The sizes of the inverse of the axes' slopes.
    inverse: Matrix<N>,
}

impl<const N: usize> Nodes<N> {
    fn tool(&self, tau: f64) -> [f64; N] {
        let mut nodes = CurveMotion::<N>::NODES.iter().zip(&self.tools);
        let found = nodes.find(|(node, _)| **node >= tau);
        found.map_or([f64::NAN; N], |(_, tool)| *tool)
    }
}
