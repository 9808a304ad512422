//! The knots of a table: how many, at which speeds, and whether they can be told apart.

use core::fmt::Debug;
use core::iter;

use crate::chain::Chain;
use crate::departure::{FINEST, Speeds, bound_of_parameters, estimate, fewest, spread};
use crate::leg::Leg;
use crate::number::larger_or_nan;
use crate::reciprocals::Reciprocals;
use crate::table::spans_of_leg;
use crate::{Axes, AxisLimits, Knot, Legs, Path, PlanError, Span, profile, smooth};

/// What all legs are planned with.
pub(crate) struct Planner<A: Axes> {
    limits: A::Of<AxisLimits>,
    reciprocals: Reciprocals<A>,
}

/// Fewest segments of a leg: it starts and stops.
pub(crate) const MIN_SEGMENTS: u32 = 2;

/// Largest number of segments of a leg: 12 machine epsilons of the length from its last knot but one to its end.
pub(crate) const MAX_SEGMENTS: u32 = 1 << 24;

impl<A: Axes> Planner<A> {
    /// The planner for axes with limits within the range of the crate.
    pub(crate) fn new<E>(limits: A::Of<AxisLimits>) -> Result<Self, PlanError<E>> {
        Ok(Self {
            reciprocals: Reciprocals::checked(&limits)?,
            limits,
        })
    }

    pub(crate) const fn reciprocals(&self) -> &Reciprocals<A> {
        &self.reciprocals
    }

    /// A number of segments that a leg can have; more than asked for where each phase of an
    /// S-curve needs one.
    pub(crate) fn bounded<E>(&self, leg: usize, segments: u32) -> Result<u32, PlanError<E>> {
        let least = if self.reciprocals.has_jerk() {
            smooth::PHASES
        } else {
            MIN_SEGMENTS
        };
        let max = MAX_SEGMENTS;
        if segments <= max {
            Ok(segments.max(least))
        } else {
            Err(PlanError::TooFine { leg, max })
        }
    }

    /// Checks the legs and the memory for the smallest number of knots that they need, before anything is
    /// planned.
    pub(crate) fn check_legs<L: Legs<Axes = A>>(
        &self,
        legs: &Chain<L>,
        least: impl Fn(&L::Leg) -> u32,
        available: usize,
    ) -> Result<(), PlanError<L::Error>> {
        let mut needed = 0_usize;
        let mut last: Option<A> = None;
        for leg in legs.forward(&self.reciprocals) {
            let leg = leg?;
            leg.check()?;
            let (number, start) = (leg.number, leg.checked_point(0.0)?.position);
            if let Some(last) = last {
                check_joint(number, &last, &start)?;
            }
            last = Some(leg.checked_point(leg.length())?.position);
            needed = needed.saturating_add(knots_of(self.bounded(number, least(leg.path()))?));
        }
        if needed <= available {
            return Ok(());
        }
        Err(PlanError::Memory { needed, available })
    }

    /// The ends of a leg at which its knots are dense.
    fn rests<P: Path<Axes = A>>(&self, leg: &Leg<P>, starts_at_rest: bool) -> [bool; 2] {
        if self.reciprocals.has_jerk() {
            return [true; 2];
        }
        [starts_at_rest, leg.joint().is_stop()]
    }

    /// Spreads a leg's knots over the first of the free ones; those that it takes.
    pub(crate) fn lay_leg<'k, P: Path<Axes = A>>(
        &self,
        leg: &Leg<P>,
        starts_at_rest: bool,
        free: &'k mut [Knot],
        segments: u32,
    ) -> Result<&'k mut [Knot], PlanError<P::Error>> {
        let (needed, available) = (knots_of(segments), free.len());
        let own = free
            .get_mut(..needed)
            .ok_or(PlanError::Memory { needed, available })?;
        profile::spread(own, leg.length(), self.rests(leg, starts_at_rest));
        Ok(own)
    }

    /// Plans all legs whose knots are spread. Seconds from the first knot to the last.
    pub(crate) fn plan_legs<L: Legs<Axes = A>>(
        &self,
        legs: &Chain<L>,
        knots: &mut [Knot],
    ) -> Result<f64, PlanError<L::Error>> {
        if self.reciprocals.has_jerk() {
            self.plan_smooth(legs.clone(), knots)?;
        } else {
            profile::fastest_of_all(&self.reciprocals, legs, knots)?;
        }
        let mut time_s = 0.0;
        for (leg, own) in legs.forward(&self.reciprocals).zip(profile::by_leg(knots)) {
            time_s = check_times(leg?.number, own, time_s)?;
        }
        Ok(time_s)
    }

    /// The same with a limit of jerk: from stop to stop.
    fn plan_smooth<L: Legs<Axes = A>>(
        &self,
        mut legs: Chain<L>,
        knots: &mut [Knot],
    ) -> Result<(), PlanError<L::Error>> {
        let mut later = knots;
        while let Some(part) = legs.split_at_stop(&self.reciprocals)? {
            let count = (0..part.count()).fold(0_usize, |count, _| {
                let (_, rest) = later.split_at(count.min(later.len()));
                count.saturating_add(profile::first_leg(rest))
            });
            let (own, rest) = profile::split(later, count);
            smooth::smooth(&self.limits, &self.reciprocals, &part, own)?;
            later = rest;
        }
        Ok(())
    }

    /// Plans a leg from rest to rest in the first of the free knots; those that it takes.
    fn plan_leg<'k, P: Path<Axes = A> + Debug>(
        &self,
        leg: &Leg<P>,
        free: &'k mut [Knot],
        segments: u32,
    ) -> Result<&'k mut [Knot], PlanError<P::Error>> {
        let (needed, available) = (knots_of(segments), free.len());
        let own = free
            .get_mut(..needed)
            .ok_or(PlanError::Memory { needed, available })?;
        if self.reciprocals.has_jerk() {
            let alone = Chain::new(iter::once(leg.path()), leg.number);
            smooth::smooth_leg(&self.limits, &self.reciprocals, &alone, own)?;
        } else {
            profile::fastest(&self.reciprocals, leg, own)?;
        }
        Ok(own)
    }

    /// A number of segments that keeps the allowed departure, while one fewer does not.
    pub(crate) fn fewest<P: Path<Axes = A> + Debug>(
        &self,
        leg: &Leg<P>,
        starts_at_rest: bool,
        [used, free]: [usize; 2],
        knots: &mut [Knot],
        wanted: &Within<impl Fn(&P, &Span<A>) -> f64>,
    ) -> Result<u32, PlanError<P::Error>> {
        let least = self.bounded(leg.number, wanted.at_least)?;
        let room = u32::try_from(free.saturating_sub(1)).unwrap_or(u32::MAX);
        if room < least {
            return Err(PlanError::Memory {
                needed: used.saturating_add(knots_of(least)),
                available: used.saturating_add(free),
            });
        }
        let rests = self.rests(leg, starts_at_rest);
        let (jerk, any_feed) = (self.reciprocals.has_jerk(), wanted.any_feed);
        let is_alone = starts_at_rest && leg.joint().is_stop();
        let speeds = match (any_feed, jerk) {
            (true, _) => Speeds::Run,
            (false, true) => Speeds::PassingSmoothly,
            (false, false) => Speeds::Passing,
        };
        let bound_of = |segments| {
            let mut bound = 0.0;
            if any_feed && !jerk || !is_alone {
                let parameters = spread(leg, segments, rests);
                bound = bound_of_parameters(leg, parameters, speeds, &wanted.departure)?;
            }
            // With jerk also where each leg runs alone.
            if jerk || is_alone && !any_feed {
                let knots = self.plan_leg(leg, knots, segments)?;
                let parameters = knots.iter().map(|knot| knot.s);
                let alone = if any_feed {
                    bound_of_parameters(leg, parameters, speeds, &wanted.departure)
                } else {
                    bound_of_leg(leg, knots, &wanted.departure)
                };
                bound = larger_or_nan(bound, alone?);
            }
            Ok(bound)
        };
        let too_coarse =
            |bound, segments| too_coarse(leg.number, bound / wanted.allowed, segments, used, room);
        fewest(least, room, wanted.allowed, bound_of, too_coarse)
    }
}

/// A departure that segments have to keep.
pub(crate) struct Within<D> {
    pub(crate) at_least: u32,
    pub(crate) allowed: f64,
    /// Whether at any speeds, or at those of the table.
    pub(crate) any_feed: bool,
    pub(crate) departure: D,
}

/// The number of knots of a leg with this number of segments.
pub(crate) fn knots_of(segments: u32) -> usize {
    usize::try_from(segments).map_or(usize::MAX, |segments| segments.saturating_add(1))
}

/// The number of segments of a leg with these knots.
pub(crate) fn segments_of(knots: &[Knot]) -> u32 {
    u32::try_from(knots.len().saturating_sub(1)).unwrap_or(u32::MAX)
}

/// Refuses a leg that begins elsewhere than the one before ends.
pub(crate) fn check_joint<A: Axes, E>(leg: usize, end: &A, start: &A) -> Result<(), PlanError<E>> {
    let axes = start.as_slice().iter().zip(end.as_slice());
    let mut apart = axes.map(|(start, end)| start - end).enumerate();
    apart
        .find(|(_, by)| *by != 0.0)
        .map_or(Ok(()), |(axis, by)| Err(PlanError::Gap { leg, axis, by }))
}

/// Refuses knots that no time lies between; the time at the last.
fn check_times<E>(leg: usize, knots: &[Knot], mut time_s: f64) -> Result<f64, PlanError<E>> {
    let segments = knots.split_last().map_or(knots, |(_, segments)| segments);
    for (knot, segment) in (1..).zip(segments) {
        let before_s = time_s;
        time_s += segment.duration_s;
        if !(time_s > before_s && time_s.is_finite()) {
            return Err(PlanError::Indistinct { leg, knot });
        }
    }
    Ok(time_s)
}

/// Why no number of segments that there is room for keeps the departure.
fn too_coarse<E>(leg: usize, excess: f64, segments: u32, used: usize, room: u32) -> PlanError<E> {
    let estimate = estimate(segments, excess);
    if segments < room || estimate > f64::from(FINEST) {
        return PlanError::TooFine { leg, max: FINEST };
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked against the finest"
    )]
    let needed = (estimate as u32).saturating_add(1);
    PlanError::Memory {
        needed: used.saturating_add(knots_of(needed)),
        available: used.saturating_add(knots_of(room)),
    }
}

/// The largest departure of a leg's segments.
pub(crate) fn bound_of_leg<P: Path>(
    leg: &Leg<P>,
    knots: &[Knot],
    departure: &impl Fn(&P, &Span<P::Axes>) -> f64,
) -> Result<f64, PlanError<P::Error>> {
    spans_of_leg(leg, knots).try_fold(0.0, |worst, span| {
        Ok(larger_or_nan(worst, departure(leg.path(), &span?)))
    })
}
