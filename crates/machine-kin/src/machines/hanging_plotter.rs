//! Hanging plotter: a pen on two cords from two winches.

use core::ops::RangeInclusive;

use crate::machines::{GeometryError, check_lengths};
use crate::{Axis, Machine, Number, Refusal};

/// A pen that hangs from two winches: x to the right of the left winch, y downwards.
///
/// ```text
/// o------ width ------o     left  = √(x² + y²)
///  \                 /      right = √((width - x)² + y²)
///   \     o pen     /
/// ```
///
/// Axes are the lengths of the cords. The pen hangs where it is between the winches and below both;
/// on the line between them the machine is singular.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HangingPlotter {
    width: f64,
    cords: [f64; 2],
}

impl HangingPlotter {
    /// From the distance of the winches and the least and the largest length of a cord.
    ///
    /// # Errors
    /// [`GeometryError`] of a distance that is not above 0.
    pub fn new(width: f64, cords: RangeInclusive<f64>) -> Result<Self, GeometryError> {
        check_lengths([("width", width)])?;
        Ok(Self {
            width,
            cords: [*cords.start(), *cords.end()],
        })
    }
}

impl Machine<2> for HangingPlotter {
    type Branch = ();

    fn axes(&self) -> [Axis; 2] {
        let [min, max] = self.cords;
        [
            Axis::linear("left cord", min..=max),
            Axis::linear("right cord", min..=max),
        ]
    }

    fn inverse<T: Number>(&self, [x, y]: [T; 2], (): ()) -> Result<[T; 2], Refusal> {
        let beside = T::from(self.width) - x;
        x.require_positive("the pen is left of the left winch")?;
        beside.require_positive("the pen is right of the right winch")?;
        y.require_positive("the pen is above the winches")?;
        let cord = |x: T| (x.squared() + y.squared()).root("the pen is at a winch");
        Ok([cord(x)?, cord(beside)?])
    }
}
