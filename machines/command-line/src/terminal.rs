//! Where lines come from and answers go to: a file, standard input, or a serial port.

use core::time::Duration;
use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Write};
use std::path::Path;

use anyhow::{Context as _, Result, ensure};
use serialport::SerialPort;

/// How long one attempt to read a port lasts; it is then made again.
const PATIENCE: Duration = Duration::from_millis(200);

/// Bytes in, answers out.
pub struct Terminal {
    reader: BufReader<Box<dyn Read>>,
    writer: Box<dyn Write>,
    is_file: bool,
}

impl core::fmt::Debug for Terminal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Terminal")
            .field("is_file", &self.is_file)
            .finish_non_exhaustive()
    }
}

impl Terminal {
    /// A file, or standard input for `-`; answers go to standard output.
    ///
    /// # Errors
    /// It cannot be opened, or is a folder; the message begins with its name.
    pub fn open_file(path: &Path) -> Result<Self> {
        let (reader, is_file): (Box<dyn Read>, _) = if path.as_os_str() == "-" {
            (Box::new(io::stdin()), false)
        } else {
            let place = || path.display().to_string();
            let file = File::open(path).with_context(place)?;
            let metadata = file.metadata().with_context(place)?;
            ensure!(!metadata.is_dir(), "{}: is a folder", place());
            (Box::new(file), metadata.is_file())
        };
        Ok(Self {
            reader: BufReader::new(reader),
            writer: Box::new(io::stdout()),
            is_file,
        })
    }

    /// A serial port or pseudo-terminal, 8N1, in both directions.
    ///
    /// # Errors
    /// It cannot be opened; the message begins with its name.
    pub fn open_port(name: &str, baud: u32) -> Result<Self> {
        let port = serialport::new(name, baud).timeout(PATIENCE);
        let port = port.open().with_context(|| name.to_owned())?;
        let writer = port.try_clone().with_context(|| name.to_owned())?;
        Ok(Self {
            reader: BufReader::new(Box::new(Port(port))),
            writer: Box::new(writer),
            is_file: false,
        })
    }

    /// Whether all bytes are there, and none is waited for.
    #[must_use]
    pub const fn is_file(&self) -> bool {
        self.is_file
    }

    /// The next byte, which is waited for; `None` when no more come.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn read_byte(&mut self) -> Result<Option<u8>> {
        let mut byte = [0];
        loop {
            match self.reader.read(&mut byte) {
                Ok(0) => return Ok(None),
                Ok(_) => return Ok(Some(u8::from_le_bytes(byte))),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error).context("input"),
            }
        }
    }

    /// Sends a line.
    ///
    /// # Errors
    /// Nobody takes it.
    pub fn answer(&mut self, text: &str) -> Result<()> {
        writeln!(self.writer, "{text}")
            .and_then(|()| self.writer.flush())
            .context("answer")
    }
}

/// A port that waits for bytes as long as there is another end.
struct Port(Box<dyn SerialPort>);

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

/// The kernel says EIO, other systems that the pipe is broken.
fn is_hang_up(error: &io::Error) -> bool {
    const EIO: i32 = 5;
    error.kind() == ErrorKind::BrokenPipe || error.raw_os_error() == Some(EIO)
}
