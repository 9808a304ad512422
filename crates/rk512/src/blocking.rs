//! A client over 3964R that waits, on any [`Port`] of proto3964r.

use alloc::{sync::Arc, vec::Vec};
use core::time::Duration;
use std::{
    io,
    net::{TcpStream, ToSocketAddrs},
    time::Instant,
};

use proto3964r::{
    Line, Priority,
    blocking::{Driver, Port},
};

use crate::{
    area::Area,
    command::Command,
    config::Config,
    session::{CallError, Nothing, Session, Transport, send_command},
    telegram::MAX_TELEGRAM,
};

/// How long the line is watched at a time while nothing is due.
const WATCH: Duration = Duration::from_secs(1);

type LineDriver<P> = Driver<P, MAX_TELEGRAM>;

/// A client with its station and port.
///
/// The station works while a job runs: in between nobody answers the partner. What it asks for
/// during a job is refused: this side serves nothing. With feature `serialport` the port may be one
/// of that crate.
///
/// # Examples
/// ```no_run
/// use rk512::Area;
///
/// fn main() -> Result<(), Box<dyn std::error::Error>> {
///     let mut plc = rk512::blocking::connect("192.168.0.7:4001")?;
///     let words = plc.fetch(Area::db(10, 0), 8)?;
///     plc.send(Area::db(10, 8), &words)?;
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct Client<P> {
    line: LineDriver<P>,
    session: Session<Nothing>,
    epoch: Instant,
}

/// Connects to a serial server in raw TCP mode whose port is set to 9600 bit/s, 8 data bits and
/// even parity. The partner has the high priority, as a Siemens communication processor by default.
///
/// # Errors
/// The errors of the connection.
pub fn connect(address: impl ToSocketAddrs) -> io::Result<Client<TcpStream>> {
    let line = proto3964r::Config::siemens_3964r(Priority::Low, Line::buffered(9600, 11));
    let stream = TcpStream::connect(address)?;
    stream.set_nodelay(true)?;
    Client::new(stream, line, Config::DEFAULT)
}

impl<P: Port> Client<P> {
    /// Puts a client and its station on an open port.
    ///
    /// # Errors
    /// The errors of the port.
    pub fn new(port: P, line: proto3964r::Config, config: Config) -> io::Result<Self> {
        Ok(Self {
            line: Driver::new(port, line)?,
            session: Session::new(config),
            epoch: Instant::now(),
        })
    }

    /// FETCH: reads `length` units (words or bytes, as the area counts); words have the high byte
    /// first.
    ///
    /// # Errors
    /// [`CallError`].
    pub fn fetch(&mut self, area: Area, length: u16) -> Result<Vec<u8>, CallError> {
        self.run(Command::fetch(area, length)?, &[])
    }

    /// SEND: writes words, high byte first, to a DB or DX.
    ///
    /// # Errors
    /// [`CallError`].
    pub fn send(&mut self, area: Area, data: &[u8]) -> Result<(), CallError> {
        self.run(send_command(area, data)?, data).map(drop)
    }

    /// Any command, for instance one with a coordination flag; the data are those of a SEND, and
    /// what is returned those of a FETCH.
    ///
    /// # Errors
    /// [`CallError`].
    pub fn run(&mut self, command: Command, data: &[u8]) -> Result<Vec<u8>, CallError> {
        self.session.submit(command, data)?;
        loop {
            match self.step() {
                Ok(Some(outcome)) => return outcome,
                Ok(None) => {}
                Err(error) => {
                    self.session.abandon(self.epoch.elapsed());
                    return Err(CallError::Lost(Arc::new(error)));
                }
            }
        }
    }

    /// Waits for what comes next; returns how the job ended.
    fn step(&mut self) -> io::Result<Option<Result<Vec<u8>, CallError>>> {
        let now = self.epoch.elapsed();
        let outcome = self.session.step(now, &mut self.line)?;
        if outcome.is_none() {
            let due = self.session.poll_timeout();
            let patience = due.map_or(WATCH, |due| due.saturating_sub(now));
            if let Some(event) = self.line.wait(patience)? {
                self.session.handle(self.epoch.elapsed(), event);
            }
        }
        Ok(outcome)
    }
}

impl<P: Port> Transport for LineDriver<P> {
    fn is_busy(&self) -> bool {
        self.is_busy()
    }

    fn submit(&mut self, telegram: &[u8]) -> Result<(), proto3964r::SubmitError> {
        self.submit(telegram)
    }

    fn cancel(&mut self) {
        self.cancel();
    }
}
