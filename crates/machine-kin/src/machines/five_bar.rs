//! Five-bar: two motors side by side, each with an upper arm and a forearm, both forearms at the
//! tool.

use crate::machines::{GeometryError, check_lengths, check_reach};
use crate::{Axis, Machine, Number, Refusal};

/// To which side an arm's elbow is of the line from its motor to the tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a line has two sides")]
pub enum Elbow {
    /// To its left, as seen from the motor.
    Left,
    /// To its right.
    Right,
}

/// A five-bar: motors at (-base/2, 0) and (base/2, 0).
///
/// ```text
///       o tool             d = tool - motor,  u upper arm, l forearm
///      / \                 k = (d² + u² - l²) / 2u,  h = ±√(d² - k²)
///     /   \                angle = atan2(dy k + dx h, dx k - dy h)     + with the elbow to the left
///    o     o elbows
///     \   /
///  ----o-o---- motors
/// ```
///
/// Angles are counter-clockwise from the axis of x. A branch is the elbows of the left and the
/// right arm: `[Elbow::Left, Elbow::Right]` bends both outwards. To pass from one to another an arm
/// must be straight or folded, which ends the branch. Where both forearms are in line the machine
/// is singular.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FiveBar {
    base: f64,
    upper: f64,
    fore: f64,
    ranges: [[f64; 2]; 2],
}

impl FiveBar {
    /// From the distance of the motors and the lengths of upper arms and forearms.
    ///
    /// # Errors
    /// [`GeometryError`] of a length that is not above 0, and of a forearm with which the arms do
    /// not meet.
    pub fn new(base: f64, upper: f64, fore: f64) -> Result<Self, GeometryError> {
        check_lengths([("base", base), ("upper arm", upper), ("forearm", fore)])?;
        check_reach("forearm", fore, base / 2.0 - upper)?;
        Ok(Self {
            base,
            upper,
            fore,
            ranges: [[f64::NEG_INFINITY, f64::INFINITY]; 2],
        })
    }

    /// With the least and the largest angle of each motor, in radians.
    #[must_use]
    pub const fn with_ranges(mut self, left: [f64; 2], right: [f64; 2]) -> Self {
        self.ranges = [left, right];
        self
    }

    fn motor<T: Number>(
        &self,
        dx: T,
        dy: T,
        elbow: Elbow,
        reason: &'static str,
    ) -> Result<T, Refusal> {
        let square = dx.squared() + dy.squared();
        let (upper, fore) = (self.upper, self.fore);
        let k = (square + (upper * upper - fore * fore)) / (2.0 * upper);
        let root = (square - k.squared()).root(reason)?;
        let h = match elbow {
            Elbow::Left => root,
            Elbow::Right => -root,
        };
        T::atan2(dy * k + dx * h, dx * k - dy * h, reason)
    }
}

impl Machine<2> for FiveBar {
    type Branch = [Elbow; 2];

    fn axes(&self) -> [Axis; 2] {
        let [[a, b], [c, d]] = self.ranges;
        [
            Axis::angle("left motor", a..=b),
            Axis::angle("right motor", c..=d),
        ]
    }

    fn inverse<T: Number>(
        &self,
        [x, y]: [T; 2],
        [left, right]: [Elbow; 2],
    ) -> Result<[T; 2], Refusal> {
        let half = self.base / 2.0;
        Ok([
            self.motor(x + half, y, left, "the left arm is too short or too long")?,
            self.motor(x - half, y, right, "the right arm is too short or too long")?,
        ])
    }
}
