//! How far the tool leaves its curve while the axes run the cubics of a table.

use path_timing::{Cubic, CurveMotion, Row, Span};

use super::around::Around;
use super::stretch::{ROUNDING, Stretch};
use super::{MachinePath, of};
use crate::matrix::{Enclosure, Matrix, both, inverse, larger_or_nan, largest, norm, product};
use crate::{Interval, Machine, Number};

/// Nodes between the ends of a segment.
const NODES: usize = 15;

/// Shortest pieces of a segment that are looked at, as parts of it.
const FINEST: u32 = 64;

/// Pieces whose slopes are known better than this are not halved.
const GOOD: f64 = 0.5;

/// Pieces are not halved where what their fourth derivatives leave between nodes is a smaller part than
/// this of what nodes are off by.
const SMALL: f64 = 0.1;

/// What fourth derivatives leave between nodes: 5/64 h⁴.
const FOURTH_BETWEEN: f64 = 5.0 / 64.0 / 65_536.0;

/// Steps to where the tool is at a node: each leaves about what slopes change by on a piece.
const STEPS: usize = 3;

/// Pieces are halved where slopes change by more than this part of themselves from node to node.
const CHANGED: f64 = 0.2;

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
    /// infinite where the segment is too long to know. For
    /// [`Table::plan_within`](path_timing::Table::plan_within).
    ///
    /// Proof. Let P(τ) run along the curve as in [`CurveMotion`], q the inverse on the path's branch, c
    /// the cubics of the axes, and e the tool's distance from P. At both ends the axes are on the path
    /// with its velocity, so c are the Hermite cubics of q(P(τ)), and with ε = c - q(P)
    ///
    /// ```text
    /// |ε⁗| ≤ Q = max |d⁴q/dτ⁴|     |ε"| ≤ S/h² + 5/8 Q h²     between nodes τ = k h, h = 1/16,
    ///                              ε is linear but for h²/8 max |ε"| = S/8 + 5/64 Q h⁴
    /// ```
    ///
    /// where Q is enclosed by jets of intervals, and S is the largest of |ε₁ - 2 ε₀ + ε₋₁| of three nodes
    /// and of |8 ε₁ - ε₂|/2 at the ends, where ε and ε' are 0: by Taylor's formula ε" is off from these
    /// over h² by Q h²/12 and Q h²/2 at most, and from a line between nodes by Q h²/8. The tool is where q(P + e) = c, that is
    /// J e = ε with J the mean of the inverse's Jacobian from P to P + e. Where the enclosure of all
    /// Jacobians within a radius of the curve is regular, and what it says of e is within that radius,
    /// Newton's map takes the box round P into itself and contracts: there is one such place, and since
    /// it moves continuously from the start it is the tool, on its branch.
    ///
    /// At the nodes ε is known but for rounding, by intervals, and e by some Jacobian there and the most
    /// that those from P to P + e are apart from it. Between nodes,
    /// J e = ε put in from both sides, e is linear but for what the enclosure makes of what ε is, and of
    /// the change of J times the largest e. The rest is [`CurveMotion`].
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; N]>) -> f64 {
        self.known(span).unwrap_or(f64::INFINITY)
    }

    fn known(&self, span: &Span<[f64; N]>) -> Option<f64> {
        let ([start, end], [from, to]) = (span.s, &span.rows);
        let (before, after) = (self.velocity(start, from)?, self.velocity(end, to)?);
        let motion = CurveMotion::new(&self.curve, span.s, [&before, &after], to.duration_s);
        let nodes = self.nodes(&motion, &cubics(span))?;
        let (_, slopes) = self.slopes_at(motion.at(0.5)).ok()?;
        let inverse = inverse(slopes)?.map(|row| row.map(f64::abs));
        // About what the tool is off by.
        let off = product(&inverse, &nodes.largest);
        let enough = norm(&off) * SMALL + self.rounding;
        let known = nodes.known(&self.fourth(&motion, &inverse, enough)?);
        let mut radius = off.map(|off| off * 2.0 + self.rounding);
        for _ in 0..4 {
            let tools = self.tools(&motion, &radius, &nodes)?;
            let enclosure = tools.enclosure?;
            let off = enclosure.off(&known.errors);
            // Written so that NaN is none.
            if off.iter().zip(&radius).all(|(off, radius)| off <= radius) {
                let changed = enclosure.between(&tools.changes, largest(&tools.off));
                let [between, rests] =
                    [&known.between, &tools.rests].map(|axes| norm(&enclosure.off(axes)));
                let departure = motion.departure_between(
                    |tau| tools.at(tau),
                    norm(&enclosure.off(&known.fourth)),
                    between + rests + norm(&changed),
                );
                let departure = departure + self.rounding;
                return (!departure.is_nan()).then_some(departure);
            }
            radius = off.map(|off| off * 1.25 + self.rounding);
        }
        None
    }

    /// The velocity of the tool along the curve at an end that is on the path.
    fn velocity(&self, s: f64, row: &Row<[f64; N]>) -> Option<[f64; N]> {
        let jets = self.jets::<2>(s).ok()?;
        let apart = self.apart(&row.position, &of(&jets, 0));
        let mut pairs = apart.iter().zip(&row.position);
        // Written so that NaN is apart.
        let is_on_path = pairs.all(|(apart, at)| apart.abs() <= SAME * (1.0 + at.abs()));
        let (mut along, mut square) = (0.0, 0.0);
        for (slope, velocity) in of(&jets, 1).iter().zip(row.velocity) {
            (along, square) = (along + slope * velocity, square + slope * slope);
        }
        let tangent = self.curve.at(s).tangent;
        is_on_path.then(|| tangent.map(|slope| slope * (along / square)))
    }

    /// The largest that the fourth derivatives of the axes can be; known well where the tool is off by
    /// less than `enough` for it between nodes.
    fn fourth(
        &self,
        motion: &CurveMotion<'_, N>,
        inverse: &Matrix<N>,
        enough: f64,
    ) -> Option<[f64; N]> {
        let mut largest = [0.0; N];
        pieces(1, FINEST, |part, can_halve| {
            let jets = Stretch::new(motion, part, self.rounding).jets::<5>();
            let axes = self.machine.inverse(jets, self.branch).ok()?;
            let fourth = axes.map(|axis| {
                let [.., fourth] = *axis.coefficients();
                fourth.magnitude() * 24.0
            });
            if fourth.iter().any(|fourth| !fourth.is_finite()) {
                return None;
            }
            let between = fourth.map(|fourth| fourth * FOURTH_BETWEEN);
            if can_halve && norm(&product(inverse, &between)) > enough {
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
            places: [[0.0; N]; NODES],
            errors: [[0.0; N]; NODES],
            largest: [0.0; N],
            rounding: [0.0; N],
        };
        let places = nodes.places.iter_mut().zip(&mut nodes.errors);
        for (tau, (place, errors)) in CurveMotion::<N>::NODES.into_iter().zip(places) {
            *place = motion.at(tau);
            let axes = place.map(Interval::from);
            let axes = self.machine.inverse(axes, self.branch).ok()?;
            let positions = cubics.map(|cubic| cubic.position(tau));
            *errors = self.apart(&positions, &axes.map(Number::middle));
            raise(&mut nodes.largest, errors);
            let rounding = axes.map(|axis| axis.radius() + axis.middle().abs() * ROUNDING);
            raise(&mut nodes.rounding, &rounding);
        }
        // What the positions on the cubics are rounded by.
        for (rounding, cubic) in nodes.rounding.iter_mut().zip(cubics) {
            let size = cubic.control_points().map(f64::abs).iter().sum::<f64>();
            *rounding += size * ROUNDING;
        }
        Some(nodes)
    }

    /// Where the tool is at the nodes, by all Jacobians within a radius of the curve.
    fn tools(
        &self,
        motion: &CurveMotion<'_, N>,
        radius: &[f64; N],
        nodes: &Nodes<N>,
    ) -> Option<Tools<N>> {
        let mut tools = Tools {
            enclosure: None,
            changes: [[0.0; N]; N],
            places: nodes.places,
            off: [0.0; N],
            rests: [0.0; N],
        };
        pieces(1, FINEST, |part, can_halve| {
            let stretch = Stretch::new(motion, part, self.rounding);
            let around = self.around(&stretch, radius).ok()?;
            let y = inverse(around.at(0.0))?;
            let enclosure = Enclosure::by(&y, &around.slopes())?;
            let changes = around.changes();
            let changed = norm(&enclosure.between(&changes, 1.0));
            if can_halve && (enclosure.spread() > GOOD || changed > CHANGED) {
                return Some(false);
            }
            tools.changes = both(&tools.changes, &changes, 0.0, larger_or_nan);
            tools.add(part, &around, &y, nodes);
            let known = tools.enclosure;
            tools.enclosure = Some(known.map_or(enclosure, |known| known.and(&enclosure)));
            Some(true)
        })?;
        Some(tools)
    }
}

/// Takes the larger sizes.
fn raise<const N: usize>(most: &mut [f64; N], values: &[f64; N]) {
    for (most, value) in most.iter_mut().zip(values) {
        *most = larger_or_nan(*most, value.abs());
    }
}

/// What is known of the axes at the nodes.
struct Nodes<const N: usize> {
    /// The places of the curve.
    places: [[f64; N]; NODES],
    /// What each axis is off by there.
    errors: [[f64; N]; NODES],
    /// The most of that.
    largest: [f64; N],
    /// What that is rounded by at most.
    rounding: [f64; N],
}

/// What is known of the tool within a radius of the curve.
struct Tools<const N: usize> {
    /// All Jacobians.
    enclosure: Option<Enclosure<N>>,
    /// The most that they change by from node to node.
    changes: Matrix<N>,
    /// The tool at the nodes, but for what the rests make of it.
    places: [[f64; N]; NODES],
    /// The most that it is off the curve by there in each coordinate.
    off: [f64; N],
    /// The most that is left of what each axis is off by there.
    rests: [f64; N],
}

impl<const N: usize> Tools<N> {
    /// Takes the nodes of a part in.
    ///
    /// ```text
    /// J e = ε     with K near J:  e = Y ε + ...,  |ε - K e| + |J - K| |e| is left
    /// ```
    fn add(&mut self, [from, to]: [f64; 2], around: &Around<N>, y: &Matrix<N>, nodes: &Nodes<N>) {
        let (middle, apart) = ((from + to) * 0.5, around.apart());
        let places = self.places.iter_mut().zip(&nodes.errors);
        for (tau, (place, errors)) in CurveMotion::<N>::NODES.into_iter().zip(places) {
            if tau < from || tau >= to {
                continue;
            }
            let slopes = around.at(tau - middle);
            let mut off = [0.0; N];
            let mut left = *errors;
            for _ in 0..STEPS {
                for (off, step) in off.iter_mut().zip(product(y, &left)) {
                    *off += step;
                }
                let made = product(&slopes, &off);
                for (left, (error, made)) in left.iter_mut().zip(errors.iter().zip(made)) {
                    *left = error - made;
                }
            }
            let by_slopes = product(&apart, &off.map(f64::abs));
            let rounding = nodes.rounding.iter().zip(by_slopes);
            for (left, (rounding, by_slopes)) in left.iter_mut().zip(rounding) {
                *left = left.abs() + rounding + by_slopes * (1.0 + ROUNDING);
            }
            for (place, off) in place.iter_mut().zip(off) {
                *place += off;
            }
            raise(&mut self.off, &off);
            raise(&mut self.rests, &left);
        }
    }

    fn at(&self, tau: f64) -> [f64; N] {
        let mut nodes = CurveMotion::<N>::NODES.iter().zip(&self.places);
        let found = nodes.find(|(node, _)| **node >= tau);
        found.map_or([f64::NAN; N], |(_, place)| *place)
    }
}

/// What is known of the axes on all of a segment.
struct Known<const N: usize> {
    /// The most that each is off by.
    errors: [f64; N],
    /// The most that it is off by from linear between nodes.
    between: [f64; N],
    /// The least M found for which it is off by at most M τ² (1 - τ)²/24.
    fourth: [f64; N],
}

impl<const N: usize> Nodes<N> {
    /// From the largest fourth derivatives.
    fn known(&self, fourth: &[f64; N]) -> Known<N> {
        let mut known = Known {
            errors: [0.0; N],
            between: [0.0; N],
            fourth: *fourth,
        };
        for axis in 0..N {
            let at = |values: &[f64; N]| values.get(axis).copied().unwrap_or(f64::NAN);
            let (rest, q) = (at(&self.rounding), at(fourth));
            let mut errors = [0.0; NODES + 2];
            for (error, node) in errors.iter_mut().skip(1).zip(&self.errors) {
                *error = at(node);
            }
            let known_axis = along(&errors, rest, q);
            let places = (known.errors.iter_mut().zip(&mut known.between)).zip(&mut known.fourth);
            if let Some(((error, between), fourth)) = places.into_iter().nth(axis) {
                (*error, *between) = (known_axis[0], known_axis[1]);
                *fourth = larger_or_nan(0.0, known_axis[2]).min(q);
            }
        }
        known
    }
}

/// Of one axis that is off by so much at the ends and the nodes of a segment, with rounding, and has a
/// largest fourth derivative: see [`Known`].
fn along(errors: &[f64; NODES + 2], rounding: f64, q: f64) -> [f64; 3] {
    let (mut bend, mut most) = (0.0, 0.0);
    for three in errors.windows(3) {
        if let [a, b, c] = three {
            bend = larger_or_nan(bend, (a - 2.0 * b + c).abs());
            most = larger_or_nan(most, b.abs());
        }
    }
    let ([_, first, second, ..], [.., before, last, _]) = (errors, errors);
    for [near, far] in [[first, second], [last, before]] {
        bend = larger_or_nan(bend, (8.0 * near - far).abs() * 0.5);
    }
    let bend = bend + 4.5 * rounding;
    let between = bend / 8.0 + q * FOURTH_BETWEEN;
    // At the ends by the second derivative, elsewhere by the nodes.
    let second = bend * 256.0 + q * (5.0 / 8.0 / 256.0);
    let mut fourth = 12.0 * second / ((15.0 / 16.0) * (15.0 / 16.0));
    let taus = CurveMotion::<1>::NODES;
    let inner = errors.get(1..=NODES).unwrap_or_default();
    for (pair, taus) in inner.windows(2).zip(taus.windows(2)) {
        if let ([a, b], [from, to]) = (pair, taus) {
            let weight = |tau: f64| tau * tau * (1.0 - tau) * (1.0 - tau);
            let off = larger_or_nan(a.abs(), b.abs()) + rounding + between;
            fourth = larger_or_nan(fourth, 24.0 * off / weight(*from).min(weight(*to)));
        }
    }
    [most + rounding + between, between, fourth]
}
