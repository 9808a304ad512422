//! The serial line.

use core::hint::black_box;

use proto3964r::{Check, Config, Event, Priority, Station, Transmit, frame};
use rk512::{Area, Client, DataBlock, Memory, Outcome, Server};

use super::holds;
/// One telegram from station to station, and the same block without a link.
pub fn stations() -> Option<()> {
    use proto3964r::Instant;
    let mut plc = Station::<64>::new(Config::siemens_3964r(Priority::High));
    let mut scale = Station::<64>::new(Config::siemens_3964r(Priority::Low));
    let (now, mut wire) = (Instant::ZERO, [0; 16]);
    let payload = black_box(b"tare \x10\x03");
    plc.send(now, payload).ok()?;
    for _ in 0..4 {
        while let Some(Transmit::Bytes(bytes)) = plc.poll_transmit(now, &mut wire) {
            scale.handle_bytes(now, bytes);
        }
        while let Some(Transmit::Bytes(bytes)) = scale.poll_transmit(now, &mut wire) {
            plc.handle_bytes(now, bytes);
        }
    }
    holds(scale.poll_event() == Some(Event::Received(payload)))?;
    holds(plc.poll_event() == Some(Event::Sent { len: payload.len() }))?;
    let (mut body, mut buffer) = ([0; 24], [0; 8]);
    let len = frame::encode(payload, Check::Bcc, &mut body).ok()?;
    let (decoded, rest) = frame::decode(body.get(..len)?, Check::Bcc, &mut buffer).ok()?;
    holds(decoded == payload && rest.is_empty())
}

/// A job of two telegrams each way.
pub fn read_data_block() -> Option<()> {
    use rk512::{Config, Instant};
    let now = Instant::ZERO;
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
    client
        .send(Area::db(5, 10), black_box(&[0x12, 0x34]))
        .ok()?;
    exchange(&mut client);
    holds(matches!(client.poll_outcome(), Some(Outcome::Sent { .. })))?;
    client.fetch(Area::db(5, 10), black_box(65)).ok()?;
    exchange(&mut client);
    let Some(Outcome::Fetched { data, .. }) = client.poll_outcome() else {
        return None;
    };
    holds(data.len() == 130 && data.starts_with(&[0x12, 0x34]))
}
