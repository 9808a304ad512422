//! Why a geometry is refused.

use core::fmt::{Display, Formatter};

use nalgebra::RealField;

use crate::digits::Digits;

/// Why a geometry is refused.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum GeometryError<T = f64> {
    /// A link length is not a number between the stated ends.
    LinkLength {
        /// The link: `upper arm` or `forearm`.
        link: &'static str,
        /// The length given.
        length: T,
        /// Shortest length that is accurate in `T`, for the forearm with this upper arm.
        min: T,
        /// Longest length that is accurate in `T`, for the forearm with this upper arm.
        max: T,
    },
    /// A joint range is empty, or an end of it is not a number within the range of angles.
    JointRange {
        /// Lower end given, in radians.
        min: T,
        /// Upper end given, in radians.
        max: T,
        /// Largest angle that is accurate in `T`, in radians.
        largest: T,
    },
    /// The keep-out radius is negative, not finite, or leaves nothing within reach.
    KeepOut {
        /// The radius given.
        radius: T,
        /// The arm's reach.
        reach: T,
    },
    /// The base's rotation is not of length one, as that of nalgebra's constructors is.
    Rotation {
        /// Its length.
        length: T,
    },
    /// What a joint turns for a radian of its drive is not a number between the stated ends.
    Ratio {
        /// The joint: `shoulder` or `elbow`.
        joint: &'static str,
        /// The ratio given.
        ratio: T,
        /// Smallest ratio that is accurate in `T`.
        min: T,
        /// Largest ratio that is accurate in `T`.
        max: T,
    },
    /// A setting is not a number, or too large.
    OutOfRange {
        /// The setting.
        name: &'static str,
        /// Its value.
        value: T,
        /// The largest value, of either sign, that is accurate in `T`.
        largest: T,
    },
}

impl<T: RealField + Copy> Display for GeometryError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match *self {
            Self::LinkLength {
                link,
                length,
                min,
                max,
            } => write!(
                f,
                "length {} of the {link} is not within {}..={}",
                Digits(length),
                Digits(min),
                Digits(max)
            ),
            Self::JointRange { min, max, largest } => write!(
                f,
                "joint range {}..={} rad is empty or not within ±{} rad",
                Digits(min),
                Digits(max),
                Digits(largest)
            ),
            Self::KeepOut { radius, reach } => write!(
                f,
                "keep-out radius {} is not within 0..{}",
                Digits(radius),
                Digits(reach)
            ),
            Self::Rotation { length } => {
                write!(f, "base rotation has length {}, not 1", Digits(length))
            }
            Self::Ratio {
                joint,
                ratio,
                min,
                max,
            } => write!(
                f,
                "ratio {} of the {joint} is not within {}..={}",
                Digits(ratio),
                Digits(min),
                Digits(max)
            ),
            Self::OutOfRange {
                name,
                value,
                largest,
            } => write!(
                f,
                "{name} is {}, not within ±{}",
                Digits(value),
                Digits(largest)
            ),
        }
    }
}

impl<T: RealField + Copy> core::error::Error for GeometryError<T> {}
