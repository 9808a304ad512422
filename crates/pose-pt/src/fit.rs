//! The rigid motion that brings points nearest to points.

use nalgebra::{Isometry3, Matrix3, Point3, RealField, Rotation3, UnitQuaternion, Vector3};

use crate::number::{epsilons, largest, two};
use crate::rotation::{from_rotation_vector, to_matrix};
use crate::svd::Svd;

/// Which of the two sets of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a motion has two ends")]
pub enum Side {
    /// The points that are moved: the body's.
    From,
    /// The points that are met: the measured ones.
    To,
}

impl core::fmt::Display for Side {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::From => "moved",
            Self::To => "met",
        })
    }
}

/// Why points have no best motion.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FitError<T = f64> {
    /// The sets differ in size.
    #[error("{from} points are to meet {to}")]
    Count {
        /// Points moved.
        from: usize,
        /// Points met.
        to: usize,
    },
    /// Fewer than three points.
    #[error("{count} points do not determine a pose, 3 do")]
    TooFew {
        /// Points given.
        count: usize,
    },
    /// A coordinate is not finite, or so large that its square overflows.
    #[error("coordinate {value} of the {side} point {point} is not within ±{max:e}")]
    Coordinate {
        /// The set.
        side: Side,
        /// The point, from 0.
        point: usize,
        /// Its coordinate.
        value: T,
        /// Largest coordinate.
        max: T,
    },
    /// All points are the same within rounding.
    #[error("the {side} points coincide within {length}")]
    Coincident {
        /// The set.
        side: Side,
        /// Largest distance from their mean.
        length: T,
    },
    /// All points are on a line within rounding: the rotation about it is free.
    #[error(
        "the {side} points are on a line: {width} wide, {length} long, at least {needed} is needed"
    )]
    Collinear {
        /// The set.
        side: Side,
        /// Largest distance from the line.
        width: T,
        /// Largest distance from their mean.
        length: T,
        /// Width needed.
        needed: T,
    },
    /// Two different rotations fit equally well, as when the points met are a mirror
    /// image of those moved.
    #[error(
        "two rotations fit equally well: eigenvalue gap {gap:e}, more than {needed:e} is needed"
    )]
    Ambiguous {
        /// Eigenvalue gap, in length².
        gap: T,
        /// Gap needed.
        needed: T,
    },
}

/// The rigid motion that brings points nearest to points, by least squares.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct RigidFit<T: RealField = f64> {
    /// The motion; a rotation and a translation, never a reflection.
    pub motion: Isometry3<T>,
    /// Root of the mean square of the residuals' lengths.
    pub rms: T,
    /// Length of the largest residual.
    pub max_residual: T,
    /// Gap between the two largest eigenvalues of the quaternion problem, in length²:
    /// the smaller, the softer the rotation.
    pub eigenvalue_gap: T,
}

impl<T: RealField + Copy> RigidFit<T> {
    /// What is left between a moved and a met point.
    #[must_use]
    pub fn residual(&self, from: &Point3<T>, to: &Point3<T>) -> Vector3<T> {
        to - self.motion * from
    }
}

/// Width of a set of points against its length, in roots of the machine epsilon: the
/// matrix of the fit holds products of two coordinates.
const WIDTH_ROOTS: f64 = 16.0;

/// Rounding of the mean and of the differences from it, in machine epsilons.
const MEAN_EPSILONS: f64 = 16.0;

/// Least eigenvalue gap against the largest singular value, in machine epsilons.
const GAP_EPSILONS: f64 = 64.0;

/// Mean and shape of a set of points.
pub(crate) struct Shape<T: RealField> {
    mean: Vector3<T>,
    /// Largest distance from the mean.
    length: T,
}

impl<T: RealField + Copy> Shape<T> {
    pub(crate) fn new(points: &[Point3<T>], side: Side) -> Result<Self, FitError<T>> {
        let max = largest::<T>();
        let (mut sum, mut count, mut far) = (Vector3::zeros(), T::zero(), T::zero());
        for (point, place) in points.iter().enumerate() {
            for value in place.iter().copied() {
                if !(value.abs() <= max) {
                    return Err(FitError::Coordinate {
                        side,
                        point,
                        value,
                        max,
                    });
                }
                far = far.max(value.abs());
            }
            sum += place.coords;
            count += T::one();
        }
        let mean = sum / count;
        let (mut length, mut farthest) = (T::zero(), Vector3::zeros());
        for arm in points.iter().map(|point| point.coords - mean) {
            if arm.norm() > length {
                (length, farthest) = (arm.norm(), arm);
            }
        }
        let rounding = epsilons::<T>(MEAN_EPSILONS) * far;
        if length <= rounding {
            return Err(FitError::Coincident { side, length });
        }
        let line = farthest / length;
        let width = points
            .iter()
            .map(|point| (point.coords - mean).cross(&line).norm())
            .fold(T::zero(), T::max);
        let root = T::default_epsilon().sqrt();
        let needed = rounding + root * nalgebra::convert::<f64, T>(WIDTH_ROOTS) * length;
        if width <= needed {
            return Err(FitError::Collinear {
                side,
                width,
                length,
                needed,
            });
        }
        Ok(Self { mean, length })
    }
}

/// The rotation and translation that bring the points `from` nearest to the points `to`.
///
/// # Errors
/// [`FitError`].
pub fn rigid_fit<T: RealField + Copy>(
    from: &[Point3<T>],
    to: &[Point3<T>],
) -> Result<RigidFit<T>, FitError<T>> {
    if from.len() != to.len() {
        return Err(FitError::Count {
            from: from.len(),
            to: to.len(),
        });
    }
    if from.len() < 3 {
        return Err(FitError::TooFew { count: from.len() });
    }
    let (a, b) = (Shape::new(from, Side::From)?, Shape::new(to, Side::To)?);
    let arms = || {
        from.iter().zip(to).map(|(from, to)| {
            (
                (from.coords - a.mean) / a.length,
                (to.coords - b.mean) / b.length,
            )
        })
    };
    let h: Matrix3<T> = arms().map(|(from, to)| to * from.transpose()).sum();
    let svd = Svd::new(&h);
    let [s1, s2, s3] = svd.sigma;
    let area = a.length * b.length;
    let needed = epsilons::<T>(GAP_EPSILONS) * s1;
    let gap = two::<T>() * (s2 + s3);
    if !(gap > needed) {
        return Err(FitError::Ambiguous {
            gap: gap * area,
            needed: needed * area,
        });
    }
    let start =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(svd.rotation()));
    let mut rotation = start;
    for _ in 0..REFINEMENTS {
        rotation = refined(&rotation, arms(), &svd);
    }
    let matrix = to_matrix(&rotation);
    let translation = b.mean - matrix * a.mean;
    let motion = Isometry3::from_parts(translation.into(), rotation);
    let (mut sum, mut count, mut max_residual) = (T::zero(), T::zero(), T::zero());
    for (from, to) in from.iter().zip(to) {
        let residual = (to.coords - b.mean - matrix * (from.coords - a.mean)).norm();
        sum += residual * residual;
        count += T::one();
        max_residual = max_residual.max(residual);
    }
    Ok(RigidFit {
        motion,
        rms: (sum / count).sqrt(),
        max_residual,
        eigenvalue_gap: gap * area,
    })
}

/// Newton steps after the decomposition: of a narrow set it leaves an error of the
/// epsilon times (length / width)², which one step squares and a second polishes.
const REFINEMENTS: usize = 2;

/// One Newton step: the residuals' moment against the stiffness of the fit.
fn refined<T: RealField + Copy>(
    rotation: &UnitQuaternion<T>,
    arms: impl Iterator<Item = (Vector3<T>, Vector3<T>)>,
    svd: &Svd<T>,
) -> UnitQuaternion<T> {
    let matrix = to_matrix(rotation);
    let moment: Vector3<T> = arms
        .map(|(from, to)| {
            let moved = matrix * from;
            moved.cross(&(to - moved))
        })
        .sum();
    let ([u1, u2, u3], [s1, s2, s3]) = (&svd.u, svd.sigma);
    let turn = u1 * (u1.dot(&moment) / (s2 + s3))
        + u2 * (u2.dot(&moment) / (s1 + s3))
        + u3 * (u3.dot(&moment) / (s1 + s2));
    UnitQuaternion::new_normalize((from_rotation_vector(&turn) * rotation).into_inner())
}
