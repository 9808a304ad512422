//! One request at a time.

use core::fmt;
use core::time::Duration;

use thiserror::Error;

use crate::command::{Light, STATUS_REQUEST};
use crate::lcd::LcdBlock;
use crate::number::{Key, Led, Position};
use crate::report::{DecodeError, EncodeError, Knob, LcdAnswer, Model, Report, Status, put};
use crate::time::Instant;

/// How long the driver waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_structs, reason = "plain settings")]
pub struct Timing {
    /// From the delivery of a request to its reply. Longer than the unit's own attempts take:
    /// 3 transfers, each of up to 3 set-ups and one acknowledgement of 128 ms, are 1536 ms.
    pub reply: Duration,
    /// From a status request that failed to the next.
    pub retry: Duration,
    /// From the last telegram of the unit to a status request that asks whether it is still
    /// there; `None` for never. A unit that was without power for less than that is not missed:
    /// it wakes up by this request, with an empty display.
    pub keep_alive: Option<Duration>,
}

impl Default for Timing {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Timing {
    /// Reply 2 s, retry 1 s, keep-alive 2 s.
    pub const DEFAULT: Self = Self {
        reply: Duration::from_secs(2),
        retry: Duration::from_secs(1),
        keep_alive: Some(Duration::from_secs(2)),
    };
}

/// What the driver was asked to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Job {
    /// A lamp.
    Led,
    /// A display block.
    Lcd,
}

/// Why a job was not done, as far as is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Failure {
    /// The transport gave the telegram up.
    #[error("the transport gave the telegram up")]
    Transport,
    /// The answer to the display block did not come.
    #[error("no answer within {0:?}")]
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    NoReply(Duration),
}

/// Why a job was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SubmitError {
    /// The job before has not ended.
    #[error("the job before has not ended")]
    Busy,
    /// The block or the lamp is another unit's.
    #[error(transparent)]
    Encode(#[from] EncodeError),
}

/// What came of a push into the driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Event {
    /// A key went down, or all are released.
    Key(Option<Key>),
    /// A knob was turned.
    Knob(Knob, Position),
    /// The status, asked for at start-up, after a failure, and to see whether the unit is there.
    Status {
        /// Keys and knobs.
        status: Status,
        /// The unit was not known to be there before. It may have lost its display and lamps.
        connected: bool,
    },
    /// The lamp is set.
    LedDone,
    /// The unit's word on the display block. The HBAS says it in its status.
    Lcd {
        /// The word.
        answer: LcdAnswer,
        /// The HBAS's status.
        status: Option<Status>,
    },
    /// A job may not have been done. A status request follows by itself, which resets the unit;
    /// what the display shows is not known.
    Failed(Job, Failure),
    /// The unit does not answer. Requests go on; the next [`Status`](Self::Status) tells when it
    /// is back.
    Lost,
    /// A telegram that means nothing.
    Unreadable(DecodeError),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Request {
    Status,
    Job(Job),
}

#[derive(Clone, Copy, Debug)]
enum State {
    /// Nothing is under way.
    Idle,
    /// The transport has a telegram.
    Transfer(Request),
    /// It is delivered, its reply is due.
    Reply(Request, Instant),
}

#[derive(Clone, Copy)]
enum Pending {
    Led(u8),
    Lcd(LcdBlock),
}

impl Pending {
    const fn job(&self) -> Job {
        match self {
            Self::Led(_) => Job::Led,
            Self::Lcd(_) => Job::Lcd,
        }
    }
}

/// Serialises requests to one unit and their replies, as both manuals advise: nothing goes out
/// between a status request and its reply, no display block before the answer to the one before,
/// and a status request after everything that failed.
///
/// After power-on the unit is dead until its status is asked for: that is the first request, and
/// it is repeated until the unit replies.
///
/// # Contract
/// The driver sits on a transport of whole telegrams, as a 3964R station is, and owns no clock.
/// Push [`handle_delivered`](Self::handle_delivered), [`handle_failed`](Self::handle_failed),
/// [`handle_block`](Self::handle_block) and [`handle_timeout`](Self::handle_timeout) when
/// something happens; each returns at most one event. Then, **while the transport receives
/// nothing**, pull [`poll_transmit`](Self::poll_transmit) and hand the telegram to the transport,
/// which answers exactly once with `handle_delivered` or `handle_failed`.
/// [`poll_timeout`](Self::poll_timeout) tells when to call `handle_timeout` and `poll_transmit`
/// next; too early does nothing, too late only delays.
///
/// Each job that was taken ends with exactly one [`Event::LedDone`], [`Event::Lcd`] or
/// [`Event::Failed`].
///
/// # Size
/// At most 256 bytes.
#[derive(Clone)]
#[expect(
    missing_copy_implementations,
    reason = "a copy would be a second driver of one unit"
)]
pub struct Driver {
    model: Model,
    timing: Timing,
    state: State,
    /// The job that waits or is under way.
    pending: Option<Pending>,
    /// The HBAS has a display block whose fate its next status tells; `must_poll` is set then.
    lcd_open: bool,
    /// The next status request; `None` for never.
    poll_at: Option<Instant>,
    /// A status request has to come before anything else.
    must_poll: bool,
    online: bool,
    dropped: u32,
}

impl Driver {
    /// A driver for a unit that may have been switched on just now.
    #[must_use]
    pub const fn new(model: Model, timing: Timing) -> Self {
        Self {
            model,
            timing,
            state: State::Idle,
            pending: None,
            lcd_open: false,
            poll_at: Some(Instant::ZERO),
            must_poll: true,
            online: false,
            dropped: 0,
        }
    }

    /// Whether the unit is taken to be there: from a status of it until [`Event::Lost`].
    #[must_use]
    pub const fn is_online(&self) -> bool {
        self.online
    }

    /// Whether a job would be taken.
    #[must_use]
    pub const fn is_ready(&self) -> bool {
        self.pending.is_none()
    }

    /// Whether a reply is due.
    #[must_use]
    pub const fn awaits_reply(&self) -> bool {
        matches!(self.state, State::Reply(..))
    }

    /// Answers to display blocks that came unasked, and were dropped.
    #[must_use]
    pub const fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Takes a lamp of the HBLS as the next job; `None` for all of them.
    ///
    /// # Errors
    /// [`SubmitError`]; the job before goes on.
    pub fn set_led(&mut self, led: Option<Led>, light: Light) -> Result<(), SubmitError> {
        let mut byte = [0; 1];
        crate::Command::Led { led, light }.encode(self.model, &mut byte)?;
        let [code] = byte;
        self.submit(Pending::Led(code))
    }

    /// Takes a display block as the next job.
    ///
    /// # Errors
    /// [`SubmitError`]; the job before goes on.
    pub fn send_lcd(&mut self, block: &LcdBlock) -> Result<(), SubmitError> {
        let model = self.model;
        if block.model() != model {
            return Err(EncodeError::Model { model }.into());
        }
        self.submit(Pending::Lcd(*block))
    }

    fn submit(&mut self, pending: Pending) -> Result<(), SubmitError> {
        if self.pending.is_some() {
            return Err(SubmitError::Busy);
        }
        self.pending = Some(pending);
        Ok(())
    }

    /// The next telegram for the transport, in the head of `buffer`, if it is time for one.
    ///
    /// [`MAX_COMMAND`](crate::MAX_COMMAND) bytes hold every telegram.
    ///
    /// # Errors
    /// [`EncodeError::NoRoom`]; the telegram is still to come then.
    pub fn poll_transmit<'b>(
        &mut self,
        now: Instant,
        buffer: &'b mut [u8],
    ) -> Result<Option<&'b [u8]>, EncodeError> {
        if !matches!(self.state, State::Idle) {
            return Ok(None);
        }
        let poll_is_due = self.poll_at.is_some_and(|due| due <= now);
        let (request, telegram) = match &self.pending {
            Some(Pending::Led(code)) if !self.must_poll => {
                (Request::Job(Job::Led), put(buffer, &[*code])?)
            }
            Some(Pending::Lcd(block)) if !self.must_poll => {
                (Request::Job(Job::Lcd), put(buffer, block.as_bytes())?)
            }
            _ if poll_is_due => (Request::Status, put(buffer, &[STATUS_REQUEST])?),
            _ => return Ok(None),
        };
        self.state = State::Transfer(request);
        Ok(Some(telegram))
    }

    /// The transport delivered the telegram.
    #[must_use]
    pub fn handle_delivered(&mut self, now: Instant) -> Option<Event> {
        let State::Transfer(request) = self.state else {
            return None;
        };
        match (request, self.model) {
            (Request::Job(Job::Led), _) => {
                self.state = State::Idle;
                self.pending = None;
                Some(Event::LedDone)
            }
            (Request::Job(Job::Lcd), Model::Hbas) => {
                self.lcd_open = true;
                self.poll(now);
                None
            }
            _ => {
                self.state = State::Reply(request, now + self.timing.reply);
                None
            }
        }
    }

    /// The transport gave the telegram up; it may have arrived all the same.
    #[must_use]
    pub fn handle_failed(&mut self, now: Instant) -> Option<Event> {
        match self.state {
            State::Transfer(request) => self.fail(now, request, Failure::Transport),
            _ => None,
        }
    }

    /// Time has passed.
    #[must_use]
    pub fn handle_timeout(&mut self, now: Instant) -> Option<Event> {
        match self.state {
            State::Reply(request, deadline) if deadline <= now => {
                self.fail(now, request, Failure::NoReply(self.timing.reply))
            }
            _ => None,
        }
    }

    /// When [`handle_timeout`](Self::handle_timeout) and
    /// [`poll_transmit`](Self::poll_transmit) are due next; it may lie in the past.
    #[must_use]
    pub const fn poll_timeout(&self) -> Option<Instant> {
        match self.state {
            State::Reply(_, deadline) => Some(deadline),
            State::Transfer(_) => None,
            State::Idle if self.pending.is_some() && !self.must_poll => Some(Instant::ZERO),
            State::Idle => self.poll_at,
        }
    }

    /// A telegram came from the unit.
    #[must_use]
    pub fn handle_block(&mut self, now: Instant, telegram: &[u8]) -> Option<Event> {
        let report = match Report::decode(self.model, telegram) {
            Ok(report) => report,
            Err(error) => return Some(Event::Unreadable(error)),
        };
        if !self.must_poll {
            self.poll_at = self.timing.keep_alive.map(|quiet| now + quiet);
        }
        match report {
            Report::Key(key) => Some(Event::Key(key)),
            Report::Knob { knob, position } => Some(Event::Knob(knob, position)),
            Report::Lcd(answer) => self.lcd_answer(answer, None),
            Report::Status(status) => self.status(now, status),
        }
    }

    fn status(&mut self, now: Instant, status: Status) -> Option<Event> {
        if matches!(self.state, State::Reply(Request::Status, _)) {
            self.state = State::Idle;
            self.must_poll = false;
            self.poll_at = self.timing.keep_alive.map(|quiet| now + quiet);
        }
        let connected = !self.online;
        self.online = true;
        if let Status::Hbas { lcd, .. } = status
            && self.lcd_open
        {
            return self.lcd_answer(lcd, Some(status));
        }
        Some(Event::Status { status, connected })
    }

    fn lcd_answer(&mut self, answer: LcdAnswer, status: Option<Status>) -> Option<Event> {
        let awaited = matches!(self.state, State::Reply(Request::Job(Job::Lcd), _));
        if !awaited && !self.lcd_open {
            self.dropped = self.dropped.saturating_add(1);
            return None;
        }
        if awaited {
            self.state = State::Idle;
        }
        self.lcd_open = false;
        self.pending = None;
        Some(Event::Lcd { answer, status })
    }

    /// The telegram or its reply is lost: the unit is asked for its status before anything else.
    fn fail(&mut self, now: Instant, request: Request, failure: Failure) -> Option<Event> {
        match request {
            Request::Job(job) => {
                self.poll(now);
                self.pending = None;
                Some(Event::Failed(job, failure))
            }
            Request::Status => {
                self.poll(now + self.timing.retry);
                if core::mem::take(&mut self.lcd_open) {
                    self.pending = None;
                    return Some(Event::Failed(Job::Lcd, failure));
                }
                core::mem::take(&mut self.online).then_some(Event::Lost)
            }
        }
    }

    const fn poll(&mut self, at: Instant) {
        self.state = State::Idle;
        self.must_poll = true;
        self.poll_at = Some(at);
    }
}

impl fmt::Debug for Driver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Driver")
            .field("model", &self.model)
            .field("state", &self.state)
            .field("pending", &self.pending.as_ref().map(Pending::job))
            .field("poll_at", &self.poll_at)
            .field("online", &self.online)
            .field("dropped", &self.dropped)
            .finish_non_exhaustive()
    }
}
