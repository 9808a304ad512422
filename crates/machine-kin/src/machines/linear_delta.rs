//! Linear Delta: three carriages on columns, each with a rod to the platform.

use core::f64::consts::TAU;
use core::ops::RangeInclusive;

use trig_kernels::{sin_cos, sqrt};

use crate::machines::{GeometryError, check_lengths, check_reach};
use crate::{Axis, Machine, Number, Refusal};

/// A linear Delta: columns on a circle round the z axis, seen from above
///
/// ```text
///       o 3                 columns at radius r, 1 at -150°, 2 at -30°, 3 at 90°
///                           carriage = z + √(rod² - (x - X)² - (y - Y)²)
///   o 1     o 2
/// ```
///
/// with r the distance of a column's joints from the middle less that of the platform's. Carriages
/// are above the platform. Rods that are all in one plane make the machine singular.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearDelta {
    rod: f64,
    columns: [[f64; 2]; 3],
    carriages: [f64; 2],
}

impl LinearDelta {
    /// From the length of the rods, the radius of the columns less that of the platform, and the
    /// range of the carriages' heights.
    ///
    /// # Errors
    /// [`GeometryError`] of a length that is not above 0, and of a rod that is not longer than the
    /// radius: not even the middle is within its reach.
    pub fn new(
        rod: f64,
        radius: f64,
        carriages: RangeInclusive<f64>,
    ) -> Result<Self, GeometryError> {
        check_lengths([("rod", rod), ("radius", radius)])?;
        check_reach("rod", rod, radius)?;
        let column = |turns: f64| {
            let (sin, cos) = sin_cos(turns * TAU);
            [radius * cos, radius * sin]
        };
        Ok(Self {
            rod,
            columns: [-5.0 / 12.0, -1.0 / 12.0, 0.25].map(column),
            carriages: [*carriages.start(), *carriages.end()],
        })
    }

    /// With each column where it was measured, less the platform's joint.
    ///
    /// # Errors
    /// [`GeometryError`] of columns in a line, which hold no platform, and of a rod that is not
    /// longer than the radius of the smallest circle round the columns: no place is within reach of
    /// all three.
    pub fn with_columns(mut self, columns: [[f64; 2]; 3]) -> Result<Self, GeometryError> {
        let [first, second, third] = columns;
        let apart = |[from, to]: [[f64; 2]; 2]| [to[0] - from[0], to[1] - from[1]];
        let sides = [[first, second], [second, third], [third, first]].map(apart);
        let [[across, along], [aside, ahead], _] = sides;
        let double_area = (across * ahead - along * aside).abs();
        check_lengths([("the area between the columns", 0.5 * double_area)])?;

        let mut squares = sides.map(|[x, y]| x * x + y * y);
        squares.sort_unstable_by(f64::total_cmp);
        let [short, middle, long] = squares;
        let is_obtuse = long >= short + middle;
        let radius = if is_obtuse {
            0.5 * sqrt(long)
        } else {
            0.5 * sqrt(short) * sqrt(middle) * sqrt(long) / double_area
        };
        check_reach("rod", self.rod, radius)?;
        self.columns = columns;
        Ok(self)
    }
}

impl Machine<3> for LinearDelta {
    type Branch = ();

    fn axes(&self) -> [Axis; 3] {
        let [min, max] = self.carriages;
        ["carriage 1", "carriage 2", "carriage 3"].map(|name| Axis::linear(name, min..=max))
    }

    fn inverse<T: Number>(&self, [x, y, z]: [T; 3], (): ()) -> Result<[T; 3], Refusal> {
        let carriage = |[column_x, column_y]: [f64; 2], reason| {
            let away = (x - column_x).squared() + (y - column_y).squared();
            Ok(z + (T::from(self.rod * self.rod) - away).root(reason)?)
        };
        let [first, second, third] = self.columns;
        Ok([
            carriage(first, "rod 1 is too short")?,
            carriage(second, "rod 2 is too short")?,
            carriage(third, "rod 3 is too short")?,
        ])
    }
}
