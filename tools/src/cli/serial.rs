//! Serial ports by their options on a command line.

use core::time::Duration;

use anyhow::{Context as _, Result};
use clap::{Args, ValueEnum};
use serialport::SerialPort;

/// How the characters of a line are made.
#[derive(Clone, Copy, Debug, Args)]
pub(super) struct Frame {
    /// Bits per second.
    #[arg(long, default_value_t = 9600, value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) baud: u32,
    /// Parity bit.
    #[arg(long, default_value = "even")]
    parity: Parity,
}

/// The character frame.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Parity {
    /// 8N1.
    None,
    /// 8E1.
    Even,
    /// 8O1.
    Odd,
}

impl Frame {
    /// Opens a port, on which a read waits at most for `patience`.
    pub(super) fn open(self, path: &str, patience: Duration) -> Result<Box<dyn SerialPort>> {
        let parity = match self.parity {
            Parity::None => serialport::Parity::None,
            Parity::Even => serialport::Parity::Even,
            Parity::Odd => serialport::Parity::Odd,
        };
        serialport::new(path, self.baud)
            .parity(parity)
            .timeout(patience)
            .open()
            .with_context(|| path.to_owned())
    }

    /// Bits of a character on the line, with start and stop bit.
    pub(super) const fn bits(self) -> u8 {
        match self.parity {
            Parity::None => 10,
            Parity::Even | Parity::Odd => 11,
        }
    }
}
