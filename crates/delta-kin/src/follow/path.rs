//! Straight lines and arcs of circles.

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::{Trig, sin_cos};

use crate::range::{is_within, largest_angle, largest_coordinate, length, two};
use crate::rounded::Rounded;

/// A path of the platform's centre in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlatformPath<T: RealField = f64> {
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
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PlatformPathError<T: RealField + Copy = f64> {
    /// A number of the path is not one of the stated size.
    #[error("{name} {} of the path is not within ±{}", Rounded(*.value), Rounded(*.largest))]
    OutOfRange {
        /// `coordinate`, `axis component` or `angle`.
        name: &'static str,
        /// The value given, in the unit of length or in radians.
        value: T,
        /// The largest allowed, either way.
        largest: T,
    },
    /// The arc starts at its centre.
    #[error("the arc starts at its centre")]
    NoRadius,
    /// The axis has no direction.
    #[error("the arc's axis has no direction")]
    NoAxis,
    /// The start does not lie in the plane through the centre perpendicular to the axis.
    #[error("the arc's start is {} out of the plane of its centre", Rounded(*.by))]
    Helix {
        /// How far it is from that plane, in the unit of length.
        by: T,
    },
}

/// How far out of its plane an arc's start may be, in units of its radius: 1e-9 for points typed
/// in, and some roundings of `T`.
const OUT_OF_PLANE: f64 = 1e-9;

impl<T: RealField + Trig> PlatformPath<T> {
    /// A straight line. Coordinates are within ±4 h, h the fourth root of the largest number
    /// divided by 32 (f64: ±1.4e76, f32: ±5.4e8).
    ///
    /// # Errors
    /// [`PlatformPathError::OutOfRange`].
    pub fn line(from: Point3<T>, to: Point3<T>) -> Result<Self, PlatformPathError<T>> {
        within("coordinate", from.coords, largest_coordinate())?;
        within("coordinate", to.coords, largest_coordinate())?;
        Ok(Self {
            shape: Shape::Line { from, to },
        })
    }

    /// An arc of `angle` radians from `start`, round the axis through `centre`, counter-clockwise
    /// seen against the axis; negative: clockwise. 2π and more go round. Coordinates as for
    /// [`line`](Self::line), the angle within ±1/√ε (f64: 6.7e7, f32: 2900).
    ///
    /// # Errors
    /// [`PlatformPathError`].
    pub fn arc(
        start: Point3<T>,
        centre: Point3<T>,
        axis: Vector3<T>,
        angle: T,
    ) -> Result<Self, PlatformPathError<T>> {
        within("coordinate", start.coords, largest_coordinate())?;
        within("coordinate", centre.coords, largest_coordinate())?;
        within("axis component", axis, largest_coordinate())?;
        let largest = largest_angle();
        if !is_within(angle, largest) {
            let name = "angle";
            let value = angle;
            return Err(PlatformPathError::OutOfRange {
                name,
                value,
                largest,
            });
        }
        let out = start - centre;
        let radius = length(&out);
        if radius <= T::zero() {
            return Err(PlatformPathError::NoRadius);
        }
        let largest = axis.amax();
        if largest <= T::zero() {
            return Err(PlatformPathError::NoAxis);
        }
        let axis = (axis / largest).normalize();
        let rounding = T::default_epsilon() * nalgebra::convert(64.0);
        let slack = rounding.max(nalgebra::convert(OUT_OF_PLANE));
        let by = out.dot(&axis).abs();
        if by > radius * slack {
            return Err(PlatformPathError::Helix { by });
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
            Shape::Line { from, to } => length(&(to - from)),
            Shape::Arc { start, angle, .. } => length(start) * angle.abs(),
        }
    }

    /// The point after a fraction of the path; `None` unless that is within 0..=1.
    #[must_use]
    pub fn point_at(&self, fraction: T) -> Option<Point3<T>> {
        (fraction >= T::zero() && fraction <= T::one()).then(|| self.at(fraction))
    }

    pub(super) fn at(&self, fraction: T) -> Point3<T> {
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
                let (sin, cos) = sin_cos(*angle * fraction);
                centre + start * cos + ahead * sin
            }
        }
    }

    /// How far a fraction of the path departs from the straight line between its ends; none for
    /// more than half a turn.
    pub(super) fn height(&self, fraction: T) -> Option<T> {
        match &self.shape {
            Shape::Line { .. } => Some(T::zero()),
            Shape::Arc { start, angle, .. } => {
                let turn = (*angle * fraction).abs();
                // r (1 - cos(turn/2)) without its cancellation.
                let (sin, _) = sin_cos(turn / (two::<T>() * two()));
                (turn <= T::pi()).then(|| length(start) * two() * sin * sin)
            }
        }
    }
}

fn within<T: RealField + Copy>(
    name: &'static str,
    vector: Vector3<T>,
    largest: T,
) -> Result<(), PlatformPathError<T>> {
    for value in vector.iter().copied() {
        if !is_within(value, largest) {
            return Err(PlatformPathError::OutOfRange {
                name,
                value,
                largest,
            });
        }
    }
    Ok(())
}
