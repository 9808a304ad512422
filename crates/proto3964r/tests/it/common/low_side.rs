//! What tests of the low-priority side need.

use core::time::Duration;

use proto3964r::{Config, Line, Priority, Station};

pub(crate) const STX: u8 = 0x02;
pub(crate) const DLE: u8 = 0x10;
pub(crate) const NAK: u8 = 0x15;

pub(crate) fn low() -> Config {
    Config {
        nak_at_startup: false,
        ..Config::siemens_3964r(Priority::Low, Line::Instant)
    }
}

pub(crate) fn ms(millis: u64) -> Duration {
    Duration::from_millis(millis)
}

/// Takes all characters; telegrams in them wait to be polled.
pub(crate) fn hear<const N: usize, const T: usize>(
    station: &mut Station<N, T>,
    now: Duration,
    characters: &[u8],
) {
    let mut rest = characters;
    while !rest.is_empty() {
        rest = &rest[station.handle_bytes(now, rest)..];
    }
}
