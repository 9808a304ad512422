//! One request at a time.

mod job;

use core::fmt;
use core::time::Duration;

pub use job::{Event, Failure, Job, SubmitError};

use crate::command::{Command, STATUS_REQUEST};
use crate::lcd::LcdBlock;
use crate::report::{LcdAnswer, Model, Report, Status};

/// How long the driver waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_structs, reason = "plain settings")]
pub struct Timeouts {
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

impl Default for Timeouts {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Timeouts {
    /// Reply 2 s, retry 1 s, keep-alive 2 s.
    pub const DEFAULT: Self = Self {
        reply: Duration::from_secs(2),
        retry: Duration::from_secs(1),
        keep_alive: Some(Duration::from_secs(2)),
    };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Request {
    Status,
    Led,
    Lcd,
}

#[derive(Clone, Copy, Debug)]
enum State {
    /// Nothing is under way.
    Idle,
    /// The transport has a telegram.
    Transfer(Request),
    /// It is delivered, its reply is due until then.
    Reply(Request, Duration),
}

/// A job that waits or is under way, as its telegram.
#[derive(Clone, Copy)]
enum Pending {
    Led([u8; 1]),
    Lcd(LcdBlock),
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
/// something happens, and pull [`poll_event`](Self::poll_event) after each. Then, **while the
/// transport receives nothing**, pull [`poll_transmit`](Self::poll_transmit) and hand the telegram
/// to the transport, which answers exactly once with `handle_delivered` or `handle_failed`.
/// [`poll_timeout`](Self::poll_timeout) says when to call `handle_timeout` and `poll_transmit`
/// next; too early does nothing, too late only delays. Times are `Duration`s since an epoch of the
/// caller and must not run backwards.
///
/// Each job that was taken ends with exactly one [`Event::LedDone`], [`Event::Lcd`] or
/// [`Event::Failed`]. Of other events that nobody polls the newest is kept.
///
/// # Size
/// At most 288 bytes.
#[derive(Clone)]
pub struct Driver {
    model: Model,
    timeouts: Timeouts,
    state: State,
    /// The job that waits or is under way.
    pending: Option<Pending>,
    /// The HBAS has a display block whose fate its next status reports; `must_poll` is set then.
    lcd_open: bool,
    /// The next status request; `None` for never.
    poll_at: Option<Duration>,
    /// A status request has to come before anything else.
    must_poll: bool,
    online: bool,
    dropped: u32,
    /// How the job ended.
    outcome: Option<Event>,
    /// What else happened.
    report: Option<Event>,
}

impl Driver {
    /// A driver for a unit that may have been switched on just now.
    #[must_use]
    pub const fn new(model: Model, timeouts: Timeouts) -> Self {
        Self {
            model,
            timeouts,
            state: State::Idle,
            pending: None,
            lcd_open: false,
            poll_at: Some(Duration::ZERO),
            must_poll: true,
            online: false,
            dropped: 0,
            outcome: None,
            report: None,
        }
    }

    /// Whether the unit is taken to be there: from a status of it until [`Event::Lost`].
    #[must_use]
    pub const fn is_online(&self) -> bool {
        self.online
    }

    /// Whether a job is under way, or its outcome has not been polled.
    #[must_use]
    pub const fn is_busy(&self) -> bool {
        self.pending.is_some() || self.outcome.is_some()
    }

    /// Answers to display blocks that came unasked, and were dropped.
    #[must_use]
    pub const fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Takes a job.
    ///
    /// # Errors
    /// [`SubmitError`]; the job before goes on.
    pub fn submit(&mut self, job: Job) -> Result<(), SubmitError> {
        if self.is_busy() {
            return Err(SubmitError::Busy);
        }
        let model = self.model;
        self.pending = Some(match job {
            Job::Led { led, state } => {
                let mut telegram = [0; 1];
                Command::Led { led, state }
                    .encode(model, &mut telegram)
                    .map_err(|_| SubmitError::Model { model })?;
                Pending::Led(telegram)
            }
            Job::Lcd(block) if block.model() == model => Pending::Lcd(block),
            Job::Lcd(_) => return Err(SubmitError::Model { model }),
        });
        Ok(())
    }

    /// The next telegram for the transport, if it is time for one.
    #[must_use]
    pub fn poll_transmit(&mut self, now: Duration) -> Option<&[u8]> {
        if !matches!(self.state, State::Idle) {
            return None;
        }
        let (request, telegram): (_, &[u8]) = match &self.pending {
            Some(Pending::Led(telegram)) if !self.must_poll => (Request::Led, telegram),
            Some(Pending::Lcd(block)) if !self.must_poll => (Request::Lcd, block.as_bytes()),
            _ if self.poll_at.is_some_and(|due| due <= now) => (Request::Status, &[STATUS_REQUEST]),
            _ => return None,
        };
        self.state = State::Transfer(request);
        Some(telegram)
    }

    /// What happened; how the job ended comes first.
    #[must_use]
    pub const fn poll_event(&mut self) -> Option<Event> {
        match self.outcome.take() {
            Some(outcome) => Some(outcome),
            None => self.report.take(),
        }
    }

    /// The transport delivered the telegram.
    pub const fn handle_delivered(&mut self, now: Duration) {
        let State::Transfer(request) = self.state else {
            return;
        };
        match (request, self.model) {
            (Request::Led, _) => {
                self.state = State::Idle;
                self.end(Event::LedDone);
            }
            (Request::Lcd, Model::Hbas) => {
                self.lcd_open = true;
                self.poll(now);
            }
            _ => self.state = State::Reply(request, now.saturating_add(self.timeouts.reply)),
        }
    }

    /// The transport gave the telegram up; it may have arrived all the same.
    pub const fn handle_failed(&mut self, now: Duration) {
        if let State::Transfer(request) = self.state {
            self.fail(now, request, Failure::Transport);
        }
    }

    /// Time has passed.
    pub fn handle_timeout(&mut self, now: Duration) {
        if let State::Reply(request, deadline) = self.state
            && deadline <= now
        {
            self.fail(now, request, Failure::NoReply(self.timeouts.reply));
        }
    }

    /// When [`handle_timeout`](Self::handle_timeout) and
    /// [`poll_transmit`](Self::poll_transmit) are due next; it may lie in the past.
    #[must_use]
    pub const fn poll_timeout(&self) -> Option<Duration> {
        match self.state {
            State::Reply(_, deadline) => Some(deadline),
            State::Transfer(_) => None,
            State::Idle if self.pending.is_some() && !self.must_poll => Some(Duration::ZERO),
            State::Idle => self.poll_at,
        }
    }

    /// A telegram came from the unit.
    pub fn handle_block(&mut self, now: Duration, telegram: &[u8]) {
        let report = match Report::decode(self.model, telegram) {
            Ok(report) => report,
            Err(error) => {
                self.report = Some(Event::Unreadable(error));
                return;
            }
        };
        if !self.must_poll {
            self.poll_later(now);
        }
        match report {
            Report::Key(key) => self.report = Some(Event::Key(key)),
            Report::RotarySwitch { switch, position } => {
                self.report = Some(Event::RotarySwitch(switch, position));
            }
            Report::Lcd(answer) => self.lcd_answer(answer, None),
            Report::Status(status) => self.status(now, status),
        }
    }

    fn status(&mut self, now: Duration, status: Status) {
        if matches!(self.state, State::Reply(Request::Status, _)) {
            self.state = State::Idle;
            self.must_poll = false;
            self.poll_later(now);
        }
        let connected = !core::mem::replace(&mut self.online, true);
        match status {
            Status::Hbas { lcd, .. } if self.lcd_open => self.lcd_answer(lcd, Some(status)),
            _ => self.report = Some(Event::Status { status, connected }),
        }
    }

    const fn lcd_answer(&mut self, answer: LcdAnswer, status: Option<Status>) {
        let awaited = matches!(self.state, State::Reply(Request::Lcd, _));
        if !awaited && !self.lcd_open {
            self.dropped = self.dropped.saturating_add(1);
            return;
        }
        if awaited {
            self.state = State::Idle;
        }
        self.lcd_open = false;
        self.end(Event::Lcd { answer, status });
    }

    /// The telegram or its reply is lost: the unit is asked for its status before anything else.
    const fn fail(&mut self, now: Duration, request: Request, failure: Failure) {
        match request {
            Request::Led | Request::Lcd => {
                self.poll(now);
                self.end(Event::Failed(failure));
            }
            Request::Status => {
                self.poll(now.saturating_add(self.timeouts.retry));
                if self.lcd_open {
                    self.lcd_open = false;
                    self.end(Event::Failed(failure));
                } else if self.online {
                    self.online = false;
                    self.report = Some(Event::Lost);
                }
            }
        }
    }

    /// The job has ended.
    const fn end(&mut self, outcome: Event) {
        self.pending = None;
        self.outcome = Some(outcome);
    }

    /// The status is asked for next.
    const fn poll(&mut self, at: Duration) {
        self.state = State::Idle;
        self.must_poll = true;
        self.poll_at = Some(at);
    }

    /// The unit is there: its status is asked for when it has been silent.
    fn poll_later(&mut self, now: Duration) {
        self.poll_at = self
            .timeouts
            .keep_alive
            .map(|quiet| now.saturating_add(quiet));
    }
}

impl fmt::Debug for Driver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Driver")
            .field("model", &self.model)
            .field("state", &self.state)
            .field("is_busy", &self.is_busy())
            .field("poll_at", &self.poll_at)
            .field("online", &self.online)
            .field("dropped", &self.dropped)
            .finish_non_exhaustive()
    }
}
