//! One end of the line.

mod compact;
#[cfg(test)]
mod explore;
mod receive;
mod report;
mod state;
#[cfg(test)]
mod tests;
mod transmit;

use thiserror::Error;

use self::{
    compact::{Flag, Flags, Note, Notes, Replies, Reply},
    state::{Job, State},
};
use crate::{
    ascii::DLE,
    config::Config,
    event::{Cause, LineError},
    frame::{Encoder, Progress, Rules},
    time::Instant,
};

/// One end of a 3964 or 3964R line.
///
/// `N` is the longest block that is received, `T` the longest that is sent, both at most 65535.
///
/// # The contract
/// A station owns no clock, port or thread. Push in what happens, then pull out what follows:
///
/// | push | when |
/// |---|---|
/// | [`handle_bytes`](Self::handle_bytes), [`handle_byte`](Self::handle_byte) | characters came in |
/// | [`handle_damaged`](Self::handle_damaged), [`handle_break`](Self::handle_break) | the receiver circuit saw an error |
/// | [`handle_timeout`](Self::handle_timeout) | the instant of `poll_timeout` has come |
/// | [`send`](Self::send), [`cancel`](Self::cancel) | the user wants it |
///
/// | pull | what |
/// |---|---|
/// | [`poll_transmit`](Self::poll_transmit), [`poll_transmit_byte`](Self::poll_transmit_byte) | characters for the line |
/// | [`poll_event`](Self::poll_event) | telegrams, outcomes of jobs, diagnosis |
/// | [`poll_timeout`](Self::poll_timeout) | when to call `handle_timeout` |
///
/// After any push, call all three pullers, the first two until they give `None`, `poll_timeout`
/// last. An extra call is a no-op; a call of `handle_timeout` before its time is one too; a late
/// one only delays. No call takes longer than its bytes need. Time must not run backwards.
///
/// # Jobs
/// A station holds one job: from [`send`](Self::send) until its outcome has been polled. A job
/// waits while a telegram comes in, and survives a collision and a failed reception. It ends with
/// exactly one [`Event::Sent`](crate::Event::Sent) or [`Event::Failed`](crate::Event::Failed).
///
/// # The receive buffer
/// It is in use from the first STX until [`Event::Received`](crate::Event::Received) has been
/// polled. A partner that sends in between is made to wait and then answered NAK, as the
/// procedure wants it.
///
/// # Size
/// At most `N + T + 96` bytes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Station<const N: usize, const T: usize = N> {
    /// What the state waits for; `NEVER` in idle.
    deadline: Instant,
    /// Receiving and quiet: the end of patience, whatever comes in. Waiting for DLE: the end of
    /// the burst that spoiled the attempt before. Sending: the end of the output so far.
    limit: Instant,
    config: Config,
    decoder: Progress,
    encoder: Encoder,
    notes: Notes,
    dropped_notes: u8,
    replies: Replies,
    state: State,
    job: Job,
    /// STX in this transfer attempt.
    setup: u8,
    /// Transfer attempts of the job.
    transfer: u8,
    /// First error of the job.
    first_cause: Option<Cause>,
    /// Rejected receptions in a row.
    rejections: u8,
    /// Collisions in a row.
    collisions: u8,
    /// First damage of the block that is coming in.
    line_error: Option<LineError>,
    /// First character of the noise that is being waited out.
    noise: u8,
    flags: Flags,
    rx_len: u16,
    tx_len: u16,
    rx: [u8; N],
    tx: [u8; T],
}

/// What to do with the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
#[expect(clippy::exhaustive_enums, reason = "a driver must know all of them")]
pub enum Transmit<'o> {
    /// Drop what was handed out before and is not on the line yet: the block was aborted, and
    /// what follows must not stand behind its rest.
    Discard,
    /// Send these characters.
    Bytes(&'o [u8]),
}

/// Why a job was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SendError {
    /// The outcome of the job before has not been polled.
    #[error("the outcome of the job before has not been polled")]
    Busy,
    /// The payload does not fit into the transmit buffer.
    #[error("the payload has {len} bytes, the transmit buffer holds {capacity}")]
    TooLong {
        /// Bytes of the payload.
        len: usize,
        /// Bytes of the transmit buffer.
        capacity: usize,
    },
    /// Empty blocks are switched off.
    #[error("the payload is empty")]
    Empty,
}

impl<const N: usize> Station<N, N> {
    /// A station with buffers of the same size for both directions.
    ///
    /// With [`Config::nak_at_startup`] it has one NAK to send.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self::with_buffers(config)
    }
}

impl<const N: usize, const T: usize> Station<N, T> {
    /// A station with buffers of different sizes.
    #[must_use]
    pub fn with_buffers(config: Config) -> Self {
        const {
            assert!(
                N <= 65535 && T <= 65535,
                "a block holds at most 65535 bytes"
            );
        }
        let mut replies = Replies::EMPTY;
        if config.nak_at_startup {
            replies.push(Reply::Nak);
        }
        Self {
            deadline: Instant::NEVER,
            limit: Instant::NEVER,
            decoder: Progress::START,
            encoder: Encoder::START,
            config: Config {
                // No gap at all would end a block between two of its characters.
                zvz_ms: config.zvz_ms.max(1),
                ..config
            },
            notes: Notes::default(),
            dropped_notes: 0,
            replies,
            state: State::Idle,
            job: Job::None,
            setup: 0,
            transfer: 0,
            first_cause: None,
            rejections: 0,
            collisions: 0,
            line_error: None,
            noise: 0,
            flags: Flags::default(),
            rx_len: 0,
            tx_len: 0,
            rx: [0; N],
            tx: [0; T],
        }
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Whether neither a transmission nor a reception is under way.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.state == State::Idle
    }

    /// Whether [`send`](Self::send) would take a job.
    #[must_use]
    pub fn can_send(&self) -> bool {
        self.job == Job::None
    }

    /// Takes a job. STX goes out at once when the line is idle, else after the reception.
    ///
    /// # Errors
    /// [`SendError::Busy`] until the outcome of the job before has been polled;
    /// [`SendError::TooLong`] above `T` bytes; [`SendError::Empty`] unless
    /// [`Config::allow_empty`].
    pub fn send(&mut self, now: Instant, payload: &[u8]) -> Result<(), SendError> {
        let too_long = SendError::TooLong {
            len: payload.len(),
            capacity: T,
        };
        if self.job != Job::None {
            return Err(SendError::Busy);
        }
        if payload.is_empty() && !self.config.allow_empty {
            return Err(SendError::Empty);
        }
        let len = u16::try_from(payload.len()).map_err(|_| too_long)?;
        self.tx
            .get_mut(..payload.len())
            .ok_or(too_long)?
            .copy_from_slice(payload);
        if let Some(behind) = self.tx.get_mut(payload.len()) {
            *behind = DLE; // where `Encoder::next_plain` stops
        }
        self.handle_timeout(now);
        self.tx_len = len;
        self.job = Job::Open;
        self.setup = 0;
        self.transfer = 1;
        self.first_cause = None;
        self.flags.clear(Flag::YIELDED);
        if self.state == State::Idle {
            self.start_setup(now, Instant::ZERO);
        }
        Ok(())
    }

    /// Gives the job up; `false` when there is none to give up.
    ///
    /// Its outcome is [`Event::Failed`](crate::Event::Failed) with [`Cause::Cancelled`] unless an error came before.
    /// A transmission under way ends with NAK.
    pub fn cancel(&mut self, now: Instant) -> bool {
        self.handle_timeout(now);
        if self.job != Job::Open {
            return false;
        }
        self.end_job(now, Cause::Cancelled);
        true
    }

    /// Takes a BREAK: the line is idle at once, a transmission under way fails.
    pub fn handle_break(&mut self, now: Instant) {
        self.handle_timeout(now);
        self.diagnose(Note::Break);
        if self.state.is_job() {
            self.end_job(now, Cause::Break);
        } else {
            self.go_idle(now);
        }
    }

    /// Takes characters from the line, in pieces of any size.
    ///
    /// Call [`poll_transmit`](Self::poll_transmit), [`poll_event`](Self::poll_event) and
    /// [`poll_timeout`](Self::poll_timeout) afterwards.
    pub fn handle_bytes(&mut self, now: Instant, bytes: &[u8]) {
        let mut rest = bytes;
        while !rest.is_empty() {
            self.handle_timeout(now);
            rest = if self.state.is_receiving() {
                self.receive_block(now, rest)
            } else {
                let Some((&byte, behind)) = rest.split_first() else {
                    return;
                };
                self.character(now, byte, None);
                behind
            };
        }
    }

    /// Takes one character from the line, as an interrupt handler has it.
    #[inline]
    pub fn handle_byte(&mut self, now: Instant, byte: u8) {
        // One condition at a time: the compiler makes one branch of each, and nothing else.
        if self.state != State::Receiving {
            return self.handle_other_byte(now, byte);
        }
        if now >= self.deadline {
            return self.handle_other_byte(now, byte);
        }
        if byte == DLE {
            return self.handle_other_byte(now, byte);
        }
        if self.decoder.push_plain(byte, &mut self.rx) {
            let zvz_us = u64::from(self.config.zvz_ms) * 1000;
            self.deadline = now.plus_us_unchecked_end(zvz_us);
        } else {
            self.handle_other_byte(now, byte);
        }
    }

    /// Anything but one more data byte.
    #[cold]
    #[inline(never)]
    fn handle_other_byte(&mut self, now: Instant, byte: u8) {
        self.handle_timeout(now);
        self.character(now, byte, None);
    }

    /// Takes one character that came in damaged.
    ///
    /// In a block the error is noted and the block rejected at its end; in place of an answer it
    /// is a wrong answer; in idle it is noise.
    pub fn handle_damaged(&mut self, now: Instant, byte: u8, error: LineError) {
        self.handle_timeout(now);
        self.character(now, byte, Some(error));
    }

    /// Does what is due at `now`; nothing when nothing is.
    #[inline]
    pub fn handle_timeout(&mut self, now: Instant) {
        if now >= self.deadline || self.state.has_other_due() {
            self.handle_due(now);
        }
    }

    fn handle_due(&mut self, now: Instant) {
        if self.state == State::WaitBuffer && !self.flags.has(Flag::RX_FULL) {
            self.invite(now);
        } else if self.poll_timeout().is_some_and(|due| due <= now) {
            match self.state {
                State::Idle => {}
                State::WaitBuffer
                | State::Receiving
                | State::ReceivingOther
                | State::AwaitRepeat
                | State::NoiseQuiet => {
                    self.receive_timeout(now);
                }
                State::AwaitDle
                | State::Sending
                | State::SendingOther
                | State::ResendQuiet
                | State::AwaitAck => {
                    self.transmit_timeout(now);
                }
            }
        }
    }

    /// When [`handle_timeout`](Self::handle_timeout) must be called; an instant in the past means
    /// at once, `None` means that only a push can change anything.
    ///
    /// Changes after every push, after [`poll_transmit`](Self::poll_transmit), and after
    /// [`Event::Received`](crate::Event::Received) was polled.
    #[must_use]
    pub fn poll_timeout(&self) -> Option<Instant> {
        let due = match self.state {
            State::Idle => return None,
            State::WaitBuffer if !self.flags.has(Flag::RX_FULL) => Instant::ZERO,
            State::Sending | State::SendingOther => self.limit.plus_ms(self.config.qvz_ms),
            State::ReceivingOther | State::NoiseQuiet | State::ResendQuiet => {
                self.deadline.min(self.limit)
            }
            _ => self.deadline,
        };
        Some(due)
    }

    const fn rules(&self) -> Rules {
        Rules {
            check: self.config.check,
            illegal_dle: self.config.illegal_dle,
        }
    }

    /// One character, in any state.
    fn character(&mut self, now: Instant, byte: u8, error: Option<LineError>) {
        match self.state {
            State::Receiving | State::ReceivingOther => {
                if error.is_some() {
                    self.line_error = self.line_error.or(error);
                }
                self.receive_byte(now, byte);
            }
            State::Idle | State::AwaitRepeat => self.idle_character(now, byte, error),
            State::WaitBuffer => self.waiting_character(now, byte, error),
            State::NoiseQuiet | State::ResendQuiet => {
                self.deadline = now.plus_ms(self.config.zvz_ms);
            }
            State::AwaitDle if self.flags.has(Flag::STX) => self.early_character(now, byte, error),
            State::AwaitDle => self.setup_answer(now, byte, error),
            State::Sending | State::SendingOther => self.interrupted(now, byte, error),
            State::AwaitAck => self.block_answer(now, byte, error),
        }
    }

    /// The end of whatever was under way. A waiting job gets its turn.
    fn go_idle(&mut self, now: Instant) {
        self.state = State::Idle;
        self.deadline = Instant::NEVER;
        self.limit = Instant::NEVER;
        self.rejections = 0;
        if self.job == Job::Open {
            self.resume(now);
        }
    }
}
