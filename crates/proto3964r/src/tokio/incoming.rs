//! A telegram whose user answers it.

use alloc::vec::Vec;
use core::{future::pending, mem};

use ::tokio::sync::oneshot;

/// A telegram that [`Link::incoming`](super::Link::incoming) has handed out.
///
/// With [`Config::acknowledge_wait_ms`](crate::Config::acknowledge_wait_ms) the partner waits for
/// its answer: [`accept`](Self::accept) acknowledges it; [`refuse`](Self::refuse), or dropping it,
/// has the partner repeat it, and so has the end of that time. Otherwise it has been acknowledged.
#[derive(Debug)]
pub struct Incoming {
    telegram: Vec<u8>,
    /// Takes who wants to know whether the acknowledgement came in time; `None` where the station
    /// has acknowledged it by itself.
    accepting: Option<oneshot::Sender<Accepted>>,
}

/// The receiver of the news whether the acknowledgement came in time.
pub(super) type Accepted = oneshot::Sender<bool>;

/// The task's end of a telegram that is held.
#[derive(Debug)]
pub(super) struct Decision(Option<oneshot::Receiver<Accepted>>);

impl Decision {
    /// Nothing is held.
    pub(super) const NONE: Self = Self(None);

    /// Waits from now on for what becomes of this telegram.
    pub(super) fn about(&mut self, telegram: Vec<u8>) -> Incoming {
        let (accepting, decision) = oneshot::channel();
        self.0 = Some(decision);
        Incoming {
            telegram,
            accepting: Some(accepting),
        }
    }

    /// Returns when the telegram is accepted, or refused: `None`. May be dropped and called again.
    pub(super) async fn made(&mut self) -> Option<Accepted> {
        let made = match &mut self.0 {
            Some(decision) => decision.await.ok(),
            None => pending().await,
        };
        self.0 = None;
        made
    }
}

impl Incoming {
    pub(super) fn acknowledged(telegram: Vec<u8>) -> Self {
        Self {
            telegram,
            accepting: None,
        }
    }

    /// The bytes of the telegram.
    #[must_use]
    pub fn telegram(&self) -> &[u8] {
        &self.telegram
    }

    /// Acknowledges the telegram; `false` when that is too late, and it comes again, or when the
    /// connection is lost.
    pub async fn accept(mut self) -> bool {
        match self.accept_at_once() {
            Some(accepted) => accepted.await.unwrap_or(false),
            None => true,
        }
    }

    /// Has the partner repeat the telegram, unless it has been acknowledged.
    pub fn refuse(self) {}

    /// Whether it has been answered NAK, or its partner is gone.
    pub(super) fn is_void(&self) -> bool {
        self.accepting
            .as_ref()
            .is_some_and(oneshot::Sender::is_closed)
    }

    pub(super) const fn is_held(&self) -> bool {
        self.accepting.is_some()
    }

    /// Acknowledges the telegram, and hands it out without waiting for what comes of that.
    pub(super) fn into_accepted(mut self) -> Vec<u8> {
        drop(self.accept_at_once());
        self.into_telegram()
    }

    pub(super) fn into_telegram(mut self) -> Vec<u8> {
        mem::take(&mut self.telegram)
    }

    fn accept_at_once(&mut self) -> Option<oneshot::Receiver<bool>> {
        let (accepted, is_accepted) = oneshot::channel();
        // An error is a telegram that is void: `accepted` is dropped, of which `is_accepted` tells.
        drop(self.accepting.take()?.send(accepted));
        Some(is_accepted)
    }
}
