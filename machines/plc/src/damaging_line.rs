//! What the line makes of the bytes, and its log.

use core::fmt;
use core::str::FromStr;
use core::time::Duration;
use std::io::Write;

use anyhow::{Context as _, Result, bail};
use machine_sim::serial_line::Noise;

use crate::report::Traffic;
use crate::side::Role;

/// One byte of every `N` to `2 N` is damaged; none for 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Spacing(u64);

impl Spacing {
    /// Longer than any block on the line, so that none is hit twice: two errors can cancel in the
    /// BCC.
    pub const MIN: Self = Self(280);
}

impl FromStr for Spacing {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let spacing = text.parse()?;
        if (1..Self::MIN.0).contains(&spacing) {
            bail!(
                "must be 0 or at least {}, so that no block is hit twice",
                Self::MIN
            );
        }
        Ok(Self(spacing))
    }
}

impl fmt::Display for Spacing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// The noise of both directions.
///
/// It logs what each side received: time in s, `>` from the PC or `<` from the PLC, bytes.
#[derive(Debug)]
pub struct DamagingLine<W> {
    log: W,
    from_pc: Noise,
    from_plc: Noise,
}

impl<W: Write> DamagingLine<W> {
    /// A line with a log; the seed says which bytes are damaged, and how.
    #[must_use]
    pub const fn new(log: W, spacing: Spacing, seed: u64) -> Self {
        Self {
            log,
            from_pc: Noise::new(seed, spacing.0),
            from_plc: Noise::new(!seed, spacing.0),
        }
    }

    /// What arrives of the bytes that a side sent.
    ///
    /// # Errors
    /// The log cannot be written.
    pub fn pass(&mut self, now: Duration, from: Role, sent: &[u8]) -> Result<Vec<u8>> {
        let (noise, arrow) = match from {
            Role::Pc => (&mut self.from_pc, '>'),
            Role::Plc => (&mut self.from_plc, '<'),
        };
        let arrived = noise.pass(sent);
        let mut text = format!("{:.6} {arrow}", now.as_secs_f64());
        for byte in &arrived {
            text += &format!(" {byte:02X}");
        }
        writeln!(self.log, "{text}").context("line.log")?;
        Ok(arrived)
    }

    /// Ends the log, and says what the line carried until now.
    ///
    /// # Errors
    /// The log cannot be written.
    pub fn finish(mut self, now: Duration) -> Result<Traffic> {
        self.log.flush().context("line.log")?;
        Ok(Traffic {
            duration: now,
            bytes: self.from_pc.bytes() + self.from_plc.bytes(),
            damaged: self.from_pc.damaged() + self.from_plc.damaged(),
        })
    }
}
