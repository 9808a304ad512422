//! The inverse and its Jacobian within a radius of a piece of a curve.

use super::MachinePath;
use super::stretch::{K, Stretch};
use crate::matrix::{Intervals, Matrix};
use crate::model::Model;
use crate::{Gradient, Machine, Refusal};

/// What is known of a machine within a radius of a piece of its path.
pub(super) struct Around<const N: usize> {
    /// The Jacobian along the piece, its time from -1 to 1.
    jacobian: [[Model<K>; N]; N],
    /// Half of the piece, in segments.
    half: f64,
}

/// Half the distance of nodes, in segments.
const HALF_NODE: f64 = 1.0 / 32.0;

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// The axes along a piece.
    pub(super) fn axes(&self, stretch: &Stretch<N>) -> Result<[Model<K>; N], Refusal> {
        let tool = stretch.models(&[0.0; N]);
        self.machine.inverse(tool, self.branch)
    }

    /// Within `radius` of each coordinate of a piece: by Taylor models along it, in whose rests is what
    /// is beside it.
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
    /// All Jacobians.
    pub(super) fn slopes(&self) -> Intervals<N> {
        self.jacobian.map(|row| row.map(|slope| slope.range()))
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

    /// The most that it changes from one node of a segment to the next, and within the radius: what
    /// the tool at both makes of it in the middle between them.
    pub(super) fn changes(&self) -> Matrix<N> {
        let share = HALF_NODE / self.half;
        self.jacobian.map(|row| {
            row.map(|slope| {
                let (mut number, mut fastest) = (0.0, 0.0);
                for coefficient in slope.coefficients().iter().skip(1) {
                    number += 1.0;
                    fastest += coefficient.abs() * number;
                }
                slope.rest() * 2.0 + fastest * share
            })
        })
    }
}
