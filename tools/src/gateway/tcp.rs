//! Events and commands as lines of JSON, over TCP.

use alloc::sync::Arc;
use std::io;

use log::{info, warn};
use serde::Deserialize;
use serde_json::value::RawValue;
use tokio::{
    io::{AsyncBufReadExt as _, AsyncReadExt as _, AsyncWriteExt as _, BufReader},
    net::{TcpListener, TcpStream, tcp::ReadHalf},
    sync::broadcast::error::RecvError,
    task::JoinSet,
};

use super::{accept, hub::Hub, job::MAX_COMMAND};

/// Clients at once.
const MAX_CLIENTS: usize = 64;

/// A command for one of the lines: `{"line": "scale", "command": {"send": "41"}}`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Addressed {
    line: String,
    command: Box<RawValue>,
}

/// Serves every client until the gateway ends.
pub(crate) async fn serve(listener: TcpListener, hub: Arc<Hub>) {
    let mut clients = JoinSet::new();
    loop {
        tokio::select! {
            (stream, from) = accept(&listener, "tcp") => {
                if clients.len() >= MAX_CLIENTS {
                    warn!("tcp: {from} refused: {MAX_CLIENTS} clients are connected");
                    continue;
                }
                let hub = Arc::clone(&hub);
                clients.spawn(async move {
                    let ended = client(stream, &hub).await;
                    if let Err(error) = ended {
                        info!("tcp: {from}: {error}");
                    }
                });
            }
            Some(_) = clients.join_next() => {}
        }
    }
}

/// # Errors
/// Those of the connection; a client that is too slow, or sends what is no command.
async fn client(mut stream: TcpStream, hub: &Hub) -> io::Result<()> {
    stream.set_nodelay(true)?;
    let mut events = hub.events.subscribe();
    let (reader, mut writer) = stream.split();
    let mut reader = BufReader::new(reader);
    let mut line = Vec::new();
    loop {
        tokio::select! {
            event = events.recv() => match event {
                Ok(event) => {
                    writer.write_all(&event).await?;
                    writer.write_all(b"\n").await?;
                }
                Err(RecvError::Lagged(behind)) => {
                    return Err(io::Error::other(format!("too slow, {behind} events behind")));
                }
                Err(RecvError::Closed) => return Ok(()),
            },
            read = read_line(&mut reader, &mut line) => {
                if !read? {
                    return Ok(());
                }
                command(&line, hub)?;
                line.clear();
            }
        }
    }
}

/// Reads up to the end of a line; `false` at the end of the stream. May be dropped and called
/// again: what was read stays in `line`.
async fn read_line(reader: &mut BufReader<ReadHalf<'_>>, line: &mut Vec<u8>) -> io::Result<bool> {
    let room = MAX_COMMAND.saturating_sub(line.len());
    let mut limited = reader.take(u64::try_from(room).unwrap_or(u64::MAX));
    limited.read_until(b'\n', line).await?;
    if line.ends_with(b"\n") {
        return Ok(true);
    }
    if line.len() >= MAX_COMMAND {
        return Err(io::Error::other(format!(
            "a line above {MAX_COMMAND} bytes"
        )));
    }
    // The stream has ended.
    Ok(false)
}

fn command(line: &[u8], hub: &Hub) -> io::Result<()> {
    if line.trim_ascii().is_empty() {
        return Ok(());
    }
    let Addressed { line, command } = serde_json::from_slice(line)?;
    hub.command(&line, command.get().as_bytes(), None, false);
    Ok(())
}
