//! The inverse and its Jacobian within a radius of a piece of a curve.

use super::MachinePath;
use super::stretch::Stretch;
use crate::matrix::{Intervals, Matrix, both};
use crate::{Gradient, Interval, Jet, Machine, Refusal};

/// What is known of a machine within a radius of a piece of its path.
pub(super) struct Around<const N: usize> {
    /// The derivatives of the axes by the time along the piece.
    pub(super) rates: [Interval; N],
    /// The Jacobian.
    pub(super) slopes: Intervals<N>,
    /// The most that it changes from one node of a segment to the next, and within the radius: what
    /// the tool at both makes of it in the middle between them.
    pub(super) changes: Matrix<N>,
}

/// Half the distance of nodes, in segments.
const HALF_NODE: f64 = 1.0 / 32.0;

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// Within `radius` of each coordinate of a piece.
    ///
    /// ```text
    /// J(P(τ) + e) ∈ [J(P(m) + e)] + [dJ/dτ] (τ - m)      dJ/dτ along P(τ) + e
    /// ```
    ///
    /// so that it is as wide as it changes, and not as intervals make of it.
    pub(super) fn around(
        &self,
        stretch: &Stretch<N>,
        radius: &[f64; N],
    ) -> Result<Around<N>, Refusal> {
        let mut middle = [Interval::UNKNOWN; N];
        let mut along = [Jet::new([Interval::UNKNOWN; 2]); N];
        let jets = stretch.jets();
        let places = stretch.middle().iter().zip(&jets).zip(radius);
        for ((middle, along), ((place, jet), by)) in middle.iter_mut().zip(&mut along).zip(places) {
            let within = Interval::new(-by, *by);
            *middle = Interval::around(*place, self.rounding) + within;
            let [place, first, ..] = *jet.coefficients();
            *along = Jet::new([place + within, first]);
        }
        let middle = self
            .machine
            .inverse(Gradient::variables(middle), self.branch)?;
        let along = self
            .machine
            .inverse(Gradient::variables(along), self.branch)?;
        let middle = middle.map(|axis| *axis.slopes());
        let coefficient = |k: usize| {
            along.map(|axis| {
                axis.slopes().map(|slope| {
                    let coefficient = slope.coefficients().get(k);
                    coefficient.copied().unwrap_or(Interval::UNKNOWN)
                })
            })
        };
        let (values, rates) = (coefficient(0), coefficient(1));
        let half = stretch.half();
        let time = Interval::new(-half, half);
        let unknown = Interval::UNKNOWN;
        let slopes = both(&middle, &rates, unknown, |middle, rate| {
            middle + rate * time
        });
        Ok(Around {
            rates: along.map(|axis| {
                let [_, rate] = *axis.value().coefficients();
                rate
            }),
            slopes: both(&slopes, &values, unknown, Interval::and),
            changes: both(&middle, &rates, 0.0, |middle, rate| {
                middle.width() + rate.width() * half + rate.magnitude() * HALF_NODE
            }),
        })
    }
}
