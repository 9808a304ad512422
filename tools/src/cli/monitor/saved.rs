//! What a monitor has heard, in a file.

use core::time::Duration;
use std::{
    fs::File,
    io::{self, BufWriter, Write as _},
};

use monitor3964r::Character;

use crate::capture::{self, PcapngWriter, Step};

/// An open file.
pub(super) enum Saved {
    Text(BufWriter<File>),
    Pcapng(PcapngWriter<BufWriter<File>>),
}

impl Saved {
    /// A new file; `epoch` is the time 0 of the capture, since 1970.
    pub(super) fn create(path: &str, epoch: Duration) -> io::Result<Self> {
        let file = BufWriter::new(File::create_new(path)?);
        if path.ends_with(".pcapng") {
            Ok(Self::Pcapng(PcapngWriter::new(file, epoch)?))
        } else {
            Ok(Self::Text(file))
        }
    }

    pub(super) fn piece(&mut self, piece: &[Character], steps: &[Step]) -> io::Result<()> {
        match self {
            Self::Text(file) => {
                for character in piece {
                    writeln!(file, "{}", capture::line(character))?;
                }
                file.flush()
            }
            Self::Pcapng(file) => file.piece(piece, steps),
        }
    }

    /// Steps that the time alone has made: they follow from the times of a capture.
    pub(super) fn wait(&mut self, steps: &[Step]) -> io::Result<()> {
        match self {
            Self::Text(_) => Ok(()),
            Self::Pcapng(file) => file.wait(steps),
        }
    }

    pub(super) fn verdict(&mut self, now: Duration, verdict: &str) -> io::Result<()> {
        match self {
            Self::Text(file) => {
                for line in verdict.lines() {
                    writeln!(file, "# {line}")?;
                }
                file.flush()
            }
            Self::Pcapng(file) => file.note(now, verdict),
        }
    }
}
