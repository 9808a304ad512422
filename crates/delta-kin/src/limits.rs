//! Joint limits, and a few numbers that every type has.

use nalgebra::RealField;

use crate::GeometryError;

/// The closed range of one arm's angle, in radians, at most a whole turn wide.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct JointRange<T = f64> {
    min: T,
    max: T,
}

impl<T: RealField + Copy> JointRange<T> {
    /// A range from `min` to `max`, in radians.
    ///
    /// # Errors
    /// [`GeometryError::Range`] unless both are finite and `min < max <= min + 2π`.
    pub fn new(min: T, max: T) -> Result<Self, GeometryError<T>> {
        if min.is_finite() && max.is_finite() && min < max && max - min <= T::two_pi() {
            Ok(Self { min, max })
        } else {
            Err(GeometryError::Range { min, max })
        }
    }

    /// Lower end, in radians.
    #[must_use]
    pub const fn min(&self) -> T {
        self.min
    }

    /// Upper end, in radians.
    #[must_use]
    pub const fn max(&self) -> T {
        self.max
    }

    /// Whether `angle`, taken as it is, lies in the range.
    #[must_use]
    pub fn contains(&self, angle: T) -> bool {
        self.min <= angle && angle <= self.max
    }
}

/// The largest finite number; every `RealField` of machine floats has one.
pub(crate) fn max_value<T: RealField>() -> T {
    T::max_value().unwrap_or_else(T::one)
}

pub(crate) fn two<T: RealField>() -> T {
    T::one() + T::one()
}

pub(crate) fn half<T: RealField>() -> T {
    nalgebra::convert(0.5)
}
