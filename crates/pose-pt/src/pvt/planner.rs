//! The knots of a table: how many, at which speeds, and whether they keep what was asked.

use super::check::{self, Shares};
use super::track::Track;
use super::{Knot, first_track, has_jerk, knots_of, leg, moving, segments, smooth};
use crate::cut::{Rule, within_max};
use crate::number::{larger_or_nan, sqrt};
use crate::path::Path;
use crate::strain::hermite_strain;
use crate::{Cut, PlanError, Platform};

/// What all legs are planned with.
pub(super) struct Planner<'a, const N: usize> {
    pub(super) platform: &'a Platform<N>,
    pub(super) path: Path<'a>,
    pub(super) cut: Cut,
    /// Fewest parts of a leg.
    pub(super) least: u32,
}

impl<const N: usize> Planner<'_, N> {
    /// Where the number of parts is known beforehand, the memory is checked before all else.
    pub(super) fn check_memory(&self, available: usize) -> Result<(), PlanError> {
        let mut needed = 0_usize;
        for Track { number, .. } in moving(self.platform, &self.path, 0) {
            let parts = match self.cut.rule {
                Rule::Strain(_) => self.least,
                _ => self.parts(number)?,
            };
            needed = needed.saturating_add(knots_of(within_max(Some(parts), number, MAX_PARTS)?));
        }
        if needed <= available {
            return Ok(());
        }
        Err(PlanError::TooManyPoints { needed, available })
    }

    /// Parts of a leg where the cut alone decides them.
    fn parts(&self, number: usize) -> Result<u32, PlanError> {
        let parts = (self.cut).linear_parts(self.platform, &self.path, number)?;
        within_max(Some(parts.max(self.least)), number, MAX_PARTS)
    }

    /// Plans a leg in the first of the free knots; the number of them.
    pub(super) fn plan_leg(
        &self,
        track: &Track<'_, N>,
        used: usize,
        free: &mut [Knot],
    ) -> Result<usize, PlanError> {
        let parts = match self.cut.rule {
            Rule::Strain(allowed) => self.fewest(track, used, free, allowed)?,
            _ => self.parts(track.number)?,
        };
        self.lay(track, free, parts);
        Ok(knots_of(parts))
    }

    /// Plans a leg with a number of parts.
    fn lay(&self, track: &Track<'_, N>, free: &mut [Knot], parts: u32) {
        if let Some(knots) = free.get_mut(..knots_of(parts)) {
            let locators = self.platform.locators();
            if has_jerk(self.platform) {
                smooth::smooth(locators, track, knots, parts);
            } else {
                leg::fastest(locators, track, knots, parts);
            }
        }
    }

    /// A number of parts that keeps the allowed strain, while one fewer does not.
    fn fewest(
        &self,
        track: &Track<'_, N>,
        used: usize,
        free: &mut [Knot],
        allowed: f64,
    ) -> Result<u32, PlanError> {
        let room = u32::try_from(free.len().saturating_sub(1)).unwrap_or(u32::MAX);
        let mut strain = |parts| {
            self.lay(track, free, parts);
            leg_strain(self.platform, track, free)
        };
        let (mut too_few, mut parts) = (self.least.saturating_sub(1), self.least);
        if room < parts {
            return Err(PlanError::TooManyPoints {
                needed: used.saturating_add(knots_of(parts)),
                available: used.saturating_add(free.len()),
            });
        }
        let mut bound = strain(parts);
        while bound > allowed {
            if parts >= room || parts >= FINEST {
                return Err(too_coarse(track.number, bound / allowed, parts, used, room));
            }
            too_few = parts;
            parts = parts.saturating_mul(2).min(room).min(FINEST);
            bound = strain(parts);
        }
        let mut enough = parts;
        while enough.saturating_sub(too_few) > 1 {
            let middle = too_few.midpoint(enough);
            if strain(middle) <= allowed {
                enough = middle;
            } else {
                too_few = middle;
            }
        }
        Ok(enough)
    }
}

/// Most parts of a leg: 12 machine epsilons of the way from its last knot but one to its end.
pub(super) const MAX_PARTS: u32 = 1 << 24;

/// Parts beyond which rounding is all that is left of a strain.
const FINEST: u32 = 1 << 20;

/// Why no number of parts that there is room for keeps the strain. It shrinks with the square
/// of the number; a tenth more is enough.
fn too_coarse(leg: usize, excess: f64, parts: u32, used: usize, room: u32) -> PlanError {
    let estimate = f64::from(parts) * sqrt(excess) * 1.1;
    if parts < room || estimate > f64::from(FINEST) {
        return PlanError::TooFine { leg, max: FINEST };
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked against the finest cut"
    )]
    let needed = (estimate as u32).saturating_add(1);
    PlanError::TooManyPoints {
        needed: used.saturating_add(knots_of(needed)),
        available: used.saturating_add(knots_of(room)),
    }
}

/// The strain bound of a leg whose knots are the first of `knots`.
fn leg_strain<const N: usize>(platform: &Platform<N>, track: &Track<'_, N>, knots: &[Knot]) -> f64 {
    segments(track, knots).fold(0.0, |worst, [from, to]| {
        larger_or_nan(worst, hermite_strain(platform, &from, &to))
    })
}

/// What a stretched leg rounds off.
const STRETCHED: f64 = 1.0 + 64.0 * f64::EPSILON;

/// Looks at what the controller will run: every stroke, and where jerk is limited every limit;
/// the time is then multiplied so that it just keeps them all. The fastest table keeps them by
/// its making.
pub(super) fn check_legs<const N: usize>(
    platform: &Platform<N>,
    path: &Path<'_>,
    knots: &mut [Knot],
) -> Result<(), PlanError> {
    let Some(track) = first_track(platform, path) else {
        return Ok(());
    };
    let failed = |leg, point| move |reason| PlanError::Limit { leg, point, reason };
    platform
        .check_axes(&track.place(0.0).axes)
        .map_err(failed(0, 0))?;
    let (mut rest, mut time_s) = (knots, 0.0);
    for track in moving(platform, path, 0) {
        let parts = rest.first().map_or(0, |knot| knot.parts);
        let Some((knots, later)) = rest.split_at_mut_checked(knots_of(parts)) else {
            break;
        };
        rest = later;
        for (index, [from, to]) in (1..).zip(segments(&track, knots)) {
            check::strokes(platform, &from, &to).map_err(failed(track.number, index))?;
        }
        if has_jerk(platform) {
            let stretch = Shares::of(platform.locators(), &track, knots).stretch();
            stretch_time(knots, stretch * STRETCHED);
        }
        time_s = check_times(track.number, knots, time_s)?;
    }
    Ok(())
}

/// Refuses knots that no time lies between; the time at the last.
fn check_times(leg: usize, knots: &[Knot], mut time_s: f64) -> Result<f64, PlanError> {
    let segments = knots.split_last().map_or(knots, |(_, segments)| segments);
    for (point, knot) in (1..).zip(segments) {
        let before_s = time_s;
        time_s += knot.segment_s;
        if !(time_s > before_s && time_s.is_finite()) {
            return Err(PlanError::Indistinct { leg, point });
        }
    }
    Ok(time_s)
}

/// Multiplies the time of a leg.
fn stretch_time(knots: &mut [Knot], stretch: f64) {
    for knot in knots {
        knot.speed /= stretch;
        knot.segment_s *= stretch;
    }
}
