//! A table that runs under a feed override and can stop on its path.

mod ahead;
mod warp;

use crate::demand::Demand;
use crate::number::{LARGEST, SMALLEST, range};
use crate::reciprocals::Reciprocals;
use crate::rows::{Node, Nodes};
use crate::segment::Segment;
use crate::short::short;
use crate::{Axes, Legs, PlanError, Row, Table};
pub use ahead::Ahead;
use ahead::is_rest;
use warp::{Start, Warp};

/// A feed that the override cannot take.
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

/// A [`Table`] that is handed out row by row, at a feed that may change from row to row.
///
/// Each row is handed out with the time that the present feed makes of its segment, so that the
/// machine stays on its path at any feed. From one row to the next the feed goes as far towards
/// the wanted one as the speeds and accelerations of all axes allow, checked on the cubic that the
/// controller will run; above 1 it goes only as far as what lies ahead can be run with. A stop is a
/// wanted feed of zero: the machine comes to rest at a row of the table, at most one segment later
/// than it could between rows. Where it rests, the feed changes at once.
///
/// ```text
/// segment time = 2 T / (f₀ + f₁)     velocity = f v
/// ```
///
/// Where the feed changes, the cubic between two rows is not the table's and may turn back some
/// 4 % of its length later: at the ends of the strokes leave that room. More feed does not make a table
/// take longer than at 1; of 100,000 random tables none did.
///
/// The tool's feed along a path is what is overridden: above 1 it goes beyond that of the path, and
/// only the axes limit it. A change of the feed also changes the speed within a segment and with it
/// the departure from the path.
///
/// With a limit of jerk a change is smooth and takes as many rows as it needs: of changes over 1, 2,
/// 3, 5, 8 .. segments the first whose cubics keep speed, acceleration and jerk of all axes, and that
/// leaves a constant feed possible; where none does before the next stop of the table, it is tried
/// again a row later. It is short where the table leaves room: [`Table::at_speed`] with 0.978 leaves
/// a sixteenth of the jerk. Above 1 the feed goes up to what the axes allow from end to end.
#[derive(Debug, Clone)]
pub struct Run<'a, L: Legs> {
    nodes: Nodes<'a, L>,
    /// The row handed out last, at a feed of 1, and the two after it.
    here: Option<Node<L::Axes>>,
    next: Option<Node<L::Axes>>,
    after_next: Option<Node<L::Axes>>,
    /// The second row of a corner where velocities jump.
    jump: Option<Row<L::Axes>>,
    /// From the row handed out last on.
    ahead: &'a [Ahead],
    limits: Reciprocals<L::Axes>,
    /// With a limit of jerk: the feed that the table can be run at from end to end, the rows at both
    /// ends of the segment up to the row handed out last, without the first where the machine rests,
    /// and the change of the feed that goes on there.
    full: f64,
    segment: [Option<Row<L::Axes>>; 2],
    warp: Option<Warp>,
    max: f64,
    wanted: f64,
    /// Feed at the row handed out last.
    feed: f64,
    time_s: f64,
    remaining: usize,
}

impl<'a, A: Axes, L: Legs<Axes = A>> Table<'a, L, A> {
    /// The table at a feed of 1, to be changed up to `max`, 1.5 for 150 %. Needs memory for each
    /// row of the table.
    ///
    /// # Errors
    /// [`PlanError::Feed`] for a `max` that is beyond the range of the crate,
    /// [`PlanError::Memory`] for too little memory, and where the path refuses a point.
    pub fn run(&self, max: f64, ahead: &'a mut [Ahead]) -> Result<Run<'a, L>, PlanError<L::Error>> {
        if !range().contains(&max) {
            return Err(PlanError::Feed {
                feed: max,
                min: SMALLEST,
                max: LARGEST,
            });
        }
        let (needed, available) = (self.len(), ahead.len());
        let ahead = ahead
            .get_mut(..needed)
            .ok_or(PlanError::Memory { needed, available })?;
        let (ahead, _) = ahead.split_at_mut(self.nodes.min(needed));
        let mut full = max;
        if self.limits.has_jerk() {
            full = self.full_feed()?;
        } else {
            self.look_ahead(max, ahead)?;
        }
        Ok(Run {
            nodes: Nodes::new(self),
            here: None,
            next: None,
            after_next: None,
            jump: None,
            ahead,
            limits: self.limits,
            full,
            segment: [None; 2],
            warp: None,
            max,
            wanted: max.min(1.0),
            feed: 0.0,
            time_s: 0.0,
            remaining: needed,
        })
    }
}

impl<L: Legs> Run<'_, L> {
    /// Wants a feed, 1 for 100 %; 0 stops.
    ///
    /// # Errors
    /// [`FeedError`]; the wanted feed stays.
    pub fn set_feed(&mut self, feed: f64) -> Result<(), FeedError> {
        let (min, max) = (SMALLEST, self.max);
        if feed == 0.0 || (feed >= min && feed <= max) {
            self.wanted = feed;
            return Ok(());
        }
        Err(FeedError { feed, min, max })
    }

    /// Stops as soon as the accelerations allow, on the path. [`set_feed`](Self::set_feed) goes on.
    pub const fn stop(&mut self) {
        self.wanted = 0.0;
    }

    /// The feed at the row handed out last.
    #[must_use]
    pub const fn feed(&self) -> f64 {
        self.feed
    }

    /// Rows of the table that have not been handed out.
    #[must_use]
    pub const fn remaining(&self) -> usize {
        self.remaining
    }

    /// Whether the last row of the table has been handed out.
    #[must_use]
    pub const fn is_finished(&self) -> bool {
        self.remaining == 0
    }

    /// The next row; `None` at the end and where the machine rests at a feed of zero, until
    /// another is wanted.
    ///
    /// # Errors
    /// Where the path refuses a point that it has given while the table was planned.
    pub fn next_row(&mut self) -> Result<Option<Row<L::Axes>>, L::Error> {
        let Some(from) = self.here else {
            return self.first_row();
        };
        if let Some(row) = self.jump.take() {
            self.remaining = self.remaining.saturating_sub(1);
            return Ok(Some(row));
        }
        let (Some(to), [here, later @ ..]) = (self.next, self.ahead) else {
            return Ok(None);
        };
        let [there, ..] = later else {
            return Ok(None);
        };
        let step = if self.limits.has_jerk() {
            self.next_feed_with_jerk(&from)?
        } else {
            let feed = self.next_feed(&from, &to, *here, *there);
            let both = self.feed + feed;
            (both > 0.0).then(|| (feed, 2.0 * from.duration_s / both))
        };
        let Some((feed, duration_s)) = step else {
            return Ok(None);
        };
        let after_next = self.nodes.next()?;
        self.time_s += duration_s;
        self.feed = feed;
        (self.here, self.next, self.after_next) = (self.next, self.after_next, after_next);
        self.ahead = later;
        self.remaining = self.remaining.saturating_sub(1);
        let row = Row::new(&to.point, feed, self.time_s, duration_s);
        self.jump = to.jump.map(|velocity| row.with_jump(velocity.scaled(feed)));
        if self.limits.has_jerk() {
            let [_, before] = self.segment;
            self.segment = [before, Some(row)];
        }
        Ok(Some(row))
    }

    /// The feed at the next row and the time to it; none where the machine stays at rest.
    #[expect(clippy::float_cmp, reason = "the same number")]
    fn next_feed_with_jerk(
        &mut self,
        from: &Node<L::Axes>,
    ) -> Result<Option<(f64, f64)>, L::Error> {
        let wanted = self.wanted.min(self.full);
        if is_rest(&from.point) {
            (self.feed, self.warp) = (wanted, None);
        }
        if is_rest(&from.point) || self.feed <= 0.0 {
            self.segment = [None, Some(Row::new(&from.point, 0.0, 0.0, 0.0))];
        }
        if self.warp.map_or(self.feed, |warp| warp.to) != wanted {
            let mut demand = Demand::at_rest();
            if let [Some(from), Some(to)] = &self.segment {
                demand.add(&self.limits, from, to);
            }
            let start = Start {
                limits: &self.limits,
                demand: &demand,
                feed: self.feed,
                fetched: [self.here, self.next, self.after_next],
                nodes: &self.nodes,
            };
            let change = if self.feed > 0.0 {
                start.change(wanted)?
            } else {
                start.resume(wanted)?
            };
            self.warp = change.or(self.warp);
        }
        let Some(warp) = &mut self.warp else {
            let duration_s = from.duration_s / self.feed;
            return Ok((self.feed > 0.0).then_some((self.feed, duration_s)));
        };
        let step = warp.step(from.duration_s);
        if warp.left == 0 {
            self.warp = None;
        }
        Ok(Some(step))
    }

    /// The first row, at rest.
    fn first_row(&mut self) -> Result<Option<Row<L::Axes>>, L::Error> {
        let Some(first) = self.nodes.next()? else {
            return Ok(None);
        };
        self.next = self.nodes.next()?;
        self.after_next = self.nodes.next()?;
        self.here = Some(first);
        self.remaining = self.remaining.saturating_sub(1);
        Ok(Some(Row::new(&first.point, 0.0, 0.0, 0.0)))
    }

    /// The feed at the next row. The feed here is set anew where the machine rests.
    fn next_feed(
        &mut self,
        from: &Node<L::Axes>,
        to: &Node<L::Axes>,
        here: Ahead,
        there: Ahead,
    ) -> f64 {
        let wanted = self.wanted.min(there.ceiling);
        let segment = || Segment::new(&self.limits, &from.departure(), &to.point, from.duration_s);
        if is_rest(&from.point) {
            self.feed = wanted.min(segment().even().max(1.0));
        }
        // From rest and to rest at one feed, so that the cubic has the shape of the table's; at a
        // constant feed of at most 1 the table itself holds.
        #[expect(clippy::float_cmp, reason = "the same number")]
        let is_even = is_rest(&from.point)
            || (is_rest(&to.point) && self.feed > 0.0)
            || (wanted == self.feed && wanted <= 1.0);
        if is_even {
            return self.feed;
        }
        let segment = segment();
        // A feed that both ends allow may stay.
        let known = if self.feed <= there.ceiling {
            self.feed
        } else {
            self.feed * here.after
        };
        let nearest = segment.toward(self.feed, wanted, known);
        if wanted > 0.0 || nearest <= 0.0 {
            return nearest;
        }
        let highest = self.feed.min(there.ceiling);
        let rest = self.feed_to_rest(to, highest);
        segment.toward(self.feed, rest.max(nearest), nearest)
    }

    /// The highest feed at the next row from which the machine rests at the one after it, at most
    /// `highest`: braking as hard as it can before, it would crawl there.
    fn feed_to_rest(&self, next: &Node<L::Axes>, highest: f64) -> f64 {
        let Some(after) = &self.after_next else {
            return 0.0;
        };
        let segment = Segment::new(
            &self.limits,
            &next.departure(),
            &after.point,
            next.duration_s,
        );
        if is_rest(&after.point) {
            return highest.min(segment.even().max(1.0));
        }
        let (feed, _) = segment.begin(0.0, highest);
        feed
    }
}

impl<L: Legs> Iterator for Run<'_, L> {
    type Item = Result<Row<L::Axes>, L::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_row().transpose()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        // A stop hands out fewer for now.
        (0, Some(self.remaining))
    }
}
