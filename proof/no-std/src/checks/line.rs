//! The serial line.

use core::hint::black_box;
use core::time::Duration;

use monitor3964r::{Character, Monitor, Observation, Side, Verdict, diagnose};
use proto3964r::{Check, Config, Event, Line, Priority, Station, Transmit, frame};
use rk512::{Area, Client, Command, DataBlock, Memory, Outcome, Server};

use super::holds;
/// One telegram from station to station, and the same block without a link.
pub fn stations() -> Option<()> {
    let mut plc = Station::<64>::new(Config::siemens_3964r(Priority::High, Line::Instant));
    let mut scale = Station::<64>::new(Config::siemens_3964r(Priority::Low, Line::Instant));
    let (now, mut wire) = (Duration::ZERO, [0; 16]);
    let payload = black_box(b"tare \x10\x03");
    plc.submit(now, payload).ok()?;
    for _ in 0..4 {
        while let Some(Transmit::Bytes(bytes)) = plc.poll_transmit(now, &mut wire) {
            holds(scale.handle_bytes(now, bytes) == bytes.len())?;
        }
        while let Some(Transmit::Bytes(bytes)) = scale.poll_transmit(now, &mut wire) {
            holds(plc.handle_bytes(now, bytes) == bytes.len())?;
        }
    }
    holds(scale.poll_event() == Some(Event::Received(payload)))?;
    holds(plc.poll_event() == Some(Event::Sent { len: payload.len() }))?;
    let (mut body, mut buffer) = ([0; 24], [0; 8]);
    let len = frame::encode(payload, Check::Bcc, &mut body).ok()?;
    let (decoded, rest) = frame::decode(body.get(..len)?, Check::Bcc, &mut buffer).ok()?;
    holds(decoded == payload && rest.is_empty())
}

/// A block that a monitor reads along, and what becomes of one that nobody answers.
pub fn monitor() -> Option<()> {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    let mut monitor = Monitor::<8>::new(config);
    let heard = |ms, side, byte| Character {
        at: Duration::from_millis(ms),
        side,
        byte,
        error: None,
    };
    let record = black_box([
        heard(0, Side::A, 0x02),
        heard(2, Side::B, 0x10),
        heard(3, Side::A, 0x41),
        heard(4, Side::A, 0x10),
        heard(5, Side::A, 0x03),
        heard(6, Side::A, 0x52),
        heard(8, Side::B, 0x10),
    ]);
    let mut payloads = 0;
    for it in record {
        for step in monitor.handle_byte(it.at, it.side, it.byte) {
            if let Observation::Block { payload: b"A", .. } = step {
                payloads += 1;
            }
        }
    }
    let silent = black_box([2000, 4000, 6000].map(|ms| heard(ms, Side::A, 0x02)));
    holds(payloads == 1 && diagnose(&record, &config).verdict == Verdict::Works)?;
    holds(diagnose(&silent, &config).verdict == Verdict::NoAnswer { silent: Side::B })
}

/// A job of two telegrams each way.
pub fn read_data_block() -> Option<()> {
    use rk512::Config;
    let now = Duration::ZERO;
    let mut db5 = [0; 200];
    let mut plc = Memory::new([DataBlock::db(5, &mut db5)]);
    let mut client = Client::<256>::new(Config::DEFAULT);
    let mut server = Server::new(Config::DEFAULT);
    let mut exchange = |client: &mut Client<256>| {
        while let Some(command) = client.poll_transmit(now) {
            client.handle_delivered(now);
            server.handle_block(&command, &mut plc);
            while let Some(reaction) = server.poll_transmit() {
                server.handle_delivered(now);
                client.handle_block(now, &reaction);
            }
        }
    };
    let write = Command::send(Area::db(5, 10), 1).ok()?;
    client.submit(write, black_box(&[0x12, 0x34])).ok()?;
    exchange(&mut client);
    holds(matches!(client.poll_event(), Some(Outcome::Sent { .. })))?;
    let read = Command::fetch(Area::db(5, 10), black_box(65)).ok()?;
    client.submit(read, &[]).ok()?;
    exchange(&mut client);
    let Some(Outcome::Fetched { data, .. }) = client.poll_event() else {
        return None;
    };
    holds(data.len() == 130 && data.starts_with(&[0x12, 0x34]))
}
