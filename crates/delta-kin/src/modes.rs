//! What a machine is set to besides its lengths: directions of its numbers, and its assembly.

use core::fmt;

/// Which way the z axis points. X, Y and the azimuths stay as they are: with z down the frame
/// is left-handed, as on machines that count depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "an axis has two directions")]
pub enum ZAxis {
    /// Up: the platform hangs at z < 0.
    #[default]
    Up,
    /// Down: the platform hangs at z > 0.
    Down,
}

/// Which way an arm turns when its angle grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a joint has two directions")]
pub enum Positive {
    /// Outward from straight down, and so up from horizontal.
    #[default]
    Outward,
    /// Inward, and so down from horizontal.
    Inward,
}

/// Which of the two points where the lower arms meet the platform takes.
///
/// They are mirror images in the plane of the elbows (each moved inward by the platform's radius),
/// and of the two one is lower than the other, unless that plane is upright. The platform comes
/// from one to the other through a parallel singularity, the rods in that plane, or where the plane
/// turns past upright: far out and high, or where arms swing inward beyond the axis. There a pose
/// has no mode, and on the other side the other one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "three spheres meet in two points")]
pub enum AssemblyMode {
    /// The point with the smaller z, in the thesis' frame with z up: as Delta robots hang.
    #[default]
    Lower,
    /// The point with the larger z.
    Upper,
}

impl AssemblyMode {
    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Lower => Self::Upper,
            Self::Upper => Self::Lower,
        }
    }
}

impl fmt::Display for AssemblyMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
        })
    }
}
