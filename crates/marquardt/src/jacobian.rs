//! Rows of a linear least-squares problem, triangularised one by one.
#![expect(
    clippy::indexing_slicing,
    reason = "indices run over the N parameters of N × N matrices"
)]

use nalgebra::{SMatrix, SVector};

use crate::number::{hypot, sqrt};

/// Rounding errors of a row's making and rotating, in machine epsilons.
pub(crate) const ROUNDINGS: f64 = 16.0;

/// The Jacobian and the residuals of a [`Problem`](crate::Problem), triangularised row by row.
#[derive(Debug, Clone)]
pub struct Jacobian<const N: usize> {
    /// Upper triangle; residuals in spans, changes in the parameters' units.
    pub(crate) r: SMatrix<f64, N, N>,
    q: SVector<f64, N>,
    span: f64,
    units: [f64; N],
    /// Rows taken in.
    pub(crate) count: usize,
}

impl<const N: usize> Jacobian<N> {
    pub(crate) fn new(span: f64, units: [f64; N]) -> Self {
        Self {
            r: SMatrix::zeros(),
            q: SVector::zeros(),
            span,
            units,
            count: 0,
        }
    }

    /// One row: how much the computed value grows with each parameter, and what is measured less
    /// what is computed.
    pub fn add(&mut self, row: [f64; N], residual: f64) {
        let mut scaled = row;
        for (value, unit) in scaled.iter_mut().zip(self.units) {
            *value *= unit / self.span;
        }
        self.count += 1;
        self.rotate_in(scaled, residual / self.span);
    }

    /// By a Givens rotation against each row of R that meets it.
    fn rotate_in(&mut self, mut row: [f64; N], mut value: f64) {
        for pivot in 0..N {
            if row[pivot] == 0.0 {
                continue;
            }
            let length = hypot(self.r[(pivot, pivot)], row[pivot]);
            let (cos, sin) = (self.r[(pivot, pivot)] / length, row[pivot] / length);
            let rotate = |a: &mut f64, b: &mut f64| {
                (*a, *b) = (cos * *a + sin * *b, cos * *b - sin * *a);
            };
            for (column, below) in row.iter_mut().enumerate().skip(pivot) {
                rotate(&mut self.r[(pivot, column)], below);
            }
            rotate(&mut self.q[pivot], &mut value);
        }
    }

    /// The lengths of the Jacobian's columns; zero for a parameter whose influence is rounding.
    pub(crate) fn scales(&self) -> SVector<f64, N> {
        let lengths =
            SVector::<f64, N>::from_iterator(self.r.column_iter().map(|column| column.norm()));
        let rounding = lengths.max() * f64::EPSILON * ROUNDINGS;
        lengths.map(|length| if length > rounding { length } else { 0.0 })
    }

    /// The step that reduces residuals and `√damping · scales · step` together.
    pub(crate) fn step(&self, damping: f64, scales: &SVector<f64, N>) -> SVector<f64, N> {
        let mut damped = self.clone();
        for parameter in 0..N {
            let mut row = [0.0; N];
            // What has no influence is held.
            row[parameter] = if scales[parameter] > 0.0 {
                sqrt(damping) * scales[parameter]
            } else {
                scales.max()
            };
            damped.rotate_in(row, 0.0);
        }
        damped.back()
    }

    /// Back substitution; a parameter without influence is left alone.
    fn back(&self) -> SVector<f64, N> {
        let mut x = SVector::<f64, N>::zeros();
        for i in (0..N).rev() {
            if self.r[(i, i)] != 0.0 {
                x[i] = (self.q[i] - self.r.row(i).tr_dot(&x)) / self.r[(i, i)];
            }
        }
        x
    }
}
