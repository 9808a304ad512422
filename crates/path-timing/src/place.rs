//! Where the knots of a leg stand in a table, and laying them there.

use crate::knots::{
    LARGEST_GAP, LARGEST_GAP_AT_RESTS, Shares, fraction, is_resolved, note_unused, spread,
};
use crate::laying::{Laying, MAX_SEGMENTS, bounded, knots_of};
use crate::leg::Leg;
use crate::number::{Real, cube_root, sqrt};
use crate::passes;
use crate::reciprocals::Reciprocals;
use crate::stretch::stretch;
use crate::{Axes, Knot, Path, PathPoint, PlanError};

/// Fewest segments of a leg that starts and ends slowly.
pub(crate) const MIN_BETWEEN_SLOW_ENDS: u32 = 2;

/// How often segments are halved where the path between two knots is not known.
const MOST_HALVINGS: u32 = 6;

/// Shortest segment that one is halved to which the path refuses as too coarse, as a part of its
/// leg.
const SHORTEST: f64 = 1.0 / (1 << 20) as f64;

/// A leg whose knots are to be laid.
pub(crate) struct Place<'p, P: Path> {
    pub(crate) leg: &'p Leg<P>,
    pub(crate) start: PathPoint<P::Axes>,
    /// The highest speeds at its ends: 0 where the machine stops, none where it goes on smoothly.
    pub(crate) caps: [f64; 2],
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

/// What a segment is stretched by for the speeds that are wanted at its ends.
const fn stretched<A: Axes>(
    limits: &Reciprocals<A>,
) -> impl Fn([&PathPoint<A>; 2], f64, [f64; 2]) -> f64 {
    move |ends, length, speeds| stretch(limits, ends, length, speeds)
}

impl<P: Path> Place<'_, P> {
    /// Lays a number of segments, or twice as many, and so on, where the path is not known between
    /// two knots. How many they are.
    pub(crate) fn lay_resolved(
        &self,
        segments: u32,
        mut lay: impl FnMut(u32) -> Result<u32, PlanError<P::Error>>,
    ) -> Result<u32, PlanError<P::Error>> {
        let number = self.leg.number;
        let segments = bounded(number, segments, self.fewest)?;
        let coarse = match lay(segments) {
            Err(coarse @ PlanError::TooCoarse { .. }) => coarse,
            laid => return laid,
        };
        for halvings in 1..=MOST_HALVINGS {
            let finer = bounded(number, segments << halvings, 1)?;
            match lay(finer) {
                Err(PlanError::TooCoarse { .. }) => {}
                // How many would do, nobody knows.
                Err(PlanError::Memory { .. }) => break,
                laid => return laid,
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
    ///
    /// How many segments they are: those that the path refuses as too coarse are halved, which is
    /// where it touches the end of a range.
    pub(crate) fn lay(
        &self,
        limits: &Reciprocals<P::Axes>,
        segments: u32,
        bent: f64,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<u32, PlanError<P::Error>> {
        let has_tool = self.leg.tool().is_some();
        if limits.has_jerk() && !has_tool {
            return self.lay_by_time(limits, segments, bent, knots, stretched(limits));
        }
        if has_tool || segments < FEWEST_STRETCHED {
            return self.lay_plainly(limits, segments, bent, knots);
        }
        let own = self.room(segments, knots)?;
        if self.spread_by_plan(limits, bent, own).is_ok()
            && let Ok(laid) = self.lay_checked(limits, segments, knots, stretched(limits))
        {
            return Ok(laid);
        }
        // Knots that stand elsewhere may be too far apart, or their cubics leave what the path
        // allows.
        self.lay_plainly(limits, segments, bent, knots)
    }

    /// Finds where all knots are to stand by the speeds of a plan of fewer.
    fn spread_by_plan(
        &self,
        limits: &Reciprocals<P::Axes>,
        bent: f64,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<(), PlanError<P::Error>> {
        let (parts, planned) = (BY_LIMITS.bent(bent), self.lay_roughly(limits, knots)?);
        note_unused(limits, knots, planned);
        let lost = spread(parts, knots, planned);
        if lost > MOST_LOST_ON_ONE {
            let count = knots.len();
            for _ in 0..ROUNDS {
                self.lay_unchecked(knots, stretched(limits))?;
                self.alone(limits, knots);
                note_unused(limits, knots, count);
                spread(parts, knots, count);
            }
        }
        Ok(())
    }

    /// Lays the knots where the motion is slow, none stretched: for limits of torque, for tools, few
    /// segments, and plans in single precision, which are to be small.
    pub(crate) fn lay_plainly<R: Real>(
        &self,
        limits: &Reciprocals<P::Axes, R>,
        segments: u32,
        bent: f64,
        knots: &mut [Knot<P::Axes>],
    ) -> Result<u32, PlanError<P::Error>> {
        self.lay_by_time(limits, segments, bent, knots, |_, _, _| 1.0)
    }

    /// Lays the knots where the motion is slow, each segment stretched by a factor of the points at
    /// its ends, its length and the speeds of a plan that takes jerk into account by the mean of its
    /// ramps alone.
    fn lay_by_time<R: Real>(
        &self,
        limits: &Reciprocals<P::Axes, R>,
        segments: u32,
        bent: f64,
        knots: &mut [Knot<P::Axes>],
        stretch: impl Fn([&PathPoint<P::Axes>; 2], f64, [f64; 2]) -> f64,
    ) -> Result<u32, PlanError<P::Error>> {
        let own = self.room(segments, knots)?;
        let planned = self.lay_roughly(&limits.ramped(), own)?;
        spread(BY_TIME.bent(bent), own, planned);
        self.lay_checked(limits, segments, knots, stretch)
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
        let evenness = self.evenness(limits);
        for (index, knot) in (0..=few).zip(&mut *rough) {
            let u = f64::from(index) / f64::from(few);
            knot.moved_s = length * fraction(u, evenness);
        }
        self.lay_unchecked(rough, |_, _, _| 1.0)?;
        self.alone(limits, rough);
        Ok(rough.len())
    }

    /// How evenly knots stand at both ends: from 0, where the machine stops, to 1, where it is as
    /// fast as it gets. As dense as at a stop, those at a jump would be so near to each other that
    /// rounding takes the limits for itself.
    ///
    /// ```text
    /// the fastest from rest to rest: 1/v', √(L/a'), 2 ∛(L²/32j')
    /// ```
    fn evenness<R: Real>(&self, limits: &Reciprocals<P::Axes, R>) -> [f64; 2] {
        let [speed, acceleration, jerk] = self.leg.uses(limits, &self.start);
        let length = self.leg.length();
        let fastest = (1.0 / speed)
            .min(sqrt(length / acceleration))
            .min(2.0 * cube_root(length * length / (32.0 * jerk)));
        self.caps.map(|cap| (cap / fastest).min(1.0))
    }

    /// Lays knots where they are to stand, for a plan that nothing runs by.
    fn lay_unchecked(
        &self,
        knots: &mut [Knot<P::Axes>],
        stretch: impl Fn([&PathPoint<P::Axes>; 2], f64, [f64; 2]) -> f64,
    ) -> Result<(), PlanError<P::Error>> {
        let mut laying = Laying::new(self.leg.by_ref(), self.start);
        let (length, last) = (self.leg.length(), knots.len().saturating_sub(1));
        let mut before = knots.first().map_or(0.0, |first| first.wanted);
        for (index, knot) in knots.iter_mut().enumerate().skip(1) {
            let s = if index < last { knot.moved_s } else { length };
            let speeds = [core::mem::replace(&mut before, knot.wanted), knot.wanted];
            let stretch = |from: &_, to: &_, length| stretch([from, to], length, speeds);
            *knot = laying.unchecked_knot(s, stretch)?;
        }
        Ok(())
    }

    /// Lays the knots of some segments where they are to stand, each segment stretched by a factor
    /// of the points at its ends, its length and the speeds that are wanted there. Those that are too
    /// coarse for the path are halved. How many they are then.
    fn lay_checked<R: Real>(
        &self,
        limits: &Reciprocals<P::Axes, R>,
        segments: u32,
        knots: &mut [Knot<P::Axes>],
        stretch: impl Fn([&PathPoint<P::Axes>; 2], f64, [f64; 2]) -> f64,
    ) -> Result<u32, PlanError<P::Error>> {
        let mut laying = Laying::new(self.leg.by_ref(), self.start);
        let (length, least) = (self.leg.length(), knots_of(segments));
        let (mut count, mut index) = (least, 1);
        let mut before = knots.first().map_or(0.0, |first| first.wanted);
        while index < count {
            let (from, is_last) = (laying.last.s, index.saturating_add(1) == count);
            let Some(knot) = knots.get_mut(index) else {
                break;
            };
            let s = if is_last { length } else { knot.moved_s };
            let speeds = [before, knot.wanted];
            let stretch = |from: &_, to: &_, length| stretch([from, to], length, speeds);
            match laying.knot(s, stretch) {
                Ok(laid) => {
                    (*knot, index) = (laid, index.saturating_add(1));
                    [_, before] = speeds;
                }
                Err(PlanError::TooCoarse { .. }) if s - from > length * SHORTEST => {
                    let [before, wanted] = speeds;
                    let between = [(from + s) * 0.5, (before + wanted) * 0.5];
                    self.make_room(index, count, knots, between)?;
                    count = count.saturating_add(1);
                }
                Err(refused) => return Err(refused),
            }
        }
        let more = u32::try_from(count.saturating_sub(least)).unwrap_or(u32::MAX);
        let laid = segments.saturating_add(more);
        let gap = if laid > MIN_BETWEEN_SLOW_ENDS {
            LARGEST_GAP
        } else {
            LARGEST_GAP_AT_RESTS
        };
        self.check_known(laid, knots, |from, to| is_resolved(limits, from, to, gap))?;
        Ok(laid)
    }

    /// Moves knots by one from an index on, for one more at a place with its speed.
    fn make_room(
        &self,
        index: usize,
        count: usize,
        knots: &mut [Knot<P::Axes>],
        [moved_s, wanted]: [f64; 2],
    ) -> Result<(), PlanError<P::Error>> {
        let available = self.used.saturating_add(knots.len());
        let Some([first, later @ ..]) = knots.get_mut(index..=count) else {
            return Err(PlanError::Memory {
                // As many again may follow.
                needed: available.saturating_add(count.saturating_sub(index)),
                available,
            });
        };
        let mut moved = *first;
        for knot in later {
            core::mem::swap(knot, &mut moved);
        }
        (first.moved_s, first.wanted) = (moved_s, wanted);
        Ok(())
    }

    /// Refuses segments of the leg between whose knots something is not known.
    pub(crate) fn check_known(
        &self,
        segments: u32,
        knots: &[Knot<P::Axes>],
        is_known: impl Fn(&Knot<P::Axes>, &Knot<P::Axes>) -> bool,
    ) -> Result<(), PlanError<P::Error>> {
        let mut from = Knot::start(self.start);
        for to in knots.iter().take(knots_of(segments)).skip(1) {
            if !is_known(&from, to) {
                let (leg, s) = (self.leg.number, from.s);
                return Err(PlanError::TooCoarse { leg, s });
            }
            from = *to;
        }
        Ok(())
    }

    /// Plans the leg for itself, evenly from and to what goes on smoothly: what comes from elsewhere
    /// as fast as this leg alone can brake from, brakes there already.
    fn alone<R: Real>(&self, limits: &Reciprocals<P::Axes, R>, knots: &mut [Knot<P::Axes>]) {
        let before = knots.first().copied();
        let [start, end] = self.caps;
        if let Some(first) = knots.first_mut() {
            *first = Knot::start(self.start);
        }
        if let [first, second, ..] = knots {
            first.cap = start.min(passes::evenly(limits, [first, second]));
        }
        if let [.., earlier, last] = knots {
            last.cap = end.min(passes::evenly(limits, [earlier, last]));
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
