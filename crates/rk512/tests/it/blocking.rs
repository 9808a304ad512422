//! The client that waits, over TCP and the pace of a serial line.

use core::time::Duration;
use std::{
    io::{ErrorKind, Read as _, Write as _},
    net::{TcpListener, TcpStream},
    thread,
};

use proto3964r::{Config as LineConfig, Event, Line, Priority, blocking::Driver};
use rk512::{
    Area, CallError, Config, DataBlock, JobError, MAX_TELEGRAM, Memory, ReactionError, Server,
    blocking::{Client, connect},
};

const LOW: LineConfig = LineConfig::siemens_3964r(Priority::Low, Line::Instant);
const HIGH: LineConfig = LineConfig::siemens_3964r(Priority::High, Line::Instant);
/// Above what a conversation takes on a busy computer.
const PATIENCE: Duration = Duration::from_secs(30);

/// A PLC with data block 10 of 255 words, until its connection ends.
fn plc(stream: TcpStream) {
    let mut db10 = [0; 510];
    let mut memory = Memory::new([DataBlock::db(10, &mut db10)]);
    let mut server = Server::new(Config::DEFAULT);
    let mut line = Driver::<_, MAX_TELEGRAM>::new(stream, HIGH).unwrap();
    let now = Duration::ZERO;
    loop {
        match line.wait(PATIENCE) {
            Ok(Some(Event::Received(command))) => server.handle_block(command, &mut memory),
            Ok(Some(Event::Sent { .. })) => server.handle_delivered(now),
            Ok(Some(Event::Failed(_))) => server.handle_failed(&mut memory),
            Ok(_) => {}
            Err(_) => return,
        }
        if let Some(reaction) = server.poll_transmit() {
            line.submit(&reaction).unwrap();
        }
    }
}

/// A TCP connection.
fn connection() -> (TcpStream, TcpStream) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let here = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
    let there = listener.accept().unwrap().0;
    for stream in [&here, &there] {
        stream.set_nodelay(true).unwrap();
    }
    (here, there)
}

fn pair() -> Client<TcpStream> {
    let (here, there) = connection();
    thread::spawn(|| plc(there));
    Client::new(here, LOW, Config::DEFAULT).unwrap()
}

/// One direction of a serial server at 9600 bit/s, 11 bits a character.
fn pace(mut from: TcpStream, mut to: TcpStream) {
    let mut byte = [0; 1];
    while from.read_exact(&mut byte).is_ok() {
        thread::sleep(Duration::from_micros(1146));
        if to.write_all(&byte).is_err() {
            return;
        }
    }
}

#[test]
fn what_was_sent_through_a_serial_server_is_fetched() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let mut client = connect(listener.local_addr().unwrap()).unwrap();
    let server = listener.accept().unwrap().0;
    server.set_nodelay(true).unwrap();
    let (port, there) = connection();
    thread::spawn(|| plc(there));
    let (from_client, from_plc) = (server.try_clone().unwrap(), port.try_clone().unwrap());
    thread::spawn(|| pace(from_client, port));
    thread::spawn(|| pace(from_plc, server));
    client.send(Area::db(10, 4), b"12.5 kg ").unwrap();
    assert_eq!(client.fetch(Area::db(10, 4), 4).unwrap(), b"12.5 kg ");
}

#[test]
fn jobs_of_several_telegrams() {
    let mut client = pair();
    let control = [0x02, 0x03, 0x10, 0x15, 0xFF, 0x41, 0x00];
    let data: Vec<u8> = control.into_iter().cycle().take(300).collect();
    client.send(Area::db(10, 0), &data).unwrap();
    assert_eq!(client.fetch(Area::db(10, 0), 150).unwrap(), data);
}

#[test]
fn what_the_plc_refuses_is_told_with_its_number_and_the_next_job_runs() {
    let mut client = pair();
    let error = client.fetch(Area::db(11, 0), 1).unwrap_err();
    let refused = JobError::Refused(ReactionError::NoSuchBlock);
    assert!(matches!(error, CallError::Failed(error) if error == refused));
    assert_eq!(client.fetch(Area::db(10, 0), 1).unwrap(), [0, 0]);
    let odd = client.send(Area::db(10, 0), &[1, 2, 3]).unwrap_err();
    assert!(matches!(odd, CallError::Words { len: 3 }), "{odd}");
}

#[test]
fn a_silent_plc_is_no_reaction() {
    let (here, there) = connection();
    thread::spawn(|| {
        let mut line = Driver::<_, MAX_TELEGRAM>::new(there, HIGH).unwrap();
        while line.wait(PATIENCE).is_ok() {}
    });
    let config = Config {
        reaction_time: Duration::from_millis(100),
        ..Config::DEFAULT
    };
    let mut client = Client::new(here, LOW, config).unwrap();
    let error = client.fetch(Area::db(10, 0), 1).unwrap_err();
    assert!(
        matches!(error, CallError::Failed(JobError::NoReaction(_))),
        "{error}"
    );
}

#[test]
fn a_lost_connection_is_told_to_every_job() {
    let (here, there) = connection();
    drop(there);
    let mut client = Client::new(here, LOW, Config::DEFAULT).unwrap();
    for _ in 0..2 {
        let error = client.fetch(Area::db(10, 0), 1).unwrap_err();
        let CallError::Lost(lost) = error else {
            panic!("{error}");
        };
        let kinds = [
            ErrorKind::UnexpectedEof,
            ErrorKind::BrokenPipe,
            ErrorKind::ConnectionReset,
        ];
        assert!(kinds.contains(&lost.kind()), "{lost}");
    }
}
