//! Links over streams of tokio: both ways at once, noise, a dead partner, dropped futures.

extern crate alloc;

use alloc::collections::VecDeque;
use core::{
    pin::Pin,
    task::{Context, Poll},
    time::Duration,
};
use std::{
    io::{self, ErrorKind},
    thread,
};

use proto3964r::{
    Cause, CharacterError, Config, Event, JobPhase, Line, Priority, SubmitError,
    serialport::Driver,
    tokio::{Damage, Link, SendError},
};
use serialport::TTYPort;
use tokio::{
    io::{
        AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, DuplexStream, ReadBuf, duplex,
    },
    net::{TcpListener, TcpStream},
    time::{sleep, timeout},
};

const LOW: Config = Config::siemens_3964r(Priority::Low, Line::Instant);
const HIGH: Config = Config::siemens_3964r(Priority::High, Line::Instant);
/// Telegrams in each direction.
const COUNT: u8 = 100;
/// Above what a conversation takes on a busy computer, where time is not paused.
const PATIENCE: Duration = Duration::from_secs(30);

/// Control characters, and lengths from 1 to 60.
fn telegram(number: u8) -> Vec<u8> {
    let control = [0x02, 0x03, 0x10, 0x15, 0x41];
    let rest = control.iter().cycle().take(usize::from(number % 60));
    core::iter::once(number).chain(rest.copied()).collect()
}

async fn send_all(link: &Link) {
    for number in 0..COUNT {
        link.send(&telegram(number)).await.unwrap();
    }
}

/// Receives every telegram, in their order; a lost acknowledgement makes a duplicate.
async fn receive_all(link: &Link) {
    let mut last = None;
    for number in 0..COUNT {
        let wanted = telegram(number);
        let mut received = link.receive().await.unwrap();
        while Some(&received) == last.as_ref() {
            received = link.receive().await.unwrap();
        }
        assert_eq!(received, wanted);
        last = Some(received);
    }
}

/// Both links send and receive at once.
async fn both_ways(a: &Link, b: &Link) {
    let all = async {
        tokio::join!(send_all(a), send_all(b), receive_all(a), receive_all(b));
    };
    timeout(PATIENCE * 1000, all).await.unwrap();
}

#[tokio::test(start_paused = true)]
async fn both_ways_at_once() {
    let (here, there) = duplex(16);
    both_ways(&Link::new(here, LOW), &Link::new(there, HIGH)).await;
}

#[tokio::test]
async fn over_tcp() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = format!("tcp://{}", listener.local_addr().unwrap());
    let (link, accepted) = tokio::join!(Link::connect(&address, LOW), listener.accept());
    both_ways(&link.unwrap(), &Link::new(accepted.unwrap().0, HIGH)).await;
}

/// One direction of a line on which every 997th byte loses a bit.
async fn damage(mut from: impl AsyncRead + Unpin, mut to: impl AsyncWrite + Unpin) {
    let mut count = 0;
    while let Ok(byte) = from.read_u8().await {
        count += 1;
        let damaged = if count % 997 == 0 { byte ^ 0x20 } else { byte };
        if to.write_u8(damaged).await.is_err() {
            return;
        }
    }
}

/// The ends of a line that damages bytes in both directions.
fn noisy_line() -> (DuplexStream, DuplexStream) {
    let (here, left) = duplex(16);
    let (right, there) = duplex(16);
    let (left_reader, left_writer) = tokio::io::split(left);
    let (right_reader, right_writer) = tokio::io::split(right);
    tokio::spawn(damage(left_reader, right_writer));
    tokio::spawn(damage(right_reader, left_writer));
    (here, there)
}

#[tokio::test(start_paused = true)]
async fn noise_costs_repeats_and_no_telegram() {
    let (here, there) = noisy_line();
    both_ways(&Link::new(here, LOW), &Link::new(there, HIGH)).await;
}

#[tokio::test(start_paused = true)]
async fn a_dead_partner_is_a_failure_of_the_connection_phase() {
    let (here, _there) = duplex(1024);
    let link = Link::new(here, LOW);
    let error = link.send(b"tare").await.unwrap_err();
    let SendError::Failed(failure) = error else {
        panic!("{error}");
    };
    assert_eq!(
        (failure.phase, failure.cause),
        (JobPhase::Connection, Cause::Timeout)
    );
}

#[tokio::test(start_paused = true)]
async fn a_dropped_send_gives_its_telegram_up_and_the_next_goes_out() {
    let (here, mut there) = duplex(1024);
    let link = Link::new(here, LOW);
    let second = Duration::from_secs(1);
    assert!(timeout(second, link.send(b"lost")).await.is_err());
    let mut silent = [0; 16];
    let _ = there.read(&mut silent).await.unwrap();
    let partner = Link::new(there, HIGH);
    link.send(b"tare").await.unwrap();
    assert_eq!(partner.receive().await.unwrap(), b"tare");
}

#[tokio::test(start_paused = true)]
async fn a_dropped_receive_loses_nothing() {
    let (here, there) = duplex(1024);
    let (link, partner) = (Link::new(here, LOW), Link::new(there, HIGH));
    let millisecond = Duration::from_millis(1);
    assert!(timeout(millisecond, link.receive()).await.is_err());
    partner.send(b"12.5 kg").await.unwrap();
    assert_eq!(link.receive().await.unwrap(), b"12.5 kg");
}

#[tokio::test(start_paused = true)]
async fn what_is_not_fetched_makes_the_partner_wait_and_is_not_lost() {
    let (here, there) = duplex(1024);
    let (link, partner) = (Link::new(here, LOW), Link::new(there, HIGH));
    let sender = tokio::spawn(async move {
        let mut sent = 0_u8;
        while partner.send(&[sent]).await.is_ok() {
            sent += 1;
        }
        (sent, partner)
    });
    // Far longer than all attempts of the partner take.
    sleep(Duration::from_secs(600)).await;
    let (sent, _partner) = sender.await.unwrap();
    // Those in the queue, and the one in the station.
    assert_eq!(usize::from(sent), Link::QUEUE + 1);
    for number in 0..sent {
        assert_eq!(link.receive().await.unwrap(), [number]);
    }
}

/// A telegram that nobody answers is refused by the end of its time. It kept the outcomes of jobs
/// for itself: a gateway that was read anew with a command under way waited for that for ever.
#[tokio::test(start_paused = true)]
async fn what_is_not_accepted_keeps_no_outcome_back() {
    let (here, there) = duplex(1024);
    let held = Config {
        acknowledge_wait_ms: 300,
        ..LOW
    };
    let (link, partner) = (Link::new(here, held), Link::new(there, HIGH));
    let sending = tokio::spawn(async move {
        // One after the other is given up by the partner.
        while !matches!(partner.send(b"12.5 kg").await, Err(SendError::Lost(_))) {
            sleep(Duration::from_millis(700)).await;
        }
    });
    sleep(Duration::from_secs(60)).await;
    let sent = timeout(Duration::from_secs(60), link.send(b"tare")).await;
    sent.expect("an outcome").ok();
    // What comes next is there for whoever fetches again.
    let incoming = timeout(Duration::from_secs(60), link.incoming()).await;
    assert!(incoming.expect("a telegram").unwrap().accept().await);
    drop(link);
    sending.await.unwrap();
}

#[tokio::test]
async fn a_closed_link_hands_back_all_that_it_has_acknowledged() {
    /// Closed in the middle of a telegram, between two, and with a full queue.
    const FETCHED_BEFORE: [u8; 4] = [0, 1, 7, 30];
    for fetched in FETCHED_BEFORE {
        let (here, there) = duplex(64);
        let (plc, scale) = (Link::new(here, HIGH), Link::new(there, LOW));
        let sending = tokio::spawn(async move {
            let mut acknowledged = 0;
            while plc.send(&telegram(acknowledged)).await.is_ok() {
                acknowledged += 1;
            }
            acknowledged
        });
        let mut received = Vec::new();
        for _ in 0..fetched {
            received.push(scale.receive().await.unwrap());
        }
        if fetched == 30 {
            // Until the partner is made to wait.
            sleep(Duration::from_millis(200)).await;
        }
        received.extend(scale.close().await);
        let acknowledged = sending.await.unwrap();
        let all: Vec<_> = (0..acknowledged).map(telegram).collect();
        // The last acknowledgement may have been lost with the stream.
        assert!(received.starts_with(&all), "{fetched} {acknowledged}");
        assert!(received.len() <= all.len() + 1, "{fetched} {acknowledged}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_lost_connection_is_told_to_every_call() {
    let (here, there) = duplex(1024);
    let (link, partner) = (Link::new(here, LOW), Link::new(there, HIGH));
    partner.send(b"last").await.unwrap();
    drop(partner);
    assert_eq!(link.receive().await.unwrap(), b"last");
    let lost = link.receive().await.unwrap_err();
    assert_eq!(lost.kind(), ErrorKind::UnexpectedEof);
    let error = link.send(b"tare").await.unwrap_err();
    assert_eq!(
        error.to_string(),
        "the connection is lost: closed by the other end"
    );
}

#[tokio::test(start_paused = true)]
async fn a_telegram_that_is_too_long_is_refused() {
    let (here, _there) = duplex(1024);
    let link = Link::new(here, LOW);
    let len = Link::MAX_TELEGRAM + 1;
    let error = link.send(&vec![0; len]).await.unwrap_err();
    let capacity = Link::MAX_TELEGRAM;
    let wanted = SubmitError::TooLong { len, capacity };
    assert!(matches!(error, SendError::Refused(error) if error == wanted));
}

#[tokio::test]
async fn other_addresses_are_refused() {
    let error = Link::connect("192.168.0.7:4001", LOW).await.unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert_eq!(
        error.to_string(),
        "an address is tcp://HOST:PORT, not 192.168.0.7:4001"
    );
}

/// One end of a pseudo-terminal, carried over TCP as a serial server does, until either end closes.
fn serial_server(mut port: TTYPort, mut stream: std::net::TcpStream) {
    use serialport::SerialPort as _;
    use std::io::{Read as _, Write as _};
    port.set_timeout(Duration::from_millis(1)).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_millis(1)))
        .unwrap();
    let mut buffer = [0; 64];
    loop {
        match port.read(&mut buffer) {
            Ok(len) => stream.write_all(&buffer[..len]).unwrap(),
            Err(error) if error.kind() == ErrorKind::TimedOut => {}
            Err(_) => return,
        }
        match stream.read(&mut buffer) {
            Ok(0) => return,
            Ok(len) => port.write_all(&buffer[..len]).unwrap(),
            // A process that is paused and goes on is interrupted where a socket has a time-out.
            Err(error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
            Err(_) => return,
        }
    }
}

#[tokio::test]
async fn a_serial_server_with_a_pseudo_terminal_behind_it() {
    let (port, there) = TTYPort::pair().unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let (stream, accepted) = tokio::join!(TcpStream::connect(address), listener.accept());
    let accepted = accepted.unwrap().0.into_std().unwrap();
    accepted.set_nonblocking(false).unwrap();
    thread::spawn(move || serial_server(port, accepted));
    let device = thread::spawn(move || {
        let mut line = Driver::<64>::new(Box::new(there), HIGH).unwrap();
        loop {
            match line.wait(PATIENCE).unwrap() {
                Some(Event::Received(request)) => {
                    let answer: Vec<u8> = request.iter().rev().copied().collect();
                    line.submit(&answer).unwrap();
                }
                Some(Event::Sent { .. }) => return,
                Some(_) => {}
                None => panic!("no request"),
            }
        }
    });
    let link = Link::new(stream.unwrap(), LOW);
    timeout(PATIENCE, link.send(b"abc")).await.unwrap().unwrap();
    let answer = timeout(PATIENCE, link.receive()).await.unwrap().unwrap();
    assert_eq!(answer, b"cba");
    device.join().unwrap();
}

/// A stream that reports damage in between its characters.
struct Damaging {
    stream: DuplexStream,
    script: VecDeque<Result<u8, Damage>>,
}

impl AsyncRead for Damaging {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        match self.script.pop_front() {
            Some(Ok(byte)) => buffer.put_slice(&[byte]),
            Some(Err(damage)) => return Poll::Ready(Err(damage.into())),
            None => return Pin::new(&mut self.stream).poll_read(context, buffer),
        }
        Poll::Ready(Ok(()))
    }
}

impl AsyncWrite for Damaging {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(context, bytes)
    }

    fn poll_flush(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }
}

/// The BCC is right all the same: two bits of the character are wrong.
#[tokio::test(start_paused = true)]
async fn damaged_characters_reach_the_station() {
    let (stream, mut partner) = duplex(64);
    let damaged = Damage::Character {
        byte: 0x41,
        error: CharacterError::Parity,
    };
    let block = [Ok(0x02), Err(damaged), Ok(0x10), Ok(0x03), Ok(0x52)];
    let script = [Err(Damage::Break)].into_iter().chain(block).collect();
    let link = Link::new(Damaging { stream, script }, LOW);
    let mut answers = [0; 3];
    partner.read_exact(&mut answers).await.unwrap();
    assert_eq!(answers, [0x15, 0x10, 0x15], "start-up, ready, rejected");
    partner.write_all(&[0x02]).await.unwrap();
    assert_eq!(partner.read_u8().await.unwrap(), 0x10);
    partner.write_all(&[0x41, 0x10, 0x03, 0x52]).await.unwrap();
    assert_eq!(link.receive().await.unwrap(), [0x41]);
}
