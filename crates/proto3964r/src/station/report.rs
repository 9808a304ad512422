//! What the user is told.

use super::{
    Job, Station,
    compact::{Flag, Note},
};
use crate::event::{Cause, Event, Failure, Phase};

impl<const N: usize, const T: usize> Station<N, T> {
    /// Whether [`poll_event`](Self::poll_event) has something.
    #[must_use]
    pub fn has_event(&self) -> bool {
        !self.notes.is_empty()
    }

    /// The next event, in the order in which they happened.
    #[must_use]
    pub fn poll_event(&mut self) -> Option<Event<'_>> {
        Some(match self.notes.pop()? {
            Note::Received => {
                self.flags.clear(Flag::RX_FULL);
                Event::Received(self.rx.get(..usize::from(self.rx_len)).unwrap_or_default())
            }
            Note::Sent => {
                self.job = Job::None;
                Event::Sent {
                    len: usize::from(self.tx_len),
                }
            }
            Note::Failed(phase) => {
                self.job = Job::None;
                Event::Failed(self.failure(phase))
            }
            Note::Rejected(rejection) => Event::Rejected(rejection),
            Note::Abandoned(abandoned) => Event::Abandoned(abandoned),
            Note::Collision(in_a_row) => Event::Collision { in_a_row },
            Note::SamePriority => Event::SamePriority,
            Note::Break => Event::Break,
        })
    }

    /// Diagnostic events that were dropped because nobody polled, at most 255.
    #[must_use]
    pub fn dropped_events(&self) -> u8 {
        self.dropped_notes
    }

    fn failure(&self, phase: Phase) -> Failure {
        Failure {
            phase,
            cause: self.first_cause.unwrap_or(Cause::Timeout),
            attempts: match phase {
                Phase::Setup => self.setup,
                Phase::Transfer => self.transfer,
            },
        }
    }

    /// Reports something that may be dropped when nobody polls.
    pub(super) fn diagnose(&mut self, note: Note) {
        if !self.notes.diagnosis(note) {
            self.dropped_notes = self.dropped_notes.saturating_add(1);
        }
    }
}
