//! Levenberg-Marquardt for N parameters and any number of residuals, in fixed memory.
#![expect(
    clippy::indexing_slicing,
    reason = "indices run over the N parameters of N × N matrices"
)]

use nalgebra::{SMatrix, SVector};

use super::Problem;
use crate::Delta;
use crate::range::{hypot, sqrt};

/// Rounding errors of a row's making and rotating, in machine epsilons.
pub(super) const ROUNDINGS: f64 = 16.0;

/// A least-squares problem `R x = q`, triangularised row by row.
#[derive(Debug, Clone)]
pub(super) struct LeastSquares<const N: usize> {
    /// Upper triangle.
    pub(super) r: SMatrix<f64, N, N>,
    q: SVector<f64, N>,
}

/// What [`minimise`] has found.
pub(super) struct Fit<const N: usize> {
    pub(super) changes: [f64; N],
    /// The machine with these changes.
    pub(super) delta: Delta,
    pub(super) system: LeastSquares<N>,
    /// Sum of the squares that is left.
    pub(super) sum: f64,
    pub(super) iterations: u32,
    pub(super) is_converged: bool,
}

impl<const N: usize> LeastSquares<N> {
    pub(super) fn new() -> Self {
        Self {
            r: SMatrix::zeros(),
            q: SVector::zeros(),
        }
    }

    /// Takes in one row, by a Givens rotation against each row of R that meets it.
    pub(super) fn add(&mut self, mut row: [f64; N], mut value: f64) {
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
    pub(super) fn scales(&self) -> SVector<f64, N> {
        let lengths =
            SVector::<f64, N>::from_iterator(self.r.column_iter().map(|column| column.norm()));
        let rounding = lengths.max() * f64::EPSILON * ROUNDINGS;
        lengths.map(|length| if length > rounding { length } else { 0.0 })
    }

    /// The step that reduces residuals and `√damping · scales · step` together.
    fn step(&self, damping: f64, scales: &SVector<f64, N>) -> SVector<f64, N> {
        let mut damped = self.clone();
        for parameter in 0..N {
            let mut row = [0.0; N];
            // What has no influence is held.
            row[parameter] = if scales[parameter] > 0.0 {
                sqrt(damping) * scales[parameter]
            } else {
                scales.max()
            };
            damped.add(row, 0.0);
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

/// Damping at the start, and where no damping helps any more, in units of the columns' squares.
const FIRST_DAMPING: f64 = 1e-3;
const MAX_DAMPING: f64 = 1e12;

/// Relative decrease of the sum below which another iteration is not worth its time.
const SMALL_DECREASE: f64 = 1e-9;

pub(super) fn minimise<const N: usize>(problem: &Problem<'_, N>, max_iterations: u32) -> Fit<N> {
    let mut changes = SVector::<f64, N>::zeros();
    let mut delta = problem.start;
    let mut scales = SVector::<f64, N>::zeros();
    let mut damping = FIRST_DAMPING;
    let mut system = LeastSquares::new();
    let mut is_converged = false;
    let mut iterations = 0;
    let mut sum = 0.0;
    while iterations < max_iterations && !is_converged {
        let Some(now) = problem.system(&delta) else {
            break;
        };
        (system, sum) = now;
        iterations += 1;
        scales = scales.sup(&system.scales());
        // Without a step that reduces the sum rounding is all that is left, and where residuals are
        // rounding it is chance that reduces it.
        is_converged = true;
        if sum <= problem.rounding() {
            break;
        }
        while damping <= MAX_DAMPING {
            let next = changes + system.step(damping, &scales);
            let tried = problem
                .machine(&next.into())
                .and_then(|delta| Some((delta, problem.sum(&delta)?)));
            if let Some((better, left)) = tried.filter(|(_, left)| *left < sum) {
                is_converged = sum - left <= sum * SMALL_DECREASE;
                (changes, delta, sum) = (next, better, left);
                damping /= 10.0;
                break;
            }
            damping *= 10.0;
        }
    }
    Fit {
        changes: changes.into(),
        delta,
        system,
        sum,
        iterations,
        is_converged,
    }
}
