//! Levenberg-Marquardt for N parameters and any number of residuals, in fixed memory.

use nalgebra::{RealField, SMatrix, SVector};
use trig_kernels::Trig;

use super::Problem;
use crate::Delta;

/// Rounding errors of a row's making and rotating, in machine epsilons.
pub(super) const ROUNDINGS: f64 = 16.0;

/// A least-squares problem `R x = q`, triangularised row by row.
#[derive(Debug, Clone)]
pub(super) struct LeastSquares<const N: usize, T: RealField> {
    /// Upper triangle.
    pub(super) r: SMatrix<T, N, N>,
    q: SVector<T, N>,
}

/// What [`minimise`] has found.
pub(super) struct Fit<const N: usize, T: RealField> {
    pub(super) changes: [T; N],
    /// The machine with these changes.
    pub(super) delta: Delta<T>,
    pub(super) system: LeastSquares<N, T>,
    /// Sum of the squares that is left.
    pub(super) sum: T,
    pub(super) iterations: u32,
    pub(super) is_converged: bool,
}

impl<const N: usize, T: RealField + Trig> LeastSquares<N, T> {
    pub(super) fn new() -> Self {
        Self {
            r: SMatrix::zeros(),
            q: SVector::zeros(),
        }
    }

    /// Takes in one row, by a Givens rotation against each row of R that meets it.
    pub(super) fn add(&mut self, row: [T; N], value: T) {
        let (mut row, mut value) = (SVector::from(row), value);
        for pivot in 0..N {
            let (Some(&below), Some(&above)) = (row.get(pivot), self.r.get((pivot, pivot))) else {
                return;
            };
            if below == T::zero() {
                continue;
            }
            let length = above.hypot(below);
            let (cos, sin) = (above / length, below / length);
            let rotate = |a: &mut T, b: &mut T| {
                (*a, *b) = (cos * *a + sin * *b, cos * *b - sin * *a);
            };
            for column in pivot..N {
                if let (Some(a), Some(b)) = (self.r.get_mut((pivot, column)), row.get_mut(column)) {
                    rotate(a, b);
                }
            }
            if let Some(a) = self.q.get_mut(pivot) {
                rotate(a, &mut value);
            }
        }
    }

    /// The lengths of the Jacobian's columns; zero for a parameter whose influence is rounding.
    pub(super) fn scales(&self) -> SVector<T, N> {
        let lengths =
            SVector::<T, N>::from_iterator(self.r.column_iter().map(|column| column.norm()));
        let rounding = lengths.max() * T::default_epsilon() * nalgebra::convert(ROUNDINGS);
        lengths.map(
            |length: T| {
                if length > rounding { length } else { T::zero() }
            },
        )
    }

    /// The step that reduces residuals and `√damping · scales · step` together.
    fn step(&self, damping: T, scales: &SVector<T, N>) -> SVector<T, N> {
        let mut damped = self.clone();
        let root = damping.sqrt();
        for (place, scale) in scales.iter().enumerate() {
            // What has no influence is held.
            let weight = if *scale > T::zero() {
                root * *scale
            } else {
                scales.max()
            };
            let mut row = [T::zero(); N];
            if let Some(entry) = row.get_mut(place) {
                *entry = weight;
            }
            damped.add(row, T::zero());
        }
        damped.back()
    }

    /// Back substitution; a parameter without influence is left alone.
    fn back(&self) -> SVector<T, N> {
        let mut x = SVector::<T, N>::zeros();
        for place in (0..N).rev() {
            let row = self.r.row(place);
            let known = row.tr_dot(&x);
            let entry = row.get(place).copied().unwrap_or(T::zero());
            let value = self.q.get(place).copied().unwrap_or(T::zero());
            if let Some(x) = x.get_mut(place).filter(|_| entry != T::zero()) {
                *x = (value - known) / entry;
            }
        }
        x
    }
}

/// Damping at the start, and where no damping helps any more, in units of the columns' squares.
const FIRST_DAMPING: f64 = 1e-3;
const MOST_DAMPING: f64 = 1e12;

pub(super) fn minimise<const N: usize, T: RealField + Trig>(
    problem: &Problem<'_, N, T>,
    most: u32,
) -> Fit<N, T> {
    let ten: T = nalgebra::convert(10.0);
    let mut changes = SVector::<T, N>::zeros();
    let mut delta = problem.start;
    let mut scales = SVector::<T, N>::zeros();
    let mut damping: T = nalgebra::convert(FIRST_DAMPING);
    let mut system = LeastSquares::new();
    let mut is_converged = false;
    let mut iterations = 0;
    let mut sum = T::zero();
    while iterations < most && !is_converged {
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
        while damping <= nalgebra::convert(MOST_DAMPING) {
            let step = system.step(damping, &scales);
            let next = changes + step;
            let tried = problem
                .machine(&next.into())
                .and_then(|delta| Some((delta, problem.sum(&delta)?)));
            if let Some((better, left)) = tried.filter(|(_, left)| *left < sum) {
                // Less than a thousandth of a millionth is not worth another iteration.
                is_converged = sum - left <= sum * nalgebra::convert(1e-9);
                (changes, delta, sum) = (next, better, left);
                damping /= ten;
                break;
            }
            damping *= ten;
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
