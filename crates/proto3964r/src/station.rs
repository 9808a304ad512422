//! One end of the line: what it is, its contract, and the user's side of it.

mod activity;
mod character;
#[cfg(test)]
mod explore;
mod output;
mod queue;
mod receive;
mod state;
#[cfg(test)]
mod tests;
mod timeout;
mod transmit;

use core::time::Duration;

use thiserror::Error;

pub use activity::Activity;
pub(crate) use queue::Note;

use self::{
    queue::{Notes, Replies, Reply},
    state::{Burst, Job, JobState, State},
};
use crate::{
    config::Config,
    event::{Cause, CharacterError, Event, Rejection},
    frame::Rules,
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
/// | [`handle_timeout`](Self::handle_timeout) | the time of `poll_timeout` has come |
/// | [`submit`](Self::submit), [`cancel`](Self::cancel) | the user wants it |
/// | [`accept`](Self::accept), [`refuse`](Self::refuse) | a telegram whose answer is held is safe, or cannot be made so |
///
/// | pull | what |
/// |---|---|
/// | [`poll_transmit`](Self::poll_transmit), [`poll_transmit_byte`](Self::poll_transmit_byte) | characters for the line |
/// | [`poll_event`](Self::poll_event) | telegrams, outcomes of jobs, diagnosis |
/// | [`poll_timeout`](Self::poll_timeout) | when to call `handle_timeout` |
///
/// After any push, call all three pullers, the first two until they give `None`, `poll_timeout`
/// last. An extra call is a no-op; a call of `handle_timeout` before its time is one too; a late
/// one only delays. No call takes longer than its bytes need.
///
/// Times are `Duration`s since an epoch of the caller, the same in all calls, and must not run
/// backwards. How fine the clock must be, [`Line`](crate::Line) says.
///
/// # Jobs
/// A station holds one job: from [`submit`](Self::submit) until its outcome has been polled. A job
/// waits while a telegram comes in, and survives an initialization conflict and a failed reception.
/// It ends with exactly one [`Event::Sent`] or [`Event::Failed`].
///
/// # The receive buffer
/// It is in use from the first STX until [`Event::Received`] has been polled. A partner that sends
/// in between is made to wait and then answered NAK, as the procedure wants it.
///
/// # Telegrams that are answered by the user
/// With [`Config::acknowledge_wait_ms`] a good block is not answered when it ends: `accept`, after
/// its [`Event::Received`] was polled, answers DLE, `refuse` and the end of that time NAK, on which
/// the partner repeats it. A user who stores what it accepts acknowledges nothing that it can lose.
///
/// # Size
/// At most `N + T + 168` bytes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Station<const N: usize, const T: usize = N> {
    config: Config,
    /// The configured ZVZ.
    zvz: Duration,
    state: State,
    job: Job,
    /// When the last character that was handed out begins to leave, at the earliest.
    leaving_at: Option<Duration>,
    /// What was handed out and is not on the line yet must not go there.
    discard: bool,
    replies: Replies,
    notes: Notes,
    /// Rejected receptions in a row.
    rejections: u8,
    /// Conflicts in a row that the partner did not settle.
    conflicts: u8,
    /// The receive buffer holds a telegram that has not been polled.
    holds_telegram: bool,
    rx: [u8; N],
    /// Length of the payload in the transmit buffer.
    tx_len: u16,
    tx: [u8; T],
}

/// What to do with the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
#[expect(clippy::exhaustive_enums, reason = "a driver must know all of them")]
pub enum Transmit<'o> {
    /// Drop what was handed out before and is not on the line yet: the block was broken off, and
    /// what follows must not come after its rest. Not on a [buffered](crate::Line::Buffered)
    /// line.
    Discard,
    /// Send these characters.
    Bytes(&'o [u8]),
}

/// Why a job was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SubmitError {
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
        let config = Config {
            // No gap at all would end a block between two of its characters.
            zvz_ms: config.zvz_ms.max(1),
            ..config
        };
        let mut replies = Replies::EMPTY;
        if config.nak_at_startup {
            replies.push(Reply::Nak);
        }
        Self {
            zvz: config.zvz(),
            config,
            state: State::Idle,
            job: Job::NONE,
            leaving_at: None,
            discard: false,
            replies,
            notes: Notes::EMPTY,
            rejections: 0,
            conflicts: 0,
            holds_telegram: false,
            rx: [0; N],
            tx_len: 0,
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
        matches!(self.state, State::Idle)
    }

    /// Whether a job is under way, or its outcome has not been polled.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.state != JobState::None
    }

    /// Takes a job. STX goes out at once when the line is idle, else after the reception.
    ///
    /// # Errors
    /// [`SubmitError::Busy`] until the outcome of the job before has been polled;
    /// [`SubmitError::TooLong`] above `T` bytes; [`SubmitError::Empty`] unless
    /// [`Config::allow_empty`].
    pub fn submit(&mut self, now: Duration, payload: &[u8]) -> Result<(), SubmitError> {
        let too_long = SubmitError::TooLong {
            len: payload.len(),
            capacity: T,
        };
        if self.is_busy() {
            return Err(SubmitError::Busy);
        }
        if payload.is_empty() && !self.config.allow_empty {
            return Err(SubmitError::Empty);
        }
        let len = u16::try_from(payload.len()).map_err(|_| too_long)?;
        self.tx
            .get_mut(..payload.len())
            .ok_or(too_long)?
            .copy_from_slice(payload);
        self.tx_len = len;
        self.handle_timeout(now);
        self.job = Job {
            state: JobState::Open,
            transmission_attempts: 1,
            ..Job::NONE
        };
        if self.is_idle() {
            self.request(now, Burst::NONE);
        }
        Ok(())
    }

    /// Gives the job up; `false` when there is none to give up.
    ///
    /// Its outcome is [`Event::Failed`] with [`Cause::Cancelled`] unless an error came before. A
    /// transmission under way ends with NAK, and the next one waits for ZVZ of silence, so that no
    /// answer to the one is taken for an answer to the other.
    ///
    /// Where that NAK comes in place of the BCC, a block that was damaged on its way may be taken
    /// for a good one: its BCC is NAK in one of 256 cases.
    pub fn cancel(&mut self, now: Duration) -> bool {
        self.handle_timeout(now);
        let had_job = self.job.is_open();
        if had_job {
            self.end_job(now, Cause::Cancelled);
        }
        had_job
    }

    /// Answers the telegram that was polled last with DLE; `false` when that is too late, because
    /// it has been answered NAK or the partner no longer waits: it comes again.
    ///
    /// For [`Config::acknowledge_wait_ms`]; otherwise nothing is held, and this is always `false`.
    #[must_use = "a telegram that is accepted too late comes again"]
    pub fn accept(&mut self, now: Duration) -> bool {
        let is_held = self.is_held(now);
        if is_held {
            self.acknowledge(now);
        }
        is_held
    }

    /// Answers the telegram that was polled last with NAK, as for [`accept`](Self::accept).
    pub fn refuse(&mut self, now: Duration) -> bool {
        let is_held = self.is_held(now);
        if is_held {
            self.reject(now, Rejection::Refused);
        }
        is_held
    }

    /// Whether the telegram that was polled last waits for its answer.
    fn is_held(&mut self, now: Duration) -> bool {
        self.handle_timeout(now);
        matches!(self.state, State::Held { .. }) && !self.holds_telegram
    }

    /// Takes a BREAK: the line is idle at once, a transmission under way fails.
    pub fn handle_break(&mut self, now: Duration) {
        self.handle_timeout(now);
        self.notes.diagnosis(Note::Break);
        if self.state.phase().is_some() {
            self.end_job(now, Cause::Break);
        }
        self.go_idle(now);
    }

    /// Takes characters from the line, in pieces of any size; returns how many.
    ///
    /// Less than all only when they end a telegram: poll it, and call again with the rest. Whoever
    /// calls again without having polled makes the partner wait.
    #[must_use = "the characters after a telegram are not taken"]
    pub fn handle_bytes(&mut self, now: Duration, bytes: &[u8]) -> usize {
        let held_telegram = self.holds_telegram;
        let mut rest = bytes;
        while let Some((&byte, after)) = rest.split_first() {
            self.handle_timeout(now);
            rest = match &self.state {
                State::Receiving { .. } | State::Spoiled { .. } => {
                    let taken = self.block_characters(now, rest);
                    rest.get(taken..).unwrap_or_default()
                }
                // Of characters that are waited out the last one counts.
                State::Noise { .. } | State::Interrupted { .. } => {
                    self.await_silence(now);
                    &[]
                }
                _ => {
                    self.character(now, byte, None);
                    after
                }
            };
            if self.holds_telegram && !held_telegram {
                break;
            }
        }
        bytes.len() - rest.len()
    }

    /// Takes one character from the line, as an interrupt handler has it.
    #[inline]
    pub fn handle_byte(&mut self, now: Duration, byte: u8) {
        // What nearly all characters are, first: one more byte of a good block, in time.
        if let State::Receiving { block, gap_at } = &mut self.state
            && now < *gap_at
            && let Some(next_gap_at) = now.checked_add(self.zvz)
            && block.push_data(byte, &mut self.rx)
        {
            *gap_at = next_gap_at;
        } else {
            self.handle_other_byte(now, byte);
        }
    }

    #[inline(never)]
    fn handle_other_byte(&mut self, now: Duration, byte: u8) {
        match self.state {
            // A bad block is swallowed no slower than it must.
            State::Spoiled {
                gap_at,
                noise_end_at,
                ..
            } if now < gap_at && now < noise_end_at => self.block_character(now, byte, None),
            _ => {
                self.handle_timeout(now);
                self.character(now, byte, None);
            }
        }
    }

    /// Takes one character that came in damaged.
    ///
    /// In a block the error is noted and the block rejected at its end; in place of an answer it
    /// is a wrong answer; in idle it is noise.
    pub fn handle_damaged(&mut self, now: Duration, byte: u8, error: CharacterError) {
        self.handle_timeout(now);
        self.character(now, byte, Some(error));
    }

    /// The next event, in the order in which they happened.
    #[must_use]
    pub fn poll_event(&mut self) -> Option<Event<'_>> {
        let note = self.take_note()?;
        Some(self.event(note))
    }

    /// Whether a telegram waits to be polled.
    #[cfg(any(
        feature = "embedded-io",
        feature = "embedded-io-async",
        feature = "std"
    ))]
    pub(crate) fn holds_telegram(&self) -> bool {
        self.holds_telegram
    }

    /// The first half of [`poll_event`](Self::poll_event), for loops that end with an event.
    pub(crate) fn take_note(&mut self) -> Option<Note> {
        self.notes.pop()
    }

    /// The second half.
    pub(crate) fn event(&mut self, note: Note) -> Event<'_> {
        let event = match note {
            Note::Received { len } => {
                self.holds_telegram = false;
                Event::Received(head(&self.rx, len))
            }
            Note::Sent => {
                self.job.state = JobState::None;
                let len = usize::from(self.tx_len);
                Event::Sent { len }
            }
            Note::Failed(failure) => {
                self.job.state = JobState::None;
                Event::Failed(failure)
            }
            Note::Rejected(rejection) => Event::Rejected(rejection),
            Note::Abandoned(abandoned) => Event::Abandoned(abandoned),
            Note::Conflict(in_a_row) => Event::Conflict { in_a_row },
            Note::SamePriority => Event::SamePriority,
            Note::Break => Event::Break,
        };
        #[cfg(feature = "log")]
        event.log();
        event
    }

    const fn rules(&self) -> Rules {
        Rules {
            check: self.config.check,
            illegal_dle: self.config.illegal_dle,
        }
    }

    /// The end of whatever was under way. A waiting job gets its turn.
    fn go_idle(&mut self, now: Duration) {
        self.state = State::Idle;
        self.rejections = 0;
        if self.job.is_open() {
            self.resume(now);
        }
    }
}

/// The first `len` bytes of a buffer that holds at least as many.
fn head(buffer: &[u8], len: u16) -> &[u8] {
    buffer.get(..usize::from(len)).unwrap_or_default()
}
