//! A blocking driver for ports with the traits of [`embedded-io`](https://docs.rs/embedded-io) 0.7.

use embedded_io::{Read, ReadReady, Write};

use crate::{
    event::Event,
    station::{SendError, Station, Transmit},
    time::Instant,
};

/// Characters that are handed to the port at a time: so many can no longer be called back when
/// the partner interrupts the block.
const PIECE: usize = 8;

/// A station with its port and a clock.
///
/// The port must not wait in `read` when `read_ready` says that something is there. `write` may
/// wait: the driver looks for input after every eight characters.
///
/// # Examples
/// ```no_run
/// use proto3964r::{Config, Event, Instant, Priority, Station, embedded_io::Driver};
///
/// # fn demo<P>(uart: P, mut micros: impl FnMut() -> u64) -> Result<(), P::Error>
/// # where P: embedded_io::Read + embedded_io::ReadReady + embedded_io::Write {
/// let station = Station::<128>::new(Config::siemens_3964r(Priority::High).with_line(9600, 11));
/// let mut line = Driver::new(station, uart, || Instant::from_micros(micros()));
/// line.send(b"A").ok();
/// loop {
///     match line.wait()? {
///         Event::Received(telegram) => { /* use it */ }
///         Event::Sent { .. } => break,
///         _ => {}
///     }
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Driver<P, C, const N: usize, const T: usize = N> {
    station: Station<N, T>,
    port: P,
    clock: C,
}

impl<P, C, const N: usize, const T: usize> Driver<P, C, N, T>
where
    P: Read + ReadReady + Write,
    C: FnMut() -> Instant,
{
    /// Puts a station on a port. `clock` gives the time that has passed since any epoch.
    pub fn new(station: Station<N, T>, port: P, clock: C) -> Self {
        Self {
            station,
            port,
            clock,
        }
    }

    /// The station, for what the driver does not offer.
    pub fn station_mut(&mut self) -> &mut Station<N, T> {
        &mut self.station
    }

    /// The port, for instance to clear an error.
    pub fn port_mut(&mut self) -> &mut P {
        &mut self.port
    }

    /// Takes a job.
    ///
    /// # Errors
    /// Those of [`Station::send`].
    pub fn send(&mut self, payload: &[u8]) -> Result<(), SendError> {
        self.station.send((self.clock)(), payload)
    }

    /// Moves what is there, in both directions, and does what is due; does not wait for input.
    ///
    /// Call it often, or call [`wait`](Self::wait).
    ///
    /// # Errors
    /// Those of the port. A receiver error (parity, framing, overrun) is one of them on most
    /// ports: tell the station with [`Station::handle_damaged`] and go on.
    pub fn step(&mut self) -> Result<(), P::Error> {
        let mut out = [0; PIECE];
        self.read()?;
        self.station.handle_timeout((self.clock)());
        while let Some(transmit) = self.station.poll_transmit((self.clock)(), &mut out) {
            // A discard needs nothing: what the port has is on the line after eight characters.
            if let Transmit::Bytes(bytes) = transmit {
                self.port.write_all(bytes)?;
                self.port.flush()?;
            }
            self.read()?;
        }
        Ok(())
    }

    /// The next event, if there is one.
    #[must_use]
    pub fn poll_event(&mut self) -> Option<Event<'_>> {
        self.station.poll_event()
    }

    /// Steps until there is an event.
    ///
    /// # Errors
    /// Those of [`step`](Self::step).
    pub fn wait(&mut self) -> Result<Event<'_>, P::Error> {
        while !self.station.has_event() {
            self.step()?;
        }
        // There is one: the fallback is never taken.
        Ok(self.station.poll_event().unwrap_or(Event::Break))
    }

    /// Reads while something is there, up to the next event that somebody must take.
    fn read(&mut self) -> Result<(), P::Error> {
        let mut input = [0; 32];
        while self.port.read_ready()? {
            let len = self.port.read(&mut input)?;
            if len == 0 {
                break;
            }
            self.station
                .handle_bytes((self.clock)(), input.get(..len).unwrap_or_default());
        }
        Ok(())
    }
}
