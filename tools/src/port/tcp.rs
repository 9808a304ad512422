//! TCP connections that are watched.

use core::time::Duration;
use std::io;

use socket2::{SockRef, TcpKeepalive};
use tokio::{net::TcpStream, time::timeout};

/// After this silence a TCP connection is probed, then again and again: a partner that is gone is
/// noticed within 25 s.
const QUIET: Duration = Duration::from_secs(10);
const PROBE: Duration = Duration::from_secs(5);
const PROBES: u32 = 3;

/// How long a connection, and the answers of a serial server, may take.
pub(super) const PATIENCE: Duration = Duration::from_secs(10);

/// Connects, within [`PATIENCE`].
pub(super) async fn connect(host: &str) -> io::Result<TcpStream> {
    let connected = timeout(PATIENCE, TcpStream::connect(host)).await;
    let stream = connected.unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into()))?;
    set_options(&stream)?;
    Ok(stream)
}

/// Sends without delay, and notices a partner that is gone: one that was switched off answers
/// nothing, and one that was switched on again knows of no connection.
pub(super) fn set_options(stream: &TcpStream) -> io::Result<()> {
    stream.set_nodelay(true)?;
    let socket = SockRef::from(stream);
    let probes = TcpKeepalive::new()
        .with_time(QUIET)
        .with_interval(PROBE)
        .with_retries(PROBES);
    socket.set_tcp_keepalive(&probes)?;
    #[cfg(any(target_os = "android", target_os = "fuchsia", target_os = "linux"))]
    socket.set_tcp_user_timeout(Some(QUIET + PROBE * PROBES))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use tokio::net::TcpListener;

    use super::*;

    #[tokio::test]
    async fn a_connection_is_watched() {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let host = listener.local_addr().unwrap().to_string();
        let stream = connect(&host).await.unwrap();
        let socket = SockRef::from(&stream);
        assert!(stream.nodelay().unwrap() && socket.keepalive().unwrap());
        #[cfg(target_os = "linux")]
        {
            let within = Some(Duration::from_secs(25));
            assert_eq!(socket.tcp_user_timeout().unwrap(), within);
            assert_eq!(socket.tcp_keepalive_time().unwrap(), QUIET);
        }
    }
}
