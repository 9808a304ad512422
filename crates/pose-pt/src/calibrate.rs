//! The frame of a locator from measured points.

use nalgebra::{Matrix3, Point3, RealField, Vector3};
use trig_kernels::{Trig, atan2};

use crate::fit::{longest, mean, rms_and_largest};
use crate::number::{first_beyond, largest, smallest};
use crate::short::short;
use crate::svd::Svd;

/// A locator's frame, as measured: what
/// [`Locator::with_calibration`](crate::Locator::with_calibration) takes over.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Calibration<T: RealField = f64> {
    /// Where the held point is when the axes are at zero.
    pub origin: Point3<T>,
    /// Columns: the displacement of the held point per unit of each axis.
    pub axes: Matrix3<T>,
    /// Root of the mean square of the residuals' lengths.
    pub rms: T,
    /// Length of the largest residual.
    pub max_residual: T,
}

impl<T: RealField + Trig> Calibration<T> {
    /// Travel of the held point per unit of each axis: 1 where the scale is right.
    #[must_use]
    pub fn scales(&self) -> Vector3<T> {
        let [x, y, z] = self.columns();
        Vector3::new(x.norm(), y.norm(), z.norm())
    }

    /// What the angles between the axes (Y to Z, Z to X, X to Y) have more than 90°, in
    /// radians.
    #[must_use]
    pub fn squareness_errors(&self) -> Vector3<T> {
        let [x, y, z] = self.columns();
        let error = |a: Vector3<T>, b: Vector3<T>| -atan2(a.dot(&b), a.cross(&b).norm());
        Vector3::new(error(y, z), error(z, x), error(x, y))
    }

    fn columns(&self) -> [Vector3<T>; 3] {
        [0, 1, 2].map(|column| self.axes.column(column).into_owned())
    }
}

/// Why measured points give no frame.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CalibrationError<T: RealField + Copy = f64> {
    /// The number of axis positions and points differs.
    #[error("{positions} axis positions for {points} points")]
    Count {
        /// Axis positions given.
        positions: usize,
        /// Points given.
        points: usize,
    },
    /// Fewer than four points.
    #[error("{count} points do not determine a frame, 4 do")]
    TooFew {
        /// Points given.
        count: usize,
    },
    /// A number is not finite, or beyond the range of the crate.
    #[error("{} of measurement {point} is not within ±{}", short(.value), short(.max))]
    Coordinate {
        /// The measurement, from 0.
        point: usize,
        /// Its coordinate.
        value: T,
        /// Largest coordinate.
        max: T,
    },
    /// The axis positions lie in a plane, on a line or in a point: some axis was not
    /// moved by itself.
    #[error(
        "the axis positions span {rank} of 3 directions: {} across, more than {} is needed",
        short(.width), short(.needed)
    )]
    Rank {
        /// Directions that they span.
        rank: u8,
        /// Extent across the others.
        width: T,
        /// Extent needed.
        needed: T,
    },
}

/// Smallest extent across against the largest, in roots of the machine epsilon.
const WIDTH_ROOTS: f64 = 16.0;

/// The frame of a locator from axis positions and the points of the world where its held
/// point was measured, by least squares.
///
/// ```text
/// A = Σ (pᵢ - p̄)(qᵢ - q̄)ᵀ (Σ (qᵢ - q̄)(qᵢ - q̄)ᵀ)⁻¹,   origin = p̄ - A q̄
/// ```
///
/// Four measurements whose axis positions are not in a plane determine a frame; the
/// residuals say something from the fifth on. Directions and scales are free: the frame
/// need not be orthogonal.
///
/// # Errors
/// [`CalibrationError`].
pub fn calibrate<T: RealField + Copy>(
    positions: &[Vector3<T>],
    points: &[Point3<T>],
) -> Result<Calibration<T>, CalibrationError<T>> {
    if positions.len() != points.len() {
        return Err(CalibrationError::Count {
            positions: positions.len(),
            points: points.len(),
        });
    }
    if positions.len() < 4 {
        return Err(CalibrationError::TooFew {
            count: positions.len(),
        });
    }
    let max = largest::<T>();
    for (point, (position, met)) in positions.iter().zip(points).enumerate() {
        if let Some(value) = first_beyond(position.iter().chain(met.iter()), max) {
            return Err(CalibrationError::Coordinate { point, value, max });
        }
    }
    let mean_axes = mean(positions.iter().copied());
    let mean_point = mean(points.iter().map(|point| point.coords));
    let arms = || {
        positions
            .iter()
            .zip(points)
            .map(|(position, point)| (position - mean_axes, point.coords - mean_point))
    };
    // In units of the longest, so that no square of a square leaves the range.
    let extent = longest(arms().map(|(position, _)| position)).norm();
    if extent < smallest() {
        return Err(CalibrationError::Rank {
            rank: 0,
            width: extent,
            needed: smallest(),
        });
    }
    let directions = || arms().map(|(position, _)| position / extent);
    let scatter: Matrix3<T> = directions().map(|d| d * d.transpose()).sum();
    let inverse = inverse_scatter(&Svd::new(&scatter), extent)?;
    let mut axes = Matrix3::zeros();
    // The second round takes back the rounding of the first.
    for _ in 0..2 {
        let moment: Matrix3<T> = arms()
            .zip(directions())
            .map(|((position, point), direction)| (point - axes * position) * direction.transpose())
            .sum();
        axes += moment * inverse / extent;
    }
    let (rms, max_residual) =
        rms_and_largest(arms().map(|(position, point)| point - axes * position));
    Ok(Calibration {
        origin: Point3::from(mean_point - axes * mean_axes),
        axes,
        rms,
        max_residual,
    })
}

fn inverse_scatter<T: RealField + Copy>(
    svd: &Svd<T>,
    extent: T,
) -> Result<Matrix3<T>, CalibrationError<T>> {
    let [s1, s2, s3] = svd.sigma.map(|sigma| sigma.abs());
    let root = T::default_epsilon().sqrt() * nalgebra::convert::<f64, T>(WIDTH_ROOTS);
    let needed = s1.sqrt() * root;
    let rank = [s1, s2, s3]
        .iter()
        .map(|sigma| u8::from(sigma.sqrt() > needed))
        .sum();
    if rank < 3 {
        let width = if rank < 2 { s2.sqrt() } else { s3.sqrt() };
        return Err(CalibrationError::Rank {
            rank,
            width: width * extent,
            needed: needed * extent,
        });
    }
    let [u1, u2, u3] = &svd.u;
    Ok(u1 * u1.transpose() / s1 + u2 * u2.transpose() / s2 + u3 * u3.transpose() / s3)
}
