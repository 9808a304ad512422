//! A server whose partner gets its reaction when the data are on disk.

use core::{error::Error, time::Duration};
use rk512::{
    Area, Client, Command, Config, DataBlock, DataSource, Memory, Outcome, ReactionError, Server,
    ServerEvent,
};
use std::{env, fs};

/// Data block 5.
struct Stored([u8; 200]);

impl Stored {
    fn memory(&mut self) -> Memory<'_, 1> {
        Memory::new([DataBlock::db(5, &mut self.0)])
    }
}

impl DataSource for Stored {
    fn size(&mut self, job: &Command) -> Result<usize, ReactionError> {
        self.memory().size(job)
    }

    fn read(&mut self, job: &Command, at: usize, data: &mut [u8]) -> Result<(), ReactionError> {
        self.memory().read(job, at, data)
    }

    fn write(&mut self, job: &Command, at: usize, data: &[u8]) -> Result<(), ReactionError> {
        self.memory().write(job, at, data)
    }

    fn holds(&self, job: &Command) -> bool {
        job.is_send()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (now, path) = (Duration::ZERO, env::temp_dir().join("db5.bin"));
    let (mut db5, mut server) = (Stored([0; 200]), Server::new(Config::DEFAULT));
    let mut plc = Client::<256>::new(Config::DEFAULT); // the partner
    plc.submit(Command::send(Area::db(5, 10), 1)?, &[0x12, 0x34])?;
    let command = plc.poll_transmit(now).ok_or("no command")?;
    plc.handle_delivered(now);

    server.handle_block(&command, &mut db5);
    if let Some(ServerEvent::Held(_)) = server.poll_event() {
        let stored = fs::write(&path, db5.0);
        server.confirm(stored.map_err(|_| ReactionError::Stopped), &mut db5);
    }
    let reaction = server.poll_transmit().ok_or("no reaction")?;
    plc.handle_block(now, &reaction);
    assert!(matches!(plc.poll_event(), Some(Outcome::Sent { .. })));
    assert_eq!(fs::read(&path)?.get(20..22), Some(&[0x12, 0x34][..]));
    Ok(())
}
