//! A job of the partner whose reaction waits for the user.

use core::future::pending;

use ::tokio::sync::oneshot;

use crate::{command::Command, reaction::ReactionError};

/// A job of the partner that the source [holds](crate::DataSource::holds): the partner waits for
/// its reaction. Dropping it has the partner hear [`ReactionError::JobFailed`].
#[derive(Debug)]
pub struct HeldJob {
    command: Command,
    answer: oneshot::Sender<Answer>,
}

/// What the user says of a job.
#[derive(Debug)]
struct Answer {
    result: Result<(), ReactionError>,
    /// Who wants to know whether the partner has the reaction.
    delivered: oneshot::Sender<bool>,
}

/// The task's end of a job that is held.
#[derive(Debug)]
pub(super) struct Holding {
    answer: Option<oneshot::Receiver<Answer>>,
    delivered: Option<oneshot::Sender<bool>>,
}

impl Holding {
    pub(super) const NOTHING: Self = Self {
        answer: None,
        delivered: None,
    };

    /// Waits from now on for what becomes of this job.
    pub(super) fn about(&mut self, command: Command) -> HeldJob {
        let (answer, is_answered) = oneshot::channel();
        *self = Self {
            answer: Some(is_answered),
            delivered: None,
        };
        HeldJob { command, answer }
    }

    /// Returns when the job is answered. May be dropped and called again.
    pub(super) async fn answered(&mut self) -> Result<(), ReactionError> {
        let answer = match &mut self.answer {
            Some(answer) => answer.await.ok(),
            None => pending().await,
        };
        self.answer = None;
        let (result, delivered) = match answer {
            Some(answer) => (answer.result, Some(answer.delivered)),
            None => (Err(ReactionError::JobFailed), None),
        };
        self.delivered = delivered;
        result
    }

    /// Whether the partner has the reaction is known. One that was not answered is void.
    pub(super) fn ends(&mut self, is_delivered: bool) {
        self.answer = None;
        if let Some(delivered) = self.delivered.take() {
            delivered.send(is_delivered).ok();
        }
    }
}

impl HeldJob {
    /// What the partner asked for.
    #[must_use]
    pub const fn command(&self) -> Command {
        self.command
    }

    /// Lets the reaction go out. `true` when the partner has acknowledged it; `false` when it may
    /// not have it, and may ask for the same again.
    pub async fn accept(self) -> bool {
        self.answer(Ok(())).await
    }

    /// Refuses the job with an error; returns when the partner knows, or cannot be told.
    pub async fn refuse(self, error: ReactionError) -> bool {
        self.answer(Err(error)).await
    }

    /// Whether another command has ended it.
    pub(super) fn is_void(&self) -> bool {
        self.answer.is_closed()
    }

    async fn answer(self, result: Result<(), ReactionError>) -> bool {
        let (delivered, is_delivered) = oneshot::channel();
        let sent = self.answer.send(Answer { result, delivered });
        sent.is_ok() && is_delivered.await.unwrap_or(false)
    }
}
