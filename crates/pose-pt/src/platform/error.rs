//! Why a platform or a pose is refused.

use nalgebra::RealField;

use crate::Axis;
use crate::short::short;

/// Why locators make no platform.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PlatformError<T: RealField + Copy = f64> {
    /// Fewer than 3 locators, or more than 32 axes.
    #[error("{locators} locators: 3 to {max} are possible")]
    Count {
        /// Locators given.
        locators: usize,
        /// Most locators.
        max: usize,
    },
    /// A coordinate is not finite, or beyond the range of the crate.
    #[error("locator {locator}: {name} is {}, not within ±{}", short(.value), short(.max))]
    Coordinate {
        /// The locator, from 0.
        locator: usize,
        /// Which: `anchor`, `origin` or `axis direction`.
        name: &'static str,
        /// Its coordinate.
        value: T,
        /// Largest coordinate.
        max: T,
    },
    /// An axis has no unit length, errors of scale aside.
    #[error("locator {locator}, axis {axis}: direction has length {}, not {}..={}", short(.length), short(.min), short(.max))]
    AxisLength {
        /// The locator, from 0.
        locator: usize,
        /// The axis.
        axis: Axis,
        /// Length of the direction.
        length: T,
        /// Shortest length.
        min: T,
        /// Longest length.
        max: T,
    },
    /// The three axes of a locator are nearly in one plane.
    #[error("locator {locator}: axes span a volume of {}, at least {} is needed", short(.volume), short(.min))]
    DependentAxes {
        /// The locator, from 0.
        locator: usize,
        /// Volume that the unit directions span: 1 where they are orthogonal.
        volume: T,
        /// Volume needed.
        min: T,
    },
    /// A stroke is empty or not finite.
    #[error("locator {locator}, axis {axis}: stroke {}..={} is empty or not finite", short(.min), short(.max))]
    Stroke {
        /// The locator, from 0.
        locator: usize,
        /// The axis.
        axis: Axis,
        /// Lower end.
        min: T,
        /// Upper end.
        max: T,
    },
    /// A rated speed, acceleration or jerk is not a number within the range of the crate.
    #[error("locator {locator}, axis {axis}: {name} is {}, not within {}..={}", short(.value), short(.min), short(.max))]
    Rating {
        /// The locator, from 0.
        locator: usize,
        /// The axis.
        axis: Axis,
        /// Which: `speed`, `acceleration` or `jerk`.
        name: &'static str,
        /// Its value.
        value: T,
        /// Smallest value.
        min: T,
        /// Largest value.
        max: T,
    },
    /// Two locators hold the same point of the body.
    #[error(
        "locators {first} and {second} hold the body {} apart, more than {} is needed",
        short(.distance), short(.needed)
    )]
    Coincident {
        /// A locator, from 0.
        first: usize,
        /// Another locator.
        second: usize,
        /// Distance of their anchors.
        distance: T,
        /// Distance needed.
        needed: T,
    },
    /// All anchors are on a line: the body could turn about it.
    #[error("the anchors are on a line: {} wide, {} long, more than {} is needed", short(.width), short(.length), short(.needed))]
    Collinear {
        /// Largest distance from the line.
        width: T,
        /// Largest distance from their mean.
        length: T,
        /// Width needed.
        needed: T,
    },
}

/// Why axis coordinates are refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LimitError<T: RealField + Copy = f64> {
    /// An axis would leave its stroke.
    #[error("locator {locator}, axis {axis}: {} is {} beyond the stroke {}..={}", short(.value), short(.by), short(.min), short(.max))]
    Stroke {
        /// The locator, from 0.
        locator: usize,
        /// The axis.
        axis: Axis,
        /// The coordinate asked for.
        value: T,
        /// Lower end of the stroke.
        min: T,
        /// Upper end of the stroke.
        max: T,
        /// By how much the coordinate is out of the stroke.
        by: T,
    },
    /// A coordinate is not finite.
    #[error("locator {locator}, axis {axis}: {} is not a finite number", short(.value))]
    NotFinite {
        /// The locator, from 0.
        locator: usize,
        /// The axis.
        axis: Axis,
        /// The coordinate.
        value: T,
    },
}
