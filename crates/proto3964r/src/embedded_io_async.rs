//! A driver for ports with the traits of [`embedded-io-async`](https://docs.rs/embedded-io-async)
//! 0.7.

use core::{
    future::{Future, poll_fn},
    pin::pin,
    task::Poll,
    time::Duration,
};

use embedded_io_async::{Read, Write};

use crate::{
    character_buffer::CharacterBuffer,
    event::Event,
    station::{Station, SubmitError, Transmit},
};

/// Characters that are handed to the port at a time.
const OUTPUT: usize = 16;
const INPUT: usize = 32;

/// A clock, and how to wait for a time of it.
pub trait AsyncClock {
    /// The time since any epoch.
    fn now(&mut self) -> Duration;

    /// Returns when it is `time` or later.
    fn sleep_until(&mut self, time: Duration) -> impl Future<Output = ()>;
}

/// A station with the two halves of its port and a timer.
///
/// The halves are apart so that the driver hears the partner while a block goes out. `read` and
/// `write` of the port must be cancel-safe, as those of a buffered UART are: a future that is
/// dropped has taken nothing.
///
/// # Examples
/// ```no_run
/// use embedded_io_async::{Read, Write};
/// use proto3964r::embedded_io_async::{Driver, AsyncClock};
/// use proto3964r::{Config, Event, Line, Priority, Station};
///
/// async fn tare<R, W>(rx: R, tx: W, timer: impl AsyncClock) -> Result<(), R::Error>
/// where
///     R: Read,
///     W: Write<Error = R::Error>,
/// {
///     let config = Config::siemens_3964r(Priority::High, Line::paced(9600, 11));
///     let mut line = Driver::new(Station::<128>::new(config), rx, tx, timer);
///     line.submit(b"tare").ok();
///     while line.is_busy() {
///         if let Event::Received(telegram) = line.wait().await? { /* use it */ }
///     }
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct Driver<R, W, M, const N: usize, const T: usize = N> {
    station: Station<N, T>,
    reader: R,
    writer: W,
    timer: M,
    input: CharacterBuffer<INPUT>,
    /// What the station handed out and the port has not taken: a dropped `wait` loses none of it.
    output: CharacterBuffer<OUTPUT>,
    flushed: bool,
}

/// What came first.
enum First {
    Written(usize),
    Flushed,
    Read(usize),
    Due,
}

impl<R, W, M, const N: usize, const T: usize> Driver<R, W, M, N, T>
where
    R: Read,
    W: Write<Error = R::Error>,
    M: AsyncClock,
{
    /// Puts a station on a port.
    pub fn new(station: Station<N, T>, reader: R, writer: W, timer: M) -> Self {
        Self {
            station,
            reader,
            writer,
            timer,
            input: CharacterBuffer::EMPTY,
            output: CharacterBuffer::EMPTY,
            flushed: true,
        }
    }

    /// The station, for what the driver does not offer.
    pub fn station_mut(&mut self) -> &mut Station<N, T> {
        &mut self.station
    }

    /// The time by the timer.
    #[cfg(feature = "tokio")]
    pub(crate) fn now(&mut self) -> Duration {
        self.timer.now()
    }

    /// Takes a job; it goes out while [`wait`](Self::wait) is polled.
    ///
    /// # Errors
    /// The errors of [`Station::submit`].
    pub fn submit(&mut self, payload: &[u8]) -> Result<(), SubmitError> {
        self.station.submit(self.timer.now(), payload)
    }

    /// Gives the job up, as [`Station::cancel`] does.
    pub fn cancel(&mut self) -> bool {
        self.station.cancel(self.timer.now())
    }

    /// Acknowledges the telegram of the last event, as [`Station::accept`] does; the answer goes
    /// out while [`wait`](Self::wait) is polled.
    #[must_use = "a telegram that is accepted too late comes again"]
    pub fn accept(&mut self) -> bool {
        self.station.accept(self.timer.now())
    }

    /// Has the telegram of the last event repeated, as [`Station::refuse`] does.
    pub fn refuse(&mut self) -> bool {
        self.station.refuse(self.timer.now())
    }

    /// Whether a job is under way, or its outcome has not been polled.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.station.is_busy()
    }

    /// Whether neither a transmission nor a reception is under way.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.station.is_idle()
    }

    /// Works until there is an event. May be dropped and called again.
    ///
    /// # Errors
    /// The errors of the port. A receiver error (parity, framing, overrun) is one of them on most
    /// ports: report it to the station with [`Station::handle_damaged`] and go on.
    pub async fn wait(&mut self) -> Result<Event<'_>, R::Error> {
        let note = loop {
            if let Some(note) = self.station.take_note() {
                break note;
            }
            self.round().await?;
        };
        Ok(self.station.event(note))
    }

    /// Waits for whatever comes first and hands it to the station. May be dropped and called again.
    pub(crate) async fn round(&mut self) -> Result<(), R::Error> {
        let now = self.timer.now();
        self.station.handle_timeout(now);
        if !self.input.waiting().is_empty() {
            // What came after a telegram. That has been polled meanwhile, or the partner must wait.
            let taken = self.station.handle_bytes(now, self.input.waiting());
            self.input.gone(taken);
            return Ok(());
        }
        self.refill(now);
        match self.first().await? {
            First::Written(len) => self.output.gone(len),
            First::Flushed => self.flushed = true,
            First::Read(len) => {
                self.input.filled(len);
                self.input.hand_to(&mut self.station, self.timer.now());
            }
            First::Due => {}
        }
        Ok(())
    }

    /// Fetches the next characters when the port has taken the last ones, or when those are void.
    fn refill(&mut self, now: Duration) {
        let mut buffer = [0; OUTPUT];
        let free: &mut [u8] = if self.output.waiting().is_empty() {
            &mut buffer
        } else {
            &mut []
        };
        match self.station.poll_transmit(now, free) {
            Some(Transmit::Discard) => {
                self.output = CharacterBuffer::EMPTY;
                self.refill(now); // a discard never comes twice in a row
            }
            Some(Transmit::Bytes(bytes)) => {
                self.output = CharacterBuffer::of(bytes);
                self.flushed = false;
            }
            None => {}
        }
    }

    async fn first(&mut self) -> Result<First, R::Error> {
        let (writer, reader, timer) = (&mut self.writer, &mut self.reader, &mut self.timer);
        let due = self.station.poll_timeout();
        let (waiting, flushed) = (self.output.waiting(), self.flushed);
        let input = self.input.room();
        let mut write = pin!(async {
            if !waiting.is_empty() {
                writer.write(waiting).await.map(First::Written)
            } else if !flushed {
                writer.flush().await.map(|()| First::Flushed)
            } else {
                core::future::pending().await
            }
        });
        let mut read = pin!(reader.read(input));
        let mut sleep = pin!(async {
            match due {
                Some(due) => timer.sleep_until(due).await,
                None => core::future::pending().await,
            }
        });
        poll_fn(|context| {
            // The input first: it may change what goes out.
            if let Poll::Ready(len) = read.as_mut().poll(context) {
                return Poll::Ready(len.map(First::Read));
            }
            if let Poll::Ready(done) = write.as_mut().poll(context) {
                return Poll::Ready(done);
            }
            sleep.as_mut().poll(context).map(|()| Ok(First::Due))
        })
        .await
    }
}
