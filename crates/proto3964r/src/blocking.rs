//! A blocking driver for the ports of a PC: TCP streams, serial ports.

use core::{fmt, time::Duration};
use std::{io, net::TcpStream, time::Instant};

use crate::{
    character_buffer::CharacterBuffer,
    config::Config,
    event::Event,
    station::{Station, SubmitError, Transmit},
};

const INPUT: usize = 256;

/// The longest sleep in the port: a port that reports no input would not notice a dead line.
const LONGEST_SLEEP: Duration = Duration::from_secs(1);

/// A port whose reads wait: a TCP stream, or with feature `serialport` one of a PC.
pub trait Port: io::Read + io::Write {
    /// Lets `read` wait for at most this time, which is not zero.
    ///
    /// # Errors
    /// The errors of the port.
    fn set_timeout(&mut self, timeout: Duration) -> io::Result<()>;

    /// Drops what has come in and was not read; nothing where a port cannot.
    ///
    /// # Errors
    /// The errors of the port.
    fn discard_input(&mut self) -> io::Result<()> {
        Ok(())
    }

    /// Drops what was written and has not left; nothing where a port cannot.
    ///
    /// # Errors
    /// The errors of the port.
    fn discard_output(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Port for TcpStream {
    fn set_timeout(&mut self, timeout: Duration) -> io::Result<()> {
        self.set_read_timeout(Some(timeout))
    }
}

/// A station with its port; the clock is that of the system.
///
/// The station works while [`wait`](Self::wait) runs: nobody answers the partner in between.
///
/// # Examples
/// ```no_run
/// use std::{net::TcpStream, time::Duration};
/// use proto3964r::{Config, Line, Priority, blocking::Driver};
///
/// fn main() -> Result<(), Box<dyn std::error::Error>> {
///     let port = TcpStream::connect("192.168.0.7:4001")?;
///     port.set_nodelay(true)?;
///     let config = Config::siemens_3964r(Priority::High, Line::buffered(9600, 11));
///     let mut line = Driver::<_, 128>::new(port, config)?;
///     line.submit(b"tare")?;
///     while let Some(event) = line.wait(Duration::from_secs(20))? {
///         println!("{event:02X?}");
///     }
///     Ok(())
/// }
/// ```
pub struct Driver<P, const N: usize, const T: usize = N> {
    station: Station<N, T>,
    port: P,
    epoch: Instant,
    input: CharacterBuffer<INPUT>,
}

impl<P: Port, const N: usize, const T: usize> Driver<P, N, T> {
    /// Puts a station on an open port and drops what the port has received so far.
    ///
    /// # Errors
    /// The errors of the port.
    pub fn new(mut port: P, config: Config) -> io::Result<Self> {
        port.discard_input()?;
        Ok(Self {
            station: Station::with_buffers(config),
            port,
            epoch: Instant::now(),
            input: CharacterBuffer::EMPTY,
        })
    }

    /// The station, for what the driver does not offer.
    pub fn station_mut(&mut self) -> &mut Station<N, T> {
        &mut self.station
    }

    fn now(&self) -> Duration {
        self.epoch.elapsed()
    }

    /// Takes a job; it goes out while [`wait`](Self::wait) runs.
    ///
    /// # Errors
    /// The errors of [`Station::submit`].
    pub fn submit(&mut self, payload: &[u8]) -> Result<(), SubmitError> {
        self.station.submit(self.now(), payload)
    }

    /// Gives the job up, as [`Station::cancel`] does.
    pub fn cancel(&mut self) -> bool {
        self.station.cancel(self.now())
    }

    /// Acknowledges the telegram of the last event, as [`Station::accept`] does; the answer goes
    /// out while [`wait`](Self::wait) runs.
    #[must_use = "a telegram that is accepted too late comes again"]
    pub fn accept(&mut self) -> bool {
        self.station.accept(self.now())
    }

    /// Has the telegram of the last event repeated, as [`Station::refuse`] does.
    pub fn refuse(&mut self) -> bool {
        self.station.refuse(self.now())
    }

    /// Whether a job is under way, or its outcome has not been polled.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.station.is_busy()
    }

    /// Works until there is an event, at most for `patience`; `None` when that has passed.
    ///
    /// # Errors
    /// The errors of the port.
    pub fn wait(&mut self, patience: Duration) -> io::Result<Option<Event<'_>>> {
        let end = self.now().saturating_add(patience);
        loop {
            let now = self.now();
            self.station.handle_timeout(now);
            self.input.hand_to(&mut self.station, now);
            self.write()?;
            if let Some(note) = self.station.take_note() {
                return Ok(Some(self.station.event(note)));
            }
            if now >= end {
                return Ok(None);
            }
            self.read(end)?;
        }
    }

    fn write(&mut self) -> io::Result<()> {
        let mut out = [0; 256];
        while let Some(transmit) = self.station.poll_transmit(self.now(), &mut out) {
            match transmit {
                Transmit::Discard => self.port.discard_output()?,
                Transmit::Bytes(bytes) => self.port.write_all(bytes)?,
            }
        }
        Ok(())
    }

    /// Reads what comes in before something is due or `end` has come.
    fn read(&mut self, end: Duration) -> io::Result<()> {
        let due = self.station.poll_timeout().map_or(end, |due| due.min(end));
        // Whole milliseconds, rounded up: the port does not count finer.
        let sleep = due.saturating_sub(self.now()).min(LONGEST_SLEEP) + Duration::from_millis(1);
        self.port.set_timeout(sleep)?;
        match self.port.read(self.input.room()) {
            Ok(0) => return Err(closed()),
            Ok(len) => self.input.filled(len),
            Err(error) if is_silence(&error) => {}
            Err(error) => return Err(error),
        }
        let now = self.now();
        self.input.hand_to(&mut self.station, now);
        Ok(())
    }
}

impl<P, const N: usize, const T: usize> fmt::Debug for Driver<P, N, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Driver")
            .field("station", &self.station)
            .finish_non_exhaustive()
    }
}

/// The error of a stream that has ended.
pub(crate) fn closed() -> io::Error {
    io::Error::new(io::ErrorKind::UnexpectedEof, "closed by the other end")
}

fn is_silence(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
    )
}
