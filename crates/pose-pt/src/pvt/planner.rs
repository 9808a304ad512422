//! The knots of a table: how many, at which speeds, and whether they keep what was asked.

use nalgebra::RealField;

use super::check::{self, Shares};
use super::{Knot, first_course, has_jerk, knots_of, leg, moving, segments, smooth};
use crate::course::Course;
use crate::cut::{Rule, within_max};
use crate::number::epsilons;
use crate::path::{Leg, Path};
use crate::strain::hermite_strain;
use crate::{Cut, PlanError, Platform};

/// What all legs are planned with.
pub(super) struct Planner<'a, const N: usize, T: RealField> {
    pub(super) platform: &'a Platform<N, T>,
    pub(super) cut: Cut<T>,
    /// Fewest parts of a leg.
    pub(super) least: u32,
}

impl<const N: usize, T: RealField + Copy> Planner<'_, N, T> {
    /// Where the number of parts is known beforehand, the memory is checked before all else.
    pub(super) fn check_memory(
        &self,
        path: &Path<'_, T>,
        available: usize,
    ) -> Result<(), PlanError<T>> {
        let mut needed = 0_usize;
        for (number, leg) in moving(path) {
            let parts = match self.cut.rule {
                Rule::Strain(_) => self.least,
                _ => self.parts(number, &leg)?,
            };
            needed = needed.saturating_add(knots_of(within_max(Some(parts), number)?));
        }
        if needed <= available {
            return Ok(());
        }
        Err(PlanError::TooManyPoints { needed, available })
    }

    /// Parts of a leg where the cut alone decides them.
    fn parts(&self, number: usize, leg: &Leg<T>) -> Result<u32, PlanError<T>> {
        let parts = self.cut.linear_parts(self.platform, number, leg)?;
        Ok(parts.max(self.least))
    }

    /// Plans a leg in the first of the free knots; the number of them.
    pub(super) fn plan_leg(
        &self,
        number: usize,
        leg: &Leg<T>,
        used: usize,
        free: &mut [Knot<T>],
    ) -> Result<usize, PlanError<T>> {
        let course = Course::new(self.platform, leg);
        let parts = match self.cut.rule {
            Rule::Strain(allowed) => self.fewest(number, &course, used, free, allowed)?,
            _ => self.parts(number, leg)?,
        };
        self.lay(&course, free, parts);
        Ok(knots_of(parts))
    }

    /// Plans a leg with a number of parts.
    fn lay(&self, course: &Course<'_, N, T>, free: &mut [Knot<T>], parts: u32) {
        if let Some(knots) = free.get_mut(..knots_of(parts)) {
            let locators = self.platform.locators();
            if has_jerk(self.platform) {
                smooth::smooth(locators, course, knots, parts);
            } else {
                leg::fastest(locators, course, knots, parts);
            }
        }
    }

    /// A number of parts that keeps the allowed strain, while one fewer does not.
    fn fewest(
        &self,
        number: usize,
        course: &Course<'_, N, T>,
        used: usize,
        free: &mut [Knot<T>],
        allowed: T,
    ) -> Result<u32, PlanError<T>> {
        let room = u32::try_from(free.len().saturating_sub(1)).unwrap_or(u32::MAX);
        let mut strain = |parts| {
            self.lay(course, free, parts);
            leg_strain(self.platform, course, free)
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
                return Err(too_coarse(number, bound / allowed, parts, used, room));
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

/// Parts beyond which rounding is all that is left of a strain.
const FINEST: u32 = 1 << 20;

/// Why no number of parts that there is room for keeps the strain. It shrinks with the square
/// of the number; a tenth more is enough.
fn too_coarse<T: RealField + Copy>(
    leg: usize,
    excess: T,
    parts: u32,
    used: usize,
    room: u32,
) -> PlanError<T> {
    let more: f64 = nalgebra::try_convert(excess.sqrt()).unwrap_or(f64::MAX);
    let estimate = f64::from(parts) * more * 1.1;
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
fn leg_strain<const N: usize, T: RealField + Copy>(
    platform: &Platform<N, T>,
    course: &Course<'_, N, T>,
    knots: &[Knot<T>],
) -> T {
    segments(course, knots).fold(T::zero(), |worst, [from, to]| {
        worst.max(hermite_strain(platform, &from, &to))
    })
}

/// What a stretched leg rounds off.
const STRETCH_EPSILONS: f64 = 64.0;

/// Looks at what the controller will run: every stroke, and where jerk is limited every limit;
/// the time is then multiplied so that it just keeps them all. The fastest table keeps them by
/// its making.
pub(super) fn check_legs<const N: usize, T: RealField + Copy>(
    platform: &Platform<N, T>,
    path: &Path<'_, T>,
    knots: &mut [Knot<T>],
) -> Result<(), PlanError<T>> {
    let Some(course) = first_course(platform, path) else {
        return Ok(());
    };
    let failed = |leg, point| move |reason| PlanError::Limit { leg, point, reason };
    platform
        .check_axes(&course.place(T::zero()).axes)
        .map_err(failed(0, 0))?;
    let mut rest = knots;
    for (number, leg) in moving(path) {
        let parts = rest.first().map_or(0, |knot| knot.parts);
        let Some((knots, later)) = rest.split_at_mut_checked(knots_of(parts)) else {
            break;
        };
        rest = later;
        let course = Course::new(platform, &leg);
        for (index, [from, to]) in (1..).zip(segments(&course, knots)) {
            check::strokes(platform, &from, &to).map_err(failed(number, index))?;
        }
        if has_jerk(platform) {
            let stretch = Shares::of(platform.locators(), &course, knots).stretch();
            stretch_time(knots, stretch * (T::one() + epsilons(STRETCH_EPSILONS)));
        }
    }
    Ok(())
}

/// Multiplies the time of a leg.
fn stretch_time<T: RealField + Copy>(knots: &mut [Knot<T>], stretch: T) {
    for knot in knots {
        knot.speed /= stretch;
        knot.segment_s *= stretch;
    }
}
