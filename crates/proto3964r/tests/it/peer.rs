//! Against an independent station in Python over a pseudo-terminal: 200 telegrams each way at
//! once, full of control characters, and none is lost.

use core::time::Duration;
use std::{
    io::{self, Read as _, Write as _},
    process::{Child, Command, Stdio},
    time::Instant as Clock,
};

use proto3964r::{Config, Event, Line, Priority, serialport::Driver};
use serialport::{SerialPort as _, TTYPort};

const COUNT: usize = 200;
/// Far above the few seconds that the exchange takes.
const PATIENCE: Duration = Duration::from_secs(120);

/// Payload of 1 to 41 bytes, differing from its neighbours, most of it 02 03 10 15.
fn telegram(side: u8, number: usize) -> Vec<u8> {
    let number = u8::try_from(number).unwrap();
    let control = [0x10, 0x03, 0x02, 0x10, 0x10, 0x15, 0x03];
    let places = 0..usize::from(number) % 41;
    let mut telegram = vec![number ^ side];
    telegram.extend(places.map(|place| {
        control
            .iter()
            .cycle()
            .nth(place * (1 + usize::from(number)) % 97)
            .unwrap()
    }));
    telegram
}

fn hex(bytes: &[u8]) -> String {
    bytes
        .iter()
        .map(|byte| format!("{byte:02X}"))
        .collect::<Vec<_>>()
        .join(" ")
}

/// The peer on the other end; `None` without Python.
fn peer(port: &str, arguments: &[&str]) -> Option<Child> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/peer/peer3964r.py");
    let started = Command::new("python3")
        .args([script, "--port", port, "--linger-ms", "500"])
        .args(["--seconds", &PATIENCE.as_secs().to_string()])
        .args(["--expect", &COUNT.to_string()])
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn();
    match started {
        Ok(child) => Some(child),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            eprintln!("skipped: there is no python3 to run the independent peer");
            None
        }
        Err(error) => panic!("python3: {error}"),
    }
}

/// Gives the peer its jobs and closes its input.
fn submit(child: &mut Child) {
    let mut jobs = child.stdin.take().unwrap();
    for number in 0..COUNT {
        writeln!(jobs, "{}", hex(&telegram(0x80, number))).unwrap();
    }
}

/// Takes a repeat, which a lost acknowledgement makes, out of a list of telegrams.
fn without_repeats(mut telegrams: Vec<String>) -> Vec<String> {
    telegrams.dedup();
    telegrams
}

fn exchange(config: Config, arguments: &[&str]) {
    let (here, there) = TTYPort::pair().expect("a pseudo-terminal");
    let Some(mut child) = peer(&there.name().unwrap(), arguments) else {
        return;
    };
    submit(&mut child);
    let mut line = Driver::<64>::new(Box::new(here), config).unwrap();
    let (mut sent, mut received) = (0, Vec::new());
    let begin = Clock::now();
    while sent < COUNT || received.len() < COUNT {
        // Before the peer has started, repeated STX would wait for it, and plain 3964 takes the
        // second one for data.
        let has_started = !received.is_empty();
        if has_started && sent < COUNT && !line.is_busy() {
            line.submit(&telegram(0x00, sent)).unwrap();
        }
        match line.wait(Duration::from_secs(1)).unwrap() {
            Some(Event::Received(payload)) => {
                received.push(hex(payload));
                received.dedup();
            }
            Some(Event::Sent { .. }) => sent += 1,
            Some(Event::Failed(failure)) => panic!("job {sent}: {failure}"),
            _ => {}
        }
        assert!(
            begin.elapsed() < PATIENCE,
            "{sent} sent, {} received",
            received.len()
        );
    }
    // The peer may still repeat a telegram: answer until the line is silent.
    while line.wait(Duration::from_millis(700)).unwrap().is_some() {}
    let mut report = String::new();
    child
        .stdout
        .take()
        .unwrap()
        .read_to_string(&mut report)
        .unwrap();
    assert!(child.wait().unwrap().success(), "{report}");
    let peer_received: Vec<_> = report
        .lines()
        .filter_map(|line| line.strip_prefix("received ").map(str::to_owned))
        .collect();
    let all = |side| (0..COUNT).map(move |number| hex(&telegram(side, number)));
    assert_eq!(received, all(0x80).collect::<Vec<_>>());
    let outgoing: Vec<_> = all(0x00).collect();
    assert_eq!(without_repeats(peer_received), outgoing);
    let count = |word| report.lines().filter(|line| line.starts_with(word)).count();
    assert_eq!((count("sent "), count("failed ")), (COUNT, 0), "{report}");
}

#[test]
fn station_low_peer_high() {
    exchange(
        Config::siemens_3964r(Priority::Low, Line::Instant),
        &["--priority", "high"],
    );
}

#[test]
fn station_high_peer_low() {
    exchange(
        Config::siemens_3964r(Priority::High, Line::Instant),
        &["--priority", "low"],
    );
}

#[test]
fn without_bcc() {
    let config = Config {
        nak_at_startup: false,
        ..Config::siemens_3964(Priority::High, Line::Instant)
    };
    let plain = ["--protocol", "3964", "--no-startup-nak"];
    exchange(config, &[&["--priority", "low"][..], &plain].concat());
}
