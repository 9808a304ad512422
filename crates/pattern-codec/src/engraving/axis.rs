//! The four axes of the engraver, and one value for each of them.

use core::fmt;

/// One of the engraver's four axes. [Engraver 2000] calls the first three theta1, theta2 and
/// theta3.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "two bits name four axes, no more")]
pub enum Axis {
    /// The forearm against the upper arm.
    Elbow,
    /// The upper arm against the body.
    Shoulder,
    /// The grinding disc, which follows the tangent of the curve.
    Disc,
    /// The lift of the arm.
    Vertical,
}

impl Axis {
    /// All axes, in the order of the fields of [`PerAxis`].
    pub const ALL: [Self; 4] = [Self::Elbow, Self::Shoulder, Self::Disc, Self::Vertical];

    /// The name as a word: `elbow`, `shoulder`, `disc` or `vertical`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Elbow => "elbow",
            Self::Shoulder => "shoulder",
            Self::Disc => "disc",
            Self::Vertical => "vertical",
        }
    }

    /// Index in [`Axis::ALL`], 0..=3.
    pub(super) const fn index(self) -> u8 {
        match self {
            Self::Elbow => 0,
            Self::Shoulder => 1,
            Self::Disc => 2,
            Self::Vertical => 3,
        }
    }

    /// The axis at an index of [`Axis::ALL`]; only the low two bits count.
    #[inline]
    pub(super) const fn from_index(index: u8) -> Self {
        match index & 3 {
            0 => Self::Elbow,
            1 => Self::Shoulder,
            2 => Self::Disc,
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
    /// The value of [`Axis::Elbow`].
    pub elbow: T,
    /// The value of [`Axis::Shoulder`].
    pub shoulder: T,
    /// The value of [`Axis::Disc`].
    pub disc: T,
    /// The value of [`Axis::Vertical`].
    pub vertical: T,
}

impl<T> PerAxis<T> {
    /// The value of one axis.
    #[must_use]
    #[inline]
    pub const fn get(&self, axis: Axis) -> &T {
        match axis {
            Axis::Elbow => &self.elbow,
            Axis::Shoulder => &self.shoulder,
            Axis::Disc => &self.disc,
            Axis::Vertical => &self.vertical,
        }
    }

    /// The value of one axis, to be changed.
    #[must_use]
    #[inline]
    pub const fn get_mut(&mut self, axis: Axis) -> &mut T {
        match axis {
            Axis::Elbow => &mut self.elbow,
            Axis::Shoulder => &mut self.shoulder,
            Axis::Disc => &mut self.disc,
            Axis::Vertical => &mut self.vertical,
        }
    }
}
