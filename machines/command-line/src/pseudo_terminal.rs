//! A pseudo-terminal with both of its ends in this program.

use anyhow::Result;

/// Bytes go in at one end and come out of the other.
#[derive(Debug)]
pub struct PseudoTerminal {
    #[cfg(unix)]
    ends: [serialport::TTYPort; 2],
}

#[cfg(unix)]
impl PseudoTerminal {
    /// A new one.
    ///
    /// # Errors
    /// The system has none left.
    pub fn open() -> Result<Self> {
        use anyhow::Context as _;
        use serialport::SerialPort as _;

        /// Far longer than a pseudo-terminal holds a byte back.
        const PATIENCE: core::time::Duration = core::time::Duration::from_secs(5);

        let (first, second) = serialport::TTYPort::pair().context("pseudo-terminal")?;
        let mut ends = [first, second];
        for end in &mut ends {
            end.set_timeout(PATIENCE)?;
        }
        Ok(Self { ends })
    }

    /// Sends a byte from the first or the second end; returns what the other one receives.
    ///
    /// # Errors
    /// It is lost or changed.
    pub fn carry(&mut self, from_first: bool, sent: u8) -> Result<u8> {
        use anyhow::{Context as _, ensure};
        use std::io::{Read as _, Write as _};

        let [first, second] = &mut self.ends;
        let (from, to) = if from_first {
            (first, second)
        } else {
            (second, first)
        };
        from.write_all(&[sent]).context("pseudo-terminal")?;
        let mut received = [0];
        to.read_exact(&mut received).context("pseudo-terminal")?;
        let [received] = received;
        ensure!(
            received == sent,
            "the pseudo-terminal turned {sent:02X}h into {received:02X}h"
        );
        Ok(received)
    }
}

#[cfg(not(unix))]
impl PseudoTerminal {
    /// There is none on this system.
    ///
    /// # Errors
    /// Always.
    pub fn open() -> Result<Self> {
        anyhow::bail!("pseudo-terminals need a Unix system")
    }

    /// Not called: none can be opened.
    ///
    /// # Errors
    /// Always.
    pub fn carry(&mut self, _: bool, _: u8) -> Result<u8> {
        anyhow::bail!("pseudo-terminals need a Unix system")
    }
}
