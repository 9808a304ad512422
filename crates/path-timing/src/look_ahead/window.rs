//! The knots in the window: how fast each may be passed, and the speed at the next.

use crate::feed_change::{At, Course, SmoothFeed};
use crate::knot::ToolTimes;
use crate::number::LARGEST;
use crate::passes::{rest_to_rest_s, time_of};
use crate::reciprocals::Reciprocals;
use crate::stepping::{Ahead, Pair, Pairs, leads_to_rest, may_rest};
use crate::{Axes, Knot, PlanError, jerk};

/// Smallest window: a knot between two at rest, and one behind a jump.
const MIN_KNOTS: usize = 4;

/// Feeds, 1 for 100 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Feed {
    pub(crate) max: f64,
    /// 0 holds.
    pub(crate) wanted: f64,
}

impl Feed {
    /// Whether speeds for the wanted feed are others than those for the highest.
    fn is_lower(&self) -> bool {
        self.wanted > 0.0 && self.wanted < self.max
    }
}

/// What the next row is made of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step<A: Axes> {
    pub(crate) knot: Knot<A>,
    pub(crate) speed: f64,
    pub(crate) duration_s: f64,
    /// Whether the knot before was the last of its path.
    pub(crate) begins_leg: bool,
}

/// Knots in their order, the one handed out last first.
pub(crate) struct Window<'w, A: Axes> {
    knots: &'w mut [Knot<A>],
    first: usize,
    end: usize,
    /// Knots at the end that have not been looked through.
    new: usize,
    /// What the wanted speeds were computed for.
    feed: Option<Feed>,
    /// With a limit of jerk: whether what follows was to come.
    is_open: bool,
}

impl<'w, A: Axes> Window<'w, A> {
    /// An empty one in this memory.
    pub(crate) fn checked<E>(knots: &'w mut [Knot<A>]) -> Result<Self, PlanError<E>> {
        if knots.len() < MIN_KNOTS {
            return Err(PlanError::Memory {
                needed: MIN_KNOTS,
                available: knots.len(),
            });
        }
        Ok(Self {
            knots,
            first: 0,
            end: 0,
            new: 0,
            feed: None,
            is_open: false,
        })
    }

    fn knots(&self) -> &[Knot<A>] {
        self.knots.get(self.first..self.end).unwrap_or_default()
    }

    pub(crate) fn first(&self) -> Option<&Knot<A>> {
        self.knots().first()
    }

    /// Whether there is a knot after the first.
    pub(crate) fn goes_on(&self) -> bool {
        self.knots().len() > 1
    }

    pub(crate) fn last_mut(&mut self) -> Option<&mut Knot<A>> {
        let knots = self.knots.get_mut(self.first..self.end);
        knots.and_then(|knots| knots.last_mut())
    }

    /// Where at most half of the memory holds knots: moves these to the beginning. With a limit of
    /// jerk the one before the first is kept.
    pub(crate) fn make_room(&mut self, has_jerk: bool) -> bool {
        let kept = self.first.saturating_sub(usize::from(has_jerk));
        let count = self.end.saturating_sub(kept);
        if count > self.knots.len().midpoint(1) {
            return false;
        }
        if kept > 0 {
            for index in 0..count {
                let knot = self.knots.get(kept.saturating_add(index)).copied();
                if let (Some(knot), Some(to)) = (knot, self.knots.get_mut(index)) {
                    *to = knot;
                }
            }
        }
        (self.first, self.end) = (self.first.saturating_sub(kept), count);
        true
    }

    /// Whether there is room for a knot and one behind a jump.
    pub(crate) const fn has_room(&self) -> bool {
        self.end.saturating_add(1) < self.knots.len()
    }

    /// Appends a knot.
    pub(crate) fn push(&mut self, knot: Knot<A>) {
        if let Some(slot) = self.knots.get_mut(self.end) {
            *slot = knot;
            self.end = self.end.saturating_add(1);
            self.new = self.new.saturating_add(1);
        }
    }

    /// From the last knot, at rest: the highest speed at each from which the rest of the window can
    /// be run, until knots are met for which nothing has changed.
    ///
    /// A speed that was allowed before stays so, since no later knot has become slower.
    pub(crate) fn look_back(&mut self, pairs: &impl Pairs<A>, limits: &Reciprocals<A>, feed: Feed) {
        let is_same_feed = self.feed == Some(feed);
        if self.new == 0 && is_same_feed {
            return;
        }
        let slower = limits.at_feed(feed.wanted.min(1.0));
        let limits = limits.at_feed(feed.max.min(1.0));
        let knots = self.knots.get_mut(self.first..self.end).unwrap_or_default();
        let mut earlier = knots.iter_mut().enumerate().rev();
        let Some((mut index, mut next)) = earlier.next() else {
            return;
        };
        let first_new = index.saturating_add(1).saturating_sub(self.new);
        for (number, knot) in earlier {
            let before = (knot.speed, knot.ratio, knot.wanted);
            raise(knot, next, pairs, &limits, feed.max);
            knot.wanted = knot.speed;
            if feed.is_lower() {
                knot.wanted = if next.ds > 0.0 {
                    let times = ToolTimes::of_feed(feed.wanted);
                    let segment = pairs.of(&slower, [knot, next], times);
                    segment.begin(next.wanted, LARGEST).0.min(knot.speed)
                } else {
                    next.wanted.min(knot.speed)
                };
            }
            let is_same = (knot.speed, knot.ratio, knot.wanted) == before;
            (index, next) = (number, knot);
            if is_same && is_same_feed && index < first_new {
                break;
            }
        }
        (self.new, self.feed) = (0, Some(feed));
    }

    /// With a limit of jerk: where the machine has been held at the first knot, all are to be planned
    /// anew from a rest there; unless it is to rest at the next one, too.
    pub(crate) fn rest(&mut self, limits: &Reciprocals<A>) {
        let knots = self.knots.get_mut(self.first..self.end).unwrap_or_default();
        if let [first, next, ..] = knots
            && first.speed > 0.0
            && !leads_to_rest(limits, [first, next], || ToolTimes::ONE)
        {
            first.speed = 0.0;
            self.new = knots.len().saturating_sub(1);
        }
    }

    /// With a limit of jerk: plans the new knots, and those before them that change. Where there is
    /// room nothing follows for now.
    pub(crate) fn look_through(&mut self, limits: &Reciprocals<A>) {
        let has_ended = self.has_room();
        if self.new == 0 && !(self.is_open && has_ended) {
            return;
        }
        let begin = self.first.saturating_sub(1);
        let half = self.knots.len().midpoint(1);
        let knots = self.knots.get_mut(begin..self.end).unwrap_or_default();
        // One more, since the window is filled a row before.
        let handed = knots.len().saturating_sub(half).saturating_add(1);
        let extension = jerk::Extension {
            from: self.first.saturating_sub(begin),
            old: knots.len().saturating_sub(self.new).saturating_sub(1),
            handed: (!has_ended).then_some(handed),
        };
        jerk::extend(limits, knots, extension);
        (self.new, self.is_open) = (0, !has_ended);
    }

    /// With a limit of jerk: the same as [`step`](Self::step), towards a wanted feed of at most 1.
    pub(crate) fn step_smoothly(
        &self,
        limits: &Reciprocals<A>,
        feed: &mut SmoothFeed,
        wanted: f64,
        [before, speed]: [f64; 2],
    ) -> Option<Step<A>> {
        if speed <= 0.0 && wanted <= 0.0 {
            return None;
        }
        let [from, to, ..] = self.knots() else {
            return None;
        };
        let begin = self.first.saturating_sub(1);
        let course = Course {
            knots: self.knots.get(begin..self.end).unwrap_or_default(),
            limits,
            stretch: 1.0,
            max_feed: 1.0,
        };
        let at = At {
            index: self.first.saturating_sub(begin),
            speed,
            before,
        };
        let from_rest_s =
            |from: &Knot<A>, to: &Knot<A>| rest_to_rest_s(limits, [from, to], &to.tool) / wanted;
        let next = if to.ds > 0.0 {
            let next = feed.next_speed(&course, at, wanted)?;
            let crawls = wanted > 0.0 && self.crawls([speed, next], from_rest_s);
            if crawls && feed.may_rest(&course, at) {
                0.0
            } else {
                next
            }
        } else {
            speed
        };
        let duration_s = if to.ds <= 0.0 || speed + next > 0.0 {
            time_of(to.ds, [speed, next])
        } else {
            from_rest_s(from, to)
        };
        self.to_next(next, duration_s)
    }

    /// The knot after the first and the speed there, coming from the first at `speed`; none where
    /// the machine stays at rest.
    pub(crate) fn step<Q: Pairs<A>>(
        &self,
        pairs: &Q,
        limits: &Reciprocals<A>,
        feed: Feed,
        speed: f64,
    ) -> Option<Step<A>> {
        let limits = &limits.at_feed(feed.max.min(1.0));
        let [from, to, later @ ..] = self.knots() else {
            return None;
        };
        let times = ToolTimes::of_feed(feed.max);
        let rest_to_rest_s = |from: &Knot<A>, to: &Knot<A>| {
            pairs.rest_to_rest_s(limits, [from, to], &to.tool.times(times)) / feed.wanted.min(1.0)
        };
        let next = if to.ds > 0.0 {
            let segment = pairs.of(limits, [from, to], times);
            let after = later.first().filter(|after| after.ds > 0.0);
            let later = || after.map(|after| pairs.of(limits, [to, after], times));
            let ahead = Ahead {
                segment: &segment,
                later,
                ceiling: to.speed,
                ratio: from.ratio,
                lengths: [to.ds, after.map_or(0.0, |after| after.ds)],
                may_rest: may_rest([from, to]),
            };
            if feed.wanted > 0.0 {
                let next = ahead.toward(speed, to.wanted);
                let crawls = self.crawls([speed, next], rest_to_rest_s);
                if crawls && segment.holds(speed, 0.0) {
                    0.0
                } else {
                    next
                }
            } else {
                ahead.hold(speed)
            }
        } else {
            speed
        };
        let duration_s = if to.ds <= 0.0 || speed + next > 0.0 {
            time_of(to.ds, [speed, next])
        } else if feed.wanted > 0.0 {
            rest_to_rest_s(from, to)
        } else {
            return None;
        };
        self.to_next(next, duration_s)
    }

    /// Whether the machine takes longer through the next knot to a rest at the one after it than
    /// with a rest at both.
    fn crawls(
        &self,
        [speed, next]: [f64; 2],
        rest_to_rest_s: impl Fn(&Knot<A>, &Knot<A>) -> f64,
    ) -> bool {
        let [_, to, end, ..] = self.knots() else {
            return false;
        };
        // From rest to rest departures are bounded at the end of a path alone.
        if next <= 0.0 || end.ds <= 0.0 || end.speed > 0.0 || !end.ends_leg {
            return false;
        }
        let through_s = time_of(to.ds, [speed, next]) + time_of(end.ds, [next, 0.0]);
        through_s > time_of(to.ds, [speed, 0.0]) + rest_to_rest_s(to, end)
    }

    /// What is made of the knot after the first.
    fn to_next(&self, speed: f64, duration_s: f64) -> Option<Step<A>> {
        let [from, to, ..] = self.knots() else {
            return None;
        };
        Some(Step {
            knot: *to,
            speed,
            duration_s,
            begins_leg: from.ends_leg,
        })
    }

    /// The knot after the first is handed out.
    pub(crate) const fn advance(&mut self) {
        self.first = self.first.saturating_add(1);
    }
}

/// Gives a knot the highest speed from which the rest can be run, if that is higher than before.
fn raise<A: Axes>(
    knot: &mut Knot<A>,
    next: &Knot<A>,
    pairs: &impl Pairs<A>,
    limits: &Reciprocals<A>,
    feed: f64,
) {
    if next.ds <= 0.0 {
        (knot.speed, knot.ratio) = (next.speed.min(knot.cap), 1.0);
        return;
    }
    let segment = pairs.of(limits, [knot, next], ToolTimes::of_feed(feed));
    let (start, end) = segment.begin(next.speed, knot.cap);
    if start >= knot.speed {
        (knot.speed, knot.ratio) = (start, if start > 0.0 { end / start } else { 0.0 });
    } else {
        knot.ratio = segment.end(knot.speed, next.speed, knot.ratio) / knot.speed;
    }
}
