//! The checks of a platform and of its axes.

use nalgebra::{Matrix3, Point3, RealField, Vector3};

use crate::fit::{FitError, PointSet, Shape};
use crate::number::{epsilons, first_beyond, largest, smallest};
use crate::{Axis, LimitError, Locator, PlatformError};

/// Axes that one motion card drives [Alignment 2010].
const MAX_AXES: usize = 32;

/// Errors of scale of an axis.
const AXIS_LENGTH: [f64; 2] = [0.5, 2.0];

/// Smallest volume of the unit directions: axes 6° from a plane.
const MIN_VOLUME: f64 = 0.1;

/// Distance of two anchors against the largest coordinate, in machine epsilons.
const DISTANCE_EPSILONS: f64 = 64.0;

pub(super) fn count<T: RealField + Copy>(locators: usize) -> Result<(), PlatformError<T>> {
    let max = MAX_AXES / 3;
    if (3..=max).contains(&locators) {
        Ok(())
    } else {
        Err(PlatformError::Count { locators, max })
    }
}

/// The matrix that turns a vector of the world into axis coordinates.
pub(super) fn locator<T: RealField + Copy>(
    number: usize,
    locator: &Locator<T>,
) -> Result<Matrix3<T>, PlatformError<T>> {
    let max = largest::<T>();
    for (name, values) in [
        ("anchor", locator.anchor.coords.as_slice()),
        ("origin", locator.origin.coords.as_slice()),
        ("axis direction", locator.axes.as_slice()),
    ] {
        if let Some(value) = first_beyond(values, max) {
            return Err(PlatformError::Coordinate {
                locator: number,
                name,
                value,
                max,
            });
        }
    }
    for (axis, limits) in Axis::ALL.into_iter().zip(&locator.limits) {
        let (min, max) = (limits.min, limits.max);
        if !(min.is_finite() && max.is_finite() && min < max) {
            return Err(PlatformError::Stroke {
                locator: number,
                axis,
                min,
                max,
            });
        }
        for (name, value) in [
            ("speed", Some(limits.speed)),
            ("acceleration", Some(limits.acceleration)),
            ("jerk", limits.jerk),
        ] {
            let (min, max) = (smallest(), largest());
            if let Some(value) = value.filter(|value| !(*value >= min && *value <= max)) {
                return Err(PlatformError::Rating {
                    locator: number,
                    axis,
                    name,
                    value,
                    min,
                    max,
                });
            }
        }
    }
    directions(number, &locator.axes)
}

fn directions<T: RealField + Copy>(
    number: usize,
    axes: &Matrix3<T>,
) -> Result<Matrix3<T>, PlatformError<T>> {
    let [min, max] = AXIS_LENGTH.map(nalgebra::convert::<f64, T>);
    let mut product = T::one();
    for (axis, direction) in Axis::ALL.into_iter().zip(axes.column_iter()) {
        let length = direction.norm();
        if !(length >= min && length <= max) {
            return Err(PlatformError::AxisLength {
                locator: number,
                axis,
                length,
                min,
                max,
            });
        }
        product *= length;
    }
    let volume = axes.determinant().abs() / product;
    let min = nalgebra::convert(MIN_VOLUME);
    let dependent = PlatformError::DependentAxes {
        locator: number,
        volume,
        min,
    };
    if volume < min {
        return Err(dependent);
    }
    axes.try_inverse().ok_or(dependent)
}

/// The largest distance between two anchors.
pub(super) fn anchors<T: RealField + Copy>(anchors: &[Point3<T>]) -> Result<T, PlatformError<T>> {
    let far = anchors
        .iter()
        .map(|p| p.coords.amax())
        .fold(T::zero(), T::max);
    let needed = (epsilons::<T>(DISTANCE_EPSILONS) * far).max(smallest());
    let mut largest = T::zero();
    for (second, anchor) in anchors.iter().enumerate() {
        for (first, other) in anchors.iter().enumerate().take(second) {
            let distance = (anchor - other).norm();
            if distance <= needed {
                return Err(PlatformError::Coincident {
                    first,
                    second,
                    distance,
                    needed,
                });
            }
            largest = largest.max(distance);
        }
    }
    match Shape::new(anchors, PointSet::From) {
        Err(FitError::Collinear {
            width,
            length,
            needed,
            ..
        }) => Err(PlatformError::Collinear {
            width,
            length,
            needed,
        }),
        Err(FitError::Coincident { length, needed, .. }) => Err(PlatformError::Collinear {
            width: length,
            length,
            needed,
        }),
        // Count and coordinates have been checked.
        Ok(_) | Err(_) => Ok(largest),
    }
}

/// Rounding of axes to pose to axes, in machine epsilons of all lengths involved: a fit,
/// a rotation, three sums and a frame.
const ROUNDING_EPSILONS: f64 = 16.0;

/// What axis coordinates are off by rounding.
fn rounding<T: RealField + Copy>(locator: &Locator<T>, coordinates: &Vector3<T>) -> T {
    let span = locator.anchor.coords.norm() + locator.origin.coords.norm() + coordinates.amax();
    span * epsilons(ROUNDING_EPSILONS)
}

pub(super) fn strokes<T: RealField + Copy>(
    locators: &[Locator<T>],
    axes: &[Vector3<T>],
) -> Result<(), LimitError<T>> {
    let mut worst: Option<(T, LimitError<T>)> = None;
    for (number, (locator, coordinates)) in locators.iter().zip(axes).enumerate() {
        let each = Axis::ALL.into_iter().zip(coordinates.iter().copied());
        for ((axis, value), limits) in each.zip(&locator.limits) {
            if !value.is_finite() {
                return Err(LimitError::NotFinite {
                    locator: number,
                    axis,
                    value,
                });
            }
            let by = (limits.min - value).max(value - limits.max);
            if by > T::zero()
                && by > rounding(locator, coordinates)
                && worst.is_none_or(|(largest, _)| by > largest)
            {
                let (min, max) = (limits.min, limits.max);
                let error = LimitError::Stroke {
                    locator: number,
                    axis,
                    value,
                    min,
                    max,
                    by,
                };
                worst = Some((by, error));
            }
        }
    }
    worst.map_or(Ok(()), |(_, error)| Err(error))
}
