//! What a least-squares problem determines: its singular values and directions.
#![expect(
    clippy::indexing_slicing,
    reason = "indices run over the N parameters of N × N matrices"
)]

use core::array::from_fn;

use nalgebra::{SMatrix, SVector};

use crate::jacobian::{Jacobian, ROUNDINGS};
use crate::number::{hypot, sqrt};

/// The singular value decomposition of the Jacobian with its columns scaled to length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rank<const N: usize> {
    /// Right singular vectors.
    v: SMatrix<f64, N, N>,
    sigma: SVector<f64, N>,
    /// Column lengths over the parameters' units: parameters times these are pure numbers.
    scales: SVector<f64, N>,
    /// Singular values up to this are rounding.
    rounding: f64,
    /// Variance of one residual.
    variance: f64,
}

/// One-sided Jacobi needs about log N sweeps; what has not converged then is rounding.
const MAX_SWEEPS: usize = 40;

/// A parameter counts as undetermined where its component of a null direction of length 1 is above
/// this.
const UNDETERMINED: f64 = 1e-4;

impl<const N: usize> Rank<N> {
    /// The rank of triangularised rows, `sum` the sum of their squared residuals.
    pub(crate) fn new(rows: &Jacobian<N>, sum: f64, units: [f64; N]) -> Self {
        let scales = rows.scales();
        let mut u = rows.r;
        for (mut column, scale) in u.column_iter_mut().zip(&scales) {
            if *scale > 0.0 {
                column /= *scale;
            } else {
                column.fill(0.0);
            }
        }
        let mut v = SMatrix::identity();
        for _ in 0..MAX_SWEEPS {
            if !sweep(&mut u, &mut v) {
                break;
            }
        }
        let sigma = SVector::from_iterator(u.column_iter().map(|column| column.norm()));
        let free = rows.count.saturating_sub(N).max(1);
        Self {
            v,
            sigma,
            scales: scales.component_div(&SVector::from(units)),
            rounding: sigma.max() * count(rows.count) * f64::EPSILON * ROUNDINGS,
            variance: sum / count(free),
        }
    }

    pub(crate) fn rank(&self) -> usize {
        (0..N).filter(|k| self.is_determined(*k)).count()
    }

    fn is_determined(&self, k: usize) -> bool {
        self.sigma[k] > self.rounding
    }

    pub(crate) fn conditioning(&self) -> f64 {
        let largest = self.sigma.max();
        if largest > 0.0 {
            self.sigma.min() / largest
        } else {
            0.0
        }
    }

    /// Directions that the residuals do not feel, in scaled parameters.
    fn null_columns(&self) -> impl Iterator<Item = SVector<f64, N>> + use<N> {
        let this = *self;
        (0..N)
            .filter(move |k| !this.is_determined(*k))
            .map(move |k| this.v.column(k).into_owned())
    }

    pub(crate) fn null_space(&self) -> impl Iterator<Item = [f64; N]> + use<N> {
        let scales = self.scales;
        let unscaled = |value, scale| if scale > 0.0 { value / scale } else { value };
        self.null_columns()
            .map(move |column| column.zip_map(&scales, unscaled).into())
    }

    /// For each parameter, whether it is part of the null space.
    pub(crate) fn free(&self) -> [bool; N] {
        let zero = SVector::<f64, N>::zeros();
        let components = self
            .null_columns()
            .fold(zero, |largest, column| largest.sup(&column.abs()));
        components.map(|component| component > UNDETERMINED).into()
    }

    pub(crate) fn deviations(&self) -> [Option<f64>; N] {
        let free = self.free();
        from_fn(|i| {
            if free[i] || self.scales[i] == 0.0 {
                return None;
            }
            let sum: f64 = (0..N)
                .filter(|k| self.is_determined(*k))
                .map(|k| self.v[(i, k)] / self.sigma[k])
                .map(|quotient| quotient * quotient)
                .sum();
            Some(sqrt(sum * self.variance) / self.scales[i])
        })
    }
}

/// Makes each pair of columns orthogonal once; false where all were.
fn sweep<const N: usize>(u: &mut SMatrix<f64, N, N>, v: &mut SMatrix<f64, N, N>) -> bool {
    let mut has_turned = false;
    for first in 0..N {
        for second in first + 1..N {
            let (a, b) = (u.column(first), u.column(second));
            let (alpha, beta, gamma) = (a.norm_squared(), b.norm_squared(), a.dot(&b));
            if gamma.abs() <= f64::EPSILON * sqrt(alpha * beta) {
                continue;
            }
            has_turned = true;
            let zeta = (beta - alpha) / (2.0 * gamma);
            let tan = 1_f64.copysign(zeta) / (zeta.abs() + hypot(1.0, zeta));
            let cos = 1.0 / hypot(1.0, tan);
            let sin = cos * tan;
            for matrix in [&mut *u, &mut *v] {
                let a = matrix.column(first).into_owned();
                let b = matrix.column(second).into_owned();
                matrix.set_column(first, &(a * cos - b * sin));
                matrix.set_column(second, &(a * sin + b * cos));
            }
        }
    }
    has_turned
}

#[expect(clippy::cast_precision_loss, reason = "2^53 rows fit in no memory")]
fn count(count: usize) -> f64 {
    count as f64
}
