//! Where lines come from and answers go to: a file, standard input or a serial port.

use core::time::Duration;
use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Write};
use std::path::Path;

use anyhow::{Context, Result, anyhow};
use serialport::SerialPort;

/// How long one attempt to read a port lasts; it is then made again.
const PATIENCE: Duration = Duration::from_millis(200);

/// More of a line in bytes is not kept, so that a line without an end does not fill the memory.
const LONGEST_LINE: usize = 256;

/// Lines in, answers out.
pub(crate) struct Terminal {
    reader: Box<dyn Read>,
    writer: Box<dyn Write>,
    /// Whether the line before ended with a carriage return, to which a line feed may belong.
    returned: bool,
    is_file: bool,
}

impl Terminal {
    /// A file, or standard input for `-`; answers go to standard output.
    pub(crate) fn file(path: &Path) -> Result<Self> {
        let (reader, is_file): (Box<dyn Read>, _) = if path.as_os_str() == "-" {
            (Box::new(BufReader::new(io::stdin())), false)
        } else {
            let place = || path.display().to_string();
            let file = File::open(path).with_context(place)?;
            let metadata = file.metadata()?;
            anyhow::ensure!(!metadata.is_dir(), "{}: is a folder", place());
            (Box::new(BufReader::new(file)), metadata.is_file())
        };
        Ok(Self {
            reader,
            writer: Box::new(io::stdout()),
            returned: false,
            is_file,
        })
    }

    /// A serial port, 8N1, in both directions.
    pub(crate) fn port(path: &str, baud: u32) -> Result<Self> {
        let port = serialport::new(path, baud)
            .timeout(PATIENCE)
            .open()
            .with_context(|| path.to_owned())?;
        let writer = port.try_clone().with_context(|| path.to_owned())?;
        Ok(Self {
            reader: Box::new(BufReader::new(Port(port))),
            writer: Box::new(writer),
            returned: false,
            is_file: false,
        })
    }

    /// Whether all lines are there, and none is waited for.
    pub(crate) const fn is_file(&self) -> bool {
        self.is_file
    }

    /// The next line without its end, or why it cannot be read; `None` when no more come.
    pub(crate) fn line(&mut self) -> Result<Option<Result<String>>> {
        let mut line = Vec::new();
        let mut is_cut = false;
        let mut byte = [0];
        loop {
            match self.reader.read(&mut byte) {
                Ok(0) if line.is_empty() => return Ok(None),
                Ok(0) => break,
                Ok(_) => {}
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(error).context("input"),
            }
            let returned = core::mem::replace(&mut self.returned, byte == [b'\r']);
            match byte {
                [b'\n'] if returned => {}
                // A terminal ends its lines with the second alone.
                [b'\n' | b'\r'] => break,
                _ if line.len() < LONGEST_LINE => line.extend(byte),
                // Of a comment nothing is missed.
                _ => is_cut = !line.contains(&b'#'),
            }
        }
        if is_cut {
            return Ok(Some(Err(anyhow!("longer than {LONGEST_LINE} bytes"))));
        }
        Ok(Some(Ok(String::from_utf8_lossy(&line).into_owned())))
    }

    pub(crate) fn answer(&mut self, text: &str) -> Result<()> {
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
                // The other end has been closed; the kernel says EIO.
                Err(error) if is_hang_up(&error) => return Ok(0),
                other => return other,
            }
        }
    }
}

fn is_hang_up(error: &io::Error) -> bool {
    const EIO: i32 = 5;
    error.kind() == ErrorKind::BrokenPipe || error.raw_os_error() == Some(EIO)
}
