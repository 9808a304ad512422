//! What a least-squares problem determines: its singular values and directions.

use nalgebra::{RealField, SMatrix, SVector};
use trig_kernels::Trig;

use super::least_squares::{LeastSquares, ROUNDINGS};

/// The singular value decomposition of the Jacobian with its columns scaled to length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rank<const N: usize, T: RealField> {
    /// Right singular vectors.
    v: SMatrix<T, N, N>,
    sigma: SVector<T, N>,
    /// Column lengths over the parameters' units: parameters times these are pure numbers.
    scales: SVector<T, N>,
    /// Singular values up to this are rounding.
    least: T,
    /// Variance of one residual.
    variance: T,
}

/// One-sided Jacobi needs about log N sweeps; what has not converged then is rounding.
const MOST_SWEEPS: usize = 40;

/// A parameter counts as undetermined where its part of a null direction of length 1 is above this.
const PART: f64 = 1e-4;

impl<const N: usize, T: RealField + Trig> Rank<N, T> {
    pub(super) fn new(system: &LeastSquares<N, T>, sum: T, rows: usize, units: &[T; N]) -> Self {
        let scales = system.scales();
        let mut u = system.r;
        for (mut column, scale) in u.column_iter_mut().zip(&scales) {
            if *scale > T::zero() {
                column /= *scale;
            } else {
                column.fill(T::zero());
            }
        }
        let mut v = SMatrix::identity();
        for _ in 0..MOST_SWEEPS {
            if !sweep(&mut u, &mut v) {
                break;
            }
        }
        let sigma = SVector::from_iterator(u.column_iter().map(|column| column.norm()));
        let rows_: T = count(rows);
        let free = rows.saturating_sub(N);
        let variance = sum / count::<T>(free.max(1));
        Self {
            v,
            sigma,
            scales: scales.component_div(&SVector::from(*units)),
            least: sigma.max() * rows_ * T::default_epsilon() * nalgebra::convert(ROUNDINGS),
            variance,
        }
    }

    pub(super) fn rank(&self) -> usize {
        self.sigma
            .iter()
            .filter(|sigma| **sigma > self.least)
            .count()
    }

    pub(super) fn conditioning(&self) -> T {
        let greatest = self.sigma.max();
        if greatest > T::zero() {
            self.sigma.min() / greatest
        } else {
            T::zero()
        }
    }

    /// Directions that the residuals do not feel, in scaled parameters.
    fn null_columns(&self) -> impl Iterator<Item = SVector<T, N>> + use<N, T> {
        let this = *self;
        (0..N).filter_map(move |place| {
            let sigma = this.sigma.get(place)?;
            (*sigma <= this.least).then(|| this.v.column(place).into_owned())
        })
    }

    pub(super) fn null_space(&self) -> impl Iterator<Item = [T; N]> + use<N, T> {
        let scales = self.scales;
        self.null_columns()
            .map(move |column| column.zip_map(&scales, unscaled).into())
    }

    /// For each parameter, whether it is part of the null space.
    pub(super) fn free(&self) -> [bool; N] {
        let part: T = nalgebra::convert(PART);
        let mut share = SVector::<T, N>::zeros();
        for column in self.null_columns() {
            share = share.sup(&column.abs());
        }
        share.map(|share| share > part).into()
    }

    pub(super) fn deviations(&self) -> [Option<T>; N] {
        let free = self.free();
        core::array::from_fn(|parameter| {
            let is_free = free.get(parameter).copied().unwrap_or(true);
            let scale = self.scales.get(parameter).copied()?;
            if is_free || scale == T::zero() {
                return None;
            }
            let sum = self
                .v
                .row(parameter)
                .iter()
                .zip(&self.sigma)
                .filter(|(_, sigma)| **sigma > self.least)
                .fold(T::zero(), |sum, (v, sigma)| {
                    sum + (*v / *sigma) * (*v / *sigma)
                });
            Some((sum * self.variance).sqrt() / scale)
        })
    }
}

fn unscaled<T: RealField + Copy>(value: T, scale: T) -> T {
    if scale > T::zero() {
        value / scale
    } else {
        value
    }
}

/// Makes each pair of columns square to each other once; false where all were.
fn sweep<const N: usize, T: RealField + Copy>(
    u: &mut SMatrix<T, N, N>,
    v: &mut SMatrix<T, N, N>,
) -> bool {
    let mut has_turned = false;
    for first in 0..N {
        for second in first + 1..N {
            let (a, b) = (u.column(first), u.column(second));
            let (alpha, beta, gamma) = (a.norm_squared(), b.norm_squared(), a.dot(&b));
            let rounding = T::default_epsilon() * (alpha * beta).sqrt();
            if gamma.abs() <= rounding {
                continue;
            }
            has_turned = true;
            let zeta = (beta - alpha) / (gamma + gamma);
            let t = T::one().copysign(zeta) / (zeta.abs() + T::one().hypot(zeta));
            let cos = T::one().hypot(t).recip();
            let sin = cos * t;
            for matrix in [&mut *u, &mut *v] {
                let (a, b) = (
                    matrix.column(first).into_owned(),
                    matrix.column(second).into_owned(),
                );
                matrix.set_column(first, &(a * cos - b * sin));
                matrix.set_column(second, &(a * sin + b * cos));
            }
        }
    }
    has_turned
}

/// A count as a number of the field, exact up to 2^32.
fn count<T: RealField>(count: usize) -> T {
    nalgebra::convert(f64::from(u32::try_from(count).unwrap_or(u32::MAX)))
}
