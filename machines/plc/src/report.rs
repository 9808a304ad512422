//! The numbers of a run, for programs and for people.

use core::fmt;
use core::time::Duration;

use anyhow::{Result, ensure};
use serde::Serialize;

use crate::side::{Side, Tally};

/// What the line carried, both ways.
#[derive(Debug, Default, Clone, Copy)]
#[expect(clippy::exhaustive_structs, reason = "written as a literal")]
pub struct Traffic {
    /// How long the run took.
    pub duration: Duration,
    /// Bytes that were sent.
    pub bytes: u64,
    /// How many of them were damaged.
    pub damaged: u64,
}

/// `report.json`; displayed, a summary in lines.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Report {
    /// To a millisecond.
    seconds: f64,
    line_bytes: u64,
    damaged_bytes: u64,
    pc: Tally,
    plc: Tally,
    memories_as_written: bool,
}

impl Report {
    /// The report on a run that is over.
    #[must_use]
    pub fn new(traffic: Traffic, pc: &Side, plc: &Side) -> Self {
        Self {
            seconds: (traffic.duration.as_secs_f64() * 1e3).round() / 1e3,
            line_bytes: traffic.bytes,
            damaged_bytes: traffic.damaged,
            pc: pc.tally(),
            plc: plc.tally(),
            memories_as_written: pc.holds_all_of(plc) && plc.holds_all_of(pc),
        }
    }

    /// That nothing was lost.
    ///
    /// # Errors
    /// Data were read back otherwise than written, or a memory does not hold them.
    pub fn check(&self) -> Result<()> {
        let whole = [self.pc, self.plc].iter().all(|side| side.different == 0);
        ensure!(whole && self.memories_as_written, "data were lost");
        Ok(())
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "line: {} bytes, {} damaged, {:.1} s",
            self.line_bytes, self.damaged_bytes, self.seconds
        )?;
        for (name, side) in [("pc", self.pc), ("plc", self.plc)] {
            writeln!(
                f,
                "{name}: {} data blocks written and read back ({} bytes), {} different, \
                 {} jobs repeated, {} blocks rejected",
                side.done, side.bytes, side.different, side.jobs_repeated, side.blocks_rejected
            )?;
        }
        Ok(())
    }
}
