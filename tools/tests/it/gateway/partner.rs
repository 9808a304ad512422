//! Partners of lines, over TCP.

use core::time::Duration;

use proto3964r::{
    Config, Line, Priority,
    tokio::{Link, SendError},
};
use rk512::{DataBlock, Memory, Server};
use tokio::net::{TcpListener, TcpStream};

use super::listeners::listen;

/// What a partner runs on: it repeats soon.
pub(crate) const PARTNER: Config = Config {
    qvz_ms: 500,
    ..Config::siemens_3964r(Priority::High, Line::Instant)
};

/// A partner that has not been connected to.
pub(crate) struct Partner {
    listener: TcpListener,
    pub(crate) port: u16,
}

impl Partner {
    pub(crate) async fn new() -> Self {
        let listener = listen();
        let port = listener.local_addr().unwrap().port();
        Self { listener, port }
    }

    /// The line, once the gateway has opened it.
    pub(crate) async fn link(&self) -> Link {
        Link::new(self.stream().await, PARTNER)
    }

    /// The same, without a station.
    pub(crate) async fn stream(&self) -> TcpStream {
        let (stream, _) = self.listener.accept().await.unwrap();
        stream.set_nodelay(true).unwrap();
        stream
    }

    /// Serves data block 10 of 100 words, `7` in the first, to whoever connects.
    pub(crate) async fn serve_rk512(self) {
        let mut db10 = [0; 200];
        db10[1] = 7;
        let mut memory = Memory::new([DataBlock::db(10, &mut db10)]);
        loop {
            let link = self.link().await;
            let mut server = Server::new(rk512::Config::DEFAULT);
            while let Ok(command) = link.receive().await {
                server.handle_block(&command, &mut memory);
                while let Some(reaction) = server.poll_transmit() {
                    match link.send(&reaction).await {
                        Ok(()) => server.handle_delivered(Duration::ZERO),
                        Err(SendError::Lost(_)) => break,
                        Err(_) => server.handle_failed(&mut memory),
                    }
                }
            }
        }
    }
}
