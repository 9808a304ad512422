//! Paths to knots, and knots to speeds.

use crate::junction::Junction;
use crate::laying::knots_of;
use crate::leg::Leg;
use crate::number::sqrt;
use crate::passes::{self, segment_s};
use crate::place::{MIN_BETWEEN_SLOW_ENDS, Place};
use crate::reciprocals::Reciprocals;
use crate::stepping::Pairs;
use crate::{Axes, Knot, Path, PathPoint, PlanError, jerk};

/// What a leg goes on to at an end: how, and for what length.
pub(crate) type Beyond<A> = (Junction<A>, f64);

/// The fewest segments of a leg: 2 where on one, on which the speed cannot rise and fall again, it
/// would take longer than with stops at its ends.
///
/// The axes go about as `start` has it. Where a leg goes on smoothly, the path beyond may turn
/// round in its length Lₙ, at an acceleration of a with a speed of √(a Lₙ / 2).
pub(crate) fn fewest<A: Axes, E>(
    limits: &Reciprocals<A>,
    leg: &Leg<impl Path<Axes = A, Error = E>>,
    start: &PathPoint<A>,
    ends: [&Beyond<A>; 2],
) -> u32 {
    let [slowness, inertia, _] = leg.uses(limits, start);
    let speeds = ends.map(|(junction, length)| match junction {
        Junction::Smooth(_) => sqrt(length / (inertia + inertia)),
        Junction::Stop | Junction::Jump(_) => junction.cap(),
    });
    let length = leg.length();
    let with_stops_s = (1.5 * length * slowness).max(sqrt(6.0 * length * inertia));
    // Written so that what rests at both ends, for ever, is longer.
    let is_fast = (length + length) / (speeds[0] + speeds[1]) <= with_stops_s;
    if is_fast { 1 } else { MIN_BETWEEN_SLOW_ENDS }
}

/// Lays the knots of all paths, one behind the other; those that they take. `lay` lays those of a
/// leg behind its first, which is the first of those that it is given, and says how many segments
/// they are.
pub(crate) fn lay_all<'k, P: Path>(
    paths: impl Iterator<Item = P>,
    limits: &Reciprocals<P::Axes>,
    knots: &'k mut [Knot<P::Axes>],
    mut lay: impl FnMut(&Place<'_, P>, &mut [Knot<P::Axes>]) -> Result<u32, PlanError<P::Error>>,
) -> Result<&'k mut [Knot<P::Axes>], PlanError<P::Error>> {
    let available = knots.len();
    let mut paths = paths.peekable();
    let (mut number, mut used) = (0_usize, 0_usize);
    let mut before: Beyond<P::Axes> = (Junction::Stop, 0.0);
    while let Some(path) = paths.next() {
        let leg = Leg::new(number, path)?;
        let start = leg.point(0.0)?;
        let (last, free) = knots.split_at_mut(used.saturating_sub(1).min(available));
        let is_alone = number == 0 && paths.peek().is_none();
        let least = if is_alone { MIN_BETWEEN_SLOW_ENDS } else { 1 };
        let short = PlanError::Memory {
            needed: used.saturating_add(knots_of(least)),
            available,
        };
        let Some(first) = free.first_mut() else {
            return Err(short);
        };
        if number == 0 {
            (*first, used) = (Knot::start(start), 1);
        } else {
            check_gap(number, &first.point.position, &start.position)?;
        }
        let junction = junction_to(&leg, paths.peek(), limits)?;
        let after = (junction, paths.peek().map_or(0.0, Path::length));
        let place = Place {
            leg: &leg,
            start,
            caps: [before.0.cap(), junction.cap()],
            fewest: fewest(limits, &leg, &start, [&before, &after]),
            is_alone,
            used: last.len(),
        };
        let segments = lay(&place, free)?;
        used = used.saturating_add(usize::try_from(segments).unwrap_or(usize::MAX));
        before = (junction, leg.length());
        number = number.saturating_add(1);
        let Some(end) = knots.get_mut(used.saturating_sub(1)) else {
            return Err(short);
        };
        let next = paths
            .peek()
            .map(|next| start_of(number, next))
            .transpose()?;
        let jump = next.and_then(|next| end.join(&junction, &next));
        if let Some(jump) = jump {
            let slot = knots.get_mut(used).ok_or(short)?;
            (*slot, used) = (jump, used.saturating_add(1));
        }
    }
    let (knots, _) = knots.split_at_mut(used.min(available));
    if let [first, .., last] = knots {
        (first.cap, last.cap) = (0.0, 0.0);
    }
    Ok(knots)
}

/// The point at which a path begins.
fn start_of<P: Path>(leg: usize, path: &P) -> Result<PathPoint<P::Axes>, PlanError<P::Error>> {
    let refused = |reason| PlanError::Path {
        leg,
        s: 0.0,
        reason,
    };
    path.point(0.0).map_err(refused)
}

/// How a leg goes on to the next path.
pub(crate) fn junction_to<P: Path>(
    leg: &Leg<P>,
    next: Option<&P>,
    limits: &Reciprocals<P::Axes>,
) -> Result<Junction<P::Axes>, PlanError<P::Error>> {
    let Some(next) = next else {
        return Ok(Junction::Stop);
    };
    let before = leg.point(leg.length())?;
    let after = start_of(leg.number.saturating_add(1), next)?;
    let corner = leg.path().corner();
    Ok(Junction::new(limits, &corner, &before.slope, &after.slope))
}

/// Gives knots the speeds of the fastest motion from rest to rest. Its time.
pub(crate) fn time<A: Axes, E>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
) -> Result<f64, PlanError<E>> {
    passes::fastest(limits, knots);
    if limits.has_jerk() {
        jerk::smooth(limits, knots);
    }
    duration(knots)
}

/// The time of knots with speeds.
pub(crate) fn duration<A: Axes, E>(knots: &[Knot<A>]) -> Result<f64, PlanError<E>> {
    let mut knots = knots.iter();
    let Some(mut from) = knots.next() else {
        return Ok(0.0);
    };
    let (mut time_s, mut leg, mut number) = (0.0, 0_usize, 0_u32);
    for to in knots {
        (leg, number) = if from.ends_leg {
            (leg.saturating_add(1), u32::from(to.ds > 0.0))
        } else {
            (leg, number.saturating_add(1))
        };
        let before_s = time_s;
        time_s += segment_s(from, to);
        // Written so that NaN is refused too.
        let is_later = time_s > before_s && time_s.is_finite();
        if to.ds > 0.0 && !is_later {
            return Err(PlanError::Indistinct { leg, knot: number });
        }
        from = to;
    }
    Ok(time_s)
}

/// Refuses a plan that legs of one segment make slow, with the worst of them: on one segment the
/// speed cannot rise and fall again, and between two slow corners it is slow all the way.
pub(crate) fn check_single_segments<A: Axes, E>(
    pairs: &impl Pairs<A>,
    limits: &Reciprocals<A>,
    knots: &[Knot<A>],
) -> Result<(), PlanError<E>> {
    let (mut time_s, mut lost_s, mut leg) = (0.0, 0.0, 0_usize);
    let (mut most_s, mut worst) = (0.0, 0);
    for pair in knots.windows(2) {
        let [from, to] = pair else { continue };
        leg = leg.saturating_add(usize::from(from.ends_leg));
        let segment_s = segment_s(from, to);
        time_s += segment_s;
        if is_leg(from, to) {
            let own_s = segment_s - pairs.rest_to_rest_s(limits, [from, to], &to.tool);
            lost_s += own_s.max(0.0);
            if own_s > most_s {
                (most_s, worst) = (own_s, leg);
            }
        }
    }
    if time_s > (time_s - lost_s) * MOST_LOST {
        return Err(PlanError::TooCoarse { leg: worst, s: 0.0 });
    }
    Ok(())
}

/// What legs of one segment take longer than they would with more, with the speeds at their ends:
/// on one the speed cannot rise and fall again.
pub(crate) fn lost_on_single_segments<A: Axes>(limits: &Reciprocals<A>, knots: &[Knot<A>]) -> f64 {
    let lost = knots.windows(2).map(|pair| match pair {
        [from, to] if is_leg(from, to) => {
            let own_s = segment_s(from, to) - passes::up_and_down_s(limits, [from, to]);
            own_s.max(0.0)
        }
        _ => 0.0,
    });
    lost.sum()
}

/// Whether the segment between two knots is all of a leg.
fn is_leg<A: Axes>(from: &Knot<A>, to: &Knot<A>) -> bool {
    to.ends_leg && to.ds > 0.0 && from.next_start() <= 0.0
}

/// The most by which legs of one segment may take longer than with stops at their ends, as a part
/// of the whole time.
const MOST_LOST: f64 = 2.0;

/// Refuses a leg that begins elsewhere than the one before ends.
pub(crate) fn check_gap<A: Axes, E>(leg: usize, end: &A, start: &A) -> Result<(), PlanError<E>> {
    let axes = start.as_slice().iter().zip(end.as_slice());
    let mut apart = axes.map(|(start, end)| start - end).enumerate();
    apart
        .find(|(_, by)| *by != 0.0)
        .map_or(Ok(()), |(axis, by)| Err(PlanError::Gap { leg, axis, by }))
}
