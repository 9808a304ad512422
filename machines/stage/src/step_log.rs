//! The steps of the path as a table.

use std::io::Write;

use anyhow::Result;

/// Writes `steps.csv` as the steps are made: time in s, and the step of each axis.
#[derive(Debug)]
pub struct StepLog<W: Write> {
    out: W,
}

impl<W: Write> StepLog<W> {
    /// Begins a table.
    ///
    /// # Errors
    /// `out` does not take it.
    pub fn new(mut out: W) -> Result<Self> {
        writeln!(out, "t_s,dx,dy")?;
        Ok(Self { out })
    }

    /// Writes a step, at a time in microseconds.
    ///
    /// # Errors
    /// `out` does not take it.
    pub fn step(&mut self, ticks: u64, [dx, dy]: [i32; 2]) -> Result<()> {
        let (s, us) = (ticks / 1_000_000, ticks % 1_000_000);
        Ok(writeln!(self.out, "{s}.{us:06},{dx},{dy}")?)
    }

    /// Ends the table.
    ///
    /// # Errors
    /// `out` does not take it.
    pub fn finish(mut self) -> Result<()> {
        Ok(self.out.flush()?)
    }
}
