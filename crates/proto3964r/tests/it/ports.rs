//! The three drivers, each against the `serialport` one over a pseudo-terminal pair.

use core::{
    convert::Infallible,
    future::Future,
    pin::pin,
    task::{Context, Poll, Waker},
    time::Duration,
};
use std::{
    io::{Read as _, Write as _},
    thread,
    time::Instant as Clock,
};

use proto3964r::{
    Config, Event, Line, Priority, Station, embedded_io as blocking,
    embedded_io_async as asynchronous, serialport::Driver,
};
use serialport::{SerialPort, TTYPort};

use crate::common::low_side::low;

/// Telegrams in each direction.
const COUNT: u8 = 60;
/// Far above what any of these conversations takes.
const PATIENCE: Duration = Duration::from_secs(30);

/// Control characters, and lengths from 1 to 60.
fn telegram(number: u8) -> Vec<u8> {
    let mut telegram = vec![number];
    let control = [0x02, 0x03, 0x10, 0x15, 0x41];
    telegram.extend(control.iter().cycle().take(usize::from(number)));
    telegram
}

fn config(priority: Priority) -> Config {
    Config::siemens_3964r(priority, Line::Instant)
}

/// What one end has done so far.
#[derive(Default)]
struct Ledger {
    sent: u8,
    received: u8,
}

impl Ledger {
    fn is_complete(&self) -> bool {
        self.sent == COUNT && self.received == COUNT
    }

    fn next(&self) -> Option<Vec<u8>> {
        (self.sent < COUNT).then(|| telegram(self.sent))
    }

    fn enter(&mut self, event: Event<'_>) {
        match event {
            Event::Received(payload)
                if self.received > 0 && payload == telegram(self.received - 1) => {}
            Event::Received(payload) => {
                assert_eq!(payload, telegram(self.received));
                self.received += 1;
            }
            Event::Sent { .. } => self.sent += 1,
            Event::Failed(failure) => panic!("{failure}"),
            _ => {}
        }
    }
}

/// The other end: the `serialport` driver in a thread of its own, alive until `COUNT` telegrams
/// have gone both ways and the line has been silent for a second.
fn partner(port: TTYPort) -> thread::JoinHandle<()> {
    thread::spawn(move || {
        let mut line = Driver::<64>::new(Box::new(port), config(Priority::High)).unwrap();
        let mut ledger = Ledger::default();
        let begin = Clock::now();
        loop {
            if let Some(telegram) = ledger.next().filter(|_| !line.is_busy()) {
                line.submit(&telegram).unwrap();
            }
            match line.wait(Duration::from_secs(1)).unwrap() {
                Some(event) => ledger.enter(event),
                None if ledger.is_complete() => break,
                None => {}
            }
            assert!(
                begin.elapsed() < PATIENCE,
                "{} sent, {} received",
                ledger.sent,
                ledger.received
            );
        }
    })
}

#[test]
fn serialport_both_ways() {
    let (here, there) = TTYPort::pair().expect("a pseudo-terminal");
    let other = partner(there);
    let mut line = Driver::<64>::new(Box::new(here), config(Priority::Low)).unwrap();
    let mut ledger = Ledger::default();
    let begin = Clock::now();
    while !ledger.is_complete() {
        if let Some(telegram) = ledger.next().filter(|_| !line.is_busy()) {
            line.submit(&telegram).unwrap();
        }
        if let Some(event) = line.wait(Duration::from_secs(1)).unwrap() {
            ledger.enter(event);
        }
        assert!(begin.elapsed() < PATIENCE);
    }
    other.join().unwrap();
}

/// A pseudo-terminal with the traits of `embedded-io` and `embedded-io-async`.
struct Port(TTYPort);

#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct PortError(std::io::Error);

impl embedded_io::Error for PortError {
    fn kind(&self) -> embedded_io::ErrorKind {
        embedded_io::ErrorKind::Other
    }
}

impl embedded_io::ErrorType for Port {
    type Error = PortError;
}

impl embedded_io::ReadReady for Port {
    fn read_ready(&mut self) -> Result<bool, PortError> {
        let waiting = self
            .0
            .bytes_to_read()
            .map_err(|error| PortError(error.into()))?;
        Ok(waiting > 0)
    }
}

impl embedded_io::Read for Port {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        self.0.read(buffer).map_err(PortError)
    }
}

impl embedded_io::Write for Port {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.0.write(bytes).map_err(PortError)
    }

    fn flush(&mut self) -> Result<(), PortError> {
        Ok(())
    }
}

impl embedded_io_async::Read for Port {
    async fn read(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        core::future::poll_fn(|_| match embedded_io::ReadReady::read_ready(self) {
            Ok(false) => Poll::Pending, // the executor of this test polls without being woken
            Ok(true) => Poll::Ready(embedded_io::Read::read(self, buffer)),
            Err(error) => Poll::Ready(Err(error)),
        })
        .await
    }
}

impl embedded_io_async::Write for Port {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        embedded_io::Write::write(self, bytes)
    }

    async fn flush(&mut self) -> Result<(), PortError> {
        Ok(())
    }
}

#[test]
fn embedded_io_both_ways() {
    let (here, there) = TTYPort::pair().expect("a pseudo-terminal");
    let other = partner(there);
    let epoch = Clock::now();
    let station = Station::<64>::new(config(Priority::Low));
    let mut line = blocking::Driver::new(station, Port(here), || epoch.elapsed());
    let mut ledger = Ledger::default();
    while !ledger.is_complete() {
        if let Some(telegram) = ledger.next().filter(|_| !line.is_busy()) {
            line.submit(&telegram).unwrap();
        }
        ledger.enter(line.wait().unwrap());
        assert!(epoch.elapsed() < PATIENCE);
    }
    line.step().unwrap(); // the last acknowledgement
    other.join().unwrap();
}

/// Two telegrams that an adapter handed on in one piece.
const BOTH: [u8; 10] = [0x02, 0x41, 0x10, 0x03, 0x52, 0x02, 0x42, 0x10, 0x03, 0x51];
const ANSWERS: [u8; 4] = [0x10; 4];

/// Hands on all that has come in at once, and keeps what is written.
#[derive(Default)]
struct Canned {
    input: Vec<u8>,
    output: Vec<u8>,
}

impl embedded_io::ErrorType for Canned {
    type Error = Infallible;
}

impl embedded_io::ReadReady for Canned {
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        Ok(!self.input.is_empty())
    }
}

impl embedded_io::Read for Canned {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Infallible> {
        let len = self.input.len();
        for (to, from) in buffer.iter_mut().zip(self.input.drain(..)) {
            *to = from;
        }
        Ok(len)
    }
}

impl embedded_io::Write for Canned {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        self.output.extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl embedded_io_async::Read for Canned {
    async fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Infallible> {
        if self.input.is_empty() {
            core::future::pending::<()>().await;
        }
        embedded_io::Read::read(self, buffer)
    }
}

impl embedded_io_async::Write for Canned {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        embedded_io::Write::write(self, bytes)
    }

    async fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

#[test]
fn embedded_io_gives_both_telegrams_of_one_read() {
    let port = Canned {
        input: BOTH.to_vec(),
        output: vec![],
    };
    let mut line = blocking::Driver::new(Station::<64>::new(low()), port, || Duration::ZERO);
    assert_eq!(line.wait().unwrap(), Event::Received(b"A"));
    assert_eq!(line.wait().unwrap(), Event::Received(b"B"));
    line.step().unwrap();
    assert_eq!(line.port_mut().output, ANSWERS);
}

#[test]
fn embedded_io_async_gives_both_telegrams_of_one_read() {
    let reader = Canned {
        input: BOTH.to_vec(),
        output: vec![],
    };
    let timer = SystemTimer(Clock::now());
    let station = Station::<64>::new(low());
    let mut line = asynchronous::Driver::new(station, reader, Canned::default(), timer);
    block_on(async {
        assert_eq!(line.wait().await.unwrap(), Event::Received(b"A"));
        assert_eq!(line.wait().await.unwrap(), Event::Received(b"B"));
    });
}

#[test]
fn serialport_gives_both_telegrams_of_one_read() {
    let (here, mut there) = TTYPort::pair().expect("a pseudo-terminal");
    let mut line = Driver::<64>::new(Box::new(here), low()).unwrap();
    there.write_all(&BOTH).unwrap();
    let patience = Duration::from_secs(5);
    assert_eq!(line.wait(patience).unwrap(), Some(Event::Received(b"A")));
    assert_eq!(line.wait(patience).unwrap(), Some(Event::Received(b"B")));
    assert_eq!(line.wait(Duration::ZERO).unwrap(), None);
    let mut answers = [0; ANSWERS.len()];
    there.set_timeout(patience).unwrap();
    there.read_exact(&mut answers).unwrap();
    assert_eq!(answers, ANSWERS);
}

struct SystemTimer(Clock);

impl asynchronous::AsyncClock for SystemTimer {
    fn now(&mut self) -> Duration {
        self.0.elapsed()
    }

    async fn sleep_until(&mut self, time: Duration) {
        core::future::poll_fn(|_| match self.now() < time {
            true => Poll::Pending,
            false => Poll::Ready(()),
        })
        .await;
    }
}

/// Polls again and again.
fn block_on<F: Future>(future: F) -> F::Output {
    let mut future = pin!(future);
    loop {
        match future
            .as_mut()
            .poll(&mut Context::from_waker(Waker::noop()))
        {
            Poll::Ready(output) => return output,
            Poll::Pending => thread::sleep(Duration::from_micros(50)),
        }
    }
}

#[test]
fn embedded_io_async_both_ways() {
    let (here, there) = TTYPort::pair().expect("a pseudo-terminal");
    let other = partner(there);
    let writer = Port(here.try_clone_native().expect("a second handle"));
    let timer = SystemTimer(Clock::now());
    let station = Station::<64>::new(config(Priority::Low));
    let mut line = asynchronous::Driver::new(station, Port(here), writer, timer);
    let mut ledger = Ledger::default();
    let begin = Clock::now();
    block_on(async {
        while !ledger.is_complete() {
            if let Some(telegram) = ledger.next().filter(|_| !line.is_busy()) {
                line.submit(&telegram).unwrap();
            }
            ledger.enter(line.wait().await.unwrap());
            assert!(begin.elapsed() < PATIENCE);
        }
        // The last acknowledgement: work on until the partner has been silent.
        let mut rest = pin!(line.wait());
        let end = Clock::now() + Duration::from_millis(300);
        core::future::poll_fn(|context| match rest.as_mut().poll(context) {
            Poll::Pending if Clock::now() < end => Poll::Pending,
            _ => Poll::Ready(()),
        })
        .await;
    });
    other.join().unwrap();
}
