//! The axes of a machine: one number for each, and the limits of each.

use core::fmt::Debug;

use crate::number::range;

/// One number for each axis of a machine: `[f64; N]`, or `[[f64; G]; N]` where the axes come in `N`
/// groups of `G`, as those of a platform on three-axis locators do.
pub trait Axes: Copy + Debug + PartialEq + sealed::Sealed {
    /// The same shape with a value of another type for each axis.
    type Of<T: Copy + Debug>: Copy + Debug;

    /// Zero for each axis.
    fn zeros() -> Self;
    /// The numbers, one axis after the other.
    fn as_slice(&self) -> &[f64];
    /// The numbers, one axis after the other.
    fn as_mut_slice(&mut self) -> &mut [f64];
    /// The same value for each axis.
    fn filled<T: Copy + Debug>(value: T) -> Self::Of<T>;
    /// The values, one axis after the other.
    fn each<T: Copy + Debug>(of: &Self::Of<T>) -> &[T];
    /// The values, one axis after the other.
    fn each_mut<T: Copy + Debug>(of: &mut Self::Of<T>) -> &mut [T];

    /// The numbers times a factor.
    #[must_use]
    fn scaled(mut self, factor: f64) -> Self {
        for value in self.as_mut_slice() {
            *value *= factor;
        }
        self
    }
}

mod sealed {
    #[expect(unnameable_types, reason = "no other crate may add a shape")]
    pub trait Sealed {}

    impl<const N: usize> Sealed for [f64; N] {}
    impl<const G: usize, const N: usize> Sealed for [[f64; G]; N] {}
}

impl<const N: usize> Axes for [f64; N] {
    type Of<T: Copy + Debug> = [T; N];

    fn zeros() -> Self {
        [0.0; N]
    }

    fn as_slice(&self) -> &[f64] {
        self
    }

    fn as_mut_slice(&mut self) -> &mut [f64] {
        self
    }

    fn filled<T: Copy + Debug>(value: T) -> [T; N] {
        [value; N]
    }

    fn each<T: Copy + Debug>(of: &[T; N]) -> &[T] {
        of
    }

    fn each_mut<T: Copy + Debug>(of: &mut [T; N]) -> &mut [T] {
        of
    }
}

impl<const G: usize, const N: usize> Axes for [[f64; G]; N] {
    type Of<T: Copy + Debug> = [[T; G]; N];

    fn zeros() -> Self {
        [[0.0; G]; N]
    }

    fn as_slice(&self) -> &[f64] {
        self.as_flattened()
    }

    fn as_mut_slice(&mut self) -> &mut [f64] {
        self.as_flattened_mut()
    }

    fn filled<T: Copy + Debug>(value: T) -> [[T; G]; N] {
        [[value; G]; N]
    }

    fn each<T: Copy + Debug>(of: &[[T; G]; N]) -> &[T] {
        of.as_flattened()
    }

    fn each_mut<T: Copy + Debug>(of: &mut [[T; G]; N]) -> &mut [T] {
        of.as_flattened_mut()
    }
}

/// Limits of one axis, in its unit (mm, rad) and seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "named fields; a motion has no other derivatives that drives limit"
)]
pub struct AxisLimits {
    /// Largest speed, per second.
    pub speed: f64,
    /// Largest acceleration, per second².
    pub acceleration: f64,
    /// Largest jerk, per second³, if the axis has one.
    pub jerk: Option<f64>,
}

/// Limits of the tool along a path whose parameter is its arc length, or grows by no less
/// ([`Path::tool_rate`](crate::Path::tool_rate)), in its unit and seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct ToolLimits {
    /// Largest speed along the path, per second.
    pub feed: f64,
    /// Largest acceleration along the path, per second², if there is such a limit. Across the path,
    /// where it bends, the tool is accelerated by curvature and squared speed, which this does not
    /// limit.
    pub acceleration: Option<f64>,
}

/// The first limit that is outside the range of the crate, with its name.
fn outside<const N: usize>(
    limits: [(&'static str, Option<f64>); N],
) -> Option<(&'static str, f64)> {
    let given = limits.into_iter();
    let mut given = given.filter_map(|(name, value)| Some((name, value?)));
    given.find(|(_, value)| !range().contains(value))
}

impl AxisLimits {
    /// The first limit that is outside the range of the crate, with its name.
    pub(crate) fn outside(&self) -> Option<(&'static str, f64)> {
        outside([
            ("speed", Some(self.speed)),
            ("acceleration", Some(self.acceleration)),
            ("jerk", self.jerk),
        ])
    }
}

impl ToolLimits {
    /// The first limit that is outside the range of the crate, with its name.
    pub(crate) fn outside(&self) -> Option<(&'static str, f64)> {
        outside([
            ("feed", Some(self.feed)),
            ("acceleration", self.acceleration),
        ])
    }
}
