//! One locator: three axes that hold one point of the body.

use nalgebra::{Matrix3, Point3, RealField, Vector3};

use crate::Calibration;

/// One of a locator's three axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "lowercase")
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a locator has three axes")]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis.
    Z,
}

impl Axis {
    /// The axes in the order of a locator's coordinates.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];
}

impl core::fmt::Display for Axis {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::X => "X",
            Self::Y => "Y",
            Self::Z => "Z",
        })
    }
}

/// The stroke of one axis and the limits of its motion, in the unit of length and seconds. Checked
/// by [`Platform::new`](crate::Platform::new).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct LocatorAxis<T = f64> {
    /// Lower end of the stroke.
    pub min: T,
    /// Upper end of the stroke.
    pub max: T,
    /// Rated speed, per second.
    pub speed: T,
    /// Largest acceleration, per second².
    pub acceleration: T,
    /// Largest jerk, per second³, if the drive has one.
    pub jerk: Option<T>,
}

/// A three-axis locator that holds one point of the body.
///
/// ```text
/// world position = origin + axes · (axis coordinates)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        deny_unknown_fields,
        bound(
            serialize = "T: serde::Serialize",
            deserialize = "T: serde::Deserialize<'de> + Copy"
        )
    )
)]
#[non_exhaustive]
pub struct Locator<T: RealField = f64> {
    /// The point of the body that it holds, in the body's frame.
    pub anchor: Point3<T>,
    /// Where the held point is in the world when the three axes are at zero.
    pub origin: Point3<T>,
    /// Columns: the displacement of the held point in the world per unit of each axis; unit
    /// vectors but for errors of scale, not necessarily orthogonal.
    #[cfg_attr(feature = "serde", serde(default = "Matrix3::identity"))]
    pub axes: Matrix3<T>,
    /// Stroke and limits of the three axes.
    pub limits: [LocatorAxis<T>; 3],
}

impl<T: RealField + Copy> Locator<T> {
    /// A locator whose axes are parallel to the world's. Checked by
    /// [`Platform::new`](crate::Platform::new).
    ///
    /// `anchor` is the point of the body that it holds, in the body's frame; `origin` is
    /// where that point is in the world when the three axes are at zero.
    #[must_use]
    pub fn new(anchor: Point3<T>, origin: Point3<T>, limits: [LocatorAxis<T>; 3]) -> Self {
        Self {
            anchor,
            origin,
            axes: Matrix3::identity(),
            limits,
        }
    }

    /// The locator with the given columns as axes.
    #[must_use]
    pub const fn with_axes(mut self, axes: Matrix3<T>) -> Self {
        self.axes = axes;
        self
    }

    /// The locator with origin and axes as measured.
    #[must_use]
    pub const fn with_calibration(mut self, frame: &Calibration<T>) -> Self {
        self.origin = frame.origin;
        self.axes = frame.axes;
        self
    }

    /// Where in the world the held point is at these axis coordinates.
    #[must_use]
    pub fn position(&self, axes: &Vector3<T>) -> Point3<T> {
        self.origin + self.axes * axes
    }
}
