//! The side that answers.

use core::time::Duration;

use crate::command::{Command, CommandError, Continuation};
use crate::config::Config;
use crate::reaction::{Reaction, ReactionError};
use crate::source::DataSource;
use crate::telegram::{Part, SHORT_HEADER, Telegram, is_continuation};

/// Why a job that had begun was given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum AbandonCause {
    /// The continuation did not come in time.
    NoContinuation,
    /// The partner began another job.
    NewCommand,
    /// The transport could not deliver a reaction.
    Transport,
}

/// What became of a partner's command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ServerEvent {
    /// All data moved; the last reaction waits for [`Server::confirm`].
    Held(Command),
    /// All data moved; the last reaction waits for the transport.
    Served(Command),
    /// It was refused with [`CommandError::reaction`].
    Refused(CommandError),
    /// It had begun and does not go on.
    Abandoned(Command, AbandonCause),
}

#[derive(Clone, Copy, Debug)]
struct Job {
    command: Command,
    /// Bytes that have moved.
    done: usize,
}

/// The side that answers commands from a [`DataSource`], which every call gets again.
///
/// Memory: at most 288 bytes, whatever the length of the jobs: data go straight to the source.
///
/// # Contract
/// After every call, poll in this order until nothing comes:
/// [`poll_transmit`](Self::poll_transmit), [`poll_event`](Self::poll_event),
/// [`poll_timeout`](Self::poll_timeout). A poll too many does nothing.
/// [`handle_timeout`](Self::handle_timeout) too early does nothing, too late only delays.
///
/// Each telegram that `poll_transmit` returns is one block for the transport, which answers
/// exactly once: [`handle_delivered`](Self::handle_delivered) or
/// [`handle_failed`](Self::handle_failed).
///
/// A command that comes before the reaction to the last one is delivered ends that one's job and
/// earns [`ReactionError::Synchronisation`](crate::ReactionError::Synchronisation); a reaction that
/// the transport has not taken yet is replaced by it, one that it has should be
/// [taken back](Self::wants_recall). A first telegram in the middle of a job
/// begins again: the partner has lost a reaction and given its old job up.
#[derive(Debug)]
pub struct Server {
    config: Config,
    job: Option<Job>,
    /// The job ends then; set while a continuation is due.
    deadline: Option<Duration>,
    reaction: Option<Telegram>,
    /// Whose last reaction that is, which waits to be confirmed.
    held: Option<Command>,
    in_transfer: bool,
    event: Option<ServerEvent>,
}

impl Server {
    /// A server without a job.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            job: None,
            deadline: None,
            reaction: None,
            held: None,
            in_transfer: false,
            event: None,
        }
    }

    /// Whether a command of several telegrams is under way.
    #[must_use]
    pub const fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Whether a reaction waits for the transport or for the transport's report.
    const fn owes_reaction(&self) -> bool {
        self.reaction.is_some() || self.in_transfer
    }

    /// Whether the reaction in the hands of the transport is out of date: the partner's next
    /// command came before its delivery was reported. A transport that can take it back should,
    /// and report [`handle_failed`](Self::handle_failed); else a repeat of it may pass for the
    /// reaction to that command.
    #[must_use]
    pub const fn wants_recall(&self) -> bool {
        self.in_transfer && self.reaction.is_some()
    }

    /// The reaction for the transport, if there is one.
    #[must_use]
    pub fn poll_transmit(&mut self) -> Option<Telegram> {
        if self.in_transfer || self.held.is_some() {
            return None;
        }
        let reaction = self.reaction.take()?;
        self.in_transfer = true;
        Some(reaction)
    }

    /// The transport delivered the reaction.
    pub fn handle_delivered(&mut self, now: Duration) {
        if !self.in_transfer {
            return;
        }
        self.in_transfer = false;
        let deadline = now.saturating_add(self.config.continuation_time);
        self.deadline = self.job.map(|_| deadline);
    }

    /// The transport gave the reaction up: the partner will not go on.
    pub fn handle_failed<D: DataSource + ?Sized>(&mut self, source: &mut D) {
        if !self.in_transfer {
            return;
        }
        self.in_transfer = false;
        self.abandon(source, AbandonCause::Transport);
    }

    /// Ends the job that the source [holds](DataSource::holds): its last reaction goes out, or this
    /// error in place of it. `false`: nothing is held, or no longer, since the partner's next
    /// command came before.
    ///
    /// Without this call the reaction never comes; the partner waits for its reaction monitoring
    /// time.
    pub fn confirm<D: DataSource + ?Sized>(
        &mut self,
        result: Result<(), ReactionError>,
        source: &mut D,
    ) -> bool {
        let Some(command) = self.held.take() else {
            return false;
        };
        if result.is_err() {
            source.abort(&command);
        }
        self.event = Some(match result.and_then(|()| source.close(&command)) {
            Ok(()) => ServerEvent::Served(command),
            Err(error) => {
                let part = match &self.reaction {
                    Some(reaction) if is_continuation(reaction) => Part::Continuation,
                    _ => Part::First,
                };
                let result = Err(error);
                self.reaction = Some(Telegram::with_room(Reaction { part, result }.encode(), 0));
                ServerEvent::Refused(CommandError::Refused(error))
            }
        });
        true
    }

    /// A block came from the partner: it is executed and its reaction made.
    pub fn handle_block<D: DataSource + ?Sized>(&mut self, block: &[u8], source: &mut D) {
        self.deadline = None;
        let part = if is_continuation(block) {
            Part::Continuation
        } else {
            Part::First
        };
        let answer = if self.owes_reaction() {
            Err(CommandError::ReactionPending)
        } else if part == Part::First {
            self.begin(block, source)
        } else {
            self.go_on(block, source)
        };
        self.reaction = Some(match answer {
            Ok(reaction) => reaction,
            Err(error) => {
                let begun = self.job.take().map(|job| job.command);
                if let Some(command) = self.held.take().or(begun) {
                    source.abort(&command);
                }
                self.event = Some(ServerEvent::Refused(error));
                let result = Err(error.reaction());
                Telegram::with_room(Reaction { part, result }.encode(), 0)
            }
        });
    }

    /// Time has passed.
    pub fn handle_timeout<D: DataSource + ?Sized>(&mut self, now: Duration, source: &mut D) {
        if self.deadline.is_some_and(|deadline| deadline <= now) {
            self.abandon(source, AbandonCause::NoContinuation);
        }
    }

    /// When [`handle_timeout`](Self::handle_timeout) is due next.
    #[must_use]
    pub const fn poll_timeout(&self) -> Option<Duration> {
        self.deadline
    }

    /// The newest event, once; one that was not polled is replaced by the next.
    #[must_use]
    pub const fn poll_event(&mut self) -> Option<ServerEvent> {
        self.event.take()
    }

    fn abandon<D: DataSource + ?Sized>(&mut self, source: &mut D, cause: AbandonCause) {
        self.deadline = None;
        if let Some(Job { command, .. }) = self.job.take() {
            source.abort(&command);
            self.event = Some(ServerEvent::Abandoned(command, cause));
        }
    }

    fn begin<D: DataSource + ?Sized>(
        &mut self,
        block: &[u8],
        source: &mut D,
    ) -> Result<Telegram, CommandError> {
        self.abandon(source, AbandonCause::NewCommand);
        let (command, data) = Command::decode(block)?;
        let size = source.size(&command).map_err(CommandError::Refused)?;
        check_within(command, size)?;
        source.open(&command).map_err(CommandError::Refused)?;
        let job = Job { command, done: 0 };
        self.job = Some(job);
        self.advance(job, Part::First, data, source)
    }

    fn go_on<D: DataSource + ?Sized>(
        &mut self,
        block: &[u8],
        source: &mut D,
    ) -> Result<Telegram, CommandError> {
        let (continuation, data) = Continuation::decode(block)?;
        let job = self.job.ok_or(CommandError::NothingToContinue)?;
        let [value, kind] = continuation.request().codes();
        let [first, first_kind] = job.command.request().codes();
        if value != first {
            return Err(CommandError::OtherRequest { value, first });
        }
        if kind != first_kind {
            let (value, first) = (kind, first_kind);
            return Err(CommandError::OtherAreaKind { value, first });
        }
        let (len, expected) = (data.len(), job.command.chunk_after(job.done));
        if job.command.is_send() && len != expected {
            return Err(CommandError::ContinuationDataLength { len, expected });
        }
        self.advance(job, Part::Continuation, data, source)
    }

    /// Moves the data of one telegram and makes its reaction.
    fn advance<D: DataSource + ?Sized>(
        &mut self,
        Job { command, done }: Job,
        part: Part,
        data: &[u8],
        source: &mut D,
    ) -> Result<Telegram, CommandError> {
        let chunk = command.chunk_after(done);
        let result = Ok(());
        let room = if command.is_send() { 0 } else { chunk };
        let mut reaction = Telegram::with_room(Reaction { part, result }.encode(), room);
        if command.is_send() {
            source.write(&command, done, data)
        } else {
            source.read(&command, done, reaction.after_mut(SHORT_HEADER))
        }
        .map_err(CommandError::Refused)?;
        let done = done + chunk;
        if done < command.byte_len() {
            self.job = Some(Job { command, done });
        } else {
            self.job = None;
            self.event = Some(if source.holds(&command) {
                self.held = Some(command);
                ServerEvent::Held(command)
            } else {
                source.close(&command).map_err(CommandError::Refused)?;
                ServerEvent::Served(command)
            });
        }
        Ok(reaction)
    }
}

fn check_within(command: Command, size: usize) -> Result<(), CommandError> {
    let start = command.area().start();
    if usize::from(start) >= size {
        return Err(CommandError::Start { start, size });
    }
    let end = usize::from(start) + usize::from(command.length());
    if end > size {
        return Err(CommandError::End { end, size });
    }
    Ok(())
}
