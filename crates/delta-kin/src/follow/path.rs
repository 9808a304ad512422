//! Straight lines and arcs of circles.

use nalgebra::{Point3, RealField, Vector3};

use crate::limits::{max_value, two};

/// A way of the platform's centre in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Path<T: RealField = f64> {
    shape: Shape<T>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape<T: RealField> {
    Line {
        from: Point3<T>,
        to: Point3<T>,
    },
    Arc {
        centre: Point3<T>,
        /// From the centre to the start.
        start: Vector3<T>,
        /// A quarter turn further.
        ahead: Vector3<T>,
        angle: T,
    },
}

/// Why a path is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PathError {
    /// A coordinate or angle is infinite, not a number, or too large to reckon with.
    #[error("a coordinate or angle of the path is not finite")]
    NotFinite,
    /// The arc starts at its centre, or its axis has no direction.
    #[error("the arc has no radius, or its axis no direction")]
    NoRadius,
    /// The start does not lie in the plane through the centre square to the axis.
    #[error("the arc's start is not in the plane of its centre")]
    Helix,
}

/// How far out of its plane an arc's start may be, in units of its radius: 1e-9 for points typed
/// in, and some roundings of `T`.
const OUT_OF_PLANE: f64 = 1e-9;

impl<T: RealField + Copy> Path<T> {
    /// A straight line.
    ///
    /// # Errors
    /// [`PathError::NotFinite`].
    pub fn line(from: Point3<T>, to: Point3<T>) -> Result<Self, PathError> {
        if !(to - from).norm_squared().is_finite() {
            return Err(PathError::NotFinite);
        }
        Ok(Self {
            shape: Shape::Line { from, to },
        })
    }

    /// An arc of `angle` radians from `start`, round the axis through `centre`, counter-clockwise
    /// seen against the axis; negative: clockwise. 2π and more go round.
    ///
    /// # Errors
    /// [`PathError`].
    pub fn arc(
        start: Point3<T>,
        centre: Point3<T>,
        axis: Vector3<T>,
        angle: T,
    ) -> Result<Self, PathError> {
        let out = start - centre;
        let (radius, length) = (out.norm(), axis.norm());
        if !(angle.is_finite() && radius.is_finite() && length.is_finite()) {
            return Err(PathError::NotFinite);
        }
        if !(radius > T::zero() && length > T::zero()) {
            return Err(PathError::NoRadius);
        }
        let axis = axis / length;
        let rounding = T::default_epsilon() * nalgebra::convert(64.0);
        let slack = rounding.max(nalgebra::convert(OUT_OF_PLANE));
        if out.dot(&axis).abs() > radius * slack {
            return Err(PathError::Helix);
        }
        Ok(Self {
            shape: Shape::Arc {
                centre,
                start: out,
                ahead: axis.cross(&out),
                angle,
            },
        })
    }

    /// Length of the path.
    #[must_use]
    pub fn length(&self) -> T {
        match &self.shape {
            Shape::Line { from, to } => (to - from).norm(),
            Shape::Arc { start, angle, .. } => (start.norm() * angle.abs()).min(max_value()),
        }
    }

    /// The place after a share of the path, 0..=1.
    #[must_use]
    pub fn point_at(&self, fraction: T) -> Point3<T> {
        match &self.shape {
            // From the nearer end, so that both are met exactly.
            Shape::Line { from, to } if fraction * two() < T::one() => {
                from + (to - from) * fraction
            }
            Shape::Line { from, to } => to - (to - from) * (T::one() - fraction),
            Shape::Arc {
                centre,
                start,
                ahead,
                angle,
            } => {
                let (sin, cos) = (*angle * fraction).sin_cos();
                centre + start * cos + ahead * sin
            }
        }
    }

    /// How far a share of the path departs from the straight line between its ends; none for
    /// more than half a turn.
    pub(super) fn height(&self, share: T) -> Option<T> {
        match &self.shape {
            Shape::Line { .. } => Some(T::zero()),
            Shape::Arc { start, angle, .. } => {
                let turn = (*angle * share).abs();
                // r (1 - cos(turn/2)) without its cancellation.
                let sin = (turn / (two::<T>() * two())).sin();
                (turn <= T::pi()).then(|| start.norm() * two() * sin * sin)
            }
        }
    }
}
