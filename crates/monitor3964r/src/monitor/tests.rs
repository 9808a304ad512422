//! Conversations as a listener hears them.

use alloc::{
    string::{String, ToString},
    vec,
    vec::Vec,
};

use proptest::prelude::*;
use proto3964r::{Line, Priority};

use super::*;

/// Reads `ms side byte...` groups, `A` to `B` and back, and returns what was seen.
fn listen(monitor: &mut Monitor<32>, capture: &str) -> Vec<String> {
    let mut seen = Vec::new();
    for group in capture.split(';') {
        let mut words = group.split_whitespace();
        let now = Duration::from_millis(words.next().unwrap().parse().unwrap());
        let side = if words.next() == Some("A") {
            Side::A
        } else {
            Side::B
        };
        for word in words {
            let byte = u8::from_str_radix(word, 16).unwrap();
            seen.extend(
                monitor
                    .handle_byte(now, side, byte)
                    .map(|observation| observation.to_string()),
            );
        }
    }
    seen
}

fn monitor() -> Monitor<32> {
    Monitor::new(Config::siemens_3964r(Priority::Low, Line::Instant))
}

#[test]
fn a_telegram_and_its_answer() {
    let mut monitor = monitor();
    let seen = listen(
        &mut monitor,
        "0 A 15; 1 A 02; 3 B 10; 4 A 41 10 10 10 03 52; 6 B 10",
    );
    assert_eq!(
        seen,
        [
            "A NAK without a question",
            "A STX, attempt 1",
            "B DLE, ready to receive, 2.000 ms",
            "A block of 2: 41 10",
            "B DLE, accepted, 2.000 ms",
        ]
    );
}

#[test]
fn a_block_with_a_wrong_bcc_and_its_repeat() {
    let mut monitor = monitor();
    let seen = listen(&mut monitor, "1 B 02; 2 A 10; 3 B 41 10 03 00; 4 A 15");
    assert_eq!(
        seen[2..],
        [
            "B bad block: BCC 00h received, 52h computed",
            "A NAK, rejected, 1.000 ms"
        ]
    );
    listen(&mut monitor, "5 B 02; 6 A 10; 7 B 41 10 03 52; 8 A 10");
}

#[test]
fn a_late_answer_is_named() {
    let mut monitor = monitor();
    let seen = listen(&mut monitor, "0 A 02; 2500 B 10");
    assert_eq!(
        seen[1..],
        [
            "B does not answer, waited 2500.000 ms",
            "B DLE, ready to receive, 2500.000 ms"
        ]
    );
}

#[test]
fn a_live_line_reports_the_missing_answer_once() {
    let mut monitor = monitor();
    assert_eq!(listen(&mut monitor, "0 A 02").len(), 1);
    let due = monitor.poll_timeout().unwrap();
    assert_eq!(due, Duration::from_micros(2_000_001));
    assert_eq!(
        monitor.handle_timeout(Duration::from_millis(2000)).count(),
        0
    );
    assert_eq!(monitor.handle_timeout(due).size_hint(), (1, Some(1)));
    assert_eq!(monitor.poll_timeout(), None);
    assert_eq!(listen(&mut monitor, "2500 A 02"), ["A STX, attempt 2"]);
}

#[test]
fn a_damaged_character_is_no_answer() {
    let mut monitor = monitor();
    listen(&mut monitor, "0 A 02");
    let seen: Vec<_> = monitor
        .handle_damaged(
            Duration::from_millis(1),
            Side::B,
            0x10,
            CharacterError::Parity,
        )
        .map(|observation| observation.to_string())
        .collect();
    assert_eq!(seen, vec!["B parity error in 10", "B stray 10"]);
}

#[test]
fn attempts_count_anew_after_a_connection() {
    let mut monitor = monitor();
    let seen = listen(
        &mut monitor,
        "0 A 02; 1 B 15; 2 A 02; 3 B 10; 4 A 41 10 03 00; 5 B 15; 6 A 02",
    );
    let requests: Vec<_> = seen
        .iter()
        .filter(|line| line.contains("STX, attempt"))
        .collect();
    assert_eq!(
        requests,
        ["A STX, attempt 1", "A STX, attempt 2", "A STX, attempt 1"]
    );
}

proptest! {
    /// Whatever comes: no panic, and never more marks than there is room for.
    #[test]
    fn anything(capture in prop::collection::vec(
        (any::<bool>(), prop_oneof![Just(0x02), Just(0x03), Just(0x10), Just(0x15), any::<u8>()], 0..3_000_000_u64),
        0..300,
    )) {
        let mut monitor = Monitor::<8>::new(Config::siemens_3964r(Priority::Low, Line::Instant));
        let mut now = Duration::ZERO;
        for (from_a, byte, wait) in capture {
            now += Duration::from_micros(wait);
            let side = if from_a { Side::A } else { Side::B };
            prop_assert!(monitor.handle_byte(now, side, byte).count() <= 6);
        }
    }
}
