//! rk512.

use std::hint::black_box;
use std::time::Duration;

use no_panic::no_panic;
use rk512::{
    Area, Command, Config, DataBlock, DecodeError, EncodeError, Event, Memory, Message, Outcome,
    Server, ServerEvent, SubmitError, Telegram,
};

type Client = rk512::Client<256>;
type Endpoint = rk512::Endpoint<256>;
type Plc<'m> = Memory<'m, 2>;

#[no_panic]
#[inline(never)]
fn submit(client: &mut Client, command: Command, data: &[u8]) -> Result<(), SubmitError> {
    client.submit(command, data)
}

#[no_panic]
#[inline(never)]
fn client_transmit(client: &mut Client, now: Duration) -> Option<Telegram> {
    client.poll_transmit(now)
}

#[no_panic]
#[inline(never)]
fn client_delivered(client: &mut Client, now: Duration) {
    client.handle_delivered(now);
}

#[no_panic]
#[inline(never)]
fn client_failed(client: &mut Client, now: Duration) {
    client.handle_failed(now);
}

#[no_panic]
#[inline(never)]
fn client_block(client: &mut Client, now: Duration, block: &[u8]) {
    client.handle_block(now, block);
}

#[no_panic]
#[inline(never)]
fn client_timeout(client: &mut Client, now: Duration) {
    client.handle_timeout(now);
}

#[no_panic]
#[inline(never)]
fn client_due(client: &Client) -> Option<Duration> {
    client.poll_timeout()
}

#[no_panic]
#[inline(never)]
fn client_event(client: &mut Client) -> Option<Outcome<'_>> {
    client.poll_event()
}

#[no_panic]
#[inline(never)]
fn server_block(server: &mut Server, block: &[u8], plc: &mut Plc<'_>) {
    server.handle_block(block, plc);
}

#[no_panic]
#[inline(never)]
fn server_transmit(server: &mut Server) -> Option<Telegram> {
    server.poll_transmit()
}

#[no_panic]
#[inline(never)]
fn server_delivered(server: &mut Server, now: Duration) {
    server.handle_delivered(now);
}

#[no_panic]
#[inline(never)]
fn server_failed(server: &mut Server, plc: &mut Plc<'_>) {
    server.handle_failed(plc);
}

#[no_panic]
#[inline(never)]
fn server_timeout(server: &mut Server, now: Duration, plc: &mut Plc<'_>) {
    server.handle_timeout(now, plc);
}

#[no_panic]
#[inline(never)]
fn server_event(server: &mut Server) -> Option<ServerEvent> {
    server.poll_event()
}

#[no_panic]
#[inline(never)]
fn endpoint_block(endpoint: &mut Endpoint, now: Duration, block: &[u8], plc: &mut Plc<'_>) {
    endpoint.handle_block(now, block, plc);
}

#[no_panic]
#[inline(never)]
fn endpoint_transmit(endpoint: &mut Endpoint, now: Duration) -> Option<Telegram> {
    endpoint.poll_transmit(now)
}

#[no_panic]
#[inline(never)]
fn endpoint_event(endpoint: &mut Endpoint) -> Option<Event<'_>> {
    endpoint.poll_event()
}

#[no_panic]
#[inline(never)]
fn message_decode(block: &[u8]) -> Result<Message<'_>, DecodeError> {
    Message::decode(block)
}

#[no_panic]
#[inline(never)]
fn message_encode(message: &Message<'_>) -> Result<Telegram, EncodeError> {
    message.encode()
}

pub fn run() {
    let now = black_box(Duration::from_millis(5));
    let block = black_box([0, 0, 0x45, 0x44, 5, 10, 0, 2, 0xFF, 0xFF].as_slice());
    let (mut db, mut dx) = ([0; 64], [0; 32]);
    let blocks = [DataBlock::db(5, &mut db), DataBlock::dx(6, &mut dx)];
    let plc = &mut black_box(Memory::new(blocks));

    let client = &mut black_box(Client::new(Config::DEFAULT));
    if let Ok(command) = Command::fetch(Area::db(5, 10), black_box(2)) {
        let _ = black_box(submit(black_box(client), black_box(command), block));
    }
    black_box(client_transmit(black_box(client), now));
    client_delivered(black_box(client), now);
    client_block(black_box(client), now, block);
    client_failed(black_box(client), now);
    client_timeout(black_box(client), now);
    black_box(client_due(black_box(client)));
    black_box(client_event(black_box(client)));

    let server = &mut black_box(Server::new(Config::DEFAULT));
    server_block(black_box(server), block, black_box(plc));
    black_box(server_transmit(black_box(server)));
    server_delivered(black_box(server), now);
    server_failed(black_box(server), black_box(plc));
    server_timeout(black_box(server), now, black_box(plc));
    black_box(server_event(black_box(server)));

    let endpoint = &mut black_box(Endpoint::new(Config::DEFAULT));
    endpoint_block(black_box(endpoint), now, block, black_box(plc));
    black_box(endpoint_transmit(black_box(endpoint), now));
    black_box(endpoint_event(black_box(endpoint)));

    if let Ok(message) = message_decode(block) {
        let _ = black_box(message_encode(&black_box(message)));
    }
}
