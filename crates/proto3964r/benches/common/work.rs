//! What the benches do: whole telegrams through a station.
#![expect(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    reason = "a bench fails loudly"
)]

use proto3964r::{Check, Config, Event, Instant, Priority, Station, Transmit, frame};

/// Payload bytes of a telegram.
pub(crate) const LEN: usize = 1024;

/// Bytes as they come in practice: any value, so a DLE every 256 or so.
pub(crate) fn payload() -> Vec<u8> {
    let mut state = 0x2545_F491_u32;
    let mut byte = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        u8::try_from(state >> 24).unwrap()
    };
    (0..LEN).map(|_| byte()).collect()
}

/// STX and body, as the partner sends them.
pub(crate) fn telegram(payload: &[u8]) -> Vec<u8> {
    let mut telegram = vec![0; 1 + frame::max_encoded_len(payload.len())];
    telegram[0] = 0x02;
    let len = frame::encode(payload, Check::Bcc, &mut telegram[1..]).unwrap();
    telegram.truncate(1 + len);
    telegram
}

pub(crate) fn station() -> Station<LEN> {
    Station::new(Config::siemens_3964r(Priority::Low).with_nak_at_startup(false))
}

/// Takes the two answers and the telegram.
fn finish(station: &mut Station<LEN>, now: Instant) -> usize {
    while station.poll_transmit_byte(now).is_some() {}
    match station.poll_event() {
        Some(Event::Received(payload)) => payload.len(),
        _ => 0,
    }
}

/// One telegram in one piece; the length of its payload.
pub(crate) fn receive_slice(station: &mut Station<LEN>, telegram: &[u8]) -> usize {
    station.handle_bytes(Instant::ZERO, telegram);
    finish(station, Instant::ZERO)
}

/// One telegram as an interrupt handler takes it.
pub(crate) fn receive_bytes(station: &mut Station<LEN>, telegram: &[u8]) -> usize {
    let now = core::hint::black_box(Instant::ZERO);
    for &byte in telegram {
        station.handle_byte(now, core::hint::black_box(byte));
    }
    finish(station, now)
}

/// One job in one piece; the characters of its block.
pub(crate) fn send_slice(station: &mut Station<LEN>, payload: &[u8], out: &mut [u8]) -> usize {
    begin(station, payload);
    let mut len = 0;
    while let Some(Transmit::Bytes(bytes)) = station.poll_transmit(Instant::ZERO, out) {
        len += bytes.len();
    }
    end(station);
    len
}

/// One job as an interrupt handler sends it.
pub(crate) fn send_bytes(station: &mut Station<LEN>, payload: &[u8]) -> usize {
    begin(station, payload);
    let now = core::hint::black_box(Instant::ZERO);
    let mut len = 0;
    while let Some(byte) = station.poll_transmit_byte(now) {
        core::hint::black_box(byte);
        len += 1;
    }
    end(station);
    len
}

fn begin(station: &mut Station<LEN>, payload: &[u8]) {
    station.send(Instant::ZERO, payload).unwrap();
    assert_eq!(station.poll_transmit_byte(Instant::ZERO), Some(0x02));
    station.handle_byte(Instant::ZERO, 0x10);
}

fn end(station: &mut Station<LEN>) {
    station.handle_byte(Instant::ZERO, 0x10);
    assert!(matches!(
        station.poll_event(),
        Some(Event::Sent { len: LEN })
    ));
}
