//! `station` against an independent station in Python: 200 telegrams each way at once.

use core::fmt::Write as _;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::Path;
use std::process::Command;
use std::thread;

use serialport::{SerialPort as _, TTYPort};

use super::program::{instant, lines, program, run};

const PEER: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../crates/proto3964r/tests/peer/peer3964r.py"
);
const COUNT: usize = 200;
/// Far above the few seconds that the exchange takes.
const PATIENCE_S: &str = "120";

/// 1 to 40 bytes, the first two unlike any other telegram's, most of the rest 02 03 10 15.
fn telegram(side: u8, number: usize) -> Vec<u8> {
    let control = [0x10, 0x03, 0x02, 0x10, 0x10, 0x15, 0x03];
    let step = 1 + number % 5;
    let run = control.into_iter().cycle().skip(number).step_by(step);
    let head = [side, u8::try_from(number).unwrap()];
    head.into_iter().chain(run.take(number * 7 % 39)).collect()
}

fn hex(bytes: &[u8]) -> String {
    let words: Vec<_> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    words.join(" ")
}

fn jobs(side: u8) -> String {
    (0..COUNT).fold(String::new(), |mut text, number| {
        writeln!(text, "{}", hex(&telegram(side, number))).unwrap();
        text
    })
}

/// Carries bytes from one pseudo-terminal to the other until `over`.
fn carry(mut from: TTYPort, mut to: TTYPort, over: &AtomicBool) {
    from.set_timeout(Duration::from_millis(20)).unwrap();
    let mut piece = [0; 256];
    while !over.load(Ordering::Relaxed) {
        match from.read(&mut piece) {
            Ok(len) => to.write_all(&piece[..len]).unwrap(),
            Err(error) => assert_eq!(error.kind(), ErrorKind::TimedOut, "{error}"),
        }
    }
}

/// A machine may lack Python, and the published package the other crate's station.
fn has_peer() -> bool {
    let version = Command::new("python3").arg("--version").output();
    let found = version.is_ok_and(|output| output.status.success()) && Path::new(PEER).exists();
    if !found {
        eprintln!("skipped: there is no python3, or no {PEER}");
    }
    found
}

/// The telegrams of a report, one after the other; a repeat, which a lost acknowledgement makes,
/// counts once.
fn received(report: &[String]) -> Vec<&str> {
    let telegrams = report.iter().map(|line| line.strip_prefix("received "));
    let mut telegrams: Vec<_> = telegrams.flatten().collect();
    telegrams.dedup();
    telegrams
}

fn assert_exchanged(report: &[String], sent_by: u8, received_from: u8) {
    let incoming: Vec<_> = (0..COUNT)
        .map(|number| hex(&telegram(received_from, number)))
        .collect();
    assert_eq!(received(report), incoming);
    let outcomes: Vec<_> = report
        .iter()
        .filter(|line| line.starts_with("sent ") || line.starts_with("failed "))
        .collect();
    let sent: Vec<_> = (0..COUNT)
        .map(|number| format!("sent {}", telegram(sent_by, number).len()))
        .collect();
    assert!(outcomes.into_iter().eq(&sent), "{report:#?}");
    // At once, not one side after the other.
    let place = |event: &str| report.iter().position(|line| line.starts_with(event));
    let last = |event: &str| report.iter().rposition(|line| line.starts_with(event));
    assert!(place("received ") < last("sent ") && place("sent ") < last("received "));
}

fn exchange(priority: &str, peer_priority: &str) {
    if !has_peer() {
        return;
    }
    let (station_line, station_end) = TTYPort::pair().unwrap();
    let (peer_line, peer_end) = TTYPort::pair().unwrap();
    let mut peer = Command::new("python3");
    peer.args([PEER, "--port", &peer_end.name().unwrap()])
        .args(["--priority", peer_priority, "--seconds", PATIENCE_S])
        .args(["--expect", &COUNT.to_string(), "--linger-ms", "500"]);
    let mut station = program("station");
    station
        .args(["--port", &instant(&station_end)])
        .args(["--priority", priority, "--preset", "siemens-3964r"])
        .args(["--listen", "2"]);
    let over = AtomicBool::new(false);
    let (forth, back) = (
        station_line.try_clone_native(),
        peer_line.try_clone_native(),
    );
    let (forth, back) = (forth.unwrap(), back.unwrap());
    let (station, peer) = thread::scope(|scope| {
        scope.spawn(|| carry(forth, peer_line, &over));
        scope.spawn(|| carry(back, station_line, &over));
        let peer = scope.spawn(|| run(&mut peer, jobs(0xB0).as_bytes()));
        let station = run(&mut station, jobs(0xA0).as_bytes());
        let peer = peer.join();
        over.store(true, Ordering::Relaxed);
        (station, peer.unwrap())
    });
    for (output, sent_by, received_from) in [(&station, 0xA0, 0xB0), (&peer, 0xB0, 0xA0)] {
        assert_eq!(lines(&output.stderr), [""; 0]);
        assert_exchanged(&lines(&output.stdout), sent_by, received_from);
        assert!(output.status.success());
    }
}

#[test]
fn station_low_peer_high() {
    exchange("low", "high");
}

#[test]
fn station_high_peer_low() {
    exchange("high", "low");
}
