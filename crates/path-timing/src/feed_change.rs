//! Changes of the feed with limited jerk.
//!
//! Goal: from one feed to another, or to rest, along speeds that keep all limits at a constant
//! feed. Method: a lower feed and a stop by three phases of constant jerk at the limits that the
//! axes have where they begin; what brakes already goes on as it began. Else, and to a higher feed,
//! shapes of a change over 1, 2, 3, 5, 8 .. segments, each tried on the cubics that would run; the
//! shortest that keeps all limits is taken. Where none is found, or one that begins a few rows later
//! ends sooner, it is tried again a row later.

mod braking;
mod change;
mod course;
mod ramped;

pub(crate) use course::{At, Course};

use crate::Axes;
use crate::jerk::{Most, Walk};
use braking::{Braking, GAINING, KAPPAS, State, TAIL, TAILS, TAILS_OF_STOPS};
use change::{Change, Kind};
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

/// Rows after which a lower feed or a stop is looked for, too.
const LATER: [usize; 6] = [1, 2, 3, 5, 8, 13];

/// The speeds that are known for that: those before and after the last segment of the latest.
const AHEAD: usize = 15;

/// The parts of the axes' limits that braking is tried with. The first that keeps them is the
/// quickest; of all lengths few do where the machine gains speed, for it has a limit, too.
const OF_LIMITS: [f64; 8] = [1.0, 0.995, 0.99, 0.98, 0.96, 0.93, 0.9, 0.85];

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
        self.turn_to(course, at, wanted);
        let next = at.index.saturating_add(1);
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

    /// Begins a change to another feed where there is one.
    fn turn_to<A: Axes>(&mut self, course: &Course<'_, A>, at: At, wanted: f64) {
        if at.speed <= 0.0 {
            self.feed = 0.0;
            // Where the course rests, too, every feed is as good.
            if course.planned(at.index) <= 0.0 {
                (self.feed, self.change) = (wanted, None);
            }
        }
        let to = self.change.map_or(self.feed, |change| change.to);
        if (to - wanted).abs() <= 0.0 {
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
            course.resume(at, wanted)
        } else if wanted < feed {
            let ahead = course.ahead(at, feed, self.change);
            let going = self.change.as_ref().and_then(Change::braking);
            course.brake_soonest(at, &ahead, going, [feed, wanted])
        } else {
            course.change_to(at, feed, wanted)
        }
    }
}

impl<A: Axes> Course<'_, A> {
    /// The shortest change found to another feed that keeps all limits and can be followed by a
    /// constant feed: over 1, 2, 3, 5, 8 .. segments, then fewer by halves.
    fn change_to(&self, at: At, from: f64, to: f64) -> Option<Change> {
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

    /// The lower feed or the stop that begins here, unless one that begins a few rows later ends
    /// sooner: where the table uses all of the jerk, a change has to wait.
    fn brake_soonest(
        &self,
        at: At,
        ahead: &[f64; AHEAD],
        going: Option<&Braking>,
        [from, to]: [f64; 2],
    ) -> Option<Change> {
        // What brakes already goes on as it began. One found by its length takes long to find, and
        // longer to run.
        going
            .and_then(|going| self.brake_at_limits(at, &[going.begun()], to))
            .map(Some)
            .or_else(|| unless_later(at, ahead, |at| self.brake_from(at, to)))
            .or_else(|| unless_later(at, ahead, |at| self.change_to(at, from, to)))
            .flatten()
    }

    /// The change to a lower feed, or to rest, that begins here.
    fn brake_from(&self, at: At, to: f64) -> Option<Change> {
        // What the segment before has in its middle, and what the table has at the knot.
        let starts = [self.state(at), self.state_between(at)];
        self.brake_at_limits(at, &starts.map(|start| (start, 0.0)), to)
    }

    /// The same that began at one of these, so far ago, and uses most of the limits that the axes
    /// have here.
    fn brake_at_limits(&self, at: At, starts: &[(State, f64)], to: f64) -> Option<Change> {
        let slope = self.knots.get(at.index)?.point.slope;
        let ahead = self.knots.get(at.index.saturating_add(1))?;
        let axes = self.limits.axes().iter().zip(slope.as_slice());
        let tool = ahead.tool.times(self.tool_times());
        let of_tool = [1.0 / tool.acceleration, 0.0];
        let inverse = axes.fold(of_tool, |[acceleration, jerk], (limits, slope)| {
            let slope = slope.abs();
            [
                acceleration.max(slope * limits.acceleration),
                jerk.max(slope * limits.jerk),
            ]
        });
        let tails = if to > 0.0 {
            &TAILS[..]
        } else {
            &TAILS_OF_STOPS
        };
        OF_LIMITS.iter().find_map(|part| {
            let limits @ [_, jerk] = inverse.map(|inverse| part / inverse);
            // What gains its highest speed first needs all of the jerk for that.
            let shapes = [None, Some(jerk)].into_iter().flat_map(|first| {
                (starts.iter())
                    .flat_map(move |start| tails.iter().map(move |tail| (first, *start, *tail)))
            });
            shapes
                .filter_map(|(first, start, tail)| {
                    self.braking(at, start, [to, tail], limits, first)
                })
                .find(|change| self.holds(at, *change))
        })
    }

    /// What ends at the first knot by which braking within a deceleration and a jerk has come to a
    /// feed, from where it began so far ago.
    fn braking(
        &self,
        at: At,
        (start, reached): (State, f64),
        [to, tail]: [f64; 2],
        limits @ [_, jerk]: [f64; 2],
        first: Option<f64>,
    ) -> Option<Change> {
        let to_rest = Braking::quickest([start, State::REST], limits);
        let (mut left, mut length) = (0_usize, reached);
        let ahead = self.knots.iter().enumerate();
        for (index, knot) in ahead.skip(at.index.saturating_add(1)) {
            left = left.saturating_add(usize::from(knot.ds > 0.0));
            length += knot.ds;
            let end = self.planned_state(index, to);
            let [kappa, wanted] = match (end.speed > 0.0, to > 0.0) {
                (true, _) => Braking::quickest([start, end], limits),
                (false, false) => to_rest,
                // The course rests, for as long as it is not known how it goes on: no feed ends
                // there.
                (false, true) => break,
            };
            let taken = length - knot.ds * tail;
            let shape = if taken >= wanted {
                Some(kappa)
            } else {
                let is_gaining = taken <= Braking::gaining([start, end], jerk);
                is_gaining.then_some(GAINING)
            };
            if let Some(kappa) = shape {
                let braking = Braking::new([start, end], taken, kappa, first)?;
                let kind = Kind::Braking(braking.having_reached(reached));
                return Some(Change { kind, to, left });
            }
            // There the course rests itself.
            if knot.speed <= 0.0 {
                break;
            }
        }
        None
    }

    /// The same from rest, where there must be one: where the path is too short for the feed, the
    /// one that ends with it, of the highest feed of halves of it.
    fn resume(&self, at: At, to: f64) -> Option<Change> {
        let mut feed = to;
        for _ in 0..HALVINGS {
            if let Some(change) = self.change_to(at, 0.0, feed) {
                return Some(change);
            }
            if let Trial::TooLong(available) = self.trial(at, [0.0, feed], usize::MAX)
                && let Trial::Holds(change) = self.trial(at, [0.0, feed], available)
            {
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
        let states = [self.state(at), self.planned_state(index, to)];
        let tail = if to > 0.0 { 0.0 } else { TAIL };
        // No feed ends where the course rests.
        let is_braking = to < from && (to <= 0.0 || self.planned(index) > 0.0);
        let kappas = KAPPAS.iter().filter(|_| is_braking);
        let braking = kappas.filter_map(|kappa| {
            Braking::new(states, length - last * tail, *kappa, None).map(Kind::Braking)
        });
        let changes = FeedChange::over(table_s, [from, to]).map(Kind::Feed);
        let changes = braking.chain(changes).map(|kind| Change {
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
            if !holds {
                return false;
            }
            if is_after || speed <= 0.0 {
                return true;
            }
        }
    }
}

/// What is found at a knot; `Some(None)` where what is found a few rows later ends sooner.
fn unless_later(
    at: At,
    ahead: &[f64; AHEAD],
    find: impl Fn(At) -> Option<Change>,
) -> Option<Option<Change>> {
    let end_of = |at: At, found: Change| at.index.saturating_add(found.left);
    let found = find(at);
    let end = found.map_or(usize::MAX, |found| end_of(at, found));
    for rows in LATER {
        let index = at.index.saturating_add(rows);
        let speeds = ahead.get(rows..).and_then(|speeds| speeds.first_chunk());
        let Some(&[before, speed]) = speeds.filter(|[_, speed]| *speed > 0.0 && index < end) else {
            break;
        };
        let later = At {
            index,
            speed,
            before,
        };
        if find(later).is_some_and(|found| end_of(later, found) < end) {
            return Some(None);
        }
    }
    found.map(Some)
}
