//! What an arm's numbers may be, and why a geometry is refused.

use nalgebra::RealField;

use crate::arm::zip;
use crate::range::{is_within, largest_angle, largest_length, smallest_length, smallest_ratio};
use crate::rounded::Rounded;
use crate::{Arm, ArmGeometry};

/// Why a geometry is refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum GeometryError<T: RealField + Copy = f64> {
    /// A length is not a number between the stated ends.
    #[error(
        "{arm}: {name} {} is not within {}..={}",
        Rounded(*.length), Rounded(*.min), Rounded(*.max)
    )]
    Length {
        /// The arm.
        arm: Arm,
        /// `base radius`, `platform radius`, `upper arm` or `lower arm`.
        name: &'static str,
        /// The length given.
        length: T,
        /// Smallest length allowed.
        min: T,
        /// Largest length allowed.
        max: T,
    },
    /// An angle is not a number of the stated size.
    #[error("{arm}: {name} {} rad is not within ±{} rad", Rounded(*.angle), Rounded(*.largest))]
    Angle {
        /// The arm.
        arm: Arm,
        /// `azimuth` or `zero`.
        name: &'static str,
        /// The angle given.
        angle: T,
        /// Largest angle allowed, either way.
        largest: T,
    },
    /// An arm's range is empty, not finite, too far from zero or wider than a turn.
    #[error(
        "arm range {}..={} rad is empty, wider than a turn or not within ±{} rad",
        Rounded(*.min), Rounded(*.max), Rounded(*.largest)
    )]
    ArmRange {
        /// Lower end given, in radians.
        min: T,
        /// Upper end given, in radians.
        max: T,
        /// The largest angle, either way.
        largest: T,
    },
    /// A ball joint's limit is not an angle that means something.
    #[error("ball joints may swivel by {} rad, which is not above 0 and below π/2", Rounded(*.max_swivel))]
    Swivel {
        /// The limit given, in radians.
        max_swivel: T,
    },
}

/// The span of arms whose numbers are all within the range that the crate takes.
pub(crate) fn checked_span<T: RealField + Copy>(
    arms: &[ArmGeometry<T>; 3],
) -> Result<T, GeometryError<T>> {
    check_lengths(arms, smallest_length())?;
    check_angles(arms)?;
    let [first, second, third] = arms.map(|arm| arm.base + arm.platform + arm.upper + arm.lower);
    let span = first.max(second).max(third);
    check_lengths(arms, span * smallest_ratio())?;
    Ok(span)
}

fn check_lengths<T: RealField + Copy>(
    arms: &[ArmGeometry<T>; 3],
    min_arm: T,
) -> Result<(), GeometryError<T>> {
    let max = largest_length();
    for (arm, geometry) in zip(Arm::ALL, *arms) {
        for (name, length, min) in [
            ("base radius", geometry.base, T::zero()),
            ("platform radius", geometry.platform, T::zero()),
            ("upper arm", geometry.upper, min_arm),
            ("lower arm", geometry.lower, min_arm),
        ] {
            // Written so that NaN is refused too.
            if !(length >= min && length <= max) {
                return Err(GeometryError::Length {
                    arm,
                    name,
                    length,
                    min,
                    max,
                });
            }
        }
    }
    Ok(())
}

fn check_angles<T: RealField + Copy>(arms: &[ArmGeometry<T>; 3]) -> Result<(), GeometryError<T>> {
    let largest = largest_angle();
    for (arm, geometry) in zip(Arm::ALL, *arms) {
        for (name, angle) in [("azimuth", geometry.azimuth), ("zero", geometry.zero)] {
            if !is_within(angle, largest) {
                return Err(GeometryError::Angle {
                    arm,
                    name,
                    angle,
                    largest,
                });
            }
        }
    }
    Ok(())
}
