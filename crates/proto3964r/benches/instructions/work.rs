//! What the benches do: whole telegrams through a station.
#![expect(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    reason = "a bench fails loudly"
)]

use core::{hint::black_box, time::Duration};

use proto3964r::{Check, Config, Event, Line, Priority, Station, Transmit, frame};

/// Payload bytes of a telegram, and characters of a flood.
pub(crate) const LEN: usize = 1024;

/// Longer than a block takes at 19200 bit/s, shorter than its answer may take.
const LONG: Duration = Duration::from_millis(1500);

/// Bytes as they come in practice: any value, so a DLE every 256 or so.
pub(crate) fn random() -> Vec<u8> {
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

/// A station on a UART, and its clock.
#[derive(Clone)]
pub(crate) struct Bench {
    pub(crate) station: Station<LEN>,
    pub(crate) now: Duration,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let config = Config {
            nak_at_startup: false,
            ..Config::siemens_3964r(Priority::Low, Line::paced(19_200, 11))
        };
        Self {
            station: Station::new(config),
            now: Duration::ZERO,
        }
    }

    /// Characters in one piece.
    pub(crate) fn hear_slice(&mut self, characters: &[u8]) {
        let mut rest = characters;
        while !rest.is_empty() {
            rest = &rest[self.station.handle_bytes(self.now, rest)..];
        }
    }

    /// Characters as an interrupt handler takes them.
    pub(crate) fn hear_bytes(&mut self, characters: &[u8]) {
        let now = black_box(self.now);
        for &byte in characters {
            self.station.handle_byte(now, black_box(byte));
        }
    }

    /// Takes the two answers and the telegram; the length of its payload.
    fn finish(&mut self) -> usize {
        while self.station.poll_transmit_byte(self.now).is_some() {}
        // The answers take their time: what is sent next ends behind them.
        self.now += LONG;
        match self.station.poll_event() {
            Some(Event::Received(payload)) => payload.len(),
            _ => 0,
        }
    }

    /// One telegram in one piece; the length of its payload.
    pub(crate) fn receive_slice(&mut self, telegram: &[u8]) -> usize {
        self.hear_slice(telegram);
        self.finish()
    }

    /// One telegram byte by byte.
    pub(crate) fn receive_bytes(&mut self, telegram: &[u8]) -> usize {
        self.hear_bytes(telegram);
        self.finish()
    }

    /// One job in one piece; the characters of its block.
    pub(crate) fn send_slice(&mut self, payload: &[u8], out: &mut [u8]) -> usize {
        self.begin(payload);
        let mut len = 0;
        while let Some(Transmit::Bytes(bytes)) = self.station.poll_transmit(self.now, out) {
            len += bytes.len();
        }
        self.end();
        len
    }

    /// One job as an interrupt handler sends it.
    pub(crate) fn send_bytes(&mut self, payload: &[u8]) -> usize {
        self.begin(payload);
        let now = black_box(self.now);
        let mut len = 0;
        while let Some(byte) = self.station.poll_transmit_byte(now) {
            black_box(byte);
            len += 1;
        }
        self.end();
        len
    }

    pub(crate) fn begin(&mut self, payload: &[u8]) {
        self.station.submit(self.now, payload).unwrap();
        assert_eq!(self.station.poll_transmit_byte(self.now), Some(0x02));
        self.now += Duration::from_millis(3);
        self.station.handle_byte(self.now, 0x10);
    }

    fn end(&mut self) {
        self.now += LONG;
        self.station.handle_byte(self.now, 0x10);
        assert!(matches!(
            self.station.poll_event(),
            Some(Event::Sent { len: LEN })
        ));
    }
}
