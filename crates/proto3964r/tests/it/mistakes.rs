//! Mistakes of earlier implementations of 3964R, one test for each.

mod receive;
mod send;

use core::time::Duration;

use proto3964r::{
    Abandoned, Cause, Config, Event, Failure, IdleNoise, JobPhase, Line, Priority, Rejection,
    Station, SubmitError, Transmit, frame::FrameError,
};

use crate::common::low_side::{DLE, NAK, STX, hear, low, ms, sent};

/// The names of all events, with their contents.
fn events<const N: usize, const T: usize>(station: &mut Station<N, T>) -> Vec<String> {
    let mut all = Vec::new();
    while let Some(event) = station.poll_event() {
        all.push(format!("{event:?}"));
    }
    all
}

/// A station that has asked for the line at 0 ms.
fn asking<const N: usize>(config: Config, payload: &[u8]) -> Station<N> {
    let mut station = Station::new(config);
    station.submit(ms(0), payload).unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station
}

/// A station that has taken these characters at 0 ms.
fn after_hearing<const N: usize>(characters: &[u8]) -> Station<N> {
    let mut station = Station::new(low());
    hear(&mut station, ms(0), characters);
    station
}

/// A station that has sent the block of its job and awaits the answer, at 0 ms.
fn after_block(payload: &[u8]) -> Station<64> {
    let mut station = asking(low(), payload);
    station.handle_byte(ms(0), DLE);
    assert!(!sent(&mut station, ms(0)).is_empty());
    station
}

#[test]
fn m16_every_state_but_idle_has_a_deadline() {
    let mut waiting_for_dle = Station::<64>::new(low());
    waiting_for_dle.submit(ms(0), b"A").unwrap();
    let mut receiving = Station::<64>::new(low());
    receiving.handle_byte(ms(0), STX);
    let rejected = after_hearing(&[STX, 0x10, 0x03, 0x00]);
    let no_buffer = after_hearing(&[STX, 0x10, 0x03, 0x13, STX]);
    let mut noise = Station::<64>::new(low());
    noise.handle_byte(ms(0), 0x41);
    let mut interrupted = asking(low(), b"A");
    hear(&mut interrupted, ms(0), &[DLE, 0x41]);
    for mut station in [
        after_block(b"A"),
        waiting_for_dle,
        receiving,
        rejected,
        no_buffer,
        noise,
        interrupted,
    ] {
        let before = station.clone();
        let due = station.poll_timeout().unwrap();
        assert!(due > ms(0) && due <= ms(4000), "{station:?}");
        station.handle_timeout(due);
        assert_ne!(station, before);
    }
}

#[test]
fn same_priority_is_reported() {
    // Two high ones: STX against STX, again and again.
    let mut high = Station::<8>::new(Config {
        priority: Priority::High,
        ..low()
    });
    high.submit(ms(0), b"A").unwrap();
    for attempt in 0..2 {
        high.handle_timeout(ms(2000 * attempt));
        assert_eq!(sent(&mut high, ms(2000 * attempt)), [STX]);
        high.handle_byte(ms(2000 * attempt), STX);
    }
    assert_eq!(
        events(&mut high),
        [
            "Conflict { in_a_row: 1 }",
            "Conflict { in_a_row: 2 }",
            "SamePriority"
        ]
    );
    // Two low ones: DLE against DLE.
    let mut station = asking::<8>(low(), b"A");
    hear(&mut station, ms(0), &[STX, DLE]);
    station.handle_timeout(ms(220));
    assert_eq!(
        events(&mut station),
        [
            "Conflict { in_a_row: 1 }",
            "SamePriority",
            "Rejected(CharacterDelay)"
        ]
    );
}

#[test]
fn break_ends_a_transmission_and_a_reception() {
    let mut station = after_block(b"A");
    station.handle_break(ms(1));
    assert_eq!(
        events(&mut station),
        [
            "Break",
            "Failed(Failure { phase: Transmission, cause: Break, attempts: 1 })"
        ]
    );
    let mut station = after_hearing::<8>(&[STX, 0x41]);
    station.handle_break(ms(1));
    assert!(station.is_idle());
    assert_eq!(events(&mut station), ["Break"]);
}
