//! The transmitter's half of the procedure.

use super::{
    Job, State, Station, Transmit,
    compact::{Flag, Note, Reply},
};
use crate::{
    ascii::{DLE, NAK, STX},
    config::{Collision, Priority},
    event::{Cause, LineError, Phase},
    frame::Encoder,
    time::Instant,
};

impl<const N: usize, const T: usize> Station<N, T> {
    /// Hands out characters for the line, as many as `out` takes; `None` when there are none.
    ///
    /// The answer timer runs from the last character of the block, so hand on to the line what
    /// you get, or tell with [`Config::character_us`](crate::Config::character_us) how long it
    /// takes there. When [`Transmit::Discard`] comes, drop what the line has not taken yet.
    #[must_use]
    pub fn poll_transmit<'o>(&mut self, now: Instant, out: &'o mut [u8]) -> Option<Transmit<'o>> {
        if self.flags.take(Flag::DISCARD) {
            return Some(Transmit::Discard);
        }
        let mut len = 0;
        while let Some(slot) = out.get_mut(len) {
            let Some(byte) = self.next_control(now) else {
                break;
            };
            *slot = byte;
            len += 1;
        }
        if self.state.is_sending()
            && let Some(free) = out.get_mut(len..)
        {
            let payload = self.tx.get(..usize::from(self.tx_len)).unwrap_or_default();
            let written = self.encoder.fill(self.config.check, payload, free);
            len += written;
            self.handed_out(now, u32::try_from(written).unwrap_or(u32::MAX));
        }
        out.get(..len)
            .filter(|bytes| !bytes.is_empty())
            .map(Transmit::Bytes)
    }

    /// Hands out the next character, for a line that takes one at a time.
    ///
    /// There is nothing to discard then: what the line has taken is on the line.
    #[must_use]
    #[inline]
    pub fn poll_transmit_byte(&mut self, now: Instant) -> Option<u8> {
        if self.state == State::Sending
            && let Some(byte) = self.encoder.next_plain(&self.tx)
        {
            let time = u64::from(self.config.character_us);
            self.limit = self.limit.max(now).plus_us_unchecked_end(time);
            return Some(byte);
        }
        self.next_other_byte(now)
    }

    /// Anything but one more data byte.
    #[cold]
    #[inline(never)]
    fn next_other_byte(&mut self, now: Instant) -> Option<u8> {
        self.flags.clear(Flag::DISCARD);
        if let Some(byte) = self.next_control(now) {
            return Some(byte);
        }
        if !self.state.is_sending() {
            return None;
        }
        let payload = self.tx.get(..usize::from(self.tx_len)).unwrap_or_default();
        let byte = self.encoder.next_byte(self.config.check, payload)?;
        self.handed_out(now, 1);
        Some(byte)
    }

    /// The next reply, or STX behind the replies. The timer of the state starts again.
    #[inline]
    fn next_control(&mut self, now: Instant) -> Option<u8> {
        if self.replies.is_empty() && !self.flags.has(Flag::STX) {
            return None;
        }
        let byte = match self.replies.pop() {
            Some(reply) => reply.character(),
            None => {
                self.flags.clear(Flag::STX);
                STX
            }
        };
        let on_line = now.plus_us(u64::from(self.config.character_us));
        match self.state {
            State::AwaitDle if !self.flags.has(Flag::STX) => {
                self.deadline = on_line.plus_ms(self.config.qvz_ms);
            }
            State::Receiving | State::ReceivingOther if byte == DLE => {
                self.deadline = on_line.plus_ms(self.config.zvz_ms);
            }
            State::AwaitRepeat => self.deadline = on_line.plus_ms(self.config.bwz_ms),
            _ => {}
        }
        Some(byte)
    }

    /// `count` more characters of the block are on their way.
    ///
    /// ```text
    /// end of output = max(end of output, now) + count * character
    /// ```
    fn handed_out(&mut self, now: Instant, count: u32) {
        if count > 0 {
            let time = u64::from(self.config.character_us) * u64::from(count);
            self.limit = self.limit.max(now).plus_us(time);
        }
        if self.encoder.is_done() {
            self.state = State::AwaitAck;
            self.deadline = self.limit.plus_ms(self.config.qvz_ms);
            self.limit = Instant::NEVER;
        } else {
            self.state = self.sending_state();
        }
    }

    fn sending_state(&self) -> State {
        if self.replies.is_empty() && self.encoder.is_in_payload() {
            State::Sending
        } else {
            State::SendingOther
        }
    }

    /// While an answer is awaited: when STX or the block is on the line.
    #[inline]
    fn end_of_output(&self) -> Instant {
        self.deadline.minus_ms(self.config.qvz_ms)
    }

    /// Queues STX. Characters up to `burst_end` belong to what spoiled the attempt before.
    pub(super) fn start_setup(&mut self, now: Instant, burst_end: Instant) {
        self.setup = self.setup.saturating_add(1);
        self.flags.set(Flag::STX);
        self.flags.clear(Flag::COLLIDED);
        self.state = State::AwaitDle;
        self.deadline = now.plus_ms(self.config.qvz_ms);
        self.limit = burst_end;
    }

    /// The line is free again and a job waits.
    pub(super) fn resume(&mut self, now: Instant) {
        if self.flags.has(Flag::YIELDED) {
            self.flags.clear(Flag::YIELDED);
            self.next_setup(now, Cause::Collision, Instant::ZERO);
        } else {
            self.start_setup(now, Instant::ZERO);
        }
    }

    fn next_setup(&mut self, now: Instant, cause: Cause, burst_end: Instant) {
        self.first_cause.get_or_insert(cause);
        if self.setup >= self.config.setup_attempts {
            self.fail(now, Phase::Setup);
        } else {
            self.start_setup(now, burst_end);
        }
    }

    fn next_transfer(&mut self, now: Instant, cause: Cause, burst_end: Instant) {
        self.first_cause.get_or_insert(cause);
        self.flags.set(Flag::DISCARD);
        if self.transfer >= self.config.transfer_attempts {
            self.fail(now, Phase::Transfer);
        } else {
            self.transfer = self.transfer.saturating_add(1);
            self.setup = 0;
            self.start_setup(now, burst_end);
        }
    }

    /// The last attempt is used up: NAK puts the partner into idle.
    fn fail(&mut self, now: Instant, phase: Phase) {
        self.flags.clear(Flag::STX);
        self.replies.push(Reply::Nak);
        self.close(Note::Failed(phase));
        self.go_idle(now);
    }

    fn close(&mut self, outcome: Note) {
        self.job = Job::Closed;
        self.flags.clear(Flag::YIELDED);
        self.notes.result(outcome);
    }

    /// Ends the job from outside.
    pub(super) fn end_job(&mut self, now: Instant, cause: Cause) {
        self.first_cause.get_or_insert(cause);
        let phase = match self.state {
            State::Sending | State::SendingOther | State::ResendQuiet | State::AwaitAck => {
                Phase::Transfer
            }
            _ => Phase::Setup,
        };
        if self.state.is_job() {
            if phase == Phase::Transfer {
                self.flags.set(Flag::DISCARD);
            }
            self.fail(now, phase);
        } else {
            self.close(Note::Failed(phase));
        }
    }

    /// A character while STX is queued but not on the line: it answers nothing. A partner who
    /// asks is served first; a late DLE of the attempt before still counts.
    pub(super) fn early_character(&mut self, now: Instant, byte: u8, error: Option<LineError>) {
        match (byte, error) {
            (STX, None) => {
                self.flags.clear(Flag::STX);
                self.flags.set(Flag::YIELDED);
                self.asked_to_receive(now);
            }
            (DLE, None) if self.setup > 1 => self.start_block(now),
            (NAK, None) => {}
            _ => self.limit = now.plus_ms(self.config.zvz_ms),
        }
    }

    /// The answer to STX.
    pub(super) fn setup_answer(&mut self, now: Instant, byte: u8, error: Option<LineError>) {
        match (byte, error) {
            (STX, None) => self.collision(now),
            _ if self.config.ignore_early_answers && now < self.earliest_answer() => {}
            (DLE, None) => self.start_block(now),
            (NAK, None) => self.next_setup(now, Cause::Nak, Instant::ZERO),
            _ => {
                let burst_end = now.plus_ms(self.config.zvz_ms);
                if now < self.limit {
                    self.limit = burst_end;
                } else {
                    self.next_setup(now, wrong_answer(byte, error), burst_end);
                }
            }
        }
    }

    /// STX and the answer take a character time each: what comes before has left the partner
    /// before it saw STX, for instance a NAK that crosses STX.
    fn earliest_answer(&self) -> Instant {
        self.end_of_output()
            .plus_us(u64::from(self.config.character_us))
    }

    fn start_block(&mut self, now: Instant) {
        self.collisions = 0;
        self.flags.clear(Flag::STX);
        self.encoder = Encoder::START;
        self.state = self.sending_state();
        self.deadline = Instant::NEVER;
        self.limit = now;
    }

    fn collision(&mut self, now: Instant) {
        let gives_way = self.config.priority == Priority::Low
            || (self.config.collision == Collision::YieldOnRetry && self.setup > 1);
        if !self.flags.has(Flag::COLLIDED) {
            self.flags.set(Flag::COLLIDED);
            self.collisions = self.collisions.saturating_add(1);
            self.diagnose(Note::Collision(self.collisions));
            if self.collisions == 2 && !gives_way {
                self.diagnose(Note::SamePriority);
            }
        }
        if gives_way {
            self.flags.set(Flag::YIELDED);
            self.asked_to_receive(now);
        } else if self.config.collision == Collision::Repeat {
            self.next_setup(now, Cause::Collision, Instant::ZERO);
        } else {
            self.first_cause.get_or_insert(Cause::Collision);
        }
    }

    /// A character while the block goes out.
    pub(super) fn interrupted(&mut self, now: Instant, byte: u8, error: Option<LineError>) {
        if (byte, error) == (NAK, None) {
            self.next_transfer(now, Cause::Nak, Instant::ZERO);
        } else {
            self.flags.set(Flag::DISCARD);
            self.first_cause.get_or_insert(wrong_answer(byte, error));
            self.state = State::ResendQuiet;
            self.deadline = now.plus_ms(self.config.zvz_ms);
            self.limit = now.plus_us(self.config.babble_us());
        }
    }

    /// The answer to the block.
    pub(super) fn block_answer(&mut self, now: Instant, byte: u8, error: Option<LineError>) {
        match (byte, error) {
            (DLE, None) => {
                self.close(Note::Sent);
                self.go_idle(now);
            }
            (NAK, None) => self.next_transfer(now, Cause::Nak, Instant::ZERO),
            _ if now < self.end_of_output() => self.interrupted(now, byte, error),
            _ => {
                let burst_end = now.plus_ms(self.config.zvz_ms);
                self.next_transfer(now, wrong_answer(byte, error), burst_end);
            }
        }
    }

    pub(super) fn transmit_timeout(&mut self, now: Instant) {
        match self.state {
            State::AwaitDle if self.flags.has(Flag::STX) => {
                self.next_setup(now, Cause::Stalled, Instant::ZERO);
            }
            State::AwaitDle => self.next_setup(now, Cause::Timeout, Instant::ZERO),
            State::Sending | State::SendingOther => {
                self.next_transfer(now, Cause::Stalled, Instant::ZERO);
            }
            State::ResendQuiet => {
                // `fail` sends this NAK itself, and the cause was noted when the block stopped.
                if self.transfer < self.config.transfer_attempts {
                    self.replies.push(Reply::Nak);
                }
                self.next_transfer(now, Cause::Timeout, Instant::ZERO);
            }
            _ => self.next_transfer(now, Cause::Timeout, Instant::ZERO),
        }
    }
}

/// A character that is no answer, or a damaged one.
fn wrong_answer(byte: u8, error: Option<LineError>) -> Cause {
    error.map_or(Cause::Unexpected(byte), Cause::Line)
}
