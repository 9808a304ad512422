//! A PVT table that runs under a feed override and can stop on its path.

use core::convert::Infallible;

use path_timing::{FeedCeiling, FeedError, Playback};

use super::PvtTable;
use crate::PvtPoint;

/// A [`PvtTable`] as it goes to the controller, at a feed that may change from point to point.
///
/// How the feed goes towards the wanted one, and how it stops: see [`path_timing::Playback`]. The body
/// stays on its path at any feed; a change of it also changes the speed within a segment and with it
/// the distance error: [`hermite_distance_error`](crate::hermite_distance_error) of two points
/// handed out bounds it.
#[derive(Debug, Clone)]
pub struct PvtRun<'a, const N: usize> {
    run: Playback<'a, [[f64; 3]; N]>,
    /// The only point where nothing moves.
    still: Option<PvtPoint<N>>,
}

impl<'a, const N: usize> PvtTable<'a, N> {
    /// The table at a feed of 1, to be changed up to `max`, 1.5 for 150 %. Needs memory for each
    /// point of the table.
    ///
    /// # Errors
    /// [`Feed`](path_timing::PlanError::Feed) for a `max` that is beyond the range of the crate,
    /// [`Memory`](path_timing::PlanError::Memory) for too little memory.
    pub fn run(
        &self,
        max: f64,
        ceilings: &'a mut [FeedCeiling],
    ) -> Result<PvtRun<'a, N>, path_timing::PlanError<Infallible>> {
        Ok(PvtRun {
            run: self.table.playback(max, ceilings)?,
            still: self.still_point(),
        })
    }
}

impl<const N: usize> PvtRun<'_, N> {
    /// Wants a feed, 1 for 100 %; 0 stops.
    ///
    /// # Errors
    /// [`FeedError`]; the wanted feed stays.
    pub fn set_feed(&mut self, feed: f64) -> Result<(), FeedError> {
        self.run.set_feed(feed)
    }

    /// Stops as soon as the accelerations allow, on the path. [`set_feed`](Self::set_feed) goes on.
    pub const fn stop(&mut self) {
        self.run.stop();
    }

    /// Points of the table that have not been handed out.
    #[must_use]
    pub fn remaining(&self) -> usize {
        let still = usize::from(self.still.is_some());
        self.run.remaining().saturating_add(still)
    }

    /// Whether the last point of the table has been handed out.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.remaining() == 0
    }

    /// The next point; `None` at the end and where the machine rests at a feed of zero, until
    /// another is wanted.
    pub fn next_point(&mut self) -> Option<PvtPoint<N>> {
        if let Some(point) = self.still.take() {
            return Some(point);
        }
        self.run.next_row().as_ref().map(PvtPoint::new)
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
