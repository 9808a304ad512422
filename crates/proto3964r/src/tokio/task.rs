//! A task that does jobs until its connection is lost.

use alloc::sync::Arc;
use core::future::{Future, pending};
use std::io;

use ::tokio::sync::{mpsc, oneshot, watch};
use thiserror::Error;

/// The connection is lost, and the task has ended.
#[derive(Clone, Debug, Error)]
#[error("the connection is lost: {0}")]
pub struct Lost(#[source] Arc<io::Error>);

impl From<io::Error> for Lost {
    fn from(error: io::Error) -> Self {
        Self(Arc::new(error))
    }
}

impl From<Lost> for Arc<io::Error> {
    fn from(lost: Lost) -> Self {
        lost.0
    }
}

impl Lost {
    /// What kind of error ended it; [`io::ErrorKind::UnexpectedEof`] when the other end closed it.
    #[must_use]
    pub fn kind(&self) -> io::ErrorKind {
        self.0.kind()
    }
}

/// A task that does one job after the other until its connection is lost, or this is dropped.
#[derive(Debug)]
pub struct Task<J> {
    jobs: mpsc::Sender<J>,
    lost: watch::Receiver<Option<Lost>>,
}

impl<J: Send> Task<J> {
    /// Starts `work`, which takes its jobs from the receiver and ends when that is closed.
    ///
    /// # Panics
    /// Outside of a runtime of tokio.
    pub fn spawn<W>(work: impl FnOnce(mpsc::Receiver<J>) -> W) -> Self
    where
        W: Future<Output = io::Result<()>> + Send + 'static,
    {
        let (jobs, queue) = mpsc::channel(1);
        let (end, lost) = watch::channel(None);
        let work = work(queue);
        ::tokio::spawn(async move {
            if let Err(error) = work.await {
                #[cfg(feature = "log")]
                log::error!("the connection is lost: {error}");
                end.send_replace(Some(error.into()));
            }
        });
        Self { jobs, lost }
    }

    /// Hands over a job, made with the one who waits for its outcome, and waits for that.
    ///
    /// # Errors
    /// [`Lost`] when the task has ended before.
    pub async fn ask<T>(&self, job: impl FnOnce(Caller<T>) -> J) -> Result<T, Lost> {
        let (reply, outcome) = oneshot::channel();
        if self.jobs.send(job(Caller(Some(reply)))).await.is_err() {
            return Err(self.lost().await);
        }
        match outcome.await {
            Ok(outcome) => Ok(outcome),
            Err(_) => Err(self.lost().await),
        }
    }

    /// Waits until the task has ended, and says why.
    pub async fn lost(&self) -> Lost {
        let mut lost = self.lost.clone();
        match lost.wait_for(Option::is_some).await.as_deref() {
            Ok(Some(lost)) => lost.clone(),
            _ => io::Error::other("the runtime has ended the task").into(),
        }
    }
}

/// The one who waits for the outcome of a job.
#[derive(Debug)]
pub struct Caller<T>(Option<oneshot::Sender<T>>);

impl<T> Caller<T> {
    /// Nobody.
    pub const NONE: Self = Self(None);

    /// Tells the outcome, once; nothing when the caller has dropped its future meanwhile.
    pub fn tell(&mut self, outcome: T) {
        if let Some(reply) = self.0.take() {
            reply.send(outcome).ok();
        }
    }

    /// Returns when the caller drops its future, once. May be dropped and called again.
    pub async fn gone(&mut self) {
        match &mut self.0 {
            Some(reply) => reply.closed().await,
            None => pending().await,
        }
        self.0 = None;
    }
}
