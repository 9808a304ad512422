//! A change of the speed that goes on: of the feed, or by phases of constant jerk.

use super::phases::Phases;
use super::ramped::FeedChange;

/// How the machine goes from one speed to another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    pub(super) kind: Kind,
    /// The feed that it ends with.
    pub(super) to: f64,
    /// Segments to go.
    pub(super) left: usize,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    Feed(FeedChange),
    Slower(Phases),
    Faster(Phases),
}

impl Change {
    /// The speed at the next knot, over a segment that takes `table_s` to the speed `planned` at a
    /// feed of 1.
    pub(super) fn step(&mut self, ds: f64, table_s: f64, planned: f64) -> f64 {
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            return self.to * planned;
        }
        match &mut self.kind {
            Kind::Feed(change) => change.step(table_s) * planned,
            Kind::Slower(phases) | Kind::Faster(phases) => phases.step(ds),
        }
    }

    /// The phases to a lower speed that go on.
    pub(super) const fn braking(&self) -> Option<&Phases> {
        match &self.kind {
            Kind::Slower(phases) => Some(phases),
            Kind::Feed(_) | Kind::Faster(_) => None,
        }
    }
}
