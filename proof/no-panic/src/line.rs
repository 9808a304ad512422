//! proto3964r and monitor3964r.

use std::hint::black_box;
use std::time::Duration;

use monitor3964r::{Observation, Observations, Side};
use no_panic::no_panic;
use proto3964r::frame::{self, Check, DecodeError, EncodeError, FrameError};
use proto3964r::{CharacterError, Config, Event, Line, Priority, SubmitError, Transmit};

type Station = proto3964r::Station<128>;
type Monitor = monitor3964r::Monitor<128>;

#[no_panic]
#[inline(never)]
fn submit(station: &mut Station, now: Duration, payload: &[u8]) -> Result<(), SubmitError> {
    station.submit(now, payload)
}

#[no_panic]
#[inline(never)]
fn cancel(station: &mut Station, now: Duration) -> bool {
    station.cancel(now)
}

#[no_panic]
#[inline(never)]
fn handle_byte(station: &mut Station, now: Duration, byte: u8) {
    station.handle_byte(now, byte);
}

#[no_panic]
#[inline(never)]
fn handle_bytes(station: &mut Station, now: Duration, bytes: &[u8]) -> usize {
    station.handle_bytes(now, bytes)
}

#[no_panic]
#[inline(never)]
fn handle_damaged(station: &mut Station, now: Duration, byte: u8, error: CharacterError) {
    station.handle_damaged(now, byte, error);
}

#[no_panic]
#[inline(never)]
fn handle_break(station: &mut Station, now: Duration) {
    station.handle_break(now);
}

#[no_panic]
#[inline(never)]
fn handle_timeout(station: &mut Station, now: Duration) {
    station.handle_timeout(now);
}

#[no_panic]
#[inline(never)]
fn poll_timeout(station: &Station) -> Option<Duration> {
    station.poll_timeout()
}

#[no_panic]
#[inline(never)]
fn poll_event(station: &mut Station) -> Option<Event<'_>> {
    station.poll_event()
}

#[no_panic]
#[inline(never)]
fn poll_transmit<'o>(
    station: &mut Station,
    now: Duration,
    out: &'o mut [u8],
) -> Option<Transmit<'o>> {
    station.poll_transmit(now, out)
}

#[no_panic]
#[inline(never)]
fn poll_transmit_byte(station: &mut Station, now: Duration) -> Option<u8> {
    station.poll_transmit_byte(now)
}

#[no_panic]
#[inline(never)]
fn encode(payload: &[u8], check: Check, out: &mut [u8]) -> Result<usize, EncodeError> {
    frame::encode(payload, check, out)
}

#[no_panic]
#[inline(never)]
fn decode<'i, 'b>(
    body: &'i [u8],
    check: Check,
    buffer: &'b mut [u8],
) -> Result<(&'b [u8], &'i [u8]), DecodeError> {
    frame::decode(body, check, buffer)
}

#[no_panic]
#[inline(never)]
fn feed(
    decoder: &mut frame::Decoder,
    bytes: &[u8],
    buffer: &mut [u8],
) -> (usize, Option<Result<usize, FrameError>>) {
    decoder.feed(bytes, buffer)
}

#[no_panic]
#[inline(never)]
fn push(
    decoder: &mut frame::Decoder,
    byte: u8,
    buffer: &mut [u8],
) -> Option<Result<usize, FrameError>> {
    decoder.push(byte, buffer)
}

#[no_panic]
#[inline(never)]
fn monitor_byte(monitor: &mut Monitor, now: Duration, side: Side, byte: u8) -> Observations<'_> {
    monitor.handle_byte(now, side, byte)
}

#[no_panic]
#[inline(never)]
fn monitor_damaged(
    monitor: &mut Monitor,
    now: Duration,
    side: Side,
    byte: u8,
    error: CharacterError,
) -> Observations<'_> {
    monitor.handle_damaged(now, side, byte, error)
}

#[no_panic]
#[inline(never)]
fn monitor_timeout(monitor: &mut Monitor, now: Duration) -> Observations<'_> {
    monitor.handle_timeout(now)
}

#[no_panic]
#[inline(never)]
fn observations_next<'a>(observations: &mut Observations<'a>) -> Option<Observation<'a>> {
    observations.next()
}

#[no_panic]
#[inline(never)]
fn monitor_due(monitor: &Monitor) -> Option<Duration> {
    monitor.poll_timeout()
}

pub fn run() {
    let now = black_box(Duration::from_millis(5));
    let bytes = black_box([0x02, 0x41, 0x10, 0x03, 0x52].as_slice());
    let line = black_box(Line::paced(9600, 11));
    let config = Config::siemens_3964r(black_box(Priority::Low), line);
    let station = &mut black_box(Station::new(config));
    let mut buffer = [0; 16];
    let out = black_box(buffer.as_mut_slice());
    let _ = black_box(submit(station, now, bytes));
    black_box(cancel(black_box(station), now));
    handle_byte(black_box(station), now, black_box(0x02));
    black_box(handle_bytes(black_box(station), now, bytes));
    handle_damaged(
        black_box(station),
        now,
        0x41,
        black_box(CharacterError::Parity),
    );
    handle_break(black_box(station), now);
    handle_timeout(black_box(station), now);
    black_box(poll_timeout(black_box(station)));
    black_box(poll_event(black_box(station)));
    black_box(poll_transmit(black_box(station), now, out));
    black_box(poll_transmit_byte(black_box(station), now));
    let check = black_box(Check::Bcc);
    let _ = black_box(encode(bytes, check, black_box(&mut buffer)));
    let _ = black_box(decode(bytes, check, black_box(&mut buffer)));
    let decoder = &mut black_box(frame::Decoder::new(check));
    let _ = black_box(feed(black_box(decoder), bytes, black_box(&mut buffer)));
    black_box(push(
        black_box(decoder),
        black_box(0x10),
        black_box(&mut buffer),
    ));

    let monitor = &mut black_box(Monitor::new(config));
    let side = black_box(Side::A);
    let _ = black_box(monitor_byte(black_box(monitor), now, side, 0x02));
    let _ = black_box(monitor_damaged(
        black_box(monitor),
        now,
        side,
        0x41,
        black_box(CharacterError::Framing),
    ));
    let mut observations = black_box(monitor_timeout(black_box(monitor), now));
    black_box(observations_next(&mut observations));
    black_box(monitor_due(black_box(monitor)));
}
