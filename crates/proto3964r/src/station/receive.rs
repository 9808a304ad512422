//! The receiver's half of the procedure: what the other files decide, done.

use core::time::Duration;

use super::{
    Station,
    queue::{Note, Reply},
    state::{JobState, State},
};
use crate::{
    config::{IdleNoise, SilenceInBlock},
    event::{Abandoned, CharacterError, Rejection},
    frame::{FrameError, Progress},
};

impl<const N: usize, const T: usize> Station<N, T> {
    /// A character that belongs to nothing.
    pub(super) fn noise(&mut self, now: Duration, first: u8) {
        match self.config.idle_noise {
            IdleNoise::Ignore => {}
            IdleNoise::NakAtOnce => self.turn_away(now, Rejection::Noise { first }),
            IdleNoise::NakAfterSilence => {
                self.state = State::Noise {
                    first,
                    silent_at: now.saturating_add(self.zvz),
                    noise_end_at: now.saturating_add(self.config.max_noise()),
                };
            }
        }
    }

    /// A character more in what is waited out: the silence begins again.
    pub(super) fn await_silence(&mut self, now: Duration) {
        let in_zvz = now.saturating_add(self.zvz);
        match &mut self.state {
            State::Noise { silent_at, .. } => *silent_at = in_zvz,
            // Not before the rest of the block has left.
            State::Interrupted { silent_at, .. } | State::Settling { silent_at, .. } => {
                *silent_at = in_zvz.max(*silent_at);
            }
            _ => {}
        }
    }

    /// STX came.
    pub(super) fn asked_to_receive(&mut self, now: Duration) {
        if self.holds_telegram {
            let refuse_at = now.saturating_add(self.config.buffer_wait());
            self.state = State::AwaitBuffer { refuse_at };
        } else {
            self.invite(now);
        }
    }

    /// STX came in place of an answer that is held: what is held is void, and comes again.
    pub(super) fn asked_again(&mut self, now: Duration) {
        self.notes.diagnosis(Note::Rejected(Rejection::Undecided));
        self.asked_to_receive(now);
    }

    /// Answers DLE. ZVZ runs from here and again from the moment in which the line takes the DLE.
    pub(super) fn invite(&mut self, now: Duration) {
        self.replies.push(Reply::Dle);
        let gap_at = now.saturating_add(self.zvz);
        self.state = State::Invited { gap_at };
    }

    /// The block begins.
    pub(super) fn begin_block(&mut self, now: Duration) {
        self.state = State::Receiving {
            block: Progress::START,
            gap_at: now,
        };
    }

    /// A character of the block. Damage is noted, like an error in the frame.
    #[inline]
    pub(super) fn block_character(
        &mut self,
        now: Duration,
        byte: u8,
        damage: Option<CharacterError>,
    ) {
        if let Some(error) = damage {
            self.spoil(now, Rejection::Line(error));
        }
        let rules = self.rules();
        if let Some((block, gap_at)) = self.state.block_mut() {
            *gap_at = now.saturating_add(self.zvz);
            let end = block.push(rules, byte, &mut self.rx);
            self.block_went_on(now, end);
        }
    }

    /// Characters of the block, up to its end; returns how many.
    pub(super) fn block_characters(&mut self, now: Duration, bytes: &[u8]) -> usize {
        let rules = self.rules();
        let Some((block, gap_at)) = self.state.block_mut() else {
            return 0;
        };
        *gap_at = now.saturating_add(self.zvz);
        let (taken, end) = block.feed(rules, bytes, &mut self.rx);
        self.block_went_on(now, end);
        taken
    }

    #[inline]
    fn block_went_on(&mut self, now: Duration, end: Option<Result<u16, FrameError>>) {
        let Some(end) = end else {
            if let State::Receiving { block, .. } = &self.state
                && let Some(fault) = block.fault()
            {
                self.spoil(now, Rejection::Frame(fault));
            }
            return;
        };
        match (&self.state, end) {
            // A bad block: NAK, for the first error that was noted.
            (&State::Spoiled { rejection, .. }, _) => self.reject(now, rejection),
            (_, Err(fault)) => self.reject(now, Rejection::Frame(fault)),
            (_, Ok(len)) => self.received(now, len),
        }
    }

    /// The first error of the block is noted; patience is limited from then on.
    #[cold]
    fn spoil(&mut self, now: Duration, rejection: Rejection) {
        if let State::Receiving { block, gap_at } = self.state {
            self.state = State::Spoiled {
                block,
                rejection,
                gap_at,
                noise_end_at: now.saturating_add(self.config.max_noise()),
            };
        }
    }

    /// A good block: DLE, unless the user has to accept it first.
    fn received(&mut self, now: Duration, len: u16) {
        self.holds_telegram = true;
        self.notes.result(Note::Received { len });
        match self.config.acknowledge_wait() {
            Some(wait) => {
                let refuse_at = now.saturating_add(wait);
                self.state = State::Held { refuse_at };
            }
            None => self.acknowledge(now),
        }
    }

    /// DLE to a good block.
    pub(super) fn acknowledge(&mut self, now: Duration) {
        self.replies.push(Reply::Dle);
        self.conflicts = 0;
        // The line works: a job that gave way begins its attempts anew.
        if self.job.is_open() {
            self.job.connection_attempts = 0;
            self.job.state = JobState::Open;
        }
        self.go_idle(now);
    }

    /// NAK, and a repeat is expected, unless there were too many.
    pub(super) fn reject(&mut self, now: Duration, rejection: Rejection) {
        self.replies.push(Reply::Nak);
        self.notes.diagnosis(Note::Rejected(rejection));
        self.rejections = self.rejections.saturating_add(1);
        if self.rejections >= self.config.transmission_attempts {
            self.abandon(now, Abandoned::TooMany(self.rejections));
        } else {
            let give_up_at = now.saturating_add(self.config.bwz());
            self.state = State::AwaitRepeat {
                give_up_at,
                goes_on: false,
            };
        }
    }

    /// Characters came after the end of a bad block.
    pub(super) const fn goes_on(&mut self) {
        if let State::AwaitRepeat { goes_on, .. } = &mut self.state {
            *goes_on = true;
        }
    }

    pub(super) fn abandon(&mut self, now: Duration, reason: Abandoned) {
        self.notes.diagnosis(Note::Abandoned(reason));
        self.go_idle(now);
    }

    /// NAK, and nothing is expected.
    pub(super) fn turn_away(&mut self, now: Duration, rejection: Rejection) {
        self.replies.push(Reply::Nak);
        self.notes.diagnosis(Note::Rejected(rejection));
        self.go_idle(now);
    }

    /// ZVZ ran out in a block.
    pub(super) fn gap_in_block(&mut self, now: Duration) {
        if let State::Receiving { block, .. } = &self.state
            && block.is_lone_dle()
            && self.job.state == JobState::Yielded
        {
            // The partner answered DLE as well: it gave way like us.
            self.notes.diagnosis(Note::SamePriority);
        }
        match self.config.silence_in_block {
            SilenceInBlock::Idle => self.turn_away(now, Rejection::CharacterDelay),
            SilenceInBlock::ExpectRepeat => self.reject(now, Rejection::CharacterDelay),
        }
    }
}
