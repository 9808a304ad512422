//! How far the tool departs from its path, and the number of segments that keeps a bound of it.

use core::cell::Cell;

use crate::knots::{span, span_in_a_second};
use crate::laying::{Cutting, Laying, bounded, knots_of};
use crate::leg::Leg;
use crate::number::{cube_root, larger_or_nan, sqrt};
use crate::passes::segment_s;
use crate::place::Place;
use crate::planner::time;
use crate::reciprocals::Reciprocals;
use crate::stretch::most_evenly;
use crate::{Axes, Knot, Path, PlanError, Span};

/// Segments beyond which rounding is all that is left of a departure.
const FINEST: u32 = 1 << 20;

/// Whether the machine is slow at the ends of a path.
const CORNERS: [[bool; 2]; 4] = [[true, true], [false, false], [true, false], [false, true]];

/// Ratios w₀ T / Δs of a segment that may begin and end at rest: with T = 2Δs / (w₀ + w₁) they
/// are 0..=2.
const ANY: [f64; 5] = [0.0, 0.5, 1.0, 1.5, 2.0];

/// What a departure is bounded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Speeds {
    /// Any speeds, at rest at the ends alone; those of the plan where they are known.
    Passing,
    /// Any speeds, with holds at any knot.
    Any,
}

/// A departure that segments have to keep.
pub(crate) struct Within<D> {
    pub(crate) min_segments: u32,
    pub(crate) allowed: f64,
    pub(crate) speeds: Speeds,
    pub(crate) departure: D,
    /// Whether other speeds than those of `limits` follow, so that nothing is stretched for these.
    pub(crate) is_plain: bool,
    /// The knots of a leg alone that are planned already, with their speeds.
    pub(crate) planned: Cell<usize>,
}

/// The number of segments of a path that keeps a departure within `allowed` at any speeds, with any
/// corners at its ends: for [`LookAhead`](crate::LookAhead), whose speeds nobody knows beforehand,
/// and which halves those of them that the path takes for too coarse. Not from rest to rest but at
/// the end of the path: with a limit of jerk a window of four or five knots may rest at each.
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
    let leg = Leg::new(0, path)?;
    let at_least = bounded(0, at_least, 1)?;
    let bound_of = |segments, rests| {
        let start = leg.point(0.0)?;
        let mut cutting = Cutting::new(Laying::new(leg, start), rests, segments);
        let mut bound = Bound::new(allowed);
        let mut from = Knot::start(start);
        while !from.ends_leg && !bound.is_far() {
            let to = match cutting.next_knot(|_, _, _| 1.0, |_, _, _| true) {
                Err(PlanError::TooCoarse { .. }) => return Ok(f64::INFINITY),
                to => to?,
            };
            // What a path refuses without a stretch it refuses with one: a stream has no fewer knots.
            let ds = to.ds * most_evenly([&from.point, &to.point], to.ds);
            let stretched = Knot { ds, ..to };
            let departure = |span: &Span<P::Axes>| departure(path, span);
            bound.add_any([&from, &stretched], to.ends_leg, departure);
            from = to;
        }
        Ok(bound.worst)
    };
    let (mut most, mut kept) = (at_least, 0_usize);
    for rests in CORNERS.iter().cycle() {
        let found = search([most, FINEST], allowed, |segments| {
            bound_of(segments, *rests)
        })?;
        let (leg, max) = (0, FINEST);
        let enough = found.map_err(|_| PlanError::TooFine { leg, max })?;
        // More segments may be too few where fewer were enough.
        kept = if enough == most {
            kept.saturating_add(1)
        } else {
            1
        };
        most = enough;
        // On one segment the knots are the ends, with any corners.
        if most == 1 || kept == CORNERS.len() {
            break;
        }
    }
    Ok(most)
}

/// Refuses a departure that no segment can keep.
pub(crate) fn check_allowed<E>(allowed: f64) -> Result<(), PlanError<E>> {
    if allowed > 0.0 && allowed.is_finite() {
        return Ok(());
    }
    Err(PlanError::Allowed { allowed })
}

impl<D> Within<D> {
    /// Lays the knots of a leg of a table, doubled in number some times.
    pub(crate) fn lay<P: Path>(
        &self,
        place: &Place<'_, P>,
        limits: &Reciprocals<P::Axes>,
        doublings: u32,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<u32, PlanError<P::Error>>
    where
        D: Fn(&P, &Span<P::Axes>) -> f64,
    {
        let number = place.leg.number;
        let at_least = bounded(number, self.min_segments, place.fewest)?;
        let [segments, laid] = self.fewest(place, limits, at_least, knots)?;
        if doublings == 0 {
            return Ok(laid);
        }
        let finer = segments.saturating_mul(1 << doublings.min(24));
        let finer = bounded(number, finer, place.fewest)?;
        self.planned.set(0);
        self.lay_at_once(place, limits, finer, knots)
    }

    fn lay_at_once<P: Path>(
        &self,
        place: &Place<'_, P>,
        limits: &Reciprocals<P::Axes>,
        segments: u32,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<u32, PlanError<P::Error>> {
        let bent = self.bent(place);
        if self.is_plain {
            place.lay_plainly(limits, segments, bent, knots)
        } else {
            place.lay(limits, segments, bent, knots)
        }
    }

    /// Lays a leg with a number of segments, at most a sixteenth above the fewest found, that keeps
    /// the allowed departure; that number, and how many they are with those that the path asks for.
    /// A leg alone is planned, and the departure counts at its speeds.
    fn fewest<P: Path>(
        &self,
        place: &Place<'_, P>,
        limits: &Reciprocals<P::Axes>,
        at_least: u32,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<[u32; 2], PlanError<P::Error>>
    where
        D: Fn(&P, &Span<P::Axes>) -> f64,
    {
        let room = u32::try_from(knots.len().saturating_sub(1)).unwrap_or(u32::MAX);
        let room = room.min(FINEST);
        if room < at_least {
            return Err(too_coarse(place, at_least, room));
        }
        let (mut tried, mut laid) = (0, 0);
        let trial = |segments| {
            let (departure, all) = self.trial(place, limits, segments, knots)?;
            (tried, laid) = (segments, all);
            Ok(departure)
        };
        let found = search([at_least, room], self.allowed, trial)?;
        let segments = found.map_err(|needed| too_coarse(place, needed, room))?;
        if tried != segments {
            (_, laid) = self.trial(place, limits, segments, knots)?;
        }
        Ok([segments, laid])
    }

    /// Whether the departure counts at the speeds of the plan.
    fn is_planned<P: Path>(&self, place: &Place<'_, P>) -> bool {
        self.speeds == Speeds::Passing && place.is_alone
    }

    /// By which part knots are dense where the speed changes.
    fn bent<P: Path>(&self, place: &Place<'_, P>) -> f64 {
        if self.is_planned(place) { BENT } else { 0.0 }
    }

    /// The departure with a number of segments, and how many are laid then; what is far beyond the
    /// allowed one is not looked at to its end.
    fn trial<P: Path>(
        &self,
        place: &Place<'_, P>,
        limits: &Reciprocals<P::Axes>,
        segments: u32,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<(f64, u32), PlanError<P::Error>>
    where
        D: Fn(&P, &Span<P::Axes>) -> f64,
    {
        self.planned.set(0);
        let laid = match self.lay_at_once(place, limits, segments, knots) {
            Err(PlanError::TooCoarse { .. }) => return Ok((f64::INFINITY, 0)),
            laid => laid?,
        };
        let count = knots_of(laid);
        let (knots, _) = knots.split_at_mut(count.min(knots.len()));
        let is_planned = self.is_planned(place);
        if let (true, Some(last)) = (is_planned, knots.last_mut()) {
            last.cap = 0.0;
            time::<_, P::Error>(limits, knots)?;
            self.planned.set(count);
        }
        let path = place.leg.path();
        let last = knots.len().saturating_sub(2);
        let mut bound = Bound::new(self.allowed);
        // First those at the ends: next to a rest the departure is largest.
        let ends = [0, last].into_iter().take(last.saturating_add(1));
        for (looked, index) in ends.chain(1..last).enumerate() {
            let Some([from, to]) = knots.get(index..index.saturating_add(2)) else {
                continue;
            };
            let departure = |span: &Span<P::Axes>| (self.departure)(path, span);
            if is_planned {
                let speeds = [from.speed, to.speed];
                bound.add(departure(&span([from, to], speeds, segment_s(from, to))));
            } else {
                bound.add_any([from, to], index == last, departure);
            }
            let is_passed = looked == 1 && bound.worst > self.allowed;
            if is_passed || bound.is_far() {
                break;
            }
        }
        Ok((bound.worst, laid))
    }
}

/// The largest departure of some segments.
struct Bound {
    worst: f64,
    far: f64,
}

impl Bound {
    const fn new(allowed: f64) -> Self {
        Self {
            worst: 0.0,
            far: allowed * FAR,
        }
    }

    fn add(&mut self, departure: f64) {
        self.worst = larger_or_nan(self.worst, departure);
    }

    /// At any speeds; on the last segment before a stop, where it may be held at the knot before,
    /// also from rest to rest.
    fn add_any<A: Axes>(
        &mut self,
        knots: [&Knot<A>; 2],
        is_last: bool,
        departure: impl Fn(&Span<A>) -> f64,
    ) {
        for start in ANY {
            self.add(departure(&span_in_a_second(knots, start)));
        }
        if is_last {
            self.add(departure(&span(knots, [0.0; 2], 1.0)));
        }
    }

    /// Whether it is so far beyond what is allowed that the rest need not be looked at.
    fn is_far(&self) -> bool {
        // Written so that NaN is, too.
        let is_near = self.worst <= self.far;
        !is_near
    }
}

/// A number of segments within a range whose departure is within `allowed`, about a sixteenth or
/// one above the fewest; an estimate of what would be enough where the most are too few.
fn search<E>(
    [least, most]: [u32; 2],
    allowed: f64,
    mut bound_of: impl FnMut(u32) -> Result<f64, PlanError<E>>,
) -> Result<Result<u32, u32>, PlanError<E>> {
    let (mut too_few, mut enough) = ((least.saturating_sub(1), 0.0), None);
    let mut segments = least;
    loop {
        let excess = bound_of(segments)? / allowed;
        let root = fourth_root(excess);
        // Written so that NaN is too much.
        if excess <= 1.0 {
            enough = Some((segments, 1.0 / root));
        } else {
            too_few = (segments, 1.0 / root);
        }
        segments = match enough {
            Some(enough) => {
                let fewest = fewest_between(too_few, enough);
                let ((too_few, _), (enough, _)) = (too_few, enough);
                let (gap, close) = (
                    enough.saturating_sub(too_few),
                    enough.div_euclid(CLOSE).max(1),
                );
                if gap <= close || enough.saturating_sub(fewest) <= close {
                    return Ok(Ok(enough));
                }
                // A quarter of the way where a guess would end next to nothing.
                let step = gap.div_ceil(4);
                fewest
                    .max(too_few.saturating_add(step))
                    .min(enough.saturating_sub(step))
            }
            None => {
                let more = if segments == least {
                    root
                } else {
                    cube_root(limited(excess))
                };
                let guess = rounded_up(f64::from(segments) * more * MORE);
                let guess = guess.max(segments.saturating_add(1));
                if segments >= most {
                    return Ok(Err(guess));
                }
                guess.min(most)
            }
        };
    }
}

/// The part of the segments that more than the fewest may be.
const CLOSE: u32 = 16;

/// What is beyond this many times the allowed departure is so by its first segments.
const FAR: f64 = 64.0;

/// What is put on a guess, so that it is rather enough.
const MORE: f64 = 1.01;

/// What a departure is as a multiple of the allowed one, as far as it counts.
fn limited(excess: f64) -> f64 {
    if excess.is_finite() {
        excess.min(FAR)
    } else {
        FAR
    }
}

/// The departure shrinks with the fourth power of the number of segments, or, where knots are far
/// apart, with less.
fn fourth_root(excess: f64) -> f64 {
    sqrt(sqrt(limited(excess)))
}

/// About the fewest segments that are enough, between numbers of which one is not enough and the
/// other is, each with the inverse of the fourth root of its departure, which is about linear.
fn fewest_between((few, low): (u32, f64), (enough, high): (u32, f64)) -> u32 {
    let part = (1.0 - low) / (high - low);
    few.saturating_add(rounded_up(f64::from(enough.saturating_sub(few)) * part))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "positive; a cast saturates"
)]
fn rounded_up(number: f64) -> u32 {
    libm::ceil(number) as u32
}

/// The part of the knots that stand where the speed changes.
const BENT: f64 = 0.35;

/// Why no number of segments that there is room for keeps the departure.
fn too_coarse<P: Path>(place: &Place<'_, P>, needed: u32, room: u32) -> PlanError<P::Error> {
    if room >= FINEST {
        let (leg, max) = (place.leg.number, FINEST);
        return PlanError::TooFine { leg, max };
    }
    PlanError::Memory {
        // Room for what an estimate may be off by.
        needed: place
            .used
            .saturating_add(knots_of(needed.saturating_add(needed / 4))),
        available: place.used.saturating_add(knots_of(room)),
    }
}
