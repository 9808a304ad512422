//! Changes of the feed with limited jerk.
//!
//! Goal: from one feed to another, or to rest, along speeds that keep all limits at a constant feed.
//! Method: a stop by three phases of constant jerk at the limits that the axes have where it begins; else
//! shapes of a change over 1, 2, 3, 5, 8 .. segments, each tried on the cubics that would run; the shortest
//! that keeps all limits is taken. Where none is found, it is tried again a row later.

mod stop;

use crate::jerk::{Most, Walk};
use crate::passes::segment_s;
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot};
use stop::{KAPPAS, State, Stop, TAIL};

/// Knots that are passed at a feed times their speeds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Course<'a, A: Axes> {
    pub(crate) knots: &'a [Knot<A>],
    pub(crate) limits: &'a Reciprocals<A>,
    /// By what all times are multiplied.
    pub(crate) stretch: f64,
}

/// Where the machine is on a course.
#[derive(Debug, Clone, Copy)]
pub(crate) struct At {
    /// The knot.
    pub(crate) index: usize,
    pub(crate) speed: f64,
    /// At the knot before.
    pub(crate) before: f64,
}

/// The feed, and the change that goes on where it is not yet the wanted one. One that has ended stays for
/// a segment more, which was tried with it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SmoothFeed {
    feed: f64,
    change: Option<Change>,
}

/// A change of the feed over some segments, with ramps of its rate at both ends.
///
/// ```text
/// f = f₀ + (f₁ - f₀) g(x)        x = t / T
/// g' rises over 0..α, is constant, and falls over 1-β..1;  ∫ g' = 1
/// ```
///
/// The integral of f is the table's own time. A stop ends, and a start begins, without a step of the
/// acceleration.
#[derive(Debug, Clone, Copy)]
struct FeedChange {
    from: f64,
    to: f64,
    ramps: [f64; 2],
    /// T.
    duration_s: f64,
    /// Time of the table since it began.
    table_s: f64,
}

/// Ramps as fractions of a change: short ones where the acceleration limits it, long ones where the
/// jerk does, one end slower where the table leaves little of either.
const RAMPS: [[f64; 2]; 10] = [
    [0.08, 0.08],
    [0.15, 0.15],
    [0.25, 0.25],
    [0.35, 0.35],
    [0.5, 0.5],
    [0.5, 0.15],
    [0.15, 0.5],
    [0.8, 0.2],
    [0.2, 0.8],
    [0.65, 0.35],
];

/// Halvings that find x to its last digit.
const ROUNDS: u32 = 60;

/// g and its integral from 0.
fn shape([rise, fall]: [f64; 2], x: f64) -> [f64; 2] {
    let rate = 1.0 / (1.0 - 0.5 * (rise + fall));
    if x < rise {
        let g = rate * x * x * 0.5 / rise;
        return [g, g * x / 3.0];
    }
    let (g_rise, sum_rise) = (rate * rise * 0.5, rate * rise * rise / 6.0);
    if x <= 1.0 - fall {
        let on = x - rise;
        return [
            g_rise + rate * on,
            sum_rise + (g_rise + rate * on * 0.5) * on,
        ];
    }
    // From the end: 1 - g is a ramp as well, and the integral of g over 0..1 is known.
    let rest = 1.0 - x;
    let missing = rate * rest * rest * 0.5 / fall;
    let on = 1.0 - fall - rise;
    let middle = sum_rise + (g_rise + rate * on * 0.5) * on;
    let whole = middle + fall - rate * fall * fall / 6.0;
    [1.0 - missing, whole - (rest - missing * rest / 3.0)]
}

impl FeedChange {
    /// The feed, and its integral from 0 by x.
    fn values(&self, x: f64) -> [f64; 2] {
        let [g, integral] = shape(self.ramps, x);
        let change = self.to - self.from;
        [self.from + change * g, self.from * x + change * integral]
    }

    /// The feed at the next knot, over a segment that takes `table_s` at a feed of 1.
    fn step(&mut self, table_s: f64) -> f64 {
        self.table_s += table_s;
        let wanted = self.table_s / self.duration_s;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..ROUNDS {
            let x = (low + high) * 0.5;
            let [_, reached] = self.values(x);
            if reached < wanted {
                low = x;
            } else {
                high = x;
            }
        }
        let [feed, _] = self.values(high);
        feed
    }
}

/// How the machine goes from one speed to another.
#[derive(Debug, Clone, Copy)]
struct Change {
    kind: Kind,
    /// The feed that it ends with.
    to: f64,
    /// Segments to go.
    left: usize,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Feed(FeedChange),
    Stop(Stop),
}

impl Change {
    /// The speed at the next knot, over a segment that takes `table_s` to the speed `planned` at a feed
    /// of 1.
    fn step(&mut self, ds: f64, table_s: f64, planned: f64) -> f64 {
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            return self.to * planned;
        }
        match &mut self.kind {
            Kind::Feed(change) => change.step(table_s) * planned,
            Kind::Stop(stop) => stop.step(ds),
        }
    }
}

/// What became of a trial.
enum Trial {
    Holds(Change),
    /// A limit is passed.
    Fails,
    /// The table comes to rest before; the number of segments up to there.
    TooLong(usize),
}

/// Rows after which a stop is looked for, too.
const LATER: [usize; 6] = [1, 2, 3, 5, 8, 13];

/// The parts of the axes' limits that a stop is tried with. The first that keeps them is the quickest; of
/// all lengths few do where the machine gains speed, for it has a limit, too.
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
        let feed = self.feed;
        let to = self.change.map_or(feed, |change| change.to);
        if (to - wanted).abs() <= 0.0 {
            return;
        }
        let found = if feed <= 0.0 {
            course.resume(at, wanted)
        } else if wanted <= 0.0 && self.change.is_none() {
            course.stop_soonest(at, feed)
        } else {
            course.change_to(at, feed, wanted)
        };
        self.change = found.or(self.change);
    }
}

impl<A: Axes> Course<'_, A> {
    /// The speed at a knot at a feed of 1.
    fn planned(&self, index: usize) -> f64 {
        let knot = self.knots.get(index);
        knot.map_or(0.0, |knot| knot.speed / self.stretch)
    }

    /// Time of the table from the knot before.
    fn segment_s(&self, index: usize) -> f64 {
        let before = index.checked_sub(1);
        let ends = (
            before.and_then(|before| self.knots.get(before)),
            self.knots.get(index),
        );
        match ends {
            (Some(from), Some(to)) => segment_s(from, to) * self.stretch,
            _ => 0.0,
        }
    }

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

    /// The stop that begins here, unless one that begins a few rows later rests sooner: where the table
    /// uses all of the jerk, a change has to wait.
    fn stop_soonest(&self, at: At, feed: f64) -> Option<Change> {
        let found = self.shortest_stop(at, feed);
        let end = found.map_or(usize::MAX, |change| at.index.saturating_add(change.left));
        for rows in LATER {
            let index = at.index.saturating_add(rows);
            let speeds = [index, index.saturating_sub(1)].map(|index| feed * self.planned(index));
            let [speed, before] = speeds;
            if index >= end || speed <= 0.0 {
                break;
            }
            let later = At {
                index,
                speed,
                before,
            };
            let later = self.shortest_stop(later, feed);
            if later.is_some_and(|later| index.saturating_add(later.left) < end) {
                return None;
            }
        }
        found
    }

    /// A stop at the limits that the axes have here, or else the shortest found by its length.
    fn shortest_stop(&self, at: At, feed: f64) -> Option<Change> {
        self.stop_at_limits(at)
            .or_else(|| self.change_to(at, feed, 0.0))
    }

    /// The stop that uses most of the limits that the axes have where it begins.
    fn stop_at_limits(&self, at: At) -> Option<Change> {
        let slope = self.knots.get(at.index)?.point.slope;
        let axes = self.limits.axes().iter().zip(slope.as_slice());
        let inverse = axes.fold([0.0_f64; 2], |[acceleration, jerk], (limits, slope)| {
            let slope = slope.abs();
            [
                acceleration.max(slope * limits.acceleration),
                jerk.max(slope * limits.jerk),
            ]
        });
        let start = self.state(at);
        OF_LIMITS.iter().find_map(|part| {
            let [kappa, length] = Stop::quickest(start, inverse.map(|inverse| part / inverse));
            let (segments, lengths) = self.up_to(at, length)?;
            let change = Change {
                kind: Kind::Stop(Stop::new(start, lengths, kappa)?),
                to: 0.0,
                left: segments,
            };
            self.holds(at, change).then_some(change)
        })
    }

    /// The segments up to the first knot by which a stop has taken a length, the length up to there and that
    /// of the last.
    fn up_to(&self, at: At, wanted: f64) -> Option<(usize, [f64; 2])> {
        let (mut segments, mut length) = (0_usize, 0.0);
        for knot in self.knots.iter().skip(at.index.saturating_add(1)) {
            segments = segments.saturating_add(usize::from(knot.ds > 0.0));
            length += knot.ds;
            if length - knot.ds * TAIL >= wanted {
                return Some((segments, [length, knot.ds]));
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
        let start = self.state(at);
        let stops = KAPPAS.iter().filter(|_| to <= 0.0);
        let stops =
            stops.filter_map(|kappa| Stop::new(start, [length, last], *kappa).map(Kind::Stop));
        let changes = RAMPS.iter().map(|ramps| {
            let mut change = FeedChange {
                from,
                to,
                ramps: *ramps,
                duration_s: 1.0,
                table_s: 0.0,
            };
            let [_, mean] = change.values(1.0);
            change.duration_s = table_s / mean;
            Kind::Feed(change)
        });
        let changes = stops.chain(changes).map(|kind| Change {
            kind,
            to,
            left: segments,
        });
        let found = changes.into_iter().find(|change| self.holds(at, *change));
        found.map_or(Trial::Fails, Trial::Holds)
    }

    /// Speed and acceleration along the path.
    fn state(&self, at: At) -> State {
        let ds = self.knots.get(at.index).map_or(0.0, |knot| knot.ds);
        let squares = at.speed * at.speed - at.before * at.before;
        State {
            speed: at.speed,
            acceleration: if ds > 0.0 { squares / (2.0 * ds) } else { 0.0 },
        }
    }

    /// Whether the cubics of a change, and the first after it, keep all limits.
    fn holds(&self, at: At, mut change: Change) -> bool {
        let is_jump = self.knots.get(at.index).is_some_and(|knot| knot.ds <= 0.0);
        let mut walk = if at.speed > 0.0 && !is_jump {
            // From the segment before, whose acceleration it goes on from.
            let mut walk = Walk::new(at.index.saturating_sub(1), at.before).without_tool();
            walk.advance(self.limits, self.knots, at.speed);
            walk
        } else {
            Walk::new(at.index, at.speed).without_tool()
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
