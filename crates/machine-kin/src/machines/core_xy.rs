//! CoreXY and H-bot: two motors on one belt, or two.

use core::ops::RangeInclusive;

use crate::{Axis, Machine, Number, Refusal};

/// A CoreXY: both motors together move the carriage along x, against each other along y.
///
/// ```text
/// a = x + y    b = x - y
/// ```
///
/// Axes are the ways of both belts. Ranges are those of the carriage.
#[derive(Debug, Clone, PartialEq)]
pub struct CoreXy {
    x: RangeInclusive<f64>,
    y: RangeInclusive<f64>,
}

/// An H-bot: one belt, and the kinematics of a [`CoreXy`].
pub type HBot = CoreXy;

impl CoreXy {
    /// With the ranges of the carriage.
    #[must_use]
    pub const fn new(x: RangeInclusive<f64>, y: RangeInclusive<f64>) -> Self {
        Self { x, y }
    }
}

impl Machine<2> for CoreXy {
    type Branch = ();

    fn axes(&self) -> [Axis; 2] {
        let any = f64::NEG_INFINITY..=f64::INFINITY;
        [
            Axis::linear("belt a", any.clone()),
            Axis::linear("belt b", any),
        ]
    }

    fn area(&self) -> [RangeInclusive<f64>; 2] {
        [self.x.clone(), self.y.clone()]
    }

    fn inverse<T: Number>(&self, [x, y]: [T; 2], (): ()) -> Result<[T; 2], Refusal> {
        Ok([x + y, x - y])
    }
}
