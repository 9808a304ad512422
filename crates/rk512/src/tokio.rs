//! A client over 3964R in a task of its own, on any stream of [`tokio`](https://docs.rs/tokio) 1.

mod held;
mod task;

use alloc::vec::Vec;
use std::io;

use ::tokio::{
    io::{AsyncRead, AsyncWrite},
    sync::{Mutex, mpsc},
};
use proto3964r::{
    Event, Line, Priority,
    tokio::{Caller, Lost, Task, driver, tcp},
};

pub use self::held::HeldJob;

use crate::{
    area::Area,
    command::Command,
    config::Config,
    session::{CallError, Session, send_command},
    source::DataSource,
};

/// A client and its station, which work in a task of their own.
///
/// All methods take `&self`; several jobs at once run in the order of their calls. Dropping the
/// future of a job gives it up: it may have been done in part or in whole. What the partner asks
/// for is refused, unless there is a [source](Self::with_source) that serves it.
///
/// A lost connection is final: every call reports it as [`CallError::Lost`], and whether and when
/// to connect again is the caller's decision.
///
/// # Examples
/// ```no_run
/// use rk512::Area;
///
/// # async fn f() -> Result<(), Box<dyn std::error::Error>> {
/// let plc = rk512::tokio::connect("tcp://192.168.0.7:4001").await?;
/// let words = plc.fetch(Area::db(10, 0), 8).await?;
/// plc.send(Area::db(10, 8), &words).await?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Client {
    task: Task<Job>,
    held: Mutex<mpsc::Receiver<HeldJob>>,
}

/// A job for the task.
#[derive(Debug)]
struct Job {
    command: Command,
    data: Vec<u8>,
    caller: Caller<Result<Vec<u8>, CallError>>,
}

/// Connects to a serial server in raw TCP mode whose port is set to 9600 bit/s, 8 data bits and
/// even parity; the address is `tcp://HOST:PORT`. The partner has the high priority, as a Siemens
/// communication processor by default.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for another address; those of the connection.
pub async fn connect(address: &str) -> io::Result<Client> {
    let line = proto3964r::Config::siemens_3964r(Priority::Low, Line::buffered(9600, 11));
    Ok(Client::new(tcp(address).await?, line, Config::DEFAULT))
}

impl Client {
    /// Puts a client and its station on a stream.
    ///
    /// # Panics
    /// Outside of a runtime of tokio.
    #[must_use]
    pub fn new<S>(stream: S, line: proto3964r::Config, config: Config) -> Self
    where
        S: AsyncRead + AsyncWrite + Send + 'static,
    {
        Self::with_observer(stream, line, config, |_| {})
    }

    /// Puts a station on a stream as [`new`](Self::new) does, with an observer that gets each event
    /// of the station when it happens, diagnosis too. It is called by the task that answers the
    /// partner, and must not wait.
    ///
    /// # Panics
    /// Outside of a runtime of tokio.
    #[must_use]
    pub fn with_observer<S>(
        stream: S,
        line: proto3964r::Config,
        config: Config,
        observer: impl FnMut(Event<'_>) + Send + 'static,
    ) -> Self
    where
        S: AsyncRead + AsyncWrite + Send + 'static,
    {
        Self::with_session(stream, line, Session::new(config), observer)
    }

    /// The same, and serves the partner's SEND and FETCH from a source. What the source
    /// [holds](DataSource::holds) is to be [asked for](Self::held) and answered.
    ///
    /// # Panics
    /// Outside of a runtime of tokio.
    #[must_use]
    pub fn with_source<S, D>(
        stream: S,
        line: proto3964r::Config,
        config: Config,
        source: D,
        observer: impl FnMut(Event<'_>) + Send + 'static,
    ) -> Self
    where
        S: AsyncRead + AsyncWrite + Send + 'static,
        D: DataSource + Send + 'static,
    {
        Self::with_session(stream, line, Session::with_source(config, source), observer)
    }

    fn with_session<S, D>(
        stream: S,
        line: proto3964r::Config,
        session: Session<D>,
        observer: impl FnMut(Event<'_>) + Send + 'static,
    ) -> Self
    where
        S: AsyncRead + AsyncWrite + Send + 'static,
        D: DataSource + Send + 'static,
    {
        let driver = driver(stream, line);
        let (holding, held) = mpsc::channel(1);
        Self {
            task: Task::spawn(|jobs| task::work(driver, jobs, session, holding, observer)),
            held: Mutex::new(held),
        }
    }

    /// The partner's next job that the source holds. Dropping the future loses none.
    ///
    /// # Errors
    /// [`Lost`].
    pub async fn held(&self) -> Result<HeldJob, Lost> {
        let mut held = self.held.lock().await;
        loop {
            match held.recv().await {
                Some(job) if job.is_void() => {}
                Some(job) => return Ok(job),
                None => return Err(self.task.lost().await),
            }
        }
    }

    /// FETCH: reads `length` units (words or bytes, as the area counts); words have the high byte
    /// first.
    ///
    /// # Errors
    /// [`CallError`].
    pub async fn fetch(&self, area: Area, length: u16) -> Result<Vec<u8>, CallError> {
        self.run(Command::fetch(area, length)?, &[]).await
    }

    /// SEND: writes words, high byte first, to a DB or DX.
    ///
    /// # Errors
    /// [`CallError`].
    pub async fn send(&self, area: Area, data: &[u8]) -> Result<(), CallError> {
        let command = send_command(area, data)?;
        self.run(command, data).await.map(drop)
    }

    /// Any command, for instance one with a coordination flag; the data are those of a SEND, and
    /// what is returned those of a FETCH.
    ///
    /// # Errors
    /// [`CallError`].
    pub async fn run(&self, command: Command, data: &[u8]) -> Result<Vec<u8>, CallError> {
        let data = data.to_vec();
        let job = |caller| Job {
            command,
            data,
            caller,
        };
        let outcome = self.task.ask(job).await;
        outcome.map_err(|lost| CallError::Lost(lost.into()))?
    }
}
