//! What one side did, counted.

use core::time::Duration;

use super::{formula::Formulas, frames::Frames};

/// What one side did, as the sender of its telegrams and as the receiver of the other's.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Conduct {
    pub(super) characters: u32,
    /// The last one.
    pub(super) last: Duration,
    /// Outside of blocks: STX, DLE and NAK, and all else.
    pub(super) control: u32,
    pub(super) garbage: u32,
    /// In blocks: all, and those that read 00h or came in damaged.
    pub(super) in_blocks: u32,
    pub(super) unreadable: u32,

    pub(super) requests: u32,
    pub(super) refused: u32,
    pub(super) unanswered: u32,
    /// In a row and without any character of this side, up to the end.
    pub(super) unanswered_at_end: u32,
    pub(super) conflicts: u32,
    /// Sent on without an answer, with DLE or with something else.
    pub(super) answered_itself: u32,
    pub(super) did_not_wait: u32,

    /// Blocks that came to their end, or did not.
    pub(super) good: u32,
    pub(super) bad: u32,
    pub(super) without_bcc: u32,
    pub(super) unfinished: u32,
    /// Answers to them.
    pub(super) accepted: u32,
    pub(super) rejected: u32,
    pub(super) good_rejected: u32,
    pub(super) bad_accepted: u32,
    pub(super) unacknowledged: u32,
    pub(super) broken_off: u32,
    pub(super) gaps: u32,
    pub(super) longest_gap: Duration,
    pub(super) longest_accepted: u32,
    pub(super) shortest_rejected: Option<u32>,
    pub(super) formulas: Formulas,
    pub(super) frames: Frames,

    /// As the receiver: reactions to the other, and moments in which one was missing.
    pub(super) reacted: u32,
    pub(super) ignored: u32,
    pub(super) bcc_not_awaited: u32,
    /// NAK by itself a while after DLE to a block.
    pub(super) nak_after_dle: u32,
    pub(super) requests_for_answers: u32,
    pub(super) longest_request_for_answer: Duration,
    pub(super) worst_answer: Option<Duration>,
    pub(super) worst_acknowledgement: Option<Duration>,
}

impl Conduct {
    /// Blocks, whatever became of them.
    pub(super) const fn blocks(&self) -> u32 {
        self.good
            .saturating_add(self.bad)
            .saturating_add(self.without_bcc)
            .saturating_add(self.unfinished)
    }
}
