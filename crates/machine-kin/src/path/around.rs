//! The inverse and its Jacobian within a radius of a piece of a curve.

use super::MachinePath;
use super::nodes::NODE;
use super::stretch::Stretch;
use crate::matrix::{Matrix, both, larger_or_nan, product};
use crate::model::Model;
use crate::{Gradient, Machine, Refusal};

/// Coefficients of the Taylor models.
const K: usize = 4;

/// What is known of a machine within a radius of a piece of its path.
pub(super) struct Around<const N: usize> {
    /// The Jacobian along the piece, its time from -1 to 1.
    jacobian: [[Model<K>; N]; N],
    /// Half of the piece, in segments.
    half: f64,
}

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// The axes along a piece.
    pub(super) fn axes(&self, stretch: &Stretch<N>) -> Result<[Model<K>; N], Refusal> {
        let tool = stretch.models(&[0.0; N]);
        self.machine.inverse(tool, self.branch)
    }

    /// Within `radius` of each coordinate of a piece: by Taylor models along it, in whose rests is
    /// what is beside it.
    pub(super) fn around(
        &self,
        stretch: &Stretch<N>,
        radius: &[f64; N],
    ) -> Result<Around<N>, Refusal> {
        let tool = Gradient::variables(stretch.models(radius));
        let axes = self.machine.inverse(tool, self.branch)?;
        Ok(Around {
            jacobian: axes.map(|axis| *axis.slopes()),
            half: stretch.half(),
        })
    }
}

impl<const N: usize> Around<N> {
    /// The Jacobian along the piece, its time from -1 to 1.
    pub(super) const fn jacobian(&self) -> &[[Model<K>; N]; N] {
        &self.jacobian
    }

    /// A Jacobian at a time from the middle of the piece, in segments.
    pub(super) fn at(&self, time: f64) -> Matrix<N> {
        let share = time / self.half;
        self.jacobian.map(|row| {
            row.map(|slope| {
                let coefficients = slope.coefficients().iter().rev();
                coefficients.fold(0.0, |sum, next| sum * share + next)
            })
        })
    }

    /// How far all those within the radius are from it at most.
    pub(super) fn apart(&self) -> Matrix<N> {
        self.jacobian.map(|row| row.map(|slope| slope.rest()))
    }

    /// What the Jacobian does from one node of a segment to the next.
    ///
    /// With p(t) the polynomial of a slope, t from -1 to 1 along the piece, c a node in t, and r
    /// the rest: the slope differs from one node to the next by at most c max |p'| + 2 r, and in
    /// between from linear by c²/8 max |p"| + 2 r. Where there are several pieces from node to node
    /// it is the first that is known, of all of them.
    pub(super) fn changes(&self) -> Changes<N> {
        let node = NODE / self.half;
        let pieces = node.max(2.0) * 0.5;
        let mut changes = Changes::NONE;
        for ((first, second), slopes) in (changes.first.iter_mut())
            .zip(&mut changes.second)
            .zip(&self.jacobian)
        {
            for ((first, second), slope) in first.iter_mut().zip(second).zip(slopes) {
                let [_, linear, square, cube] = slope.coefficients().map(f64::abs);
                let rest = slope.rest() * 2.0 * pieces;
                *first = (linear + 2.0 * square + 3.0 * cube) * node + rest;
                *second = if pieces > 1.0 {
                    *first
                } else {
                    (square + 3.0 * cube) * (node * node * 0.25) + rest
                };
            }
        }
        changes
    }
}

/// The most that a Jacobian changes from one node of a segment to the next.
#[derive(Clone, Copy)]
pub(super) struct Changes<const N: usize> {
    first: Matrix<N>,
    /// From linear.
    second: Matrix<N>,
}

impl<const N: usize> Changes<N> {
    pub(super) const NONE: Self = Self {
        first: [[0.0; N]; N],
        second: [[0.0; N]; N],
    };

    /// The most of both.
    pub(super) fn and(&self, other: &Self) -> Self {
        Self {
            first: both(&self.first, &other.first, 0.0, larger_or_nan),
            second: both(&self.second, &other.second, 0.0, larger_or_nan),
        }
    }

    /// From linear.
    pub(super) const fn second(&self) -> &Matrix<N> {
        &self.second
    }

    /// How far J e is at most from linear where e is linear from one node to the next, is at most
    /// `off` at each, and changes by `steps`:
    ///
    /// ```text
    /// |J₁ - J₀| |e₁ - e₀| / 4 + |J - its linear part| |e|
    /// ```
    pub(super) fn of_linear(&self, off: &[f64; N], steps: &[f64; N]) -> [f64; N] {
        let mut axes = product(&self.second, off);
        for (axis, by_steps) in axes.iter_mut().zip(product(&self.first, steps)) {
            *axis += by_steps * 0.25;
        }
        axes
    }
}
