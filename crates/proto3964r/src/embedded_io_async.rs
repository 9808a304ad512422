//! A driver for ports with the traits of [`embedded-io-async`](https://docs.rs/embedded-io-async) 0.7.

use core::{
    future::{Future, poll_fn},
    pin::pin,
    task::Poll,
};

use embedded_io_async::{Read, Write};

use crate::{
    event::Event,
    station::{SendError, Station, Transmit},
    time::Instant,
};

/// Characters that are handed to the port at a time.
const PIECE: usize = 16;

/// The time, and a way to wait for it.
pub trait Timer {
    /// The time since any epoch.
    fn now(&mut self) -> Instant;

    /// Returns at `instant` or later; at once when it has passed.
    fn sleep_until(&mut self, instant: Instant) -> impl Future<Output = ()>;
}

/// A station with the two halves of its port and a timer.
///
/// The halves are apart so that the driver hears the partner while a block goes out. `read` and
/// `write` of the port must be cancel-safe, as those of a buffered UART are: a future that is
/// dropped has taken nothing.
///
/// # Examples
/// ```no_run
/// use proto3964r::{Config, Event, Priority, Station};
/// use proto3964r::embedded_io_async::{Driver, Timer};
///
/// # async fn demo<R, W>(rx: R, tx: W, timer: impl Timer) -> Result<(), R::Error>
/// # where R: embedded_io_async::Read, W: embedded_io_async::Write<Error = R::Error> {
/// let station = Station::<128>::new(Config::siemens_3964r(Priority::High).with_line(9600, 11));
/// let mut line = Driver::new(station, rx, tx, timer);
/// line.send(b"A").ok();
/// loop {
///     match line.wait().await? {
///         Event::Received(telegram) => { /* use it */ }
///         Event::Sent { .. } => break,
///         _ => {}
///     }
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Driver<R, W, M, const N: usize, const T: usize = N> {
    station: Station<N, T>,
    reader: R,
    writer: W,
    timer: M,
    out: Output,
}

/// What the station handed out and the port has not taken: a dropped `wait` loses none of it.
#[derive(Debug, Default)]
struct Output {
    bytes: [u8; PIECE],
    begin: usize,
    end: usize,
    flushed: bool,
}

impl Output {
    fn waiting(&self) -> &[u8] {
        self.bytes.get(self.begin..self.end).unwrap_or_default()
    }

    fn clear(&mut self) {
        self.begin = self.end;
    }
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
    M: Timer,
{
    /// Puts a station on a port.
    pub fn new(station: Station<N, T>, reader: R, writer: W, timer: M) -> Self {
        let out = Output {
            flushed: true,
            ..Output::default()
        };
        Self {
            station,
            reader,
            writer,
            timer,
            out,
        }
    }

    /// The station, for what the driver does not offer.
    pub fn station_mut(&mut self) -> &mut Station<N, T> {
        &mut self.station
    }

    /// Takes a job; it goes out while [`wait`](Self::wait) is polled.
    ///
    /// # Errors
    /// Those of [`Station::send`].
    pub fn send(&mut self, payload: &[u8]) -> Result<(), SendError> {
        self.station.send(self.timer.now(), payload)
    }

    /// Works until there is an event. May be dropped and called again.
    ///
    /// # Errors
    /// Those of the port. A receiver error (parity, framing, overrun) is one of them on most
    /// ports: tell the station with [`Station::handle_damaged`] and go on.
    pub async fn wait(&mut self) -> Result<Event<'_>, R::Error> {
        while !self.station.has_event() {
            self.round().await?;
        }
        // There is one: the fallback is never taken.
        Ok(self.station.poll_event().unwrap_or(Event::Break))
    }

    /// Waits for whatever comes first and tells the station.
    async fn round(&mut self) -> Result<(), R::Error> {
        let now = self.timer.now();
        self.station.handle_timeout(now);
        self.refill(now);
        let mut input = [0; 32];
        match self.first(&mut input).await? {
            First::Written(len) => self.out.begin += len,
            First::Flushed => self.out.flushed = true,
            First::Read(len) => {
                let now = self.timer.now();
                self.station
                    .handle_bytes(now, input.get(..len).unwrap_or_default());
            }
            First::Due => {}
        }
        Ok(())
    }

    /// Fetches the next piece when the port has taken the last one, or when that one is void.
    fn refill(&mut self, now: Instant) {
        let room = if self.out.waiting().is_empty() {
            PIECE
        } else {
            0
        };
        let mut piece = [0; PIECE];
        match self
            .station
            .poll_transmit(now, piece.get_mut(..room).unwrap_or_default())
        {
            Some(Transmit::Discard) => {
                self.out.clear();
                self.refill(now); // a discard never comes twice in a row
            }
            Some(Transmit::Bytes(bytes)) => {
                let end = bytes.len();
                self.out = Output {
                    bytes: piece,
                    begin: 0,
                    end,
                    flushed: false,
                };
            }
            None => {}
        }
    }

    async fn first(&mut self, input: &mut [u8]) -> Result<First, R::Error> {
        let (writer, reader, timer) = (&mut self.writer, &mut self.reader, &mut self.timer);
        let due = self.station.poll_timeout();
        let (waiting, flushed) = (self.out.waiting(), self.out.flushed);
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
