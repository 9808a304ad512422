//! A PVT table that runs under a feed override and can stop on its path.

use core::cell::Cell;

use nalgebra::RealField;

use crate::course::Place;
use crate::number::{largest, two};
use crate::pvt::segment::{Reciprocals, Segment};
use crate::{PlanError, PvtPoint, PvtTable};

/// Memory for one point of a table that runs: what the points ahead still allow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead<T = f64> {
    /// The highest feed at this point from which the rest can be run.
    ceiling: T,
    /// The feed at the next point that goes with it, as a share.
    after: T,
}

impl<T: RealField> Default for Ahead<T> {
    fn default() -> Self {
        Self {
            ceiling: T::zero(),
            after: T::zero(),
        }
    }
}

/// A share that the feed override cannot take.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("feed {feed} is not within 0..={max}")]
#[expect(clippy::exhaustive_structs, reason = "there is one cause")]
pub struct FeedError<T = f64> {
    /// The feed asked for, 1 for 100 %.
    pub feed: T,
    /// The highest feed that this run was made for.
    pub max: T,
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
/// A limit of jerk is kept at a constant feed of at most 1; a change of the feed looks at speed
/// and acceleration alone. It also changes the speed within a segment and with it the strain:
/// [`hermite_strain`](crate::hermite_strain) of two points handed out bounds it.
#[derive(Debug, Clone)]
pub struct PvtRun<'a, const N: usize, T: RealField = f64> {
    table: PvtTable<'a, N, T>,
    ahead: &'a [Ahead<T>],
    limits: Reciprocals<N, T>,
    max: T,
    wanted: T,
    /// Feed at the last point handed out.
    feed: T,
    /// The last point handed out, as in the table.
    last: Option<(usize, Place<N, T>)>,
    time_s: T,
}

impl<'a, const N: usize, T: RealField + Copy> PvtTable<'a, N, T> {
    /// The table at a feed of 1, to be changed up to `max`, 1.5 for 150 %. Needs memory for each
    /// point of the table.
    ///
    /// # Errors
    /// [`PlanError::Feed`] for a `max` that is not positive and finite,
    /// [`PlanError::TooManyPoints`] for too little memory.
    pub fn run(&self, max: T, ahead: &'a mut [Ahead<T>]) -> Result<PvtRun<'a, N, T>, PlanError<T>> {
        if !(max > T::zero() && max < largest()) {
            return Err(PlanError::Feed { max });
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
            wanted: T::one().min(max),
            feed: T::zero(),
            last: None,
            time_s: T::zero(),
        })
    }

    /// From the end: the highest feed at each point from which the rest can be run.
    fn look_ahead(&self, limits: &Reciprocals<N, T>, max: T, ahead: &mut [Ahead<T>]) {
        let full = T::one().min(max);
        let ahead = Cell::from_mut(ahead).as_slice_of_cells();
        if let Some(last) = ahead.last() {
            last.set(Ahead {
                ceiling: max,
                after: T::one(),
            });
        }
        let mut to = self.node(self.len().saturating_sub(1));
        for (number, pair) in ahead.windows(2).enumerate().rev() {
            let ([here, next], Some(from), Some((end, _))) = (pair, self.node(number), to) else {
                continue;
            };
            let segment = Segment::new(limits, &from.0, &end, from.1);
            let (ceiling, after) = segment.begin(next.get().ceiling, max);
            // The table itself holds.
            here.set(if ceiling > full {
                let after = after / ceiling;
                Ahead { ceiling, after }
            } else {
                Ahead {
                    ceiling: full,
                    after: T::one(),
                }
            });
            to = Some(from);
        }
    }
}

impl<const N: usize, T: RealField + Copy> PvtRun<'_, N, T> {
    /// Wants a feed, 1 for 100 %; 0 stops.
    ///
    /// # Errors
    /// [`FeedError`]; the wanted feed stays.
    pub fn set_feed(&mut self, feed: T) -> Result<(), FeedError<T>> {
        if feed >= T::zero() && feed <= self.max {
            self.wanted = feed;
            return Ok(());
        }
        Err(FeedError {
            feed,
            max: self.max,
        })
    }

    /// Stops as soon as the accelerations allow, on the path. [`set_feed`](Self::set_feed) goes on.
    pub fn stop(&mut self) {
        self.wanted = T::zero();
    }

    /// The feed at the last point handed out.
    #[must_use]
    pub const fn feed(&self) -> T {
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
    pub fn next_point(&mut self) -> Option<PvtPoint<N, T>> {
        let Some((number, from)) = self.last else {
            let (place, _) = self.table.node(0)?;
            self.last = Some((0, place));
            return Some(PvtPoint::new(&place, T::zero(), T::zero(), T::zero()));
        };
        let next = number.checked_add(1)?;
        let (here, there) = (self.ahead.get(number)?, self.ahead.get(next)?);
        if from.slope.iter().all(|slope| slope.amax() == T::zero()) {
            self.feed = self.wanted.min(here.ceiling);
        }
        let ((_, duration), (to, _)) = (self.table.node(number)?, self.table.node(next)?);
        let wanted = self.wanted.min(there.ceiling);
        // At a constant feed of at most 1 the table itself holds.
        let feed = if wanted == self.feed && wanted <= T::one() {
            wanted
        } else {
            let segment = Segment::new(&self.limits, &from, &to, duration);
            segment.toward(self.feed, wanted, self.feed * here.after)
        };
        let both = self.feed + feed;
        if both <= T::zero() {
            return None;
        }
        let segment_s = two::<T>() * duration / both;
        self.time_s += segment_s;
        self.feed = feed;
        self.last = Some((next, to));
        Some(PvtPoint::new(&to, feed, self.time_s, segment_s))
    }
}

impl<const N: usize, T: RealField + Copy> Iterator for PvtRun<'_, N, T> {
    type Item = PvtPoint<N, T>;

    fn next(&mut self) -> Option<PvtPoint<N, T>> {
        self.next_point()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        // A stop hands out fewer for now.
        (0, Some(self.remaining()))
    }
}
