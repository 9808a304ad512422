//! Into how many equal parts a leg is cut.

use nalgebra::RealField;

use crate::course::is_still;
use crate::number::{count, epsilons, two};
use crate::path::{Leg, Path};
use crate::strain::pairs;
use crate::{PlanError, Platform};

/// How finely the way from one pose to the next is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Cut<T = f64> {
    pub(crate) rule: Rule<T>,
    pub(crate) at_least: u32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) enum Rule<T> {
    Parts(u32),
    Steps { translation: T, rotation_rad: T },
    Strain(T),
}

/// Least strain against the largest distance of two anchors, in machine epsilons.
const STRAIN_EPSILONS: f64 = 64.0;

/// Most parts of a leg.
const MAX_PARTS: u32 = 1 << 30;

impl<T: RealField + Copy> Cut<T> {
    /// Every leg in so many parts.
    #[must_use]
    pub const fn parts(parts: u32) -> Self {
        Self {
            rule: Rule::Parts(parts),
            at_least: 1,
        }
    }

    /// Parts in which the reference point moves by less than `translation` and the body turns
    /// by less than `rotation_rad`: the adjustment accuracy of [Alignment 2010]. The fewest
    /// equal parts that are smaller, not as large: 10 mm at 0.01 mm are 1001.
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

    /// The fewest equal parts for which no distance between two locators ever departs from
    /// that of their anchors by more than `allowed`, in the unit of length; along pose vectors
    /// perhaps some more.
    #[must_use]
    pub const fn strain(allowed: T) -> Self {
        Self {
            rule: Rule::Strain(allowed),
            at_least: 1,
        }
    }

    /// The same with at least so many parts a leg. A PVT table gets nearer to the shortest
    /// time with more points than the strain asks for.
    #[must_use]
    pub const fn at_least(mut self, parts: u32) -> Self {
        self.at_least = parts;
        self
    }

    /// Whether the numbers make sense.
    pub(crate) fn check<const N: usize>(
        &self,
        platform: &Platform<N, T>,
    ) -> Result<(), PlanError<T>> {
        let positive = |value: T| value > T::zero() && value.is_finite();
        let bad = match self.rule {
            Rule::Parts(0) => Some(T::zero()),
            Rule::Parts(_) => None,
            Rule::Steps {
                translation,
                rotation_rad,
            } => [translation, rotation_rad]
                .into_iter()
                .find(|value| !positive(*value)),
            Rule::Strain(allowed) => (!positive(allowed)).then_some(allowed),
        };
        if let Some(value) = bad {
            return Err(PlanError::Cut { value });
        }
        let least = platform.largest_anchor_distance() * epsilons(STRAIN_EPSILONS);
        match self.rule {
            Rule::Strain(allowed) if allowed < least => Err(PlanError::Strain { allowed, least }),
            _ => Ok(()),
        }
    }

    /// Parts of a leg between whose points the axes move linearly; none where nothing moves.
    pub(crate) fn linear_parts<const N: usize>(
        &self,
        platform: &Platform<N, T>,
        path: &Path<'_, T>,
        number: usize,
    ) -> Result<u32, PlanError<T>> {
        let leg = match path.leg(number) {
            Some(leg) if !is_still(platform, path, number) => leg,
            _ => return Ok(0),
        };
        let parts = match self.rule {
            Rule::Parts(parts) => Some(parts),
            Rule::Steps {
                translation,
                rotation_rad,
            } => parts_below(leg.length(), translation)
                .zip(parts_below(leg.turn(), rotation_rad))
                .map(|(moves, turns)| moves.max(turns)),
            Rule::Strain(allowed) => {
                parts_within(leg.turn(), largest_turn(platform, &leg, allowed))
            }
        };
        within_max(
            parts.map(|parts| parts.max(self.at_least)),
            number,
            MAX_PARTS,
        )
    }
}

/// Refuses more parts than a leg can have.
pub(crate) fn within_max<T: RealField + Copy>(
    parts: Option<u32>,
    leg: usize,
    max: u32,
) -> Result<u32, PlanError<T>> {
    match parts {
        Some(parts) if parts <= max => Ok(parts.max(1)),
        _ => Err(PlanError::TooFine { leg, max }),
    }
}

/// The largest turn between two points for which no two locators come closer by more than
/// `allowed`, at most half a turn: see [`PtTable::strain_bound`](crate::PtTable::strain_bound).
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

/// The fewest equal parts of `whole` that are at most `part`.
pub(crate) fn parts_within<T: RealField + Copy>(whole: T, part: T) -> Option<u32> {
    // A quotient that rounding has put past a whole number is that number.
    whole_number((whole / part * (T::one() - epsilons(4.0))).ceil())
}

/// The fewest equal parts of `whole` that are smaller than `part`.
fn parts_below<T: RealField + Copy>(whole: T, part: T) -> Option<u32> {
    let parts = whole_number((whole / part).floor())?.checked_add(1)?;
    let is_below = whole / count(parts) < part;
    parts.checked_add(u32::from(!is_below))
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
