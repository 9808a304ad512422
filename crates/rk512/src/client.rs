//! The side that asks.

mod outcome;

use core::fmt;
use core::time::Duration;

pub use outcome::{JobError, Outcome, SubmitError};

use crate::command::{Command, Continuation};
use crate::config::Config;
use crate::reaction::{Reaction, ReactionFault};
use crate::telegram::{Part, Telegram};

#[derive(Clone, Copy, Debug)]
struct Job {
    command: Command,
    /// Bytes whose reaction has come.
    done: usize,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    /// The next telegram waits to be polled.
    Ready,
    /// The transport has it.
    Transfer,
    /// It is delivered, its reaction is due.
    Reaction { deadline: Duration },
}

#[derive(Clone, Copy, Debug)]
enum State {
    Idle,
    Running {
        job: Job,
        step: Step,
    },
    Ended {
        job: Job,
        result: Result<(), JobError>,
    },
}

/// The side that sends commands: one job at a time, with data of up to `N` bytes.
///
/// Memory: `N` bytes and at most 144 more.
///
/// # Contract
/// After every call, poll in this order until nothing comes:
/// [`poll_transmit`](Self::poll_transmit), [`poll_event`](Self::poll_event),
/// [`poll_timeout`](Self::poll_timeout). A poll too many does nothing. Times are `Duration`s since
/// an epoch of the caller and must not run backwards. [`handle_timeout`](Self::handle_timeout) too
/// early does nothing, too late only delays.
///
/// Each telegram that `poll_transmit` returns is one block for the transport, which answers
/// exactly once: [`handle_delivered`](Self::handle_delivered) or
/// [`handle_failed`](Self::handle_failed). Until then there is no other telegram, and a reaction
/// that comes before it is dropped: it belongs to something older.
///
/// Each job that was taken has exactly one [`Outcome`].
pub struct Client<const N: usize> {
    config: Config,
    buffer: [u8; N],
    state: State,
    /// The transport has a telegram, of this job or of a cancelled one.
    in_transfer: bool,
    /// No telegram before then: the pause after the last reaction.
    pause_until: Option<Duration>,
    dropped: u32,
}

impl<const N: usize> Client<N> {
    /// A client without a job.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            buffer: [0; N],
            state: State::Idle,
            in_transfer: false,
            pause_until: None,
            dropped: 0,
        }
    }

    /// Starts a job; `data` are those of a SEND (words, high byte first), empty for a FETCH.
    ///
    /// # Errors
    /// [`SubmitError`]; the running job goes on.
    pub fn submit(&mut self, command: Command, data: &[u8]) -> Result<(), SubmitError> {
        if !matches!(self.state, State::Idle) {
            return Err(SubmitError::Busy);
        }
        let (len, total) = (data.len(), command.byte_len());
        let expected = if command.is_send() { total } else { 0 };
        if len != expected {
            return Err(SubmitError::DataLength { len, expected });
        }
        if total > N {
            let (len, capacity) = (total, N);
            return Err(SubmitError::TooLong { len, capacity });
        }
        for (to, &from) in self.buffer.iter_mut().zip(data) {
            *to = from;
        }
        self.state = State::Running {
            job: Job { command, done: 0 },
            step: Step::Ready,
        };
        Ok(())
    }

    /// Gives the running job up; its outcome is [`JobError::Cancelled`]. Without one, does nothing.
    ///
    /// A telegram that the transport has stays there: the next job waits for its report.
    pub fn cancel(&mut self, now: Duration) {
        if let State::Running { job, step } = self.state {
            if matches!(step, Step::Reaction { .. }) {
                self.pause(now, self.config.resync);
            }
            self.end(job, Err(JobError::Cancelled));
        }
    }

    /// Whether a job runs or its outcome waits to be polled.
    #[must_use]
    pub const fn is_busy(&self) -> bool {
        !matches!(self.state, State::Idle)
    }

    /// Whether a reaction is due.
    pub(crate) const fn awaits_reaction(&self) -> bool {
        matches!(
            self.state,
            State::Running {
                step: Step::Reaction { .. },
                ..
            }
        )
    }

    /// Whether the telegram in the hands of the transport belongs to a cancelled job. A transport
    /// that can take it back should, and report [`handle_failed`](Self::handle_failed).
    #[must_use]
    pub const fn wants_recall(&self) -> bool {
        let transfer = matches!(
            self.state,
            State::Running {
                step: Step::Transfer,
                ..
            }
        );
        self.in_transfer && !transfer
    }

    /// Blocks dropped because no reaction was due.
    #[must_use]
    pub const fn dropped(&self) -> u32 {
        self.dropped
    }

    /// The next telegram for the transport, if it is time for one.
    #[must_use]
    pub fn poll_transmit(&mut self, now: Duration) -> Option<Telegram> {
        self.handle_timeout(now);
        let State::Running { job, step } = &mut self.state else {
            return None;
        };
        if !matches!(step, Step::Ready) || self.in_transfer || self.pause_until.is_some() {
            return None;
        }
        let (command, from) = (job.command, job.done);
        let data = if command.is_send() {
            self.buffer.get(from..from + command.chunk_after(from))?
        } else {
            &[]
        };
        let telegram = if from == 0 {
            command.telegram(data)
        } else {
            Continuation::new(command.request()).telegram(data)
        }
        .ok()?;
        *step = Step::Transfer;
        self.in_transfer = true;
        Some(telegram)
    }

    /// The transport delivered the telegram.
    pub fn handle_delivered(&mut self, now: Duration) {
        if !self.in_transfer {
            return;
        }
        self.in_transfer = false;
        match &mut self.state {
            State::Running { step, .. } if matches!(step, Step::Transfer) => {
                let deadline = now.saturating_add(self.config.reaction_time);
                *step = Step::Reaction { deadline };
            }
            // The telegram of a cancelled job: its reaction is to come and to be dropped.
            _ => self.pause(now, self.config.resync),
        }
    }

    /// The transport gave the telegram up; it may have arrived all the same.
    pub fn handle_failed(&mut self, now: Duration) {
        if !self.in_transfer {
            return;
        }
        self.in_transfer = false;
        self.pause(now, self.config.resync);
        if let State::Running { job, step } = self.state
            && matches!(step, Step::Transfer)
        {
            self.end(job, Err(JobError::Transport));
        }
    }

    /// A block came from the partner.
    pub fn handle_block(&mut self, now: Duration, block: &[u8]) {
        let State::Running {
            mut job,
            step: Step::Reaction { .. },
        } = self.state
        else {
            self.dropped = self.dropped.saturating_add(1);
            return;
        };
        let chunk = match expect_reaction(&job, block) {
            Ok(data) => data,
            Err(error) => {
                let pause = match error {
                    // The reaction that was due: no other is to come.
                    JobError::Refused(_) => self.config.quiet,
                    _ => self.config.resync,
                };
                self.pause(now, pause);
                self.end(job, Err(error));
                return;
            }
        };
        let room = self.buffer.iter_mut().skip(job.done);
        for (to, &from) in room.zip(chunk) {
            *to = from;
        }
        self.pause(now, self.config.quiet);
        job.done += job.command.chunk_after(job.done);
        if job.done >= job.command.byte_len() {
            self.end(job, Ok(()));
        } else {
            let step = Step::Ready;
            self.state = State::Running { job, step };
        }
    }

    /// Time has passed.
    pub fn handle_timeout(&mut self, now: Duration) {
        self.pause_until = self.pause_until.filter(|&until| now < until);
        if let State::Running { job, step } = self.state
            && let Step::Reaction { deadline } = step
            && deadline <= now
        {
            self.pause(now, self.config.resync);
            self.end(job, Err(JobError::NoReaction(self.config.reaction_time)));
        }
    }

    /// When [`handle_timeout`](Self::handle_timeout) and then
    /// [`poll_transmit`](Self::poll_transmit) are due next; it may lie in the past.
    #[must_use]
    pub fn poll_timeout(&self) -> Option<Duration> {
        match self.state {
            State::Running { step, .. } => match step {
                Step::Ready if !self.in_transfer => self.pause_until,
                Step::Reaction { deadline } => Some(deadline),
                Step::Ready | Step::Transfer => None,
            },
            State::Idle | State::Ended { .. } => None,
        }
    }

    /// How the job ended, once; then the client takes the next.
    #[must_use]
    pub fn poll_event(&mut self) -> Option<Outcome<'_>> {
        let State::Ended { job, result } = self.state else {
            return None;
        };
        self.state = State::Idle;
        let Job { command, done } = job;
        Some(match result {
            Err(error) => Outcome::Failed {
                command,
                error,
                done,
            },
            Ok(()) if command.is_send() => Outcome::Sent { command },
            Ok(()) => Outcome::Fetched {
                command,
                data: self.buffer.get(..done).unwrap_or_default(),
            },
        })
    }

    fn pause(&mut self, now: Duration, time: Duration) {
        if !time.is_zero() {
            self.pause_until = Some(now.saturating_add(time));
        }
    }

    fn end(&mut self, job: Job, result: Result<(), JobError>) {
        self.state = State::Ended { job, result };
    }
}

/// The data that the reaction to the job's last telegram brings.
fn expect_reaction<'a>(job: &Job, block: &'a [u8]) -> Result<&'a [u8], JobError> {
    let (reaction, data) = Reaction::decode(block).map_err(JobError::Reaction)?;
    let expected = if job.done == 0 {
        Part::First
    } else {
        Part::Continuation
    };
    let got = reaction.part;
    if got != expected {
        let fault = ReactionFault::OutOfStep { got, expected };
        return Err(JobError::Reaction(fault));
    }
    reaction.result.map_err(JobError::Refused)?;
    let len = data.len();
    let expected = job.command.chunk_after(job.done);
    let fault = match job.command.is_send() {
        true if len != 0 => ReactionFault::SendWithData { len },
        false if len != expected => ReactionFault::DataLength { len, expected },
        _ => return Ok(data),
    };
    Err(JobError::Reaction(fault))
}

impl<const N: usize> fmt::Debug for Client<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Client")
            .field("config", &self.config)
            .field("state", &self.state)
            .field("in_transfer", &self.in_transfer)
            .field("pause_until", &self.pause_until)
            .field("dropped", &self.dropped)
            .finish_non_exhaustive()
    }
}
