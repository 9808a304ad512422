//! What a program holds of a line.

use alloc::vec::Vec;
use std::io;

use ::tokio::{
    io::{AsyncRead, AsyncWrite},
    sync::{
        Mutex,
        mpsc::{self, error::TrySendError},
    },
};
use thiserror::Error;

use super::{Caller, Incoming, Lost, StreamDriver, Task, driver, incoming::Decision, tcp};
use crate::{
    config::Config,
    event::{Event, Failure},
    station::{Activity, SubmitError},
};

/// One end of a line, whose station works in a task of its own: it answers the partner at any time,
/// whatever the program does.
///
/// All methods take `&self`: a program may send and receive at once. Telegrams that were received
/// and not fetched wait; when [`QUEUE`](Self::QUEUE) of them do, the partner is made to wait, and
/// the outcomes of jobs after them, too. Dropping the link ends the task and closes the stream.
///
/// With [`Config::acknowledge_wait_ms`] nothing waits that has an acknowledgement: a telegram is
/// acknowledged when [`receive`](Self::receive) hands it out, or when its [`Incoming`] is accepted;
/// one that is not fetched in that time is refused, and keeps no outcome back.
///
/// A lost connection is final: every call reports it as [`Lost`], and whether and when to connect
/// again is the caller's decision.
///
/// # Examples
/// ```
/// use proto3964r::{Config, Line, Priority, tokio::Link};
///
/// # #[tokio::main(flavor = "current_thread")]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // Or `Link::connect("tcp://192.168.0.7:4001", config)`, `Line::buffered(9600, 11)`.
/// let (here, there) = tokio::io::duplex(64);
/// let plc = Link::new(here, Config::siemens_3964r(Priority::High, Line::Instant));
/// let scale = Link::new(there, Config::siemens_3964r(Priority::Low, Line::Instant));
///
/// plc.send(b"tare").await?;
/// assert_eq!(scale.receive().await?, b"tare");
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Link {
    task: Task<Job>,
    telegrams: Mutex<mpsc::Receiver<Incoming>>,
}

/// Why a telegram was not sent.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum SendError {
    /// The station does not take such a telegram.
    #[error(transparent)]
    Refused(#[from] SubmitError),
    /// The station gave it up; the partner may have received it all the same.
    #[error(transparent)]
    Failed(#[from] Failure),
    /// The connection is lost.
    #[error(transparent)]
    Lost(#[from] Lost),
}

impl Link {
    /// The longest telegram, in both directions.
    pub const MAX_TELEGRAM: usize = 4096;

    /// Telegrams that wait to be fetched, at most.
    pub const QUEUE: usize = 64;

    /// Puts a station on a stream.
    ///
    /// # Panics
    /// Outside of a runtime of tokio.
    #[must_use]
    pub fn new<S>(stream: S, config: Config) -> Self
    where
        S: AsyncRead + AsyncWrite + Send + 'static,
    {
        Self::with_observer(stream, config, |_| {})
    }

    /// Puts a station on a stream as [`new`](Self::new) does, with an observer that gets each event
    /// when it happens, diagnosis too. It is called by the task that answers the partner, and must
    /// not wait.
    ///
    /// # Panics
    /// Outside of a runtime of tokio.
    #[must_use]
    pub fn with_observer<S>(
        stream: S,
        config: Config,
        observer: impl FnMut(Event<'_>) + Send + 'static,
    ) -> Self
    where
        S: AsyncRead + AsyncWrite + Send + 'static,
    {
        let is_held = config.acknowledge_wait_ms > 0;
        let (received, telegrams) = mpsc::channel(if is_held { 1 } else { Self::QUEUE });
        let driver = driver::<{ Self::MAX_TELEGRAM }>(stream, config);
        Self {
            task: Task::spawn(|jobs| work(driver, jobs, received, observer)),
            telegrams: Mutex::new(telegrams),
        }
    }

    /// Connects to a serial server in raw TCP mode and puts a station on the connection; the
    /// address is `tcp://HOST:PORT`.
    ///
    /// # Errors
    /// [`io::ErrorKind::InvalidInput`] for another address; those of the connection.
    pub async fn connect(address: &str, config: Config) -> io::Result<Self> {
        Ok(Self::new(tcp(address).await?, config))
    }

    /// Sends a telegram and waits until the partner has acknowledged it.
    ///
    /// Several at once go out in the order of their calls. Dropping the future gives the telegram
    /// up; as with every failure, the partner may have received it all the same.
    ///
    /// # Errors
    /// [`SendError`].
    pub async fn send(&self, telegram: &[u8]) -> Result<(), SendError> {
        let payload = telegram.to_vec();
        self.task.ask(|caller| Job { payload, caller }).await?
    }

    /// The next telegram of the partner. Dropping the future loses none.
    ///
    /// # Errors
    /// [`Lost`], after the last telegram that had come before.
    pub async fn receive(&self) -> Result<Vec<u8>, Lost> {
        self.incoming().await.map(Incoming::into_accepted)
    }

    /// The next telegram of the partner, which may wait to be accepted. Dropping the future loses
    /// none.
    ///
    /// # Errors
    /// [`Lost`], after the last telegram that had come before.
    pub async fn incoming(&self) -> Result<Incoming, Lost> {
        let mut telegrams = self.telegrams.lock().await;
        loop {
            match telegrams.recv().await {
                Some(incoming) if incoming.is_void() => {}
                Some(incoming) => return Ok(incoming),
                None => return Err(self.task.lost().await),
            }
        }
    }

    /// Ends the task and closes the stream; hands back the telegrams, in their order, that the
    /// partner has an acknowledgement for and nobody has fetched.
    pub async fn close(self) -> Vec<Vec<u8>> {
        let Self { task, telegrams } = self;
        drop(task);
        let (mut telegrams, mut rest) = (telegrams.into_inner(), Vec::new());
        while let Some(incoming) = telegrams.recv().await {
            if !incoming.is_held() {
                rest.push(incoming.into_telegram());
            }
        }
        rest
    }
}

/// A telegram to send.
#[derive(Debug)]
struct Job {
    payload: Vec<u8>,
    caller: Caller<Result<(), SendError>>,
}

/// Works until the link is dropped.
///
/// # Errors
/// The errors of the stream.
async fn work<const N: usize>(
    mut driver: StreamDriver<N>,
    mut jobs: mpsc::Receiver<Job>,
    telegrams: mpsc::Sender<Incoming>,
    mut observer: impl FnMut(Event<'_>),
) -> io::Result<()> {
    let is_held = driver.station_mut().config().acknowledge_wait_ms > 0;
    // Of the telegram whose answer the station holds.
    let mut decision = Decision::NONE;
    // That telegram, while one whose time is over is still in the queue.
    let mut waiting = None;
    let mut caller = Caller::NONE;
    let mut is_closing = false;
    loop {
        // While the queue is full a telegram that has been acknowledged stays in the station, which
        // makes the partner wait.
        let station = driver.station_mut();
        while !(!is_held && station.holds_telegram() && telegrams.capacity() == 0)
            && let Some(event) = station.poll_event()
        {
            observer(event);
            match event {
                Event::Received(telegram) => {
                    let telegram = telegram.to_vec();
                    // One whose time is over comes again.
                    let is_void = is_held && station.activity() != Activity::AwaitUser;
                    if is_void {
                        continue;
                    }
                    let incoming = if is_held {
                        decision.about(telegram)
                    } else {
                        Incoming::acknowledged(telegram)
                    };
                    // Closed, the link has been dropped.
                    if let Err(TrySendError::Full(incoming)) = telegrams.try_send(incoming) {
                        waiting = Some(incoming);
                    }
                }
                Event::Sent { .. } => caller.tell(Ok(())),
                Event::Failed(failure) => caller.tell(Err(failure.into())),
                _ => {}
            }
        }
        let queue_is_full = station.holds_telegram();
        if station.activity() != Activity::AwaitUser {
            (decision, waiting) = (Decision::NONE, None);
        }
        // Closed, a link still takes what has been acknowledged; dropped, it does not.
        if is_closing && (!queue_is_full || is_held || telegrams.is_closed()) {
            return Ok(());
        }
        let is_idle = !driver.is_busy();
        ::tokio::select! {
            done = driver.round(), if !is_closing => if let Err(error) = done {
                driver.take_damage(error)?;
            },
            job = jobs.recv(), if is_idle && !is_closing => {
                let Some(job) = job else {
                    is_closing = true;
                    continue;
                };
                let payload = job.payload;
                caller = job.caller;
                if let Err(error) = driver.submit(&payload) {
                    caller.tell(Err(error.into()));
                }
            }
            () = caller.gone() => {
                driver.cancel();
            }
            accepted = decision.made() => match accepted {
                Some(accepted) => drop(accepted.send(driver.accept())),
                None => _ = driver.refuse(),
            },
            permit = telegrams.reserve(), if queue_is_full || waiting.is_some() => {
                if let (Ok(permit), Some(incoming)) = (permit, waiting.take()) {
                    permit.send(incoming);
                }
            }
        }
    }
}
