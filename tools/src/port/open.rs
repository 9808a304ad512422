//! Opening a port.

use core::{future::poll_fn, time::Duration};
use std::io;

use tokio::{net::TcpListener, time::timeout};

use super::{
    Address, Frame, Port, Target,
    echo::Echo,
    stream::Coding,
    tcp::{PATIENCE, connect, set_options},
    telnet::Telnet,
};
#[cfg(unix)]
use super::{marks::Marks, pty, tty::open_serial};

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
