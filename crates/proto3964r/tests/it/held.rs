//! Telegrams that are acknowledged by their user.

use core::time::Duration;
use std::{
    net::{TcpListener, TcpStream},
    thread,
};

use proto3964r::{
    Activity, Cause, Config, Event, Line, Priority, Rejection, Station, blocking,
    tokio::{Link, SendError},
};
use tokio::{
    io::{AsyncReadExt as _, duplex},
    time::{Instant, sleep, timeout},
};

use crate::common::low_side::{DLE, NAK, STX, ms, quiet, sent_by_byte as sent};

/// The block of `A`, without its STX.
const BLOCK: [u8; 4] = [0x41, 0x10, 0x03, 0x52];

const HIGH: Config = Config::siemens_3964r(Priority::High, Line::Instant);
/// Answers when its user does, within 1.5 s.
const HELD: Config = Config {
    acknowledge_wait_ms: 1500,
    ..quiet(Priority::Low, Line::Instant)
};
const WAIT: Duration = Duration::from_millis(1500);

/// A station that has received `A` at 0 ms and answered STX alone.
fn holding() -> Station<16> {
    let mut station = Station::new(HELD);
    station.handle_byte(ms(0), STX);
    assert_eq!(sent(&mut station, ms(0)), [DLE]);
    assert_eq!(station.handle_bytes(ms(0), &BLOCK), BLOCK.len());
    assert!(sent(&mut station, ms(0)).is_empty());
    assert_eq!(station.poll_event(), Some(Event::Received(b"A")));
    assert_eq!(station.activity(), Activity::AwaitUser);
    station
}

#[test]
fn accepted_it_is_acknowledged_and_refused_it_is_not() {
    let mut station = holding();
    assert!(station.accept(ms(700)));
    assert_eq!(sent(&mut station, ms(700)), [DLE]);
    assert!(station.is_idle());
    assert!(!station.accept(ms(700)), "once");

    let mut station = holding();
    assert!(station.refuse(ms(700)));
    assert_eq!(sent(&mut station, ms(700)), [NAK]);
    let refused = Event::Rejected(Rejection::Refused);
    assert_eq!(station.poll_event(), Some(refused));
    assert_eq!(station.activity(), Activity::AwaitRepeat);
    assert!(!station.accept(ms(701)));
}

#[test]
fn without_a_word_in_time_it_is_nak() {
    let mut station = holding();
    assert_eq!(station.poll_timeout(), Some(WAIT));
    station.handle_timeout(WAIT);
    assert_eq!(sent(&mut station, WAIT), [NAK]);
    assert!(!station.accept(WAIT));
    let undecided = Event::Rejected(Rejection::Undecided);
    assert_eq!(station.poll_event(), Some(undecided));
    // The repeat is a telegram of its own.
    station.handle_byte(ms(1600), STX);
    assert_eq!(sent(&mut station, ms(1600)), [DLE]);
    assert_eq!(station.handle_bytes(ms(1600), &BLOCK), BLOCK.len());
    assert!(!station.accept(ms(1600)), "it has not been polled");
    assert_eq!(station.poll_event(), Some(Event::Received(b"A")));
    assert!(station.accept(ms(1600)));
    assert_eq!(sent(&mut station, ms(1600)), [DLE]);
}

/// However long is configured, the answer comes before the partner's QVZ is over.
#[test]
fn the_answer_comes_before_qvz() {
    for (qvz_ms, wait_ms) in [(2000, 1990), (128, 118), (5, 0)] {
        let mut station = Station::<16>::new(Config {
            qvz_ms,
            acknowledge_wait_ms: u16::MAX,
            ..HELD
        });
        station.handle_byte(ms(0), STX);
        assert_eq!(station.handle_bytes(ms(0), &BLOCK), BLOCK.len());
        assert_eq!(station.poll_timeout(), Some(ms(wait_ms)));
    }
}

#[test]
fn the_partner_may_ask_again_or_give_up() {
    let mut station = holding();
    station.handle_byte(ms(100), STX);
    assert!(!station.accept(ms(100)), "another block is to come");
    assert_eq!(sent(&mut station, ms(100)), [DLE]);

    let mut station = holding();
    station.handle_byte(ms(100), NAK);
    assert!(!station.accept(ms(100)));
    assert!(sent(&mut station, ms(100)).is_empty());
    assert!(station.is_idle());

    // Noise changes nothing.
    let mut station = holding();
    for byte in [DLE, 0x41] {
        station.handle_byte(ms(100), byte);
    }
    assert!(station.accept(ms(100)));
    assert_eq!(sent(&mut station, ms(100)), [DLE]);
}

/// The job of the receiver waits for the answer of its user.
#[test]
fn a_job_waits_until_the_telegram_is_answered() {
    let mut station = holding();
    station.submit(ms(10), b"B").unwrap();
    assert!(sent(&mut station, ms(10)).is_empty());
    assert!(station.accept(ms(20)));
    assert_eq!(sent(&mut station, ms(20)), [DLE, STX]);
}

#[tokio::test(start_paused = true)]
async fn a_link_acknowledges_when_its_user_accepts() {
    let (here, there) = duplex(64);
    let (link, partner) = (Link::new(here, HELD), Link::new(there, HIGH));
    let begin = Instant::now();
    let accepting = async {
        let incoming = link.incoming().await.unwrap();
        assert_eq!(incoming.telegram(), b"12.5 kg");
        sleep(ms(1000)).await;
        assert!(incoming.accept().await);
    };
    let (sent, ()) = tokio::join!(partner.send(b"12.5 kg"), accepting);
    sent.unwrap();
    assert!(begin.elapsed() >= ms(1000));
}

#[tokio::test(start_paused = true)]
async fn refused_dropped_and_late_telegrams_come_again() {
    let (here, there) = duplex(64);
    let (link, partner) = (Link::new(here, HELD), Link::new(there, HIGH));
    let taking = async {
        link.incoming().await.unwrap().refuse();
        drop(link.incoming().await.unwrap());
        let late = link.incoming().await.unwrap();
        sleep(WAIT + ms(1)).await;
        assert!(!late.accept().await);
        let accepted = link.incoming().await.unwrap();
        assert_eq!(accepted.telegram(), b"A");
        assert!(accepted.accept().await);
    };
    let (sent, ()) = tokio::join!(partner.send(b"A"), taking);
    sent.unwrap();
}

/// Nobody takes it: the partner is told so, and it is handed out once when somebody does.
#[tokio::test(start_paused = true)]
async fn what_nobody_takes_is_never_acknowledged() {
    let (here, there) = duplex(64);
    let (link, partner) = (Link::new(here, HELD), Link::new(there, HIGH));
    let SendError::Failed(failure) = partner.send(b"A").await.unwrap_err() else {
        panic!("it was acknowledged");
    };
    assert_eq!(failure.cause, Cause::Nak);
    sleep(ms(10_000)).await;
    let (sent, received) = tokio::join!(partner.send(b"B"), link.receive());
    sent.unwrap();
    assert_eq!(received.unwrap(), b"B");
    assert!(timeout(ms(10_000), link.receive()).await.is_err());
    assert!(link.close().await.is_empty());
}

/// The stream is closed while the user decides.
#[tokio::test(start_paused = true)]
async fn a_lost_link_accepts_nothing() {
    let (here, mut there) = duplex(64);
    let link = Link::new(here, HELD);
    tokio::io::AsyncWriteExt::write_all(&mut there, &[STX])
        .await
        .unwrap();
    assert_eq!(there.read_u8().await.unwrap(), DLE);
    tokio::io::AsyncWriteExt::write_all(&mut there, &BLOCK)
        .await
        .unwrap();
    let incoming = link.incoming().await.unwrap();
    drop(there);
    sleep(ms(1)).await;
    assert!(!incoming.accept().await);
}

#[test]
fn the_blocking_driver_accepts_too() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let partner = thread::spawn(move || {
        let port = TcpStream::connect(address).unwrap();
        let mut partner = blocking::Driver::<_, 16>::new(port, HIGH).unwrap();
        partner.submit(b"A").unwrap();
        let outcome = partner.wait(ms(30_000)).unwrap();
        assert_eq!(outcome, Some(Event::Sent { len: 1 }));
    });
    let (port, _) = listener.accept().unwrap();
    let mut line = blocking::Driver::<_, 16>::new(port, HELD).unwrap();
    let mut taken = 0;
    while taken < 2 {
        if let Some(Event::Received(telegram)) = line.wait(ms(30_000)).unwrap() {
            assert_eq!(telegram, b"A");
            taken += 1;
            assert!(if taken == 1 {
                line.refuse()
            } else {
                line.accept()
            });
        }
    }
    drop(line.wait(ms(50)));
    partner.join().unwrap();
}
