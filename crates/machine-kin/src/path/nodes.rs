//! How far the axes' cubics are off the path at some nodes of a segment, and what that says of all
//! of it.

use path_timing::{Cubic, CurveMotion};

use super::MachinePath;
use super::stretch::ROUNDING;
use crate::matrix::larger_or_nan;
use crate::{Interval, Machine, Number};

/// Nodes between the ends of a segment.
pub(super) const NODES: usize = 15;

/// From a node to the next, in segments: h.
pub(super) const NODE: f64 = 1.0 / 16.0;

/// What fourth derivatives leave between nodes: 5/64 h⁴.
pub(super) const FOURTH_BETWEEN: f64 = 5.0 / 64.0 / 65_536.0;

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// The axes at the nodes.
    pub(super) fn nodes(
        &self,
        motion: &CurveMotion<'_, N>,
        cubics: &[Cubic; N],
    ) -> Option<Nodes<N>> {
        let mut nodes = Nodes {
            errors: [[0.0; N]; NODES],
            largest: [0.0; N],
            rounding: [0.0; N],
        };
        let places = CurveMotion::<N>::NODES.into_iter().zip(&mut nodes.errors);
        for (tau, errors) in places {
            let axes = motion.at(tau).map(Interval::from);
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
}

/// Takes the larger sizes.
pub(super) fn raise<const N: usize>(most: &mut [f64; N], values: &[f64; N]) {
    for (most, value) in most.iter_mut().zip(values) {
        *most = larger_or_nan(*most, value.abs());
    }
}

/// What is known of the axes at the nodes.
pub(super) struct Nodes<const N: usize> {
    /// What each axis is off by there.
    errors: [[f64; N]; NODES],
    /// The most of that.
    largest: [f64; N],
    /// What that is rounded by at most.
    rounding: [f64; N],
}

/// What is known of the axes all along a segment.
pub(super) struct Known<const N: usize> {
    /// The most that each is off by.
    pub(super) errors: [f64; N],
    /// The most that it is off by from linear from each node to those next to it.
    pub(super) between: [[f64; N]; NODES],
    /// An M for which it is off there by at most M τ² (1 - τ)²/24.
    pub(super) fourth: [[f64; N]; NODES],
}

impl<const N: usize> Nodes<N> {
    /// What each axis is off by at the nodes.
    pub(super) const fn errors(&self) -> &[[f64; N]; NODES] {
        &self.errors
    }

    /// The same halfway.
    pub(super) const fn halfway(&self) -> &[f64; N] {
        let [_, _, _, _, _, _, _, halfway, ..] = &self.errors;
        halfway
    }

    /// The most of what they are off by.
    pub(super) const fn largest(&self) -> &[f64; N] {
        &self.largest
    }

    /// What that is rounded by at most.
    pub(super) const fn rounding(&self) -> &[f64; N] {
        &self.rounding
    }

    /// From the largest fourth derivatives.
    #[expect(
        clippy::indexing_slicing,
        reason = "axes are below N, parts of a gap below 3"
    )]
    pub(super) fn known(&self, fourth: &[f64; N]) -> Known<N> {
        let mut known = Known {
            errors: [0.0; N],
            between: [[0.0; N]; NODES],
            fourth: [[0.0; N]; NODES],
        };
        for axis in 0..N {
            let mut errors = [0.0; NODES + 2];
            for (error, node) in errors.iter_mut().skip(1).zip(&self.errors) {
                *error = node[axis];
            }
            let gaps = gaps(&errors, self.rounding[axis], fourth[axis]);
            let nodes = known.between.iter_mut().zip(&mut known.fourth);
            let pairs = gaps.iter().zip(gaps.iter().skip(1));
            for ((between, fourth), (before, after)) in nodes.zip(pairs) {
                let [b, f, most] = [0, 1, 2].map(|k| larger_or_nan(before[k], after[k]));
                known.errors[axis] = larger_or_nan(known.errors[axis], most);
                (between[axis], fourth[axis]) = (b, f);
            }
        }
        known
    }
}

/// From each end or node to the next one: how far an axis is at most from linear, the least M found
/// for which it is off by at most M τ² (1 - τ)²/24, and the most that it is off by; from what it is
/// off by at all of them, with rounding, and its largest fourth derivative.
fn gaps(errors: &[f64; NODES + 2], rounding: f64, q: f64) -> [[f64; 3]; NODES + 1] {
    let mut bends = [0.0; NODES + 2];
    for (bend, three) in bends.iter_mut().skip(1).zip(errors.windows(3)) {
        if let [a, b, c] = three {
            *bend = (a - 2.0 * b + c).abs();
        }
    }
    if let ([_, first, second, ..], [.., before, last, _]) = (errors, errors)
        && let [start, .., end] = &mut bends
    {
        *start = (8.0 * first - second).abs() * 0.5;
        *end = (8.0 * last - before).abs() * 0.5;
    }
    let mut gaps = [[0.0; 3]; NODES + 1];
    let (mut tau, mut number) = (0.0, 0);
    for (gap, (errors, bends)) in gaps.iter_mut().zip(errors.windows(2).zip(bends.windows(2))) {
        if let ([from, to], [a, b]) = (errors, bends) {
            let bend = larger_or_nan(*a, *b) + 4.5 * rounding;
            let between = bend / 8.0 + q * FOURTH_BETWEEN;
            let off = larger_or_nan(from.abs(), to.abs()) + rounding + between;
            let next = tau + NODE;
            let is_end = number == 0 || number == NODES;
            let fourth = if is_end {
                // By the second derivative.
                let second = bend * 256.0 + q * (5.0 / 8.0 / 256.0);
                12.0 * second / ((15.0 / 16.0) * (15.0 / 16.0))
            } else {
                let weight = |tau: f64| tau * tau * (1.0 - tau) * (1.0 - tau);
                24.0 * off / weight(tau).min(weight(next))
            };
            *gap = [between, larger_or_nan(0.0, fourth).min(q), off];
        }
        (tau, number) = (tau + NODE, number.wrapping_add(1));
    }
    gaps
}

/// Of values at the nodes the one at τ.
pub(super) fn at<T: Copy>(values: &[T; NODES], tau: f64) -> Option<T> {
    let mut nodes = CurveMotion::<1>::NODES.iter().zip(values);
    let found = nodes.find(|(node, _)| **node >= tau);
    found.map(|(_, value)| *value)
}
