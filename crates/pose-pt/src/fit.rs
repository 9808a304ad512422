//! The rigid motion that brings points nearest to points.

use nalgebra::{Isometry3, Matrix3, Point3, RealField, Vector3};

use crate::number::{epsilons, first_beyond, largest, smallest};
use crate::rotation::{quaternion, to_matrix};
use crate::short::short;
use crate::svd::Svd;

/// Which of the two sets of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a motion has two ends")]
pub enum PointSet {
    /// The points that are moved: the body's.
    From,
    /// The points that are met: the measured ones.
    To,
}

impl core::fmt::Display for PointSet {
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
pub enum FitError<T: RealField + Copy = f64> {
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
    /// A coordinate is not finite, or beyond the range of the crate.
    #[error("coordinate {} of the {set} point {point} is not within ±{}", short(.value), short(.max))]
    Coordinate {
        /// The set.
        set: PointSet,
        /// The point, from 0.
        point: usize,
        /// Its coordinate.
        value: T,
        /// Largest coordinate.
        max: T,
    },
    /// All points are the same within rounding, or below the range of the crate.
    #[error("the {set} points coincide within {}, more than {} is needed", short(.length), short(.needed))]
    Coincident {
        /// The set.
        set: PointSet,
        /// Largest distance from their mean.
        length: T,
        /// Distance needed.
        needed: T,
    },
    /// All points are on a line within rounding: the rotation about it is free.
    #[error(
        "the {set} points are on a line: {} wide, {} long, more than {} is needed",
        short(.width), short(.length), short(.needed)
    )]
    Collinear {
        /// The set.
        set: PointSet,
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
        "two rotations fit equally well: eigenvalue gap {}, more than {} is needed",
        short(.gap), short(.needed)
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
    /// Directions that the moved points span: 2 for a plane, else 3. Both determine a
    /// pose.
    pub rank: u8,
}

impl<T: RealField + Copy> RigidFit<T> {
    /// What is left between a moved and a met point.
    #[must_use]
    pub fn residual(&self, from: &Point3<T>, to: &Point3<T>) -> Vector3<T> {
        to - self.motion * from
    }
}

/// Rounding of coordinates, of their mean and of the differences from it, in machine
/// epsilons of the largest coordinate: a set that is narrower has no width.
const ROUNDING_EPSILONS: f64 = 64.0;

/// Smallest eigenvalue gap against the second singular value, in machine epsilons.
const GAP_EPSILONS: f64 = 64.0;

/// Mean and shape of a set of points.
pub(crate) struct Shape<T: RealField> {
    mean: Vector3<T>,
    /// Largest distance from the mean.
    length: T,
    /// Columns: the direction of the farthest point, of the widest one, and across both.
    frame: Matrix3<T>,
    /// Directions that the points span, 2 or 3.
    rank: u8,
}

impl<T: RealField + Copy> Shape<T> {
    pub(crate) fn new(points: &[Point3<T>], set: PointSet) -> Result<Self, FitError<T>> {
        let far = largest_coordinate(points, set)?;
        let needed = (epsilons::<T>(ROUNDING_EPSILONS) * far).max(smallest());
        let mean = mean(points.iter().map(|point| point.coords));
        let arms = || points.iter().map(|point| point.coords - mean);
        let farthest = longest(arms());
        let length = farthest.norm();
        if length <= needed {
            return Err(FitError::Coincident {
                set,
                length,
                needed,
            });
        }
        let along = farthest / length;
        let widest = longest(arms().map(|arm| arm - along * along.dot(&arm)));
        let width = widest.norm();
        if width <= needed {
            return Err(FitError::Collinear {
                set,
                width,
                length,
                needed,
            });
        }
        // Of a narrow set the first difference is not yet perpendicular.
        let across = widest / width;
        let across = (across - along * along.dot(&across)).normalize();
        let normal = along.cross(&across);
        let height = arms()
            .map(|arm| normal.dot(&arm).abs())
            .fold(T::zero(), T::max);
        Ok(Self {
            mean,
            length,
            frame: Matrix3::from_columns(&[along, across, normal]),
            rank: if height > needed { 3 } else { 2 },
        })
    }

    /// A point in the frame of the set, its farthest point one away from the mean.
    fn local(&self, point: &Point3<T>) -> Vector3<T> {
        self.frame.tr_mul(&(point.coords - self.mean)) / self.length
    }
}

fn largest_coordinate<T: RealField + Copy>(
    points: &[Point3<T>],
    set: PointSet,
) -> Result<T, FitError<T>> {
    let (max, mut far) = (largest::<T>(), T::zero());
    for (point, position) in points.iter().enumerate() {
        if let Some(value) = first_beyond(position.iter(), max) {
            return Err(FitError::Coordinate {
                set,
                point,
                value,
                max,
            });
        }
        far = far.max(position.coords.amax());
    }
    Ok(far)
}

pub(crate) fn mean<T: RealField + Copy>(vectors: impl Iterator<Item = Vector3<T>>) -> Vector3<T> {
    let (sum, count) = vectors.fold((Vector3::zeros(), T::zero()), |(sum, count), vector| {
        (sum + vector, count + T::one())
    });
    sum / count
}

/// Root of the mean square, and the largest, of the lengths of residuals.
pub(crate) fn rms_and_largest<T: RealField + Copy>(
    residuals: impl Iterator<Item = Vector3<T>>,
) -> (T, T) {
    let (mut sum, mut count, mut largest) = (T::zero(), T::zero(), T::zero());
    for residual in residuals {
        sum += residual.norm_squared();
        count += T::one();
        largest = largest.max(residual.norm());
    }
    ((sum / count).sqrt(), largest)
}

pub(crate) fn longest<T: RealField + Copy>(
    vectors: impl Iterator<Item = Vector3<T>>,
) -> Vector3<T> {
    vectors.fold(Vector3::zeros(), |longest, vector| {
        if vector.norm_squared() > longest.norm_squared() {
            vector
        } else {
            longest
        }
    })
}

/// The rotation and translation that bring the points `from` nearest to the points `to`,
/// pair by pair, by least squares.
///
/// ```text
/// R = argmax Σ (bᵢ - b̄)·R (aᵢ - ā),   t = b̄ - R ā
/// ```
///
/// The maximum is found by singular values with proper rotations on both sides (Kabsch,
/// 1976; Umeyama, 1991), each set in the frame of its own farthest and widest point so
/// that narrow sets keep their digits.
/// In f64 the rotation of exact points is right to a few 1e-16 times the largest
/// coordinate divided by the width of the set. A reflection is never returned.
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
    let (a, b) = (
        Shape::new(from, PointSet::From)?,
        Shape::new(to, PointSet::To)?,
    );
    let pairs = || from.iter().zip(to).map(|(p, q)| (a.local(p), b.local(q)));
    let h: Matrix3<T> = pairs().map(|(p, q)| q * p.transpose()).sum();
    let svd = Svd::new(&h);
    let area = a.length * b.length;
    let eigenvalue_gap = svd.gap() * area;
    let needed = svd.second() * epsilons(GAP_EPSILONS) * area;
    if eigenvalue_gap <= needed {
        return Err(FitError::Ambiguous {
            gap: eigenvalue_gap,
            needed,
        });
    }
    let rotation = quaternion(&(b.frame * svd.rotation() * a.frame.transpose()));
    let matrix = to_matrix(&rotation);
    let translation = b.mean - matrix * a.mean;
    let (rms, max_residual) = rms_and_largest(
        from.iter()
            .zip(to)
            .map(|(p, q)| (q.coords - b.mean) - matrix * (p.coords - a.mean)),
    );
    Ok(RigidFit {
        motion: Isometry3::from_parts(translation.into(), rotation),
        rms,
        max_residual,
        eigenvalue_gap,
        rank: a.rank,
    })
}
