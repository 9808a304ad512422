//! A station in a task of its own, on any stream of [`tokio`](https://docs.rs/tokio) 1.
//!
//! [`Link`] is what a program uses. A protocol on top of 3964R, which wants every event in its
//! order, has a [`driver`] in a [`Task`] of its own.

mod damage;
mod incoming;
mod link;
mod stream;
mod task;

use alloc::string::String;
use std::io;

use ::tokio::{
    io::{AsyncRead, AsyncWrite},
    net::TcpStream,
};

pub use self::{
    damage::Damage,
    incoming::Incoming,
    link::{Link, SendError},
    stream::{Clock, Reader, Writer, sleep},
    task::{Caller, Lost, Task},
};
use crate::{config::Config, embedded_io_async::Driver, station::Station};

/// A driver on a stream, for a task that wants every event in its order.
pub type StreamDriver<const N: usize> = Driver<Reader, Writer, Clock, N>;

/// Puts a station on a stream.
#[must_use]
pub fn driver<const N: usize>(
    stream: impl AsyncRead + AsyncWrite + Send + 'static,
    config: Config,
) -> StreamDriver<N> {
    let (reader, writer) = stream::split(stream);
    Driver::new(Station::new(config), reader, writer, Clock::new())
}

/// A connection to `tcp://HOST:PORT`, which sends without delay.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for another address; those of the connection.
pub async fn tcp(address: &str) -> io::Result<TcpStream> {
    let Some(host_and_port) = address.strip_prefix("tcp://") else {
        let message = String::from("an address is tcp://HOST:PORT, not ") + address;
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    };
    let stream = TcpStream::connect(host_and_port).await?;
    stream.set_nodelay(true)?;
    Ok(stream)
}
