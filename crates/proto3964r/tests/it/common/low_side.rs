//! Stations without a NAK at their start, and what goes in and out of them.

use core::time::Duration;

use proto3964r::{Config, Line, Priority, Station, Transmit};

pub(crate) use proto3964r::ascii::{DLE, NAK, STX};
/// Of 11 bits at 9600 bit/s.
pub(crate) const CHARACTER: Duration = Duration::from_nanos(1_145_833);

/// As Siemens has it, but for the NAK at the start.
pub(crate) const fn quiet(priority: Priority, line: Line) -> Config {
    Config {
        nak_at_startup: false,
        ..Config::siemens_3964r(priority, line)
    }
}

pub(crate) fn low() -> Config {
    quiet(Priority::Low, Line::Instant)
}

pub(crate) const fn ms(millis: u64) -> Duration {
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

/// What the station hands out now, and whether what was handed out before is void.
pub(crate) fn handed_out<const N: usize, const T: usize>(
    station: &mut Station<N, T>,
    now: Duration,
) -> (Vec<u8>, bool) {
    let (mut all, mut discarded, mut out) = (Vec::new(), false, [0; 300]);
    while let Some(transmit) = station.poll_transmit(now, &mut out) {
        match transmit {
            Transmit::Bytes(bytes) => all.extend_from_slice(bytes),
            Transmit::Discard => discarded = true,
        }
    }
    (all, discarded)
}

/// The same without the discards.
pub(crate) fn sent<const N: usize, const T: usize>(
    station: &mut Station<N, T>,
    now: Duration,
) -> Vec<u8> {
    handed_out(station, now).0
}

/// What the station hands out byte by byte.
pub(crate) fn sent_by_byte(station: &mut Station<16>, now: Duration) -> Vec<u8> {
    core::iter::from_fn(|| station.poll_transmit_byte(now)).collect()
}
