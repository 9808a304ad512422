//! How far the tool leaves its curve while the axes run the cubics of a table.

use path_timing::{Cubic, CurveMotion, Row, Span};

use super::around::{Around, Changes};
use super::nodes::{FOURTH_BETWEEN, Known, NODE, NODES, Nodes, at, raise};
use super::stretch::{ROUNDING, Stretch};
use super::{MachinePath, of};
use crate::Machine;
use crate::matrix::{Enclosure, Matrix, inverse, larger_or_nan, norm, product};

/// Shortest pieces of a segment that are looked at, as parts of it.
const FINEST: u32 = 64;

/// Pieces whose slopes are known better than this are not halved.
const GOOD: f64 = 0.5;

/// Pieces are not halved where what their fourth derivatives leave between nodes is a smaller part
/// than this of what the tool is off by across the curve halfway,
const SMALL: f64 = 0.25;

/// or than this of what it is off by at most.
const SMALLEST: f64 = 0.02;

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

/// Asks for pieces of a segment one after the other, from all of it down to those of a `1 / finest`
/// where one is not known (`None`), or not known well (`false`) and can be halved. None where some
/// is not known.
pub(super) fn pieces(
    finest: u32,
    mut ask: impl FnMut([f64; 2], bool) -> Option<bool>,
) -> Option<()> {
    let (mut at, mut size) = (0, finest);
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
    /// It is known by power series, and where these do not say enough, by nodes.
    ///
    /// Proof. Let P(τ) run along the curve as in [`CurveMotion`], q the inverse on the path's
    /// branch, c the cubics of the axes, and e the tool's distance from P. At both ends the axes
    /// are on the path with its velocity, so c are the Hermite cubics of q(P(τ)), and with ε = c -
    /// q(P)
    ///
    /// ```text
    /// |ε⁗| ≤ Q = max |d⁴q/dτ⁴|     |ε"| ≤ S/h² + 5/8 Q h²     between nodes τ = k h, h = 1/16,
    ///                              ε is linear but for h²/8 max |ε"| = S/8 + 5/64 Q h⁴
    /// ```
    ///
    /// where Q is enclosed by jets of intervals, and S is the largest of |ε₁ - 2 ε₀ + ε₋₁| of three
    /// nodes and of |8 ε₁ - ε₂|/2 at the ends, where ε and ε' are 0: by Taylor's formula ε" is off
    /// from these over h² by Q h²/12 and Q h²/2 at most, and from a line between nodes by Q h²/8.
    /// The tool is where q(P + e) = c, that is J e = ε with J the mean of the inverse's Jacobian
    /// from P to P + e. Where the enclosure of all Jacobians within a radius of the curve is
    /// regular, and what it says of e is within that radius, Newton's map takes the box round P
    /// into itself and contracts: there is one such place, and since it moves continuously from the
    /// start it is the tool, on its branch.
    ///
    /// At the nodes ε is known but for rounding, by intervals, and e by some Jacobian there and the
    /// most that those from P to P + e are apart from it. From one node to the next, J e = ε put in
    /// from both sides, e is linear but for what the enclosure makes of what ε is, and of what J e
    /// is where e is linear:
    ///
    /// ```text
    /// |J₁ - J₀| |e₁ - e₀| / 4 + |J - its linear part| |e|
    /// ```
    ///
    /// S and the enclosures are those round each node. The rest is [`CurveMotion`].
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; N]>) -> f64 {
        self.known(span).unwrap_or(f64::INFINITY)
    }

    fn known(&self, span: &Span<[f64; N]>) -> Option<f64> {
        let ([start, end], [from, to]) = (span.s, &span.rows);
        let (before, after) = (self.velocity(start, from)?, self.velocity(end, to)?);
        let motion = CurveMotion::new(&self.curve, span.s, [&before, &after], to.duration_s);
        let cubics = cubics(span);
        // Enough for nineteen of twenty.
        if let Some(bound) = self.departure_by_series(&motion, &cubics) {
            return Some(bound);
        }
        let nodes = self.nodes(&motion, &cubics)?;
        let (_, slopes) = self.slopes_at(motion.at(0.5)).ok()?;
        let inverse = inverse(slopes)?;
        let [tangent, _] = motion.derivatives(0.5);
        let across = across(&product(&inverse, nodes.halfway()), &tangent);
        let inverse = inverse.map(|row| row.map(f64::abs));
        // About what the tool is off by.
        let off = product(&inverse, nodes.largest());
        let enough = (across * SMALL).max(norm(&off) * SMALLEST) + self.rounding;
        let known = nodes.known(&self.fourth(&motion, &inverse, enough)?);
        let mut radius = off.map(|off| off * 2.0 + self.rounding);
        for _ in 0..4 {
            let tools = self.tools(&motion, &radius, &nodes)?;
            let off = tools.enclosure?.off(&known.errors);
            // Written so that NaN is none.
            if off.iter().zip(&radius).all(|(off, radius)| off <= radius) {
                let found = tools.found(&known)?;
                let departure = motion.departure_by_difference(
                    |tau| at(&tools.off, tau).unwrap_or([f64::NAN; N]),
                    found.fourth,
                    |tau| at(&found.between, tau).unwrap_or(f64::NAN),
                ) + self.rounding;
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

    /// The largest that the fourth derivatives of the axes can be; known well where the tool is off
    /// by less than `enough` for it between nodes.
    fn fourth(
        &self,
        motion: &CurveMotion<'_, N>,
        inverse: &Matrix<N>,
        enough: f64,
    ) -> Option<[f64; N]> {
        let mut largest = [0.0; N];
        pieces(FINEST, |part, can_halve| {
            let jets = Stretch::new(motion, part, self.rounding).jets();
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

    /// Where the tool is at the nodes, by all Jacobians within a radius of the curve.
    fn tools(
        &self,
        motion: &CurveMotion<'_, N>,
        radius: &[f64; N],
        nodes: &Nodes<N>,
    ) -> Option<Tools<N>> {
        let mut tools = Tools {
            enclosure: None,
            near: [None; NODES],
            off: [[0.0; N]; NODES],
            rests: [[0.0; N]; NODES],
        };
        pieces(FINEST, |part, can_halve| {
            let stretch = Stretch::new(motion, part, self.rounding);
            let around = self.around(&stretch, radius).ok()?;
            let y = inverse(around.at(0.0))?;
            let enclosure = Enclosure::by(&y, around.jacobian())?;
            let changes = around.changes();
            let changed = norm(&enclosure.between(changes.second(), 1.0));
            if can_halve && (enclosure.spread() > GOOD || changed > CHANGED) {
                return Some(false);
            }
            tools.add(part, &around, &y, nodes);
            tools.enclose(part, &enclosure, &changes);
            Some(true)
        })?;
        Some(tools)
    }
}

/// The length of the part of a vector that is across another.
fn across<const N: usize>(vector: &[f64; N], direction: &[f64; N]) -> f64 {
    let dot = |a: &[f64; N], b: &[f64; N]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let along = dot(vector, direction);
    trig_kernels::sqrt((dot(vector, vector) - along * along / dot(direction, direction)).max(0.0))
}

/// What is known of the tool within a radius of the curve.
struct Tools<const N: usize> {
    /// All Jacobians.
    enclosure: Option<Enclosure<N>>,
    /// Those from each node to its neighbours, and what they change by.
    near: [Option<(Enclosure<N>, Changes<N>)>; NODES],
    /// About how far the tool is off the curve at the nodes.
    off: [[f64; N]; NODES],
    /// The most that is left of what each axis is off by there.
    rests: [[f64; N]; NODES],
}

impl<const N: usize> Tools<N> {
    /// Takes the nodes of a part in.
    ///
    /// ```text
    /// J e = ε     with K near J:  e = Y ε + ...,  |ε - K e| + |J - K| |e| is left
    /// ```
    fn add(&mut self, [from, to]: [f64; 2], around: &Around<N>, y: &Matrix<N>, nodes: &Nodes<N>) {
        let (middle, apart) = ((from + to) * 0.5, around.apart());
        let places = self.off.iter_mut().zip(&mut self.rests);
        let known = CurveMotion::<N>::NODES.into_iter().zip(nodes.errors());
        for ((tau, errors), (off, rests)) in known.zip(places) {
            if tau < from || tau >= to {
                continue;
            }
            let slopes = around.at(tau - middle);
            let mut left = *errors;
            for _ in 0..STEPS {
                for (off, step) in off.iter_mut().zip(product(y, &left)) {
                    *off += step;
                }
                let made = product(&slopes, off);
                for (left, (error, made)) in left.iter_mut().zip(errors.iter().zip(made)) {
                    *left = error - made;
                }
            }
            let by_slopes = product(&apart, &off.map(f64::abs));
            let rounding = nodes.rounding().iter().zip(by_slopes);
            for ((rest, left), (rounding, by_slopes)) in rests.iter_mut().zip(left).zip(rounding) {
                *rest = left.abs() + rounding + by_slopes * (1.0 + ROUNDING);
            }
        }
    }

    /// Takes in what is known of all Jacobians on a part, at the nodes between whose neighbours it
    /// is.
    fn enclose(&mut self, [from, to]: [f64; 2], enclosure: &Enclosure<N>, changes: &Changes<N>) {
        let all = &mut self.enclosure;
        *all = Some(all.map_or(*enclosure, |all| all.and(enclosure)));
        for (tau, near) in CurveMotion::<N>::NODES.into_iter().zip(&mut self.near) {
            if from < tau + NODE && tau - NODE < to {
                *near = Some(near.map_or((*enclosure, *changes), |(all, most)| {
                    (all.and(enclosure), most.and(changes))
                }));
            }
        }
    }

    /// What is made of what is known of the axes.
    fn found(&self, known: &Known<N>) -> Option<Found> {
        let mut found = Found {
            between: [0.0; NODES],
            fourth: 0.0,
        };
        let zero = [0.0; N];
        let of =
            |values: &[[f64; N]; NODES], number: usize| values.get(number).copied().unwrap_or(zero);
        for (number, (place, near)) in found.between.iter_mut().zip(&self.near).enumerate() {
            let (enclosure, changes) = near.as_ref()?;
            let next = [number.wrapping_sub(1), number.wrapping_add(1)];
            let (here, mut left) = (of(&self.off, number), of(&self.rests, number));
            let (mut off, mut steps) = (here.map(f64::abs), zero);
            for next in next {
                let there = of(&self.off, next);
                raise(&mut off, &there);
                let mut step = here;
                for (step, there) in step.iter_mut().zip(there) {
                    *step -= there;
                }
                raise(&mut steps, &step);
                raise(&mut left, &of(&self.rests, next));
            }
            let changed = changes.of_linear(&off, &steps);
            let between = known.between.get(number)?;
            for (left, (changed, between)) in left.iter_mut().zip(changed.iter().zip(between)) {
                *left += changed + between;
            }
            *place = norm(&enclosure.off(&left));
            let fourth = norm(&enclosure.off(known.fourth.get(number)?));
            found.fourth = larger_or_nan(found.fourth, fourth);
        }
        Some(found)
    }
}

/// What is known of the tool from node to node.
struct Found {
    /// How far it is at most from linear round each.
    between: [f64; NODES],
    /// The least M found for which it is off by at most M τ² (1 - τ)²/24.
    fourth: f64,
}
