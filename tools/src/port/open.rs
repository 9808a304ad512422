//! Opening a port.

use core::{future::poll_fn, time::Duration};
use std::io;

use socket2::{SockRef, TcpKeepalive};
use tokio::{
    net::{TcpListener, TcpStream},
    time::timeout,
};

use super::{Address, Frame, Port, Target, echo::Echo, stream::Coding, telnet::Telnet};
#[cfg(unix)]
use super::{marks::Marks, pty, tty::open_serial};

/// After this silence a TCP connection is probed, then again and again: a partner that is gone is
/// noticed within 25 s.
const QUIET: Duration = Duration::from_secs(10);
const PROBE: Duration = Duration::from_secs(5);
const PROBES: u32 = 3;

/// How long a connection, and the answers of a serial server, may take.
const PATIENCE: Duration = Duration::from_secs(10);

impl Address {
    /// Opens the port; [`Target::TcpListen`] waits until somebody connects, and hears whoever
    /// connects next in place of the one before, who may be gone.
    ///
    /// A partner on TCP that is switched off is noticed within 25 s: the port fails.
    ///
    /// A serial port is opened for this program alone. Damaged characters and BREAK are heard on
    /// serial ports of Unix, BREAK on serial servers that tell it (RFC 2217).
    ///
    /// # Errors
    /// Those of the operating system; a serial server that does not set its port up as asked.
    pub async fn open(&self) -> io::Result<Port> {
        let echo = self.has_echo.then(|| Echo::new(character(self.frame)));
        match &self.target {
            Target::Serial(path) => serial(path, self.frame, echo),
            Target::Tcp(host) => Ok(Port::new(connect(host).await?, Coding::Plain, echo)),
            Target::Rfc2217(host) => {
                let coding = Coding::Telnet(Telnet::new(self.frame));
                let port = Port::new(connect(host).await?, coding, echo);
                let set_up = timeout(PATIENCE, set_up(port)).await;
                set_up.unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into()))
            }
            Target::TcpListen(host) => {
                let listener = TcpListener::bind(host).await?;
                let (stream, _) = listener.accept().await?;
                set_options(&stream)?;
                Ok(Port::new(stream, Coding::Plain, echo).with_listener(listener))
            }
            Target::Pty(path) => pseudo_terminal(path, echo),
        }
    }
}

/// Time of a character.
fn character(frame: Frame) -> Duration {
    Duration::from_secs(1) * u32::from(frame.bits()) / frame.baud
}

#[cfg(unix)]
fn serial(path: &str, frame: Frame, echo: Option<Echo>) -> io::Result<Port> {
    let coding = Coding::Marked(Marks::default());
    Ok(Port::new(open_serial(path, frame)?, coding, echo))
}

#[cfg(unix)]
fn pseudo_terminal(path: &str, echo: Option<Echo>) -> io::Result<Port> {
    let (terminal, other_end) = pty::create(path)?;
    Ok(Port::new(terminal, Coding::Plain, echo).with_other_end(other_end))
}

/// Without marks: damaged characters cannot be told from others.
#[cfg(not(unix))]
fn serial(path: &str, frame: Frame, echo: Option<Echo>) -> io::Result<Port> {
    use super::Parity;
    use tokio_serial::{DataBits, SerialPortBuilderExt as _, StopBits};
    let parity = match frame.parity {
        Parity::None => tokio_serial::Parity::None,
        Parity::Even => tokio_serial::Parity::Even,
        Parity::Odd => tokio_serial::Parity::Odd,
    };
    let stop_bits = match frame.stop_bits {
        2 => StopBits::Two,
        _ => StopBits::One,
    };
    let port = tokio_serial::new(path, frame.baud)
        .data_bits(DataBits::Eight)
        .parity(parity)
        .stop_bits(stop_bits)
        .open_native_async()?;
    Ok(Port::new(port, Coding::Plain, echo))
}

#[cfg(not(unix))]
fn pseudo_terminal(_: &str, _: Option<Echo>) -> io::Result<Port> {
    let message = "this system has no pseudo-terminals";
    Err(io::Error::new(io::ErrorKind::Unsupported, message))
}

async fn connect(host: &str) -> io::Result<TcpStream> {
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

/// Waits until the server has confirmed every setting.
async fn set_up(mut port: Port) -> io::Result<Port> {
    while port.telnet().is_some_and(|telnet| !telnet.is_ready()) {
        let is_open = poll_fn(|context| port.poll_exchange(context)).await?;
        if !is_open {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
    }
    Ok(port)
}

#[cfg(test)]
mod tests {
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
