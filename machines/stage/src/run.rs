//! What comes of a whole program on the simulated stage.

use crate::motors::FollowedAxes;
use crate::record::{Record, Seen, TimedRow, over_time};
use crate::settings::Settings;

/// What the stage did, in a closed loop and without corrections.
#[derive(Debug, Clone)]
pub struct Run {
    pub(crate) settings: Settings,
    pub(crate) commanded: [i32; 2],
    pub(crate) duration_s: f64,
    /// From the programmed end: in a closed loop, and without.
    pub(crate) closing_mm: [f64; 2],
    pub(crate) lost: [u64; 2],
    pub(crate) followed: FollowedAxes,
    /// The same motions at their feeds from the first step to the last.
    pub(crate) at_feed: FollowedAxes,
    pub(crate) record: Record,
}

impl Run {
    /// The stage whose lost steps are corrected.
    #[must_use]
    pub const fn closed_loop(&self) -> &Seen {
        &self.record.closed
    }

    /// The stage beside it, without corrections.
    #[must_use]
    pub const fn open_loop(&self) -> &Seen {
        &self.record.open
    }

    /// Points of each programmed motion, X and Y in mm, near enough for a picture.
    pub fn programmed(&self) -> impl Iterator<Item = Vec<[f64; 2]>> {
        let motions = self.record.programmed.iter();
        motions.map(|motion| motion.points().iter().map(|at| [at.x, at.y]).collect())
    }

    /// The rows of timed steps; none where the steps are at the feed.
    #[must_use]
    pub fn rows(&self) -> &[TimedRow] {
        &self.record.rows
    }

    /// Time in s and the mean speed along the path around it in mm/s, by the steps.
    pub fn speeds(&self) -> impl Iterator<Item = [f64; 2]> {
        self.followed.motion.speeds()
    }

    /// Time in s, and by the steps the acceleration in mm/s² of the axis that has the larger one.
    pub fn axis_accelerations(&self) -> impl Iterator<Item = [f64; 2]> {
        self.followed.motion.axis_accelerations()
    }

    /// Time in s, and the steps corrected until then; where some were.
    pub fn corrections(&self) -> impl Iterator<Item = [f64; 2]> {
        over_time(&self.record.corrections).filter(|[_, steps]| steps.is_finite())
    }
}
