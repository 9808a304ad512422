//! Changes of the feed with limited jerk.
//!
//! Goal: from one feed to another, or to rest, along speeds that keep all limits at a constant
//! feed. Method: three phases of constant jerk at the limits that the axes have where they begin;
//! what brakes already goes on as it began. Else shapes of a change over 1, 2, 3, 5, 8 .. segments,
//! each tried on the cubics that would run; the shortest that keeps all limits is taken. Where none
//! is found, or one that begins a few rows later ends sooner, it is tried again a row later.

mod at_limits;
mod braking;
mod change;
mod course;
mod phases;
mod ramped;
mod root;

pub(crate) use course::{At, Course};

use crate::Axes;
use crate::jerk::{Most, Walk};
use crate::passes::time_of;
use change::{Change, Kind};
use phases::{Ends, KAPPAS, Phases, TAIL, Way};
use ramped::FeedChange;

/// The feed, and the change that goes on where it is not yet the wanted one. One that has ended
/// stays for a segment more, which was tried with it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SmoothFeed {
    feed: f64,
    change: Option<Change>,
}

/// What became of a trial.
enum Trial {
    Holds(Change),
    /// A limit is passed.
    Fails,
    /// The table comes to rest before; the number of segments up to there.
    TooLong(usize),
}

/// Rows after which a change is looked for, too.
const LATER: [usize; 6] = [1, 2, 3, 5, 8, 13];

/// The speeds that are known for that: those before and after the last segment of the latest.
const AHEAD: usize = 15;

/// Segments of a stop beyond which another one is looked for.
const LONG: usize = 2 * AHEAD;

/// Halvings of a feed that nothing moves at.
const HALVINGS: u32 = 64;

impl SmoothFeed {
    /// At 100 %.
    pub(crate) const FULL: Self = Self {
        feed: 1.0,
        change: None,
    };

    /// Whether the speeds ahead may be planned anew: no change was tried on them.
    pub(crate) const fn is_constant(&self) -> bool {
        self.change.is_none()
    }

    /// The speed at the next knot, towards a wanted feed; none where the machine stays at rest.
    pub(crate) fn next_speed<A: Axes>(
        &mut self,
        course: &Course<'_, A>,
        at: At,
        wanted: f64,
    ) -> Option<f64> {
        self.change = self.change.filter(|change| change.left > 0);
        let next = at.index.saturating_add(1);
        if at.speed <= 0.0 {
            self.feed = 0.0;
            if course.leads_to_rest(at) && wanted > 0.0 {
                self.change = None;
                return Some(0.0);
            }
            // Where the course rests, too, every feed is as good.
            if course.planned(at.index) <= 0.0 {
                (self.feed, self.change) = (wanted, None);
            }
        }
        self.turn_to(course, at, wanted);
        let planned = course.planned(next);
        let Some(going) = &mut self.change else {
            // At a feed of 0 nothing but the next stop is ahead.
            let is_ahead = self.feed > 0.0 || planned <= 0.0;
            return is_ahead.then_some(self.feed * planned);
        };
        let ds = course.knots.get(next).map_or(0.0, |knot| knot.ds);
        let speed = going.step(ds, course.segment_s(next), planned);
        if going.left == 0 {
            self.feed = going.to;
        } else if planned > 0.0 {
            self.feed = speed / planned;
        }
        Some(speed)
    }

    /// Whether the machine may rest at the next knot, with no change of the feed going on.
    pub(crate) fn may_rest<A: Axes>(&self, course: &Course<'_, A>, at: At) -> bool {
        let trial = || course.trial(at, [self.feed, 0.0], 1);
        self.is_constant() && matches!(trial(), Trial::Holds(_))
    }

    /// Begins a change to another feed where there is one.
    fn turn_to<A: Axes>(&mut self, course: &Course<'_, A>, at: At, wanted: f64) {
        let to = self.change.map_or(self.feed, |change| change.to);
        if (to - wanted).abs() <= 0.0 {
            let is_long = |change: &Change| change.to <= 0.0 && change.left > LONG;
            if let Some(long) = self.change.filter(is_long) {
                self.change = Some(course.sooner(at, long));
            }
            return;
        }
        self.change = self.change_for(course, at, wanted).or(self.change);
    }

    /// The change to another feed that begins here. Beside the rows, which most of the time have
    /// none to look for: in line, each took 96 instructions more on a Cortex-M4F.
    #[cold]
    #[inline(never)]
    fn change_for<A: Axes>(&self, course: &Course<'_, A>, at: At, wanted: f64) -> Option<Change> {
        let feed = self.feed;
        if feed <= 0.0 {
            return course.resume(at, wanted);
        }
        let ahead = course.ahead(at, feed, self.change);
        if wanted < feed {
            let going = self.change.as_ref().and_then(Change::braking);
            course.brake_soonest(at, &ahead, going, [feed, wanted])
        } else {
            course.speed_up(at, &ahead, [feed, wanted])
        }
    }
}

impl<A: Axes> Course<'_, A> {
    /// The shortest change found, by a shape of the feed or by phases of any length, that keeps all
    /// limits and can be followed by a constant feed: over 1, 2, 3, 5, 8 .. segments, then fewer by
    /// halves.
    fn by_shape(&self, at: At, from: f64, to: f64) -> Option<Change> {
        let (mut too_few, mut segments) = (0_usize, 1_usize);
        let mut found = loop {
            match self.trial(at, [from, to], segments) {
                Trial::Holds(change) => break change,
                Trial::Fails => {
                    too_few = segments;
                    segments = segments.saturating_add(segments.div_ceil(2));
                }
                Trial::TooLong(_) => return None,
            }
        };
        while segments.saturating_sub(too_few) > 1 {
            let middle = too_few.midpoint(segments);
            if let Trial::Holds(change) = self.trial(at, [from, to], middle) {
                (found, segments) = (change, middle);
            } else {
                too_few = middle;
            }
        }
        Some(found)
    }

    /// The speeds at the knot before, here and at those after it while nothing else is asked for.
    fn ahead(&self, at: At, feed: f64, mut change: Option<Change>) -> [f64; AHEAD] {
        let mut next = at.index;
        let mut speed = || {
            next = next.saturating_add(1);
            let planned = self.planned(next);
            match &mut change {
                Some(going) if going.left > 0 => {
                    let ds = self.knots.get(next).map_or(0.0, |knot| knot.ds);
                    going.step(ds, self.segment_s(next), planned)
                }
                Some(going) => going.to * planned,
                None => feed * planned,
            }
        };
        core::array::from_fn(|number| match number {
            0 => at.before,
            1 => at.speed,
            _ => speed(),
        })
    }

    /// The change to a higher feed that begins here: by phases, or by a shape of the feed if that
    /// takes less time.
    fn speed_up(&self, at: At, ahead: &[f64; AHEAD], [from, to]: [f64; 2]) -> Option<Change> {
        let shape = self.by_shape(at, from, to);
        let from_there = |at| Some((at, self.by_phases(at, to, Way::Faster)?));
        let phases = from_there(at).or_else(|| later(at, ahead).find_map(from_there));
        let Some((begun, phases)) = phases else {
            return shape;
        };
        let sooner = shape.filter(|shape| {
            let end = at.end_of(shape).max(begun.end_of(&phases));
            let time_s = |begun, change| self.time_s(at, ahead, (begun, change), end);
            time_s(at, *shape) <= time_s(begun, phases)
        });
        sooner.or_else(|| (begun.index == at.index).then_some(phases))
    }

    /// The time from here to a knot with a change that begins here, or a few rows later.
    fn time_s(
        &self,
        at: At,
        ahead: &[f64; AHEAD],
        (begun, mut change): (At, Change),
        end: usize,
    ) -> f64 {
        let knots = self.knots.iter().enumerate().take(end.saturating_add(1));
        let (mut speed, mut time_s) = (at.speed, 0.0);
        for (index, knot) in knots.skip(at.index.saturating_add(1)) {
            let planned = self.planned(index);
            let next = if index <= begun.index {
                let row = index.saturating_sub(at.index).saturating_add(1);
                ahead.get(row).map_or(0.0, |speed| *speed)
            } else if change.left > 0 {
                change.step(knot.ds, self.segment_s(index), planned)
            } else {
                change.to * planned
            };
            time_s += time_of(knot.ds, [speed, next]);
            speed = next;
        }
        time_s
    }

    /// The change that ends where the course rests itself.
    fn with_its_rest(&self, at: At, [from, to]: [f64; 2]) -> Option<Change> {
        let Trial::TooLong(available) = self.trial(at, [from, to], usize::MAX) else {
            return None;
        };
        match self.trial(at, [from, to], available) {
            Trial::Holds(change) => Some(change),
            _ => None,
        }
    }

    /// The change from rest, where there must be one: where the path is too short for the feed, the
    /// one that ends with it, of the highest feed of halves of it.
    fn resume(&self, at: At, to: f64) -> Option<Change> {
        let mut feed = to;
        for _ in 0..HALVINGS {
            if let Some(change) = self.speed_up(at, &[0.0; AHEAD], [0.0, feed]) {
                return Some(change);
            }
            if let Some(change) = self.with_its_rest(at, [0.0, feed]) {
                return Some(change);
            }
            feed *= 0.5;
        }
        None
    }

    fn trial(&self, at: At, [from, to]: [f64; 2], segments: usize) -> Trial {
        let (mut table_s, mut length, mut last) = (0.0, 0.0, 0.0);
        let (mut index, mut count) = (at.index, 0_usize);
        while count < segments {
            let next = index.saturating_add(1);
            let rests = count > 0 && self.planned(index) <= 0.0;
            let Some(knot) = self.knots.get(next).filter(|_| !rests) else {
                return Trial::TooLong(count);
            };
            table_s += self.segment_s(next);
            (length, last) = (length + knot.ds, knot.ds);
            index = next;
            count = count.saturating_add(usize::from(knot.ds > 0.0));
        }
        let ends = Ends {
            start: self.state(at),
            end: self.planned_state(index, to),
            way: Way::Slower,
        };
        let tail = if to > 0.0 { 0.0 } else { TAIL };
        // No feed ends where the course rests.
        let is_braking = to < from && (to <= 0.0 || self.planned(index) > 0.0);
        let kappas = KAPPAS.iter().filter(|_| is_braking);
        let phases = kappas.filter_map(|kappa| {
            Phases::new(&ends, length - last * tail, *kappa, None).map(Kind::Slower)
        });
        let changes = FeedChange::over(table_s, [from, to]).map(Kind::Feed);
        let changes = phases.chain(changes).map(|kind| Change {
            kind,
            to,
            left: segments,
        });
        let found = changes.into_iter().find(|change| self.holds(at, *change));
        found.map_or(Trial::Fails, Trial::Holds)
    }

    /// Whether the cubics of a change, and the first after it, keep all limits.
    fn holds(&self, at: At, mut change: Change) -> bool {
        let is_jump = self.knots.get(at.index).is_some_and(|knot| knot.ds <= 0.0);
        let from = |index, speed| Walk::new(index, speed).with_tool_times(self.tool_times());
        let mut walk = if at.speed > 0.0 && !is_jump {
            // From the segment before, whose acceleration it goes on from.
            let mut walk = from(at.index.saturating_sub(1), at.before);
            walk.advance(self.limits, self.knots, at.speed);
            walk
        } else {
            from(at.index, at.speed)
        };
        let mut most = Most::default();
        loop {
            let is_after = change.left == 0;
            let Some(next) = walk.next_knot(self.knots) else {
                return true;
            };
            let index = next.saturating_sub(1);
            let planned = self.planned(next);
            let ds = self.knots.get(next).map_or(0.0, |knot| knot.ds);
            let speed = if is_after {
                change.to * planned
            } else {
                change.step(ds, self.segment_s(next), planned)
            };
            let Some(segment) = walk.advance(self.limits, self.knots, speed) else {
                return true;
            };
            segment.visit(&mut most);
            // Written so that NaN does not hold.
            let holds = most.stretch <= 1.0;
            let crawls = || self.crawls_to(next, self.planned(index));
            if !holds || at.speed > 0.0 && speed <= 0.0 && change.to > 0.0 && crawls() {
                return false;
            }
            if is_after || speed <= 0.0 {
                return true;
            }
        }
    }
}

/// A few rows later, with the speeds that are known for them.
fn later(at: At, ahead: &[f64; AHEAD]) -> impl Iterator<Item = At> {
    let later = LATER.iter().map_while(move |rows| {
        let &[before, speed] = ahead.get(*rows..)?.first_chunk()?;
        let index = at.index.saturating_add(*rows);
        Some(At {
            index,
            speed,
            before,
        })
    });
    later.take_while(|later| later.speed > 0.0)
}
