//! The four axes of the engraver, and one value for each of them.

use core::fmt;

/// One of the engraver's four axes, named as in [Engraver 2000].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "two bits name four axes, no more")]
pub enum Axis {
    /// The forearm against the upper arm.
    Theta1,
    /// The upper arm against the body.
    Theta2,
    /// The grinding disc, which follows the tangent of the curve.
    Theta3,
    /// The lift of the arm.
    Vertical,
}

impl Axis {
    /// All axes, in the order of the fields of [`PerAxis`].
    pub const ALL: [Self; 4] = [Self::Theta1, Self::Theta2, Self::Theta3, Self::Vertical];

    /// The name as a word: `theta1`, `theta2`, `theta3` or `vertical`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Theta1 => "theta1",
            Self::Theta2 => "theta2",
            Self::Theta3 => "theta3",
            Self::Vertical => "vertical",
        }
    }

    /// Index in [`Axis::ALL`], 0..=3.
    pub(super) const fn index(self) -> u8 {
        match self {
            Self::Theta1 => 0,
            Self::Theta2 => 1,
            Self::Theta3 => 2,
            Self::Vertical => 3,
        }
    }

    /// The axis at an index of [`Axis::ALL`]; only the low two bits count.
    #[inline]
    pub(super) const fn from_index(index: u8) -> Self {
        match index & 3 {
            0 => Self::Theta1,
            1 => Self::Theta2,
            2 => Self::Theta3,
            _ => Self::Vertical,
        }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One value for each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "the format has four axes")]
pub struct PerAxis<T> {
    /// The value of [`Axis::Theta1`].
    pub theta1: T,
    /// The value of [`Axis::Theta2`].
    pub theta2: T,
    /// The value of [`Axis::Theta3`].
    pub theta3: T,
    /// The value of [`Axis::Vertical`].
    pub vertical: T,
}

impl<T> PerAxis<T> {
    /// The value of one axis.
    #[must_use]
    #[inline]
    pub const fn get(&self, axis: Axis) -> &T {
        match axis {
            Axis::Theta1 => &self.theta1,
            Axis::Theta2 => &self.theta2,
            Axis::Theta3 => &self.theta3,
            Axis::Vertical => &self.vertical,
        }
    }

    /// The value of one axis, to be changed.
    #[must_use]
    #[inline]
    pub const fn get_mut(&mut self, axis: Axis) -> &mut T {
        match axis {
            Axis::Theta1 => &mut self.theta1,
            Axis::Theta2 => &mut self.theta2,
            Axis::Theta3 => &mut self.theta3,
            Axis::Vertical => &mut self.vertical,
        }
    }
}
