//! A serial port or pseudo-terminal, 8N1, that brings lines and takes answers.

use core::time::Duration;
use std::io::{self, ErrorKind, Read, Write};

use anyhow::{Context as _, Result};
use serialport::SerialPort;

/// How long one attempt to read lasts; it is then made again.
const PATIENCE: Duration = Duration::from_millis(200);

/// An open port. A read waits for bytes as long as there is another end.
#[derive(Debug)]
pub struct Port(Box<dyn SerialPort>);

impl Port {
    /// Opens a port.
    ///
    /// # Errors
    /// It cannot be opened; the message begins with its name.
    pub fn open(name: &str, baud: u32) -> Result<Self> {
        let port = serialport::new(name, baud).timeout(PATIENCE);
        Ok(Self(port.open().with_context(|| name.to_owned())?))
    }

    /// A second handle, to write while another reads.
    ///
    /// # Errors
    /// The system has none left.
    pub fn try_clone(&self) -> Result<Self> {
        Ok(Self(self.0.try_clone()?))
    }
}

impl Read for Port {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            match self.0.read(buffer) {
                Err(error) if error.kind() == ErrorKind::TimedOut => {}
                // The other end has been closed.
                Err(error) if is_hang_up(&error) => return Ok(0),
                other => return other,
            }
        }
    }
}

impl Write for Port {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// The kernel says EIO, other systems that the pipe is broken.
fn is_hang_up(error: &io::Error) -> bool {
    const EIO: i32 = 5;
    error.kind() == ErrorKind::BrokenPipe || error.raw_os_error() == Some(EIO)
}
