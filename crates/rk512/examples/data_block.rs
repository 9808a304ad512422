//! Writes two words of a data block and reads 65, from a simulated PLC.

use core::{error::Error, time::Duration};
use rk512::{Area, Client, Command, Config, DataBlock, Memory, Outcome, Server};

fn main() -> Result<(), Box<dyn Error>> {
    let mut db5 = [0; 200]; // the partner: data block 5, 100 words
    let mut plc = Memory::new([DataBlock::db(5, &mut db5)]);
    let mut client = Client::<256>::new(Config::DEFAULT);

    let write = Command::send(Area::db(5, 10), 2)?; // DW 10 and DW 11
    client.submit(write, &[0x12, 0x34, 0xAB, 0xCD])?;
    exchange(&mut client, &mut plc);
    assert!(matches!(client.poll_event(), Some(Outcome::Sent { .. })));

    let read = Command::fetch(Area::db(5, 11), 65)?; // from DW 11 on
    client.submit(read, &[])?;
    exchange(&mut client, &mut plc);
    let Some(Outcome::Fetched { data, .. }) = client.poll_event() else {
        return Err("no data".into());
    };
    assert!(data.len() == 130 && data.starts_with(&[0xAB, 0xCD]));
    Ok(())
}

/// Instead of a line: every block arrives at once.
fn exchange(client: &mut Client<256>, plc: &mut Memory<'_, 1>) {
    let (now, mut server) = (Duration::ZERO, Server::new(Config::DEFAULT));
    while let Some(command) = client.poll_transmit(now) {
        client.handle_delivered(now);
        server.handle_block(&command, plc);
        while let Some(reaction) = server.poll_transmit() {
            server.handle_delivered(now);
            client.handle_block(now, &reaction);
        }
    }
}
