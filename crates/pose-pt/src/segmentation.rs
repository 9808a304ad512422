//! Into how many equal segments a leg is divided.

use nalgebra::RealField;

use crate::course::is_still;
use crate::distance_error::pairs;
use crate::number::{count, epsilons, two};
use crate::path::{Leg, Path};
use crate::{PlanError, Platform};

/// Into how many segments the way from one pose to the next is divided.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Segmentation<T = f64> {
    pub(crate) rule: Rule<T>,
    pub(crate) at_least: u32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) enum Rule<T> {
    Segments(u32),
    Steps { translation: T, rotation_rad: T },
    DistanceError(T),
}

/// Least distance error against the largest distance of two anchors, in machine epsilons.
const DISTANCE_ERROR_EPSILONS: f64 = 64.0;

/// Most segments of a leg.
const MAX_SEGMENTS: u32 = 1 << 30;

impl<T: RealField + Copy> Segmentation<T> {
    /// Every leg in `segments` equal segments.
    #[must_use]
    pub const fn segments(segments: u32) -> Self {
        Self {
            rule: Rule::Segments(segments),
            at_least: 1,
        }
    }

    /// Segments in which the reference point moves by less than `translation` and the body turns
    /// by less than `rotation_rad`: the adjustment accuracy of [Alignment 2010]. The fewest
    /// equal segments that are smaller, not as large: 10 mm at 0.01 mm are 1001.
    #[must_use]
    pub const fn steps(translation: T, rotation_rad: T) -> Self {
        Self {
            rule: Rule::Steps {
                translation,
                rotation_rad,
            },
            at_least: 1,
        }
    }

    /// The fewest equal segments for which no distance between two locators ever departs from
    /// that of their anchors by more than `allowed`, in the unit of length; along pose vectors
    /// perhaps some more.
    #[must_use]
    pub const fn max_distance_error(allowed: T) -> Self {
        Self {
            rule: Rule::DistanceError(allowed),
            at_least: 1,
        }
    }

    /// The same with at least `segments` of a leg. A PVT table gets nearer to the shortest
    /// time with more points than the distance error asks for.
    #[must_use]
    pub const fn at_least(mut self, segments: u32) -> Self {
        self.at_least = segments;
        self
    }

    /// Whether the numbers make sense.
    pub(crate) fn check<const N: usize>(
        &self,
        platform: &Platform<N, T>,
    ) -> Result<(), PlanError<T>> {
        let positive = |value: T| value > T::zero() && value.is_finite();
        let bad = match self.rule {
            Rule::Segments(0) => Some(T::zero()),
            Rule::Segments(_) => None,
            Rule::Steps {
                translation,
                rotation_rad,
            } => [translation, rotation_rad]
                .into_iter()
                .find(|value| !positive(*value)),
            Rule::DistanceError(allowed) => (!positive(allowed)).then_some(allowed),
        };
        if let Some(value) = bad {
            return Err(PlanError::Segmentation { value });
        }
        let least = platform.largest_anchor_distance() * epsilons(DISTANCE_ERROR_EPSILONS);
        match self.rule {
            Rule::DistanceError(allowed) if allowed < least => {
                Err(PlanError::DistanceError { allowed, least })
            }
            _ => Ok(()),
        }
    }

    /// Segments of a leg between whose points the axes move linearly; none where nothing moves.
    pub(crate) fn linear_segments<const N: usize>(
        &self,
        platform: &Platform<N, T>,
        path: &Path<'_, T>,
        number: usize,
    ) -> Result<u32, PlanError<T>> {
        let leg = match path.leg(number) {
            Some(leg) if !is_still(platform, path, number) => leg,
            _ => return Ok(0),
        };
        let segments = match self.rule {
            Rule::Segments(segments) => Some(segments),
            Rule::Steps {
                translation,
                rotation_rad,
            } => segments_below(leg.length(), translation)
                .zip(segments_below(leg.turn(), rotation_rad))
                .map(|(moves, turns)| moves.max(turns)),
            Rule::DistanceError(allowed) => {
                segments_within(leg.turn(), largest_turn(platform, &leg, allowed))
            }
        };
        within_max(
            segments.map(|segments| segments.max(self.at_least)),
            number,
            MAX_SEGMENTS,
        )
    }
}

/// Refuses more segments than a leg can have.
pub(crate) fn within_max<T: RealField + Copy>(
    segments: Option<u32>,
    leg: usize,
    max: u32,
) -> Result<u32, PlanError<T>> {
    match segments {
        Some(segments) if segments <= max => Ok(segments.max(1)),
        _ => Err(PlanError::TooFine { leg, max }),
    }
}

/// The largest turn between two points for which no two locators come closer by more than
/// `allowed`, at most half a turn: see
/// [`PtTable::distance_error_bound`](crate::PtTable::distance_error_bound).
fn largest_turn<const N: usize, T: RealField + Copy>(
    platform: &Platform<N, T>,
    leg: &Leg<T>,
    allowed: T,
) -> T {
    let mut sine = T::one();
    for pair in pairs(platform, leg) {
        if allowed < pair.length {
            // across² sin²(δ/2) = L² - (L - allowed)²
            let most = (allowed * (two::<T>() * pair.length - allowed)).sqrt();
            if most < sine * pair.across {
                sine = most / pair.across;
            }
        }
    }
    let cos = ((T::one() - sine) * (T::one() + sine)).sqrt();
    two::<T>() * sine.atan2(cos)
}

/// The fewest equal segments of `whole` that are at most `segment`.
pub(crate) fn segments_within<T: RealField + Copy>(whole: T, segment: T) -> Option<u32> {
    // A quotient that rounding has put past a whole number is that number.
    whole_number((whole / segment * (T::one() - epsilons(4.0))).ceil())
}

/// The fewest equal segments of `whole` that are smaller than `segment`.
fn segments_below<T: RealField + Copy>(whole: T, segment: T) -> Option<u32> {
    let segments = whole_number((whole / segment).floor())?.checked_add(1)?;
    let is_below = whole / count(segments) < segment;
    segments.checked_add(u32::from(!is_below))
}

fn whole_number<T: RealField + Copy>(value: T) -> Option<u32> {
    let value: f64 = nalgebra::try_convert(value)?;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked"
    )]
    (0.0..f64::from(u32::MAX))
        .contains(&value)
        .then_some(value as u32)
}
