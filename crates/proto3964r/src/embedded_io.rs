//! A blocking driver for ports with the traits of [`embedded-io`](https://docs.rs/embedded-io) 0.7.

use core::time::Duration;

use embedded_io::{Read, ReadReady, Write};

use crate::{
    character_buffer::CharacterBuffer,
    event::Event,
    station::{Station, SubmitError, Transmit},
};

/// Characters that are handed to the port at a time: these can no longer be taken back when the
/// partner interrupts the block.
const OUTPUT: usize = 8;
const INPUT: usize = 32;

/// A station with its port and a clock.
///
/// The port must not wait in `read` when `read_ready` says that something is there. `write` may
/// wait: the driver looks for input after every eight characters.
///
/// # Examples
/// ```no_run
/// use core::time::Duration;
/// use proto3964r::{Config, Event, Line, Priority, Station, embedded_io::Driver};
///
/// fn tare<P>(uart: P, mut micros: impl FnMut() -> u64) -> Result<(), P::Error>
/// where
///     P: embedded_io::Read + embedded_io::ReadReady + embedded_io::Write,
/// {
///     let config = Config::siemens_3964r(Priority::High, Line::paced(9600, 11));
///     let clock = || Duration::from_micros(micros());
///     let mut line = Driver::new(Station::<128>::new(config), uart, clock);
///     line.submit(b"tare").ok();
///     while line.is_busy() {
///         if let Event::Received(telegram) = line.wait()? { /* use it */ }
///     }
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct Driver<P, C, const N: usize, const T: usize = N> {
    station: Station<N, T>,
    port: P,
    clock: C,
    input: CharacterBuffer<INPUT>,
}

impl<P, C, const N: usize, const T: usize> Driver<P, C, N, T>
where
    P: Read + ReadReady + Write,
    C: FnMut() -> Duration,
{
    /// Puts a station on a port. `clock` gives the time that has passed since any epoch.
    pub fn new(station: Station<N, T>, port: P, clock: C) -> Self {
        Self {
            station,
            port,
            clock,
            input: CharacterBuffer::EMPTY,
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
    /// The errors of [`Station::submit`].
    pub fn submit(&mut self, payload: &[u8]) -> Result<(), SubmitError> {
        self.station.submit((self.clock)(), payload)
    }

    /// Gives the job up, as [`Station::cancel`] does.
    pub fn cancel(&mut self) -> bool {
        self.station.cancel((self.clock)())
    }

    /// Acknowledges the telegram of the last event, as [`Station::accept`] does.
    #[must_use = "a telegram that is accepted too late comes again"]
    pub fn accept(&mut self) -> bool {
        self.station.accept((self.clock)())
    }

    /// Has the telegram of the last event repeated, as [`Station::refuse`] does.
    pub fn refuse(&mut self) -> bool {
        self.station.refuse((self.clock)())
    }

    /// Whether a job is under way, or its outcome has not been polled.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.station.is_busy()
    }

    /// Moves what is there, in both directions, and does what is due; does not wait for input.
    ///
    /// Call it often, or call [`wait`](Self::wait).
    ///
    /// # Errors
    /// The errors of the port. A receiver error (parity, framing, overrun) is one of them on most
    /// ports: report it to the station with [`Station::handle_damaged`] and go on.
    pub fn step(&mut self) -> Result<(), P::Error> {
        let mut out = [0; OUTPUT];
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
    /// The errors of [`step`](Self::step).
    pub fn wait(&mut self) -> Result<Event<'_>, P::Error> {
        let note = loop {
            if let Some(note) = self.station.take_note() {
                break note;
            }
            self.step()?;
        };
        Ok(self.station.event(note))
    }

    /// Reads while something is there, up to the next telegram: that must be polled first.
    fn read(&mut self) -> Result<(), P::Error> {
        loop {
            self.input.hand_to(&mut self.station, (self.clock)());
            if !self.input.waiting().is_empty() || !self.port.read_ready()? {
                return Ok(());
            }
            let len = self.port.read(self.input.room())?;
            if len == 0 {
                return Ok(());
            }
            self.input.filled(len);
        }
    }
}
