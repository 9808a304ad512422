//! How fast each knot of a table may be passed at a feed above 1, looked at from its end.

use crate::knot::ToolTimes;
use crate::number::sqrt;
use crate::segment::Segment;
use crate::{Axes, Knot, Table, jerk};

/// Memory for one row of a table that is played back: the highest speed from which the rest can be
/// run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FeedCeiling {
    /// The highest speed at this row from which the rest can be run.
    pub(super) speed: f64,
    /// The speed at the next row that goes with it, as a ratio to this one.
    pub(super) ratio: f64,
}

impl<A: Axes> Table<'_, A> {
    /// What is asked of the tool at feeds of up to `max`.
    pub(super) fn tool_times(&self, max: f64) -> ToolTimes {
        ToolTimes::of_motion(max / self.stretch)
    }

    /// From the end: the highest speed at each row, up to `max` times that of the table. Never
    /// below the table's own: it is a motion that holds.
    pub(super) fn find_ceilings(&self, max: f64, ceilings: &mut [FeedCeiling]) {
        let tool_times = self.tool_times(max);
        let mut later: Option<(&Knot<A>, FeedCeiling)> = None;
        for (knot, slot) in self.knots.iter().zip(ceilings).rev() {
            let planned = knot.speed / self.stretch;
            let most = knot.cap.min(planned * max.max(1.0));
            *slot = FeedCeiling {
                speed: most,
                ratio: 0.0,
            };
            if let Some((to, after)) = later {
                *slot = if planned <= 0.0 {
                    FeedCeiling::default()
                } else if to.ds <= 0.0 {
                    FeedCeiling {
                        speed: after.speed.min(most),
                        ratio: 1.0,
                    }
                } else {
                    let segment = Segment::new(&self.limits, knot, to, tool_times);
                    let ends = [planned, to.speed / self.stretch];
                    look_back(&segment, ends, after.speed, most)
                };
            }
            later = Some((knot, *slot));
        }
    }

    /// The highest constant feed, up to `max`, that the axes allow from end to end.
    pub(super) fn full_feed(&self, max: f64) -> f64 {
        let mut most = jerk::Most::default();
        let mut walk = jerk::Walk::new(0, 0.0).with_tool_times(self.tool_times(max));
        while let Some(next) = walk.next_knot(self.knots) {
            let speed = self.knots.get(next).map_or(0.0, |knot| knot.speed);
            if let Some(segment) = walk.advance(&self.limits, self.knots, speed) {
                segment.visit(&mut most);
            }
        }
        max.min(self.stretch / most.stretch)
    }
}

/// The ceiling before a segment whose end allows `later`, which the table passes at the speeds
/// `planned`.
fn look_back<A: Axes>(
    segment: &Segment<A>,
    planned: [f64; 2],
    later: f64,
    most: f64,
) -> FeedCeiling {
    let [w0, w1] = planned;
    let (start, end) = segment.begin(later, most);
    // The table's own pair, faster by the same factor.
    let faster = (1.0 / sqrt(segment.load(w0, w1))).min(most / w0);
    let faster = if w1 > 0.0 {
        faster.min(later / w1)
    } else {
        faster
    };
    let own = w0 * faster.max(1.0);
    if start > own {
        return FeedCeiling {
            speed: start,
            ratio: end / start,
        };
    }
    FeedCeiling {
        speed: own,
        ratio: w1 / w0,
    }
}
