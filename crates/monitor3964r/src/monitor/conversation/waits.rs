//! What becomes of a conversation when nothing comes.

use core::time::Duration;

use super::{Conversation, Phase};
use crate::monitor::{
    observation::{Marks, Observation},
    side::Side,
};

/// What is longer than a limit is so by this much at least.
const RESOLUTION: Duration = Duration::from_micros(1);

impl Conversation {
    pub(crate) fn poll_timeout(&self) -> Option<Duration> {
        let limit = self.limit()?.saturating_add(RESOLUTION);
        (!self.overdue).then(|| self.last.saturating_add(limit))
    }

    pub(crate) fn handle_timeout(&mut self, now: Duration) {
        self.marks = Marks::default();
        self.check_wait(now);
    }

    /// The longest wait in this phase.
    const fn limit(&self) -> Option<Duration> {
        match self.phase {
            Phase::Idle => None,
            Phase::Block { .. } | Phase::AnsweredEarly { .. } => Some(self.zvz),
            Phase::Requested { .. } | Phase::Conflict | Phase::AwaitAck { .. } => Some(self.qvz),
        }
    }

    /// Reports, once per wait, that the limit has passed.
    pub(super) fn check_wait(&mut self, now: Duration) {
        while self.poll_timeout().is_some_and(|due| due <= now) {
            self.overdue = true;
            let waited = self.since_last(now);
            match self.phase {
                Phase::Idle | Phase::Conflict => {}
                Phase::Requested { by } | Phase::AwaitAck { by } => {
                    self.no_answer(by.other(), waited);
                }
                Phase::Block { by, in_conflict } => self.pause(by, in_conflict, waited),
                Phase::AnsweredEarly { by, .. } => {
                    self.see(Observation::NoBcc { by });
                    self.phase = Phase::Idle;
                }
            }
        }
    }

    /// ZVZ has run out in a block, or the receiver says so.
    pub(super) fn pause(&mut self, by: Side, in_conflict: bool, waited: Duration) {
        if self.scan.is_empty() {
            self.see(Observation::NoBlock { by, waited });
        } else if in_conflict && self.scan.is_lone_dle() {
            self.see(Observation::BothGaveWay);
        } else if self.scan.awaits_bcc() {
            self.see(Observation::NoBcc { by });
            self.phase = Phase::AwaitAck { by };
            self.overdue = false;
        } else {
            self.see(Observation::Gap { by, gap: waited });
        }
    }
}
