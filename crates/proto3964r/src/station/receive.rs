//! The receiver's half of the procedure.

use super::{
    Job, State, Station,
    compact::{Flag, Note, Reply},
};
use crate::{
    ascii::{NAK, STX},
    config::{IdleNoise, SilenceInBlock},
    event::{Abandoned, LineError, Rejection},
    frame::{FrameError, Progress},
    time::Instant,
};

impl<const N: usize, const T: usize> Station<N, T> {
    /// A character while idle, or while a repeat is awaited.
    pub(super) fn idle_character(&mut self, now: Instant, byte: u8, error: Option<LineError>) {
        match (byte, error) {
            (STX, None) => self.asked_to_receive(now),
            // Never answered: two stations would go on for ever. While a repeat is awaited it is
            // the partner's last word.
            (NAK, None) => {
                if self.state == State::AwaitRepeat {
                    self.abandon(now, Abandoned::ByPartner);
                }
            }
            _ => self.noise(now, byte),
        }
    }

    fn noise(&mut self, now: Instant, byte: u8) {
        match self.config.idle_noise {
            IdleNoise::Ignore => {}
            IdleNoise::NakAtOnce => self.answer_noise(now, byte),
            IdleNoise::NakAfterSilence => {
                self.noise = byte;
                self.state = State::NoiseQuiet;
                self.deadline = now.plus_ms(self.config.zvz_ms);
                self.limit = now.plus_us(self.config.babble_us());
            }
        }
    }

    fn answer_noise(&mut self, now: Instant, first: u8) {
        if self.rejections > 0 {
            self.reject(now, Rejection::Noise { first }); // the series goes on, and so does its count
        } else {
            self.refuse(now, Rejection::Noise { first });
        }
    }

    /// STX came.
    pub(super) fn asked_to_receive(&mut self, now: Instant) {
        if self.flags.has(Flag::RX_FULL) {
            self.state = State::WaitBuffer;
            self.limit = Instant::NEVER;
            self.deadline = now.plus_ms(self.config.effective_buffer_wait_ms());
        } else {
            self.invite(now);
        }
    }

    /// Answers DLE. ZVZ runs from here and again from the moment in which the line takes the DLE.
    pub(super) fn invite(&mut self, now: Instant) {
        self.replies.push(Reply::Dle);
        self.decoder = Progress::START;
        self.line_error = None;
        self.state = State::Receiving;
        self.deadline = now.plus_ms(self.config.zvz_ms);
        self.limit = Instant::NEVER;
    }

    /// A character while the partner waits for a receive buffer. Its next STX does not prolong
    /// the wait.
    pub(super) fn waiting_character(&mut self, now: Instant, byte: u8, error: Option<LineError>) {
        match (byte, error) {
            (STX, None) => {}
            (NAK, None) => self.go_idle(now),
            _ => self.noise(now, byte),
        }
    }

    /// Characters of a block; returns what stands behind its end.
    pub(super) fn receive_block<'b>(&mut self, now: Instant, bytes: &'b [u8]) -> &'b [u8] {
        let fed = self.decoder.feed(self.rules(), bytes, &mut self.rx);
        self.after_characters(now, fed.block);
        bytes.get(fed.consumed..).unwrap_or_default()
    }

    #[inline]
    pub(super) fn receive_byte(&mut self, now: Instant, byte: u8) {
        let block = self.decoder.push(self.rules(), byte, &mut self.rx);
        self.after_characters(now, block);
    }

    #[inline]
    fn after_characters(&mut self, now: Instant, block: Option<Result<usize, FrameError>>) {
        self.deadline = now.plus_ms(self.config.zvz_ms);
        let faulty = self.decoder.is_faulty() || self.line_error.is_some();
        if let Some(block) = block {
            self.block_ended(now, block);
        } else if faulty {
            self.state = State::ReceivingOther;
            self.limit = self.limit.min(now.plus_us(self.config.babble_us()));
        } else if self.decoder.is_in_data() {
            self.state = State::Receiving;
        } else {
            self.state = State::ReceivingOther;
        }
    }

    #[cold]
    fn block_ended(&mut self, now: Instant, block: Result<usize, FrameError>) {
        let verdict = match (block, self.line_error) {
            (_, Some(error)) => Err(Rejection::Line(error)),
            (Err(error), None) => Err(Rejection::Frame(error)),
            (Ok(len), None) => Ok(len),
        };
        match verdict {
            Err(rejection) => self.reject(now, rejection),
            Ok(len) => {
                self.replies.push(Reply::Dle);
                self.rx_len = u16::try_from(len).unwrap_or(u16::MAX);
                self.flags.set(Flag::RX_FULL);
                self.notes.result(Note::Received);
                self.collisions = 0;
                // The line works: a job that gave way begins its attempts anew.
                if self.job == Job::Open {
                    self.setup = 0;
                }
                self.flags.clear(Flag::YIELDED);
                self.go_idle(now);
            }
        }
    }

    /// NAK, and a repeat is expected, unless there were too many.
    fn reject(&mut self, now: Instant, rejection: Rejection) {
        self.replies.push(Reply::Nak);
        self.diagnose(Note::Rejected(rejection));
        self.rejections = self.rejections.saturating_add(1);
        if self.rejections >= self.config.transfer_attempts {
            self.abandon(now, Abandoned::TooMany(self.rejections));
        } else {
            self.state = State::AwaitRepeat;
            self.limit = Instant::NEVER;
            self.deadline = now.plus_ms(self.config.bwz_ms);
        }
    }

    fn abandon(&mut self, now: Instant, reason: Abandoned) {
        self.diagnose(Note::Abandoned(reason));
        self.go_idle(now);
    }

    /// NAK, and nothing is expected.
    fn refuse(&mut self, now: Instant, rejection: Rejection) {
        self.replies.push(Reply::Nak);
        self.diagnose(Note::Rejected(rejection));
        self.go_idle(now);
    }

    pub(super) fn receive_timeout(&mut self, now: Instant) {
        match self.state {
            State::WaitBuffer => self.refuse(now, Rejection::NoBuffer),
            State::AwaitRepeat => self.abandon(now, Abandoned::NoRepeat),
            State::NoiseQuiet => self.answer_noise(now, self.noise),
            _ if now < self.deadline => self.reject(now, Rejection::Endless),
            _ => self.gap_in_block(now),
        }
    }

    /// ZVZ ran out in a block.
    fn gap_in_block(&mut self, now: Instant) {
        if self.flags.has(Flag::YIELDED) && self.job == Job::Open && self.decoder.is_lone_dle() {
            // The partner answered DLE as well: it gave way like us.
            self.diagnose(Note::SamePriority);
        }
        match self.config.silence_in_block {
            SilenceInBlock::Idle => self.refuse(now, Rejection::CharacterDelay),
            SilenceInBlock::ExpectRepeat => self.reject(now, Rejection::CharacterDelay),
        }
    }
}
