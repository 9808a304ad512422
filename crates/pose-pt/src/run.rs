//! A PVT table that runs under a feed override and can stop on its path.

use core::cell::Cell;

use crate::course::Place;
use crate::number::{largest, smallest};
use crate::pvt::segment::{Reciprocals, Segment};
use crate::short::short;
use crate::{PlanError, PvtPoint, PvtTable};

/// Memory for one point of a table that runs: what the points ahead still allow.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ahead {
    /// The highest feed at this point from which the rest can be run.
    ceiling: f64,
    /// The feed at the next point that goes with it, as a share.
    after: f64,
}

/// A share that the feed override cannot take.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("feed {} is neither 0 nor within {}..={}", short(.feed), short(.min), short(.max))]
#[expect(clippy::exhaustive_structs, reason = "there is one cause")]
pub struct FeedError {
    /// The feed asked for, 1 for 100 %.
    pub feed: f64,
    /// The lowest feed above 0.
    pub min: f64,
    /// The highest feed that this run was made for.
    pub max: f64,
}

/// A [`PvtTable`] on the way to the controller, at a feed that may change from point to point.
///
/// Each point is handed out with the time that the present feed makes of its segment, so that
/// the body stays on its path at any feed. From one point to the next the feed goes as far
/// towards the wanted one as the speeds and accelerations of all axes allow, checked on the
/// cubic that the controller will run; above 1 it goes only as far as what lies ahead can be
/// run with. A stop is a wanted feed of zero: the machine comes to rest at a point of the table,
/// at most one segment later than it could between points. Where it rests, the feed changes at
/// once.
///
/// ```text
/// segment time = 2 T / (f₀ + f₁)     velocity = f v
/// ```
///
/// Where the feed changes, the cubic between two points is not the table's and may turn back some
/// 4 % of its way later: at the ends of the strokes leave that room. More feed does not make a table
/// take longer than at 1; of 100,000 random tables none did.
///
/// A limit of jerk is kept at a constant feed of at most 1; a change of the feed looks at speed
/// and acceleration alone. It also changes the speed within a segment and with it the strain:
/// [`hermite_strain`](crate::hermite_strain) of two points handed out bounds it.
#[derive(Debug, Clone)]
pub struct PvtRun<'a, const N: usize> {
    table: PvtTable<'a, N>,
    ahead: &'a [Ahead],
    limits: Reciprocals<N>,
    max: f64,
    wanted: f64,
    /// Feed at the last point handed out.
    feed: f64,
    /// The last point handed out, as in the table.
    last: Option<(usize, Place<N, f64>)>,
    time_s: f64,
}

impl<'a, const N: usize> PvtTable<'a, N> {
    /// The table at a feed of 1, to be changed up to `max`, 1.5 for 150 %. Needs memory for each
    /// point of the table.
    ///
    /// # Errors
    /// [`PlanError::Feed`] for a `max` that is beyond the range of the crate,
    /// [`PlanError::TooManyPoints`] for too little memory.
    pub fn run(&self, max: f64, ahead: &'a mut [Ahead]) -> Result<PvtRun<'a, N>, PlanError> {
        let (lowest, highest) = (smallest(), largest());
        if !(max >= lowest && max <= highest) {
            return Err(PlanError::Feed {
                feed: max,
                min: lowest,
                max: highest,
            });
        }
        let (needed, available) = (self.len(), ahead.len());
        let ahead = ahead
            .get_mut(..needed)
            .ok_or(PlanError::TooManyPoints { needed, available })?;
        let limits = Reciprocals::new(self.platform().locators());
        self.look_ahead(&limits, max, ahead);
        Ok(PvtRun {
            table: *self,
            ahead,
            limits,
            max,
            wanted: max.min(1.0),
            feed: 0.0,
            last: None,
            time_s: 0.0,
        })
    }

    /// From the end: the highest feed at each point from which the rest can be run.
    fn look_ahead(&self, limits: &Reciprocals<N>, max: f64, ahead: &mut [Ahead]) {
        let full = max.min(1.0);
        let ahead = Cell::from_mut(ahead).as_slice_of_cells();
        if let Some(last) = ahead.last() {
            last.set(Ahead {
                ceiling: max,
                after: 1.0,
            });
        }
        let mut to = self.node(self.len().saturating_sub(1));
        for (number, pair) in ahead.windows(2).enumerate().rev() {
            let ([here, next], Some(from), Some((end, _))) = (pair, self.node(number), to) else {
                continue;
            };
            let segment = Segment::new(limits, &from.0, &end, from.1);
            let later = next.get().ceiling;
            let ceiling = if is_rest(&from.0) {
                // Any feed is as good, since it makes no speed.
                max
            } else if is_rest(&end) {
                segment.even().min(max)
            } else {
                segment.begin_evenly(later, max)
            };
            // The table itself holds.
            let ceiling = ceiling.max(full);
            let after = later.min(ceiling) / ceiling;
            here.set(Ahead { ceiling, after });
            to = Some(from);
        }
    }
}

fn is_rest<const N: usize>(place: &Place<N, f64>) -> bool {
    place.slope.iter().all(|slope| slope.amax() == 0.0)
}

impl<const N: usize> PvtRun<'_, N> {
    /// Wants a feed, 1 for 100 %; 0 stops.
    ///
    /// # Errors
    /// [`FeedError`]; the wanted feed stays.
    pub fn set_feed(&mut self, feed: f64) -> Result<(), FeedError> {
        let (min, max) = (smallest(), self.max);
        if feed == 0.0 || (feed >= min && feed <= max) {
            self.wanted = feed;
            return Ok(());
        }
        Err(FeedError { feed, min, max })
    }

    /// Stops as soon as the accelerations allow, on the path. [`set_feed`](Self::set_feed) goes on.
    pub fn stop(&mut self) {
        self.wanted = 0.0;
    }

    /// The feed at the last point handed out.
    #[must_use]
    pub const fn feed(&self) -> f64 {
        self.feed
    }

    /// Points of the table that have not been handed out.
    #[must_use]
    pub fn remaining(&self) -> usize {
        let behind = self
            .last
            .as_ref()
            .map_or(0, |(number, _)| number.saturating_add(1));
        self.table.len().saturating_sub(behind)
    }

    /// Whether the last point of the table has been handed out.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.remaining() == 0
    }

    /// The next point; `None` at the end and where the machine rests at a feed of zero, until
    /// another is wanted.
    pub fn next_point(&mut self) -> Option<PvtPoint<N>> {
        let Some((number, from)) = self.last else {
            let (place, _) = self.table.node(0)?;
            self.last = Some((0, place));
            return Some(PvtPoint::new(&place, 0.0, 0.0, 0.0));
        };
        let next = number.checked_add(1)?;
        let (here, there) = (self.ahead.get(number)?, self.ahead.get(next)?);
        let ((_, duration), (to, later)) = (self.table.node(number)?, self.table.node(next)?);
        let wanted = self.wanted.min(there.ceiling);
        let segment = Segment::new(&self.limits, &from, &to, duration);
        if is_rest(&from) {
            self.feed = wanted.min(segment.even().max(1.0));
        }
        // From rest and to rest at one feed, so that the cubic has the shape of the table's; at a
        // constant feed of at most 1 the table itself holds.
        #[expect(clippy::float_cmp, reason = "the same number")]
        let is_even = is_rest(&from)
            || (is_rest(&to) && self.feed > 0.0)
            || (wanted == self.feed && wanted <= 1.0);
        let feed = if is_even {
            self.feed
        } else {
            // A feed that both ends allow may stay.
            let known = if self.feed <= there.ceiling {
                self.feed
            } else {
                self.feed * here.after
            };
            let nearest = segment.toward(self.feed, wanted, known);
            if wanted == 0.0 && nearest > 0.0 {
                let highest = self.feed.min(there.ceiling);
                let rest = self.rest_after(next, &to, later, highest);
                segment.toward(self.feed, rest.max(nearest), nearest)
            } else {
                nearest
            }
        };
        let both = self.feed + feed;
        if both <= 0.0 {
            return None;
        }
        let segment_s = 2.0 * duration / both;
        self.time_s += segment_s;
        self.feed = feed;
        self.last = Some((next, to));
        Some(PvtPoint::new(&to, feed, self.time_s, segment_s))
    }

    /// The highest feed at a point from which the machine rests at the one after it, at most
    /// `highest`: braking as hard as it can before, it would crawl there.
    fn rest_after(&self, number: usize, here: &Place<N, f64>, duration: f64, highest: f64) -> f64 {
        let after = number
            .checked_add(1)
            .and_then(|after| self.table.node(after));
        after.map_or(0.0, |(there, _)| {
            let segment = Segment::new(&self.limits, here, &there, duration);
            if is_rest(&there) {
                return highest.min(segment.even().max(1.0));
            }
            let (feed, _) = segment.begin(0.0, highest);
            feed
        })
    }
}

impl<const N: usize> Iterator for PvtRun<'_, N> {
    type Item = PvtPoint<N>;

    fn next(&mut self) -> Option<PvtPoint<N>> {
        self.next_point()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        // A stop hands out fewer for now.
        (0, Some(self.remaining()))
    }
}
