//! A pendant over 3964R in a task of its own, on any stream of [`tokio`](https://docs.rs/tokio) 1.

mod task;

use std::io;

use ::tokio::{
    io::{AsyncRead, AsyncWrite},
    sync::{Mutex, mpsc},
};
use proto3964r::{
    Config, Line,
    tokio::{Caller, Lost, Task, driver, tcp},
};
use thiserror::Error;

use crate::{
    command::LedState,
    driver::{Driver, Event, Failure, Job, SubmitError, Timeouts},
    lcd::LcdBlock,
    number::Led,
    report::{LcdAnswer, Model},
};

/// A pendant, its driver and their station, which work in a task of their own.
///
/// All methods take `&self`; several jobs at once run in the order of their calls, each when the
/// pendant is there. Dropping the future of a job does not take it back.
///
/// Events that were not [taken](Self::event) wait. When [`QUEUE`](Self::QUEUE) of them do, the line
/// stands until one is taken: the pendant gets no acknowledgement, and jobs wait, too. So no
/// release of a key is lost behind the key.
///
/// A lost connection is final: every call reports it as [`Lost`], and whether and when to connect
/// again is the caller's decision.
///
/// # Examples
/// ```no_run
/// use handwheel::{Event, LcdBlock, LcdCommand, Model, Text};
///
/// # async fn f() -> Result<(), Box<dyn std::error::Error>> {
/// let pendant = handwheel::tokio::connect("tcp://192.168.0.8:4001", Model::Hbls).await?;
/// let mut block = LcdBlock::new(Model::Hbls);
/// block.push(LcdCommand::Text(Text::new("READY")?))?;
/// pendant.show(block).await?;
/// loop {
///     match pendant.event().await? {
///         Event::Key(key) => println!("{key:?}"),
///         Event::Lost => println!("unplugged: stop"),
///         _ => {}
///     }
/// }
/// # }
/// ```
#[derive(Debug)]
pub struct Pendant {
    task: Task<Request>,
    events: Mutex<mpsc::Receiver<Event>>,
}

/// A job for the task, with the one who waits for it.
#[derive(Debug)]
struct Request {
    job: Job,
    caller: Waiting,
}

/// The one who waits for a job.
#[derive(Debug)]
enum Waiting {
    ForLed(Caller<Result<(), PendantError>>),
    ForLcd(Caller<Result<LcdAnswer, PendantError>>),
}

/// Why a job was not done, as far as is known.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum PendantError {
    /// The model has no such telegram.
    #[error(transparent)]
    Refused(#[from] SubmitError),
    /// The pendant may have done it all the same.
    #[error(transparent)]
    Failed(#[from] Failure),
    /// The connection is lost.
    #[error(transparent)]
    Lost(#[from] Lost),
}

/// Connects to a serial server in raw TCP mode whose port is set to the 9600 bit/s, 8 data bits and
/// even parity of the pendant; the address is `tcp://HOST:PORT`.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for another address; those of the connection.
pub async fn connect(address: &str, model: Model) -> io::Result<Pendant> {
    let line = Line::buffered(9600, 11);
    let line = match model {
        Model::Hbls => Config::euchner_hbls(line),
        Model::Hbas => Config::euchner_hbas(line),
    };
    let stream = tcp(address).await?;
    Ok(Pendant::new(stream, line, model, Timeouts::DEFAULT))
}

impl Pendant {
    /// Events that wait to be taken, at most.
    pub const QUEUE: usize = 64;

    /// Puts a driver and its station on a stream.
    ///
    /// # Panics
    /// Outside of a runtime of tokio.
    #[must_use]
    pub fn new<S>(stream: S, line: Config, model: Model, timeouts: Timeouts) -> Self
    where
        S: AsyncRead + AsyncWrite + Send + 'static,
    {
        let line = driver(stream, line);
        let pendant = Driver::new(model, timeouts);
        let (happened, events) = mpsc::channel(Self::QUEUE);
        Self {
            task: Task::spawn(|requests| task::work(line, pendant, requests, happened)),
            events: Mutex::new(events),
        }
    }

    /// What happens next at the pendant: keys, rotary switches, its status, that it no longer
    /// answers. Dropping the future loses nothing.
    ///
    /// # Errors
    /// [`Lost`], after the last event.
    pub async fn event(&self) -> Result<Event, Lost> {
        match self.events.lock().await.recv().await {
            Some(event) => Ok(event),
            None => Err(self.task.lost().await),
        }
    }

    /// Sends a display block, and returns the pendant's word on it. Waits for a pendant that is not
    /// there.
    ///
    /// # Errors
    /// [`PendantError`].
    pub async fn show(&self, block: LcdBlock) -> Result<LcdAnswer, PendantError> {
        let request = |caller| Request {
            job: Job::Lcd(block),
            caller: Waiting::ForLcd(caller),
        };
        self.task.ask(request).await?
    }

    /// Sets an LED of the HBLS, or all of them. Waits for a pendant that is not there.
    ///
    /// # Errors
    /// [`PendantError`].
    pub async fn set_led(&self, led: Option<Led>, state: LedState) -> Result<(), PendantError> {
        let request = |caller| Request {
            job: Job::Led { led, state },
            caller: Waiting::ForLed(caller),
        };
        self.task.ask(request).await?
    }
}
