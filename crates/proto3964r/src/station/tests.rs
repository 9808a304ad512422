//! What only the crate itself can see.

use alloc::{format, string::String, vec::Vec};
use core::time::Duration;

use proptest::prelude::*;

use super::{Activity, Station, Transmit};
use crate::{
    config::{Config, Line, Priority},
    event::{CharacterError, Event},
};

/// Bytes of a station without its two buffers.
const OVERHEAD: usize = 168;

/// A station of low priority that says nothing at start-up.
fn silent() -> Config {
    Config {
        nak_at_startup: false,
        ..Config::siemens_3964r(Priority::Low, Line::Instant)
    }
}

/// Takes all characters, with the events of the telegrams in them left to wait.
fn hear<const N: usize>(station: &mut Station<N>, now: Duration, characters: &[u8]) {
    let mut rest = characters;
    while !rest.is_empty() {
        let taken = station.handle_bytes(now, rest);
        rest = &rest[taken..];
    }
}

/// For every rest that the alignment can leave.
#[test]
fn size_is_bounded() {
    macro_rules! bounded {
        ($($n:literal)*) => {
            $(assert!(size_of::<Station<$n, 0>>() <= $n + OVERHEAD);)*
        };
    }
    bounded!(0 1 2 3 4 5 6 7 8 64 250 4096);
    assert!(size_of::<Station<64>>() <= 2 * 64 + OVERHEAD);
    assert!(size_of::<Station<250, 17>>() <= 250 + 17 + OVERHEAD);
}

/// What a station reports and sends when it is asked at the end only.
fn outcome(station: &mut Station<24>, now: Duration) -> (Vec<String>, Vec<u8>) {
    let events =
        core::iter::from_fn(|| station.poll_event().map(|event| format!("{event:?}"))).collect();
    let bytes = core::iter::from_fn(|| station.poll_transmit_byte(now)).collect();
    (events, bytes)
}

/// Byte by byte, the end of the payload is where this payload ends, whatever the one before has
/// left in the buffer.
#[test]
fn a_short_job_after_a_long_one() {
    let now = Duration::ZERO;
    let mut station = Station::<4>::new(silent());
    let jobs: [(&[u8], &[u8]); 3] = [
        (&[1, 2, 3, 4], &[1, 2, 3, 4, 0x10, 0x03, 0x17]),
        (&[5, 6], &[5, 6, 0x10, 0x03, 0x10]),
        (&[], &[0x10, 0x03, 0x13]),
    ];
    for (payload, body) in jobs {
        station.submit(now, payload).unwrap();
        assert_eq!(station.poll_transmit_byte(now), Some(0x02));
        station.handle_byte(now, 0x10);
        let sent: Vec<u8> = core::iter::from_fn(|| station.poll_transmit_byte(now)).collect();
        assert_eq!(sent, body);
        station.handle_byte(now, 0x10);
        let sent = Event::Sent { len: payload.len() };
        assert_eq!(station.poll_event(), Some(sent));
    }
}

proptest! {
    /// The pieces in which characters arrive make no difference.
    #[test]
    fn any_split_gives_the_same_events(
        characters in prop::collection::vec(
            prop_oneof![Just(0x02), Just(0x03), Just(0x10), Just(0x15), any::<u8>()], 0..200),
        cuts in prop::collection::vec(1..30_usize, 0..12),
        job in any::<bool>(),
        sent in any::<bool>(),
    ) {
        let now = Duration::from_millis(5);
        let mut whole = Station::<24>::new(Config::siemens_3964r(Priority::Low, Line::Instant));
        if job {
            whole.submit(now, b"job").unwrap();
        }
        if sent {
            while whole.poll_transmit_byte(now).is_some() {}
        }
        let (mut pieces, mut bytes) = (whole.clone(), whole.clone());
        hear(&mut whole, now, &characters);
        for &byte in &characters {
            bytes.handle_byte(now, byte);
        }
        let mut rest = &characters[..];
        for cut in cuts.into_iter().chain([characters.len()]) {
            let (piece, after) = rest.split_at(cut.min(rest.len()));
            hear(&mut pieces, now, piece);
            rest = after;
        }
        prop_assert_eq!(&whole, &bytes);
        prop_assert_eq!(&whole, &pieces);
        prop_assert_eq!(outcome(&mut whole, now), outcome(&mut bytes, now));
    }

    /// Pulling byte by byte sends what pulling in pieces sends.
    #[test]
    fn any_piece_of_output_is_the_same(
        payload in prop::collection::vec(prop_oneof![Just(0x10), any::<u8>()], 0..24),
        pieces in prop::collection::vec(1..9_usize, 1..9),
    ) {
        let now = Duration::ZERO;
        let mut whole = Station::<24>::new(silent());
        whole.submit(now, &payload).unwrap();
        prop_assert_eq!(whole.poll_transmit_byte(now), Some(0x02));
        whole.handle_byte(now, 0x10);
        let mut bytes = whole.clone();
        let mut sent = Vec::new();
        for len in pieces.into_iter().cycle() {
            let mut out = [0; 9];
            match whole.poll_transmit(now, &mut out[..len]) {
                Some(Transmit::Bytes(piece)) => sent.extend_from_slice(piece),
                Some(Transmit::Discard) => prop_assert!(false, "nothing was aborted"),
                None => break,
            }
        }
        let single: Vec<u8> = core::iter::from_fn(|| bytes.poll_transmit_byte(now)).collect();
        prop_assert_eq!(sent, single);
        prop_assert_eq!(whole, bytes);
    }

    /// Anything at any time: no panic, no endless loop, never more than one outcome per job, and
    /// a deadline in every state but idle.
    #[test]
    fn anything_at_any_time(inputs in prop::collection::vec((0..8_u8, any::<u8>(), 0..3000_u64), 0..400)) {
        let mut station = Station::<8>::new(Config::siemens_3964r(Priority::Low, Line::Instant));
        let (mut now, mut open) = (Duration::ZERO, 0);
        for (kind, byte, wait) in inputs {
            now += Duration::from_micros(wait * 100);
            match kind {
                0 => open += u8::from(station.submit(now, &[byte; 5]).is_ok()),
                1 => station.handle_damaged(now, byte, CharacterError::Framing),
                2 => station.handle_break(now),
                3 => _ = station.cancel(now),
                4 => station.handle_timeout(now),
                5 => while station.poll_transmit_byte(now).is_some() {},
                6 => station.handle_byte(now, [0x02, 0x10, 0x03, 0x15][usize::from(byte) % 4]),
                _ => hear(&mut station, now, &[byte, 0x10, 0x03, byte]),
            }
            prop_assert_eq!(station.poll_timeout().is_none(), station.is_idle());
            if byte % 3 == 0 {
                while let Some(event) = station.poll_event() {
                    if matches!(event, Event::Sent { .. } | Event::Failed(_)) {
                        prop_assert_eq!(open, 1);
                        open = 0;
                    }
                }
            }
        }
    }
}

/// One telegram, character by character.
#[test]
fn what_a_station_does_can_be_told() {
    let config = Config {
        allow_empty: false,
        ..silent()
    };
    let [mut sender, mut receiver] = [Station::<8>::new(config), Station::<8>::new(config)];
    let now = Duration::ZERO;
    let mut told = Vec::new();
    let mut tell = |sender: &Station<8>, receiver: &Station<8>| {
        let both = (sender.activity(), receiver.activity());
        if told.last() != Some(&both) {
            told.push(both);
        }
    };
    tell(&sender, &receiver);
    sender.submit(now, b"A").unwrap();
    tell(&sender, &receiver);
    for _ in 0..3 {
        while let Some(byte) = sender.poll_transmit_byte(now) {
            tell(&sender, &receiver);
            receiver.handle_byte(now, byte);
            tell(&sender, &receiver);
        }
        while let Some(byte) = receiver.poll_transmit_byte(now) {
            sender.handle_byte(now, byte);
            tell(&sender, &receiver);
        }
    }
    let expected = [
        (Activity::Idle, Activity::Idle),
        (Activity::Request, Activity::Idle),
        (Activity::AwaitConnection, Activity::Idle),
        (Activity::AwaitConnection, Activity::AwaitBlock),
        (Activity::Send, Activity::AwaitBlock),
        (Activity::Send, Activity::Receive),
        (Activity::AwaitAcknowledgement, Activity::Receive),
        (Activity::AwaitAcknowledgement, Activity::Idle),
        (Activity::Idle, Activity::Idle),
    ];
    assert_eq!(told, expected);
}
