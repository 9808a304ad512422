//! An RK512 client and server of 128 bytes, without their link.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;
use core::time::Duration;

use rk512::{Area, Client, Command, Config, DataBlock, Memory, Server};

fn work() -> Option<()> {
    let (now, mut db5) = (Duration::ZERO, [0; 64]);
    let mut memory = Memory::new([DataBlock::db(5, &mut db5)]);
    let mut client = Client::<128>::new(Config::DEFAULT);
    let mut server = Server::new(Config::DEFAULT);
    let fetch = Command::fetch(Area::db(5, 10), black_box(20)).ok()?;
    client.submit(fetch, &[]).ok()?;
    while let Some(command) = client.poll_transmit(now) {
        client.handle_delivered(now);
        server.handle_block(&command, &mut memory);
        while let Some(reaction) = server.poll_transmit() {
            server.handle_delivered(now);
            client.handle_block(now, &reaction);
        }
    }
    black_box(client.poll_event()?);
    Some(())
}
