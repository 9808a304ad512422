//! A table that is played back under a feed override and can stop on its path.

mod ceiling;

use core::convert::Infallible;

use trig_kernels::SixDigits;

use crate::feed_change::{At, Course, SmoothFeed};
use crate::knot::ToolTimes;
use crate::number::{LARGEST, SMALLEST, range};
use crate::passes::{rest_to_rest_s, time_of};
use crate::reciprocals::Reciprocals;
use crate::segment::Segment;
use crate::stepping::{Ahead, may_rest};
use crate::{Axes, Knot, PlanError, Row, Table};
pub use ceiling::FeedCeiling;

/// A feed that the override cannot take.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("feed {} is neither 0 nor within {}..={}", SixDigits(*.feed), SixDigits(*.min), SixDigits(*.max))]
#[expect(clippy::exhaustive_structs, reason = "there is one cause")]
pub struct FeedError {
    /// The feed asked for, 1 for 100 %.
    pub feed: f64,
    /// The lowest feed above 0.
    pub min: f64,
    /// The highest feed that this playback was made for.
    pub max: f64,
}

impl FeedError {
    /// A feed that is 0 or up to a highest.
    pub(crate) fn checked(feed: f64, max: f64) -> Result<f64, Self> {
        let min = SMALLEST;
        if feed == 0.0 || (feed >= min && feed <= max) {
            return Ok(feed);
        }
        Err(Self { feed, min, max })
    }
}

/// A [`Table`] that is handed out row by row, at a feed that may change from row to row.
///
/// At a feed f the machine passes each knot at f times the speed of the table, so that it stays on
/// its path. From one row to the next the feed goes as far towards the wanted one as the speeds and
/// accelerations of all axes allow, checked on the cubic that the controller will run; above 1 it
/// goes only as far as what lies ahead can be run with. A stop is a wanted feed of zero: the
/// machine comes to rest at a row of the table, at most one segment later than it could between
/// rows.
///
/// ```text
/// v = f w      segment time = 2Δs / (v₀ + v₁)
/// ```
///
/// The tool's feed along a path is what is overridden: above 1 it goes beyond that of the path, its
/// acceleration to the square of the highest feed times what it may be, and only the axes limit
/// both. Up to 1 the tool's own limits are kept, through all changes. Where the departure was
/// planned at any feed ([`Table::plan_within_at_any_feed`]), it is kept through all changes.
///
/// With a limit of jerk a change is smooth and takes as many rows as it needs: the fewest found
/// whose cubics keep speed, acceleration and jerk of all axes, and that leave a constant feed
/// possible; where none does before the next stop of the table, it is tried again a row later.
/// Above 1 the feed goes up to what the axes allow from end to end.
#[derive(Debug, Clone)]
pub struct Playback<'a, A: Axes> {
    pub(super) knots: &'a [Knot<A>],
    stretch: f64,
    limits: Reciprocals<A>,
    mode: Mode<'a>,
    max: f64,
    wanted: f64,
    /// The knot handed out last, and the speed there; none before the first.
    at: Option<At>,
    time_s: f64,
    leg: usize,
}

/// What the feed may be, without a limit of jerk and with one.
#[derive(Debug, Clone)]
enum Mode<'a> {
    /// At each knot up to a ceiling.
    Direct(&'a [FeedCeiling], ToolTimes),
    /// The same for all knots, up to `max`.
    Smooth { max: f64, feed: SmoothFeed },
}

impl<'a, A: Axes> Table<'a, A> {
    /// The table at a feed of 1, to be changed up to `max`, 1.5 for 150 %. Needs memory for each
    /// row of the table; none with a limit of jerk.
    ///
    /// # Errors
    /// [`PlanError::Feed`] for a `max` that is beyond the range of the crate, [`PlanError::Memory`]
    /// for too little memory.
    pub fn playback(
        &self,
        max: f64,
        ceilings: &'a mut [FeedCeiling],
    ) -> Result<Playback<'a, A>, PlanError<Infallible>> {
        if !range().contains(&max) {
            return Err(PlanError::Feed {
                feed: max,
                min: SMALLEST,
                max: LARGEST,
            });
        }
        let mode = if self.limits.has_jerk() {
            Mode::Smooth {
                max: self.full_feed(max),
                feed: SmoothFeed::FULL,
            }
        } else {
            let (needed, available) = (self.len(), ceilings.len());
            let ceilings = ceilings
                .get_mut(..needed)
                .ok_or(PlanError::Memory { needed, available })?;
            self.find_ceilings(max, ceilings);
            Mode::Direct(ceilings, self.tool_times(max))
        };
        Ok(Playback {
            knots: self.knots,
            stretch: self.stretch,
            limits: self.limits,
            mode,
            max,
            wanted: max.min(1.0),
            at: None,
            time_s: 0.0,
            leg: 0,
        })
    }
}

impl<A: Axes> Playback<'_, A> {
    /// Wants a feed, 1 for 100 %; 0 stops.
    ///
    /// # Errors
    /// [`FeedError`]; the wanted feed stays.
    pub fn set_feed(&mut self, feed: f64) -> Result<(), FeedError> {
        self.wanted = FeedError::checked(feed, self.max)?;
        Ok(())
    }

    /// Stops as soon as the limits allow, at a row: where the machine is slow, it may gain speed for
    /// a rest that is sooner. [`set_feed`](Self::set_feed) goes on.
    pub const fn stop(&mut self) {
        self.wanted = 0.0;
    }

    /// Whether the machine rests at the row handed out last.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.at.is_none_or(|at| at.speed <= 0.0)
    }

    /// Rows of the table that have not been handed out.
    #[must_use]
    pub fn remaining(&self) -> usize {
        let handed = self.at.map_or(0, |at| at.index.saturating_add(1));
        self.knots.len().saturating_sub(handed)
    }

    /// Whether the last row of the table has been handed out.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.remaining() == 0
    }

    /// The speed of the table at a knot.
    fn planned(&self, index: usize) -> f64 {
        let knot = self.knots.get(index);
        knot.map_or(0.0, |knot| knot.speed / self.stretch)
    }

    /// The next row; `None` at the end and where the machine rests at a feed of zero, until
    /// another is wanted.
    pub fn next_row(&mut self) -> Option<Row<A>> {
        let Some(at) = self.at else {
            let first = self.knots.first()?;
            self.at = Some(At {
                index: 0,
                speed: 0.0,
                before: 0.0,
            });
            return Some(first.row(0.0));
        };
        let next = at.index.saturating_add(1);
        let (from, to) = (self.knots.get(at.index)?, self.knots.get(next)?);
        let is_jump = to.ds <= 0.0;
        let speed = if is_jump {
            at.speed
        } else {
            self.next_speed(at, [from, to])?
        };
        let duration_s = if is_jump || at.speed + speed > 0.0 {
            time_of(to.ds, [at.speed, speed])
        } else {
            let times = ToolTimes::of_motion(self.max / self.stretch);
            rest_to_rest_s(&self.limits, [from, to], &to.tool.times(times)) / self.wanted.min(1.0)
        };
        self.time_s += duration_s;
        self.leg = self.leg.saturating_add(usize::from(from.ends_leg));
        self.at = Some(At {
            index: next,
            speed,
            before: if is_jump { at.before } else { at.speed },
        });
        Some(Row {
            time_s: self.time_s,
            duration_s,
            leg: self.leg,
            ..to.row(speed)
        })
    }

    /// The speed at the next knot; none where the machine stays at rest.
    fn next_speed(&mut self, at: At, knots: [&Knot<A>; 2]) -> Option<f64> {
        if at.speed <= 0.0 && self.wanted <= 0.0 {
            return None;
        }
        match self.mode {
            Mode::Direct(ceilings, times) => Some(self.next_direct(ceilings, times, at, knots)),
            Mode::Smooth { max, mut feed } => {
                let course = Course {
                    knots: self.knots,
                    limits: &self.limits,
                    stretch: self.stretch,
                    max_feed: self.max,
                };
                let speed = feed.next_speed(&course, at, self.wanted.min(max));
                self.mode = Mode::Smooth { max, feed };
                speed
            }
        }
    }

    fn next_direct(
        &self,
        ceilings: &[FeedCeiling],
        times: ToolTimes,
        at: At,
        [from, to]: [&Knot<A>; 2],
    ) -> f64 {
        let next = at.index.saturating_add(1);
        let [here, there] = [at.index, next].map(|index| ceilings.get(index).copied());
        let segment = Segment::new(&self.limits, from, to, times);
        let after = self.knots.get(next.saturating_add(1));
        let after = after.filter(|after| after.ds > 0.0);
        let later = || after.map(|after| Segment::new(&self.limits, to, after, times));
        let ahead = Ahead {
            segment: &segment,
            later,
            ceiling: there.unwrap_or_default().speed,
            ratio: here.unwrap_or_default().ratio,
            lengths: [to.ds, after.map_or(0.0, |after| after.ds)],
            may_rest: may_rest([from, to]),
        };
        if self.wanted > 0.0 {
            ahead.toward(at.speed, self.wanted * self.planned(next))
        } else {
            ahead.hold(at.speed)
        }
    }
}

impl<A: Axes> Iterator for Playback<'_, A> {
    type Item = Row<A>;

    fn next(&mut self) -> Option<Row<A>> {
        self.next_row()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        // A stop hands out fewer for now.
        (0, Some(self.remaining()))
    }
}
