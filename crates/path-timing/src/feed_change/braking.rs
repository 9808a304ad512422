//! Lower feeds and stops: which of those that may begin ends soonest.

use super::change::Change;
use super::phases::{Phases, Way};
use super::{AHEAD, At, Course, later};
use crate::Axes;

/// The part of the time of a stop to rest for which the machine gains speed first: what is found a
/// few rows later may not be found again at the next one.
const SOONER: f64 = 0.25;

impl<A: Axes> Course<'_, A> {
    /// The lower feed or the stop that begins here, unless one that begins a few rows later ends
    /// sooner: where the table uses all of the jerk, a change has to wait.
    pub(super) fn brake_soonest(
        &self,
        at: At,
        ahead: &[f64; AHEAD],
        going: Option<&Phases>,
        [from, to]: [f64; 2],
    ) -> Option<Change> {
        // What brakes already goes on as it began. One found by its length takes long to find, and
        // longer to run.
        let found = going
            .and_then(|going| self.at_limits(at, &[going.begun()], to, Way::Slower))
            .map(Some)
            .or_else(|| self.soonest(at, ahead, to, |at| self.by_phases(at, to, Way::Slower)))
            .or_else(|| self.soonest(at, ahead, to, |at| self.by_shape(at, from, to)))
            .flatten()?;
        let crawls = to <= 0.0 && found.left == 1 && self.crawls_to(at.end_of(&found), at.speed);
        Some(if crawls {
            self.sooner_with_its_rest(at, from, found)
        } else {
            found
        })
    }

    /// A stop to the next knot that crawls, or the one that ends where the course rests itself if
    /// that is far sooner.
    #[cold]
    #[inline(never)]
    fn sooner_with_its_rest(&self, at: At, from: f64, found: Change) -> Change {
        let time_s = |change| self.time_s(at, &[0.0; AHEAD], (at, change), at.end_of(&change));
        self.with_its_rest(at, [from, 0.0])
            .filter(|later| time_s(*later) < time_s(found) * SOONER)
            .unwrap_or(found)
    }

    /// A stop over many segments began where the table left little of the limits: the one that
    /// begins here if it ends sooner.
    #[cold]
    #[inline(never)]
    pub(super) fn sooner(&self, at: At, long: Change) -> Change {
        let time_s = |change| self.time_s(at, &[0.0; AHEAD], (at, change), at.end_of(&change));
        let found = self.by_phases(at, 0.0, Way::Slower);
        found
            .filter(|sooner| time_s(*sooner) < time_s(long))
            .unwrap_or(long)
    }

    /// What is found at a knot; `Some(None)` where what is found a few rows later ends sooner: at an
    /// earlier knot, or far sooner at rest, where the machine only gains speed.
    fn soonest(
        &self,
        at: At,
        ahead: &[f64; AHEAD],
        to: f64,
        find: impl Fn(At) -> Option<Change>,
    ) -> Option<Option<Change>> {
        let found = find(at);
        let end = found.map_or(usize::MAX, |found| at.end_of(&found));
        let time_s =
            |begun: At, change| self.time_s(at, ahead, (begun, change), begun.end_of(&change));
        let found_s = found.map_or(f64::INFINITY, |found| time_s(at, found));
        let waits = later(at, ahead).any(|later| {
            let is_faster = to <= 0.0 && later.speed > at.speed;
            (later.index < end || is_faster)
                && find(later).is_some_and(|found| {
                    later.end_of(&found) < end
                        || is_faster && time_s(later, found) < found_s * SOONER
                })
        });
        if waits { Some(None) } else { found.map(Some) }
    }
}
