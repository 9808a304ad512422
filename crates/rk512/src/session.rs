//! A client's endpoint on a 3964R station: what goes between the two, in a task or a thread.

use alloc::{sync::Arc, vec::Vec};
use core::time::Duration;
use std::io;

use proto3964r::{Event as LineEvent, Failure};
use thiserror::Error;

use crate::{
    area::Area,
    client::{JobError, Outcome, SubmitError},
    command::{Command, RequestError},
    config::Config,
    endpoint::{Endpoint, Event},
    memory::Memory,
    source::DataSource,
};
#[cfg(feature = "tokio")]
use crate::{reaction::ReactionError, server::ServerEvent, telegram::is_reaction};

/// The longest job in bytes of data.
const MAX_JOB: usize = 4096;

/// Why a job over 3964R was not done, or not wholly.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum CallError {
    /// There is no such command.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// SEND writes whole words, up to 65535 of them.
    #[error("{len} bytes of data are no whole number of words, 65535 at most")]
    Words {
        /// Bytes of data.
        len: usize,
    },
    /// The client does not take such a job; it has room for 4096 bytes.
    #[error(transparent)]
    Refused(#[from] SubmitError),
    /// The job failed.
    #[error(transparent)]
    Failed(#[from] JobError),
    /// 3964R did not deliver a command of the job.
    #[error("command not delivered: {0}")]
    NotDelivered(#[source] Failure),
    /// The connection is lost.
    #[error("the connection is lost: {0}")]
    Lost(#[source] Arc<io::Error>),
}

/// The command of a SEND of these data.
pub(crate) fn send_command(area: Area, data: &[u8]) -> Result<Command, CallError> {
    let len = data.len();
    let words = u16::try_from(len / 2)
        .ok()
        .filter(|_| len.is_multiple_of(2))
        .ok_or(CallError::Words { len })?;
    Ok(Command::send(area, words)?)
}

/// A driver of a station.
pub(crate) trait Transport {
    /// Whether a telegram is under way, or its outcome has not been polled.
    fn is_busy(&self) -> bool;

    fn submit(&mut self, telegram: &[u8]) -> Result<(), proto3964r::SubmitError>;

    /// Takes the telegram back.
    fn cancel(&mut self);
}

/// The source of a side that serves nothing: what the partner asks for is refused.
pub(crate) type Nothing = Memory<'static, 0>;

/// One side of an RK512 line.
#[derive(Debug)]
pub(crate) struct Session<D> {
    endpoint: Endpoint<MAX_JOB>,
    served: D,
    /// Why the last telegram was not delivered.
    failure: Option<Failure>,
    #[cfg(feature = "tokio")]
    partner: PartnerJob,
}

/// What is to be told of the partner's last job.
#[cfg(feature = "tokio")]
#[derive(Debug, Default)]
struct PartnerJob {
    /// Its reaction waits for the user.
    held: Option<Command>,
    /// The telegram under way is a reaction.
    reaction_is_sent: bool,
    /// Whether the reaction was delivered.
    ended: Option<bool>,
}

impl Session<Nothing> {
    pub(crate) const fn new(config: Config) -> Self {
        Self::with_source(config, Memory::new([]))
    }
}

impl<D: DataSource> Session<D> {
    pub(crate) const fn with_source(config: Config, served: D) -> Self {
        Self {
            endpoint: Endpoint::new(config),
            served,
            failure: None,
            #[cfg(feature = "tokio")]
            partner: PartnerJob {
                held: None,
                reaction_is_sent: false,
                ended: None,
            },
        }
    }

    /// Whether a job runs.
    #[cfg(feature = "tokio")]
    pub(crate) const fn is_busy(&self) -> bool {
        self.endpoint.is_busy()
    }

    pub(crate) fn submit(&mut self, command: Command, data: &[u8]) -> Result<(), SubmitError> {
        self.endpoint.submit(command, data)
    }

    /// Gives the job up, whose outcome is to come.
    #[cfg(feature = "tokio")]
    pub(crate) fn cancel(&mut self, now: Duration) {
        self.endpoint.cancel(now);
    }

    /// Gives the job up; its outcome is not reported.
    #[cfg(feature = "blocking")]
    pub(crate) fn abandon(&mut self, now: Duration) {
        self.endpoint.cancel(now);
        while self.endpoint.poll_event().is_some() {}
    }

    /// Does what is due, hands the transport the next telegram, and returns how the job ended. Call
    /// it after each event and at the time of `poll_timeout`.
    ///
    /// # Errors
    /// A telegram that the transport refuses, which none of them is.
    pub(crate) fn step(
        &mut self,
        now: Duration,
        line: &mut impl Transport,
    ) -> io::Result<Option<Result<Vec<u8>, CallError>>> {
        self.endpoint.handle_timeout(now, &mut self.served);
        let mut result = None;
        while let Some(event) = self.endpoint.poll_event() {
            match event {
                Event::Own(outcome) => {
                    result = Some(match outcome {
                        Outcome::Sent { .. } => Ok(Vec::new()),
                        Outcome::Fetched { data, .. } => Ok(data.to_vec()),
                        Outcome::Failed { error, .. } => Err(match (error, self.failure.take()) {
                            (JobError::Transport, Some(failure)) => {
                                CallError::NotDelivered(failure)
                            }
                            (error, _) => error.into(),
                        }),
                    });
                }
                #[cfg(feature = "tokio")]
                Event::Partner(ServerEvent::Held(command)) => self.partner.held = Some(command),
                #[cfg(feature = "tokio")]
                Event::Partner(ServerEvent::Refused(_)) => self.partner.ended = Some(false),
                Event::Partner(_) => {}
            }
        }
        if self.endpoint.wants_recall() {
            line.cancel();
        }
        if !line.is_busy()
            && let Some(telegram) = self.endpoint.poll_transmit(now)
        {
            #[cfg(feature = "tokio")]
            {
                self.partner.reaction_is_sent = is_reaction(&telegram);
            }
            line.submit(&telegram).map_err(io::Error::other)?;
        }
        Ok(result)
    }

    /// The partner's job whose reaction waits for [`confirm`](Self::confirm), once.
    #[cfg(feature = "tokio")]
    pub(crate) const fn take_held(&mut self) -> Option<Command> {
        self.partner.held.take()
    }

    /// Whether the partner has the reaction to its last job, once, when that is known.
    #[cfg(feature = "tokio")]
    pub(crate) const fn take_ended(&mut self) -> Option<bool> {
        self.partner.ended.take()
    }

    /// Lets the reaction go out, or an error; `false` when that is too late.
    #[cfg(feature = "tokio")]
    pub(crate) fn confirm(&mut self, result: Result<(), ReactionError>) -> bool {
        self.partner.ended = None;
        self.endpoint.confirm(result, &mut self.served)
    }

    /// An event of the station.
    pub(crate) fn handle(&mut self, now: Duration, event: LineEvent<'_>) {
        let Self {
            endpoint,
            served,
            failure,
            ..
        } = self;
        match event {
            LineEvent::Received(block) => endpoint.handle_block(now, block, served),
            LineEvent::Sent { .. } => {
                endpoint.handle_delivered(now);
                #[cfg(feature = "tokio")]
                self.partner.reaction_ends(true);
            }
            LineEvent::Failed(cause) => {
                #[cfg(feature = "tokio")]
                self.partner.reaction_ends(false);
                *failure = Some(cause);
                endpoint.handle_failed(now, served);
            }
            _ => {}
        }
    }

    /// When [`step`](Self::step) is due next.
    pub(crate) fn poll_timeout(&self) -> Option<Duration> {
        self.endpoint.poll_timeout()
    }
}

#[cfg(feature = "tokio")]
impl PartnerJob {
    /// The telegram under way has ended.
    const fn reaction_ends(&mut self, is_delivered: bool) {
        if self.reaction_is_sent {
            self.reaction_is_sent = false;
            self.ended = Some(is_delivered);
        }
    }
}
