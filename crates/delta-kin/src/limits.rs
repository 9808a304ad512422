//! The range of an arm's angle.

use nalgebra::RealField;

use crate::GeometryError;
use crate::range::{is_within, largest_angle, max_value};

/// The closed range of one arm's angle, in radians, at most a whole turn wide.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ArmRange<T = f64> {
    min: T,
    max: T,
}

impl<T: RealField + Copy> ArmRange<T> {
    /// A range from `min` to `max`, in radians.
    ///
    /// # Errors
    /// [`GeometryError::ArmRange`] unless both are within ±1/√ε and `min < max <= min + 2π`.
    pub fn new(min: T, max: T) -> Result<Self, GeometryError<T>> {
        let are_angles = is_within(min, largest_angle()) && is_within(max, largest_angle());
        if are_angles && min < max && max - min <= T::two_pi() {
            Ok(Self { min, max })
        } else {
            let largest = largest_angle();
            Err(GeometryError::ArmRange { min, max, largest })
        }
    }

    /// Any angle.
    #[must_use]
    pub fn unlimited() -> Self {
        let huge = max_value::<T>();
        Self {
            min: -huge,
            max: huge,
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
