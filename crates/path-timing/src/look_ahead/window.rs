//! The knots in the window: how fast each may be passed, and the speed at the next.

use crate::joint::Joint;
use crate::number::LARGEST;
use crate::reciprocals::Reciprocals;
use crate::segment::Segment;
use crate::{Axes, PathPoint, ToolLimits};

/// Memory for one knot of a [`LookAhead`](super::LookAhead).
#[derive(Debug, Clone, Copy)]
pub struct Slot<A: Axes> {
    point: PathPoint<A>,
    /// Slopes of the segment after, where they are others.
    jump: Option<A>,
    /// Of the segment before.
    ds: f64,
    /// Of the segment before.
    tool: Option<ToolLimits>,
    /// The highest speed at a corner.
    corner: f64,
    /// The highest speed from which the machine can stop within the window, at the highest feed.
    ceiling: f64,
    /// The speed at the next knot that goes with it, as a ratio.
    after: f64,
    /// The same at the feed that is wanted.
    wanted: f64,
}

impl<A: Axes> Default for Slot<A> {
    fn default() -> Self {
        Self {
            point: PathPoint {
                position: A::zeros(),
                slope: A::zeros(),
            },
            jump: None,
            ds: 0.0,
            tool: None,
            corner: f64::INFINITY,
            ceiling: 0.0,
            after: 0.0,
            wanted: 0.0,
        }
    }
}

impl<A: Axes> Slot<A> {
    /// Positions and slopes at the start of the segment after.
    fn departure(&self) -> PathPoint<A> {
        let position = self.point.position;
        self.jump
            .map_or(self.point, |slope| PathPoint { position, slope })
    }

    /// The segment from here to the next knot, with the tool's feed multiplied.
    fn segment_to(&self, next: &Self, limits: &Reciprocals<A>, feed: f64) -> Segment<A> {
        let tool = next.tool.map(|tool| ToolLimits {
            feed: tool.feed * feed,
            ..tool
        });
        Segment::new(limits, &self.departure(), &next.point, next.ds)
            .with_tool(tool.as_ref(), next.ds)
    }
}

/// Feeds, 1 for 100 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Feed {
    pub(super) max: f64,
    /// 0 holds.
    pub(super) wanted: f64,
}

impl Feed {
    /// Whether speeds for the wanted feed are others than those for the highest.
    fn is_lower(&self) -> bool {
        self.wanted > 0.0 && self.wanted < self.max
    }
}

/// What the next row is made of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step<A: Axes> {
    pub(super) point: PathPoint<A>,
    pub(super) jump: Option<A>,
    pub(super) speed: f64,
    pub(super) duration_s: f64,
}

/// Slots in their order, the knot handed out last first.
pub(super) struct Window<'w, A: Axes> {
    slots: &'w mut [Slot<A>],
    first: usize,
    end: usize,
    /// Knots at the end that have not been looked through.
    new: usize,
    /// What the wanted speeds were computed for.
    feed: Option<Feed>,
}

impl<'w, A: Axes> Window<'w, A> {
    pub(super) const fn new(slots: &'w mut [Slot<A>]) -> Self {
        Self {
            slots,
            first: 0,
            end: 0,
            new: 0,
            feed: None,
        }
    }

    fn knots(&self) -> &[Slot<A>] {
        self.slots.get(self.first..self.end).unwrap_or_default()
    }

    pub(super) fn first(&self) -> Option<&PathPoint<A>> {
        self.knots().first().map(|slot| &slot.point)
    }

    pub(super) fn last(&self) -> Option<&PathPoint<A>> {
        self.knots().last().map(|slot| &slot.point)
    }

    /// Where at most half of the slots hold knots: moves these to the beginning.
    pub(super) fn make_room(&mut self) -> bool {
        let count = self.knots().len();
        if count > self.slots.len().midpoint(1) {
            return false;
        }
        let moved = if self.first > 0 { count } else { 0 };
        for index in 0..moved {
            let slot = self.slots.get(self.first.saturating_add(index)).copied();
            if let (Some(slot), Some(to)) = (slot, self.slots.get_mut(index)) {
                *to = slot;
            }
        }
        (self.first, self.end) = (0, count);
        true
    }

    pub(super) const fn has_room(&self) -> bool {
        self.end < self.slots.len()
    }

    /// Appends a knot, `ds` after the last one.
    pub(super) fn push(&mut self, ds: f64, tool: Option<ToolLimits>, point: PathPoint<A>) {
        if let Some(slot) = self.slots.get_mut(self.end) {
            *slot = Slot {
                point,
                ds,
                tool,
                ..Slot::default()
            };
            self.end = self.end.saturating_add(1);
            self.new = self.new.saturating_add(1);
        }
    }

    /// Makes the last knot, the end of a path, the joint to the next one.
    pub(super) fn join(&mut self, joint: &Joint<A>, start: &A) {
        let last = self.end.saturating_sub(1);
        let Some(slot) = self.slots.get_mut(last) else {
            return;
        };
        slot.corner = joint.speed();
        match joint {
            Joint::Stop | Joint::Jump(_) => slot.jump = Some(*start),
            Joint::Smooth(slope) => slot.point.slope = *slope,
        }
    }

    /// From the last knot, at rest: the highest speed at each from which the rest of the window can
    /// be run, until knots are met for which nothing has changed.
    ///
    /// A speed that was allowed before stays so, since no later knot has become slower.
    pub(super) fn look_back(&mut self, limits: &Reciprocals<A>, feed: Feed) {
        let is_same_feed = self.feed == Some(feed);
        if self.new == 0 && is_same_feed {
            return;
        }
        let slower = limits.at_feed(feed.wanted.min(1.0));
        let limits = limits.at_feed(feed.max.min(1.0));
        let knots = self.slots.get_mut(self.first..self.end).unwrap_or_default();
        let mut earlier = knots.iter_mut().enumerate().rev();
        let Some((mut index, mut next)) = earlier.next() else {
            return;
        };
        let first_new = index.saturating_add(1).saturating_sub(self.new);
        for (number, slot) in earlier {
            let segment = slot.segment_to(next, &limits, feed.max);
            let before = (slot.ceiling, slot.after, slot.wanted);
            let (speed, after) = segment.begin(next.ceiling, LARGEST);
            let ceiling = speed.min(slot.corner);
            if ceiling >= slot.ceiling {
                (slot.ceiling, slot.after) = (ceiling, after / speed);
            } else {
                let known = slot.ceiling * slot.after;
                slot.after = segment.end(slot.ceiling, next.ceiling, known) / slot.ceiling;
            }
            slot.wanted = slot.ceiling;
            if feed.is_lower() {
                let segment = slot.segment_to(next, &slower, feed.wanted);
                let (speed, _) = segment.begin(next.wanted, LARGEST);
                slot.wanted = speed.min(slot.ceiling);
            }
            let is_same = (slot.ceiling, slot.after, slot.wanted) == before;
            (index, next) = (number, slot);
            if is_same && is_same_feed && index < first_new {
                break;
            }
        }
        (self.new, self.feed) = (0, Some(feed));
    }

    /// The knot after the first and the speed there, coming from the first at `speed`; none where the
    /// machine stays at rest.
    pub(super) fn step(
        &mut self,
        limits: &Reciprocals<A>,
        feed: Feed,
        speed: f64,
    ) -> Option<Step<A>> {
        let limits = &limits.at_feed(feed.max.min(1.0));
        let [from, to, later @ ..] = self.knots() else {
            return None;
        };
        let next = if feed.wanted > 0.0 {
            speed_toward(limits, feed, [from, to], speed)
        } else {
            speed_of_hold(limits, feed, [from, to], later.first(), speed)
        };
        let both = speed + next;
        let duration_s = if both > 0.0 {
            2.0 * to.ds / both
        } else if feed.wanted > 0.0 {
            let (start, end) = (&from.point.position, &to.point.position);
            limits.rest_to_rest_s(start, end, to.tool.as_ref(), to.ds) / feed.wanted.min(1.0)
        } else {
            return None;
        };
        let step = Step {
            point: to.point,
            jump: to.jump.filter(|_| to.corner > 0.0),
            speed: next,
            duration_s,
        };
        self.first = self.first.saturating_add(1);
        Some(step)
    }
}

/// The speed at the next knot that is nearest to the wanted one.
fn speed_toward<A: Axes>(
    limits: &Reciprocals<A>,
    feed: Feed,
    [from, to]: [&Slot<A>; 2],
    speed: f64,
) -> f64 {
    let segment = from.segment_to(to, limits, feed.max);
    // What holds for the highest speed here holds slower at the same ratio.
    let known = speed * from.after;
    if speed <= 0.0 || to.wanted >= to.ceiling {
        return segment.end(speed, to.wanted, known);
    }
    segment.toward(speed, to.wanted, known)
}

/// The speed at the next knot towards a rest there or at the one after it.
fn speed_of_hold<A: Axes>(
    limits: &Reciprocals<A>,
    feed: Feed,
    [from, to]: [&Slot<A>; 2],
    later: Option<&Slot<A>>,
    speed: f64,
) -> f64 {
    if speed <= 0.0 {
        return 0.0;
    }
    let segment = from.segment_to(to, limits, feed.max);
    let nearest = segment.toward(speed, 0.0, speed * from.after);
    let Some(later) = later.filter(|_| nearest > 0.0) else {
        return nearest;
    };
    // Braking as hard as it can before, it would crawl to the knot after it.
    let after = to.segment_to(later, limits, feed.max);
    let (rest, _) = after.begin(0.0, speed.min(to.ceiling));
    segment.toward(speed, rest.max(nearest), nearest)
}
