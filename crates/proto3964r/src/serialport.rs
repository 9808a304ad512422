//! A driver for the ports of a PC, on [`serialport`](https://docs.rs/serialport) 4.
//!
//! That crate does not tell which characters came in damaged: parity protects only as far as the
//! operating system drops or replaces them, and the BCC has to see the rest.

extern crate alloc;

use alloc::boxed::Box;
use core::time::Duration;
use std::{
    io::{self, Read as _, Write as _},
    time::Instant,
};

use serialport::{ClearBuffer, SerialPort};

use crate::{
    config::Config,
    event::Event,
    piece::Piece,
    station::{Station, SubmitError, Transmit},
};

const INPUT: usize = 256;

/// The longest sleep in the port: a port that reports no input would not notice a dead line.
const LONGEST_SLEEP: Duration = Duration::from_secs(1);

/// A station with its port; the clock is that of the system.
///
/// # Examples
/// ```no_run
/// use std::time::Duration;
/// use proto3964r::{Config, Event, Line, Priority, serialport::Driver};
///
/// fn main() -> Result<(), Box<dyn std::error::Error>> {
///     let port = serialport::new("/dev/ttyUSB0", 9600).parity(serialport::Parity::Even).open()?;
///     let config = Config::siemens_3964r(Priority::High, Line::buffered(9600, 11));
///     let mut line = Driver::<128>::new(port, config)?;
///     line.submit(b"tare")?;
///     while let Some(event) = line.wait(Duration::from_secs(20))? {
///         println!("{event:02X?}");
///     }
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct Driver<const N: usize, const T: usize = N> {
    station: Station<N, T>,
    port: PortBox,
    epoch: Instant,
    input: Piece<INPUT>,
}

/// A port that can be printed.
struct PortBox(Box<dyn SerialPort>);

impl core::fmt::Debug for PortBox {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_tuple("SerialPort").field(&self.0.name()).finish()
    }
}

impl<const N: usize, const T: usize> Driver<N, T> {
    /// Puts a station on an open port and drops what the port has received so far.
    ///
    /// # Errors
    /// Those of the port.
    pub fn new(port: Box<dyn SerialPort>, config: Config) -> io::Result<Self> {
        port.clear(ClearBuffer::Input)?;
        Ok(Self {
            station: Station::with_buffers(config),
            port: PortBox(port),
            epoch: Instant::now(),
            input: Piece::EMPTY,
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
    /// Those of [`Station::submit`].
    pub fn submit(&mut self, payload: &[u8]) -> Result<(), SubmitError> {
        self.station.submit(self.now(), payload)
    }

    /// Gives the job up, as [`Station::cancel`] does.
    pub fn cancel(&mut self) -> bool {
        self.station.cancel(self.now())
    }

    /// Whether a job is under way, or its outcome has not been polled.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.station.is_busy()
    }

    /// Works until there is an event, at most for `patience`; `None` when that has passed.
    ///
    /// # Errors
    /// Those of the port.
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
                Transmit::Discard => self.port.0.clear(ClearBuffer::Output)?,
                Transmit::Bytes(bytes) => self.port.0.write_all(bytes)?,
            }
        }
        Ok(())
    }

    /// Reads what comes in before something is due or `end` has come.
    fn read(&mut self, end: Duration) -> io::Result<()> {
        let due = self.station.poll_timeout().map_or(end, |due| due.min(end));
        // Whole milliseconds, rounded up: the port does not count finer.
        let sleep = due.saturating_sub(self.now()).min(LONGEST_SLEEP) + Duration::from_millis(1);
        self.port.0.set_timeout(sleep)?;
        match self.port.0.read(self.input.room()) {
            Ok(len) => self.input.filled(len),
            Err(error) if is_silence(&error) => {}
            Err(error) => return Err(error),
        }
        let now = self.now();
        self.input.hand_to(&mut self.station, now);
        Ok(())
    }
}

fn is_silence(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
    )
}
