//! Into how many equal segments a leg is divided.

use trig_kernels::atan2;

use crate::distance_error::pairs;
use crate::leg_axes::is_still;
use crate::number::{ceil, epsilons, floor, sqrt};
use crate::path::{Leg, PosePath};
use crate::{Platform, PtError};

/// Into how many segments the leg from one pose to the next is divided.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Segmentation {
    pub(crate) rule: Rule,
    pub(crate) at_least: u32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) enum Rule {
    Segments(u32),
    Steps { translation: f64, rotation_rad: f64 },
    DistanceError(f64),
}

/// Smallest distance error against the largest distance of two anchors, in machine epsilons.
const DISTANCE_ERROR_EPSILONS: f64 = 64.0;

/// Largest number of segments of a leg.
const MAX_SEGMENTS: u32 = 1 << 30;

impl Segmentation {
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
    pub const fn steps(translation: f64, rotation_rad: f64) -> Self {
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
    pub const fn max_distance_error(allowed: f64) -> Self {
        Self {
            rule: Rule::DistanceError(allowed),
            at_least: 1,
        }
    }

    /// The segmentation with at least `segments` of a leg.
    #[must_use]
    pub const fn at_least(mut self, segments: u32) -> Self {
        self.at_least = segments;
        self
    }

    /// Whether the numbers make sense.
    pub(crate) fn check<const N: usize>(&self, platform: &Platform<N>) -> Result<(), PtError> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let bad = match self.rule {
            Rule::Segments(0) => Some(0.0),
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
            return Err(PtError::Segmentation { value });
        }
        let min = platform.largest_anchor_distance() * epsilons::<f64>(DISTANCE_ERROR_EPSILONS);
        match self.rule {
            Rule::DistanceError(allowed) if allowed < min => {
                Err(PtError::DistanceError { allowed, min })
            }
            _ => Ok(()),
        }
    }

    /// Segments of a leg between whose points the axes move linearly; none where nothing moves, and
    /// `u32::MAX` where they would be more than can be counted.
    pub(crate) fn linear_segments<const N: usize>(
        &self,
        platform: &Platform<N>,
        path: &PosePath<'_>,
        number: usize,
    ) -> u32 {
        let leg = match path.leg(number) {
            Some(leg) if !is_still(platform, path, number) => leg,
            _ => return 0,
        };
        let segments = match self.rule {
            Rule::DistanceError(allowed) => {
                segments_within(leg.turn(), largest_turn(platform, &leg, allowed))
            }
            Rule::Segments(segments) => segments,
            Rule::Steps {
                translation,
                rotation_rad,
            } => {
                let (length, turn) = (leg.length(), leg.turn());
                segments_below(length, translation).max(segments_below(turn, rotation_rad))
            }
        };
        segments.max(self.at_least).max(1)
    }

    /// The segments of a leg, if it can have that number.
    pub(crate) fn checked_segments<const N: usize>(
        &self,
        platform: &Platform<N>,
        path: &PosePath<'_>,
        number: usize,
    ) -> Result<u32, PtError> {
        match self.linear_segments(platform, path, number) {
            segments if segments <= MAX_SEGMENTS => Ok(segments),
            _ => Err(PtError::TooFine {
                leg: number,
                max: MAX_SEGMENTS,
            }),
        }
    }
}

/// The largest turn between two points for which no two locators come closer by more than
/// `allowed`, at most half a turn: see
/// [`PtTable::distance_error_bound`](crate::PtTable::distance_error_bound).
fn largest_turn<const N: usize>(platform: &Platform<N>, leg: &Leg, allowed: f64) -> f64 {
    let mut sine = 1.0;
    for pair in pairs(platform, leg) {
        if allowed < pair.length {
            // across² sin²(δ/2) = L² - (L - allowed)²
            let root = sqrt(allowed * (2.0 * pair.length - allowed));
            if root < sine * pair.across {
                sine = root / pair.across;
            }
        }
    }
    let cos = sqrt((1.0 - sine) * (1.0 + sine));
    2.0 * atan2(sine, cos)
}

/// The fewest equal segments of `whole` that are at most `segment`.
fn segments_within(whole: f64, segment: f64) -> u32 {
    // A quotient that rounding has put past a whole number is that number.
    saturated(ceil(whole / segment * (1.0 - epsilons::<f64>(4.0))))
}

/// The fewest equal segments of `whole` that are smaller than `segment`.
fn segments_below(whole: f64, segment: f64) -> u32 {
    let segments = saturated(floor(whole / segment)).saturating_add(1);
    let is_below = whole / f64::from(segments) < segment;
    segments.saturating_add(u32::from(!is_below))
}

/// A whole number; `u32::MAX` where it is larger.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "such a conversion saturates"
)]
const fn saturated(value: f64) -> u32 {
    value as u32
}
