//! How far segments can depart from a path at any speeds, and the number of them that keeps a bound.

use crate::leg::Leg;
use crate::number::{larger_or_nan, sqrt};
use crate::planner::{MAX_SEGMENTS, MIN_SEGMENTS};
use crate::profile::fraction;
use crate::{Path, PlanError, Row, Span};

/// Segments beyond which rounding is all that is left of a departure.
pub(crate) const FINEST: u32 = 1 << 20;

/// Path speeds at both ends of a segment, times its duration over its length: from rest, to rest
/// and between, with the speed linear in time.
const LINEAR: [[f64; 2]; 5] = [[0.0, 2.0], [0.5, 1.5], [1.0, 1.0], [1.5, 0.5], [2.0, 0.0]];

/// From rest and to rest without a step of the acceleration; also where a table whose speed changes
/// threefold on the segment is held or resumed.
const SMOOTH: [[f64; 2]; 2] = [[0.0, 3.0], [3.0, 0.0]];

/// From rest to rest.
const BOTH_AT_REST: [[f64; 2]; 1] = [[0.0; 2]];

/// Which speeds a bound is looked at for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Speeds {
    /// Those of a motion that does not stop on the path.
    Passing,
    /// The same with a limit of jerk.
    PassingSmoothly,
    /// Those of a stream with any feeds, holds and resumes: linear in time on each segment.
    Stream,
    /// Those of a table that runs at any feeds, holds and resumes.
    Run,
}

/// The number of segments of a path that keeps a departure within `allowed` at any speeds, with any
/// corners at its ends: for [`LookAhead`](crate::LookAhead), whose speeds nobody knows beforehand.
///
/// `departure` is a bound on what a controller departs by on a segment, in any unit: see
/// [`Table::plan_within_at_any_feed`](crate::Table::plan_within_at_any_feed).
///
/// # Errors
/// [`PlanError`] with a leg of 0: [`PlanError::TooFine`] where 2²⁰ segments are too few,
/// [`PlanError::Allowed`], and where the path refuses a point.
pub fn segments_within<P: Path>(
    path: &P,
    at_least: u32,
    allowed: f64,
    departure: impl Fn(&P, &Span<P::Axes>) -> f64,
) -> Result<u32, PlanError<P::Error>> {
    check_allowed(allowed)?;
    if at_least > MAX_SEGMENTS {
        let max = MAX_SEGMENTS;
        return Err(PlanError::TooFine { leg: 0, max });
    }
    let leg = Leg::last(0, path);
    leg.check()?;
    let departure = |path: &&P, span: &Span<P::Axes>| departure(path, span);
    let speeds = Speeds::Stream;
    let bound_of = |segments| {
        let ends = [[false, false], [false, true], [true, false], [true, true]];
        ends.into_iter().try_fold(0.0, |worst, rests| {
            let bound =
                bound_of_parameters(&leg, spread(&leg, segments, rests), speeds, &departure)?;
            Ok(larger_or_nan(worst, bound))
        })
    };
    let too_coarse = |_, _| PlanError::TooFine {
        leg: 0,
        max: FINEST,
    };
    fewest(
        at_least.max(MIN_SEGMENTS),
        FINEST,
        allowed,
        bound_of,
        too_coarse,
    )
}

/// Refuses a departure that no segment can keep.
pub(crate) fn check_allowed<E>(allowed: f64) -> Result<(), PlanError<E>> {
    if allowed > 0.0 && allowed.is_finite() {
        return Ok(());
    }
    Err(PlanError::Allowed { allowed })
}

/// The parameters of a leg's knots.
pub(crate) fn spread<P: Path>(
    leg: &Leg<P>,
    segments: u32,
    rests: [bool; 2],
) -> impl Iterator<Item = f64> + use<P> {
    let length = leg.length();
    let at = move |index| length * fraction(f64::from(index) / f64::from(segments), rests);
    (0..=segments).map(at)
}

/// The largest departure between knots at any speeds of their segments.
pub(crate) fn bound_of_parameters<P: Path>(
    leg: &Leg<P>,
    parameters: impl Iterator<Item = f64>,
    speeds: Speeds,
    departure: &impl Fn(&P, &Span<P::Axes>) -> f64,
) -> Result<f64, PlanError<P::Error>> {
    let mut parameters = parameters.peekable();
    let mut worst = 0.0;
    let Some(mut from) = parameters.next() else {
        return Ok(worst);
    };
    let mut start = leg.checked_point(from)?;
    while let Some(to) = parameters.next() {
        let end = leg.checked_point(to)?;
        let mut check = |ratios: &[[f64; 2]]| {
            for [w0, w1] in ratios {
                // In a second.
                let [w0, w1] = [w0 * (to - from), w1 * (to - from)];
                let span = Span {
                    s: [from, to],
                    rows: [Row::new(&start, w0, 0.0, 0.0), Row::new(&end, w1, 1.0, 1.0)],
                };
                worst = larger_or_nan(worst, departure(leg.path(), &span));
            }
        };
        check(&LINEAR);
        if matches!(speeds, Speeds::PassingSmoothly | Speeds::Run) {
            check(&SMOOTH);
        }
        if matches!(speeds, Speeds::Stream | Speeds::Run) {
            // Held at the last knot before a stop.
            if parameters.peek().is_none() {
                check(&BOTH_AT_REST);
            }
        }
        (from, start) = (to, end);
    }
    Ok(worst)
}

/// A number of segments whose bound is within `allowed`, while that of one fewer is not: by doubling
/// up to `room`, and bisection. `too_coarse` is the error for a bound that is too large with the
/// number that there is room for.
pub(crate) fn fewest<E>(
    least: u32,
    room: u32,
    allowed: f64,
    mut bound_of: impl FnMut(u32) -> Result<f64, PlanError<E>>,
    too_coarse: impl Fn(f64, u32) -> PlanError<E>,
) -> Result<u32, PlanError<E>> {
    let (mut too_few, mut enough) = (least.saturating_sub(1), least);
    let mut bound = bound_of(enough)?;
    // Written so that NaN is too large.
    while !is_within(bound, allowed) {
        if enough >= room || enough >= FINEST {
            return Err(too_coarse(bound, enough));
        }
        too_few = enough;
        enough = enough.saturating_mul(2).min(room).min(FINEST);
        bound = bound_of(enough)?;
    }
    while enough.saturating_sub(too_few) > 1 {
        let middle = too_few.midpoint(enough);
        if is_within(bound_of(middle)?, allowed) {
            enough = middle;
        } else {
            too_few = middle;
        }
    }
    Ok(enough)
}

fn is_within(bound: f64, allowed: f64) -> bool {
    bound <= allowed
}

/// An estimate of the number that is enough where `segments` depart by `excess` times what is
/// allowed: the departure shrinks with the square of the number; a tenth more.
pub(crate) fn estimate(segments: u32, excess: f64) -> f64 {
    f64::from(segments) * sqrt(excess) * 1.1
}
