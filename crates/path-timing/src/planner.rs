//! Paths to knots, and knots to speeds.

use crate::junction::Junction;
use crate::knots::{
    LARGEST_GAP, LARGEST_GAP_AT_RESTS, Laying, Shares, fraction, is_resolved, note_unused, spread,
};
use crate::leg::Leg;
use crate::number::{Real, sqrt};
use crate::passes::{self, segment_s};
use crate::reciprocals::Reciprocals;
use crate::stretch::stretch;
use crate::{Axes, Knot, Path, PathPoint, PlanError, jerk};

/// Fewest segments of a leg that starts and ends slowly.
const MIN_BETWEEN_SLOW_ENDS: u32 = 2;

/// Largest number of segments of a leg: 12 machine epsilons of the length from its last knot but
/// one to its end.
pub(crate) const MAX_SEGMENTS: u32 = 1 << 24;

/// A number of segments that a leg can have, `fewest` or more.
pub(crate) fn bounded<E>(leg: usize, segments: u32, fewest: u32) -> Result<u32, PlanError<E>> {
    let max = MAX_SEGMENTS;
    if segments <= max {
        Ok(segments.max(fewest))
    } else {
        Err(PlanError::TooFine { leg, max })
    }
}

/// How often segments are halved where the path between two knots is not known.
pub(crate) const MOST_HALVINGS: u32 = 6;

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
    let slopes = limits.axes().iter().zip(start.slope.as_slice());
    let of_axes =
        slopes.map(|(limit, slope)| [limit.speed, limit.acceleration].map(|l| l * slope.abs()));
    let of_tool = leg
        .tool()
        .map(|tool| [1.0 / tool.feed, tool.acceleration.map_or(0.0, |a| 1.0 / a)]);
    let [slowness, inertia] = of_axes
        .chain(of_tool)
        .fold([0.0_f64; 2], |[speed, acceleration], [v, a]| {
            [speed.max(v), acceleration.max(a)]
        });
    let speeds = ends.map(|(junction, length)| match junction {
        Junction::Stop => 0.0,
        Junction::Smooth(_) => sqrt(length / (inertia + inertia)),
        Junction::Jump(speed) => *speed,
    });
    let length = leg.length();
    let with_stops_s = (1.5 * length * slowness).max(sqrt(6.0 * length * inertia));
    // Written so that what rests at both ends, for ever, is longer.
    let is_fast = (length + length) / (speeds[0] + speeds[1]) <= with_stops_s;
    if is_fast { 1 } else { MIN_BETWEEN_SLOW_ENDS }
}

/// A leg whose knots are to be laid.
pub(crate) struct Place<'p, P: Path> {
    pub(crate) leg: &'p Leg<P>,
    pub(crate) start: PathPoint<P::Axes>,
    /// Whether the machine rests at its ends.
    pub(crate) rests: [bool; 2],
    /// The fewest segments.
    pub(crate) fewest: u32,
    /// Whether it is the only one.
    pub(crate) is_alone: bool,
    /// Knots of the legs before.
    pub(crate) used: usize,
}

/// Segments below which all are laid to see where the machine is slow; beyond, half of them.
const FEW: u32 = 32;

const BY_TIME: Shares = Shares {
    time: 0.5,
    unused: 0.0,
    bend: 0.0,
};

const BY_LIMITS: Shares = Shares {
    time: 0.4,
    unused: 0.2,
    bend: 0.0,
};

/// What a rough plan may lose on a segment, as [`spread`] says, without being made again. Of 9,000
/// plans of random paths with some 100 segments 3 in 10 lose more, and of the others one in 300
/// takes 0.5 % longer than the shortest time.
const MOST_LOST_ON_ONE: f64 = 0.9;

/// On fewer segments the speeds of a plan say little of those of the next, whose knots stand
/// elsewhere: then higher limits took up to 1.2 times as long.
const FEWEST_STRETCHED: u32 = 16;

/// How often it is made again: with 3 one of 65 plans of waves with 100 segments takes over 0.5 %
/// longer than the best, with 4 one of 120, with 6 one of 180.
const ROUNDS: u32 = 4;

impl<P: Path + Clone> Place<'_, P> {
    /// Lays a number of segments, or twice as many, and so on, where the path is not known between
    /// two knots. How many they are.
    pub(crate) fn lay_resolved(
        &self,
        segments: u32,
        mut lay: impl FnMut(u32) -> Result<(), PlanError<P::Error>>,
    ) -> Result<u32, PlanError<P::Error>> {
        let number = self.leg.number;
        let segments = bounded(number, segments, self.fewest)?;
        let coarse = match lay(segments) {
            Err(coarse @ PlanError::TooCoarse { .. }) => coarse,
            laid => return laid.map(|()| segments),
        };
        for halvings in 1..=MOST_HALVINGS {
            let finer = bounded(number, segments << halvings, 1)?;
            match lay(finer) {
                Err(PlanError::TooCoarse { .. }) => {}
                // How many would do, nobody knows.
                Err(PlanError::Memory { .. }) => break,
                laid => return laid.map(|()| finer),
            }
        }
        Err(coarse)
    }

    /// Lays the knots of the leg behind its first, which is the first of those given: dense where
    /// the fastest motion along the leg is slow and where its limits change, by the part `bent`
    /// also where its speed changes, and stretched for it.
    ///
    /// Stretches follow from the speeds of a plan before, whose knots stand elsewhere; where
    /// accelerations change by much from knot to knot that plan is slow, so that it is made again
    /// from the better ones.
    pub(crate) fn lay(
        &self,
        limits: &Reciprocals<P::Axes>,
        segments: u32,
        bent: f64,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<(), PlanError<P::Error>> {
        if limits.has_jerk() || self.leg.tool().is_some() || segments < FEWEST_STRETCHED {
            return self.lay_plainly(limits, segments, bent, knots);
        }
        let own = self.room(segments, knots)?;
        let laid = self.lay_by_plan(limits, bent, own);
        // Knots that stand elsewhere may be too far apart, or their cubics leave what the path
        // allows.
        laid.and_then(|()| self.check_resolved(limits, own))
            .or_else(|_| self.lay_plainly(limits, segments, bent, own))
    }

    /// Lays all knots by the speeds of a plan of fewer.
    fn lay_by_plan(
        &self,
        limits: &Reciprocals<P::Axes>,
        bent: f64,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<(), PlanError<P::Error>> {
        let (parts, planned) = (BY_LIMITS.bent(bent), self.lay_roughly(limits, knots)?);
        note_unused(limits, knots, planned);
        let lost = spread(parts, knots, planned);
        self.lay_stretched(limits, knots)?;
        if lost > MOST_LOST_ON_ONE {
            let count = knots.len();
            for _ in 0..ROUNDS {
                self.alone(limits, knots);
                note_unused(limits, knots, count);
                spread(parts, knots, count);
                self.lay_stretched(limits, knots)?;
            }
        }
        Ok(())
    }

    /// Lays the knots where the motion is slow, none stretched: for limits of jerk and torque, for
    /// tools, few segments, and plans in single precision, which are to be small.
    pub(crate) fn lay_plainly<R: Real>(
        &self,
        limits: &Reciprocals<P::Axes, R>,
        segments: u32,
        bent: f64,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<(), PlanError<P::Error>> {
        let own = self.room(segments, knots)?;
        let planned = self.lay_roughly(limits, own)?;
        spread(BY_TIME.bent(bent), own, planned);
        self.lay_at_places(own)?;
        self.check_resolved(limits, own)
    }

    /// The knots of the leg, of those given.
    fn room<'k>(
        &self,
        segments: u32,
        knots: &'k mut [Knot<P::Axes>],
    ) -> Result<&'k mut [Knot<P::Axes>], PlanError<P::Error>> {
        let (count, available) = (knots_of(segments), knots.len());
        knots.get_mut(..count).ok_or(PlanError::Memory {
            needed: self.used.saturating_add(count),
            available: self.used.saturating_add(available),
        })
    }

    /// Plans a leg of fewer segments, on which it shows, too, where the machine is slow: the first
    /// of the knots. How many they are.
    fn lay_roughly<R: Real>(
        &self,
        limits: &Reciprocals<P::Axes, R>,
        own: &mut [Knot<P::Axes>],
    ) -> Result<usize, PlanError<P::Error>> {
        let length = self.leg.length();
        let segments = u32::try_from(own.len().saturating_sub(1)).unwrap_or(MAX_SEGMENTS);
        let few = (segments / 2).max(segments.min(FEW));
        let (rough, _) = own.split_at_mut(knots_of(few).min(own.len()));
        for (index, knot) in (0..=few).zip(&mut *rough) {
            let u = f64::from(index) / f64::from(few);
            knot.moved_s = length * fraction(u, self.rests);
        }
        self.lay_at_places(rough)?;
        self.alone(limits, rough);
        Ok(rough.len())
    }

    /// Lays knots where they are to stand.
    fn lay_at_places(&self, knots: &mut [Knot<P::Axes>]) -> Result<(), PlanError<P::Error>> {
        self.lay_each(knots, |_, _, _, _| 1.0)
    }

    /// The same, stretched for the speeds that are wanted there.
    fn lay_stretched(
        &self,
        limits: &Reciprocals<P::Axes>,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<(), PlanError<P::Error>> {
        self.lay_each(knots, |from, to, length, speeds| {
            stretch(limits, [from, to], length, speeds)
        })
    }

    fn lay_each(
        &self,
        knots: &mut [Knot<P::Axes>],
        stretch: impl Fn(&PathPoint<P::Axes>, &PathPoint<P::Axes>, f64, [f64; 2]) -> f64,
    ) -> Result<(), PlanError<P::Error>> {
        let (length, last) = (self.leg.length(), knots.len().saturating_sub(1));
        let mut laying = Laying::new(self.leg.clone(), self.start);
        let mut before = knots.first().map_or(0.0, |first| first.wanted);
        for (index, knot) in knots.iter_mut().enumerate().skip(1) {
            let (moved_s, wanted) = (knot.moved_s, knot.wanted);
            let s = if index < last { moved_s } else { length };
            let speeds = [core::mem::replace(&mut before, wanted), wanted];
            let stretch = |from: &_, to: &_, length| stretch(from, to, length, speeds);
            *knot = Knot {
                moved_s,
                ..laying.stretched_knot(s, stretch)?
            };
        }
        Ok(())
    }

    /// Refuses knots between which the path is not known.
    fn check_resolved<R: Real>(
        &self,
        limits: &Reciprocals<P::Axes, R>,
        knots: &[Knot<P::Axes>],
    ) -> Result<(), PlanError<P::Error>> {
        let mut from = Knot::start(self.start);
        let gap = if knots.len() > knots_of(MIN_BETWEEN_SLOW_ENDS) {
            LARGEST_GAP
        } else {
            LARGEST_GAP_AT_RESTS
        };
        for to in knots.iter().skip(1) {
            if !is_resolved(limits, &from, to, gap) {
                let (leg, s) = (self.leg.number, from.s);
                return Err(PlanError::TooCoarse { leg, s });
            }
            from = *to;
        }
        Ok(())
    }

    /// Plans the leg for itself.
    fn alone<R: Real>(&self, limits: &Reciprocals<P::Axes, R>, knots: &mut [Knot<P::Axes>]) {
        let before = knots.first().copied();
        let cap_of = |rests| if rests { 0.0 } else { f64::INFINITY };
        let [start, end] = self.rests.map(cap_of);
        if let Some(first) = knots.first_mut() {
            *first = Knot {
                cap: start,
                ..Knot::start(self.start)
            };
        }
        if let Some(last) = knots.last_mut() {
            last.cap = end;
        }
        passes::fastest(limits, knots);
        if let (Some(first), Some(before)) = (knots.first_mut(), before) {
            *first = Knot {
                speed: first.speed,
                ..before
            };
        }
    }
}

/// Lays the knots of all paths, one behind the other; those that they take. `lay` lays those of a
/// leg behind its first, which is the first of those that it is given, and says how many segments
/// they are.
pub(crate) fn lay_all<'k, P: Path + Clone>(
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
            rests: [before.0.is_stop(), junction.is_stop()],
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
        let is_single = to.ends_leg && to.ds > 0.0 && from.next_start() <= 0.0;
        if is_single {
            let own_s = segment_s - passes::rest_to_rest_s(limits, [from, to], to.tool.as_ref());
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

/// The most by which legs of one segment may take longer than with stops at their ends, as a part
/// of the whole time.
const MOST_LOST: f64 = 2.0;

/// The number of knots of a leg with this number of segments.
pub(crate) fn knots_of(segments: u32) -> usize {
    usize::try_from(segments).map_or(usize::MAX, |segments| segments.saturating_add(1))
}

/// Refuses a leg that begins elsewhere than the one before ends.
pub(crate) fn check_gap<A: Axes, E>(leg: usize, end: &A, start: &A) -> Result<(), PlanError<E>> {
    let axes = start.as_slice().iter().zip(end.as_slice());
    let mut apart = axes.map(|(start, end)| start - end).enumerate();
    apart
        .find(|(_, by)| *by != 0.0)
        .map_or(Ok(()), |(axis, by)| Err(PlanError::Gap { leg, axis, by }))
}
