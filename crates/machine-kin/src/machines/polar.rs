//! Polar: a table or an arm that turns, and a carriage along a radius.

use core::ops::RangeInclusive;

use crate::{Axis, Machine, Number, Refusal};

/// On which side of the middle the carriage is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a line has two ends")]
pub enum CarriageSide {
    /// At a radius above 0.
    Front,
    /// At a radius below 0, the arm half a turn further.
    Behind,
}

/// A polar machine.
///
/// ```text
/// angle = atan2(y, x)    radius = √(x² + y²)       in front
/// angle = atan2(-y, -x)  radius = -√(x² + y²)      behind
/// ```
///
/// The arm turns, or the table does by as much the other way. The middle is singular: there the
/// branch ends. The angle may turn without end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polar {
    radius: [f64; 2],
}

impl Polar {
    /// With the range of the carriage, whose lower end is below 0 where it can go behind the
    /// middle.
    #[must_use]
    pub const fn new(radius: RangeInclusive<f64>) -> Self {
        Self {
            radius: [*radius.start(), *radius.end()],
        }
    }
}

impl Machine<2> for Polar {
    type Branch = CarriageSide;

    fn axes(&self) -> [Axis; 2] {
        let [min, max] = self.radius;
        let any = f64::NEG_INFINITY..=f64::INFINITY;
        [Axis::angle("arm", any), Axis::linear("carriage", min..=max)]
    }

    fn inverse<T: Number>(&self, [x, y]: [T; 2], side: CarriageSide) -> Result<[T; 2], Refusal> {
        const MIDDLE: &str = "the tool is in the middle";
        let radius = (x.squared() + y.squared()).root(MIDDLE)?;
        Ok(match side {
            CarriageSide::Front => [T::atan2(y, x, MIDDLE)?, radius],
            CarriageSide::Behind => [T::atan2(-y, -x, MIDDLE)?, -radius],
        })
    }
}
