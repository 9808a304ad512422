//! The steps as a table: `steps.csv`, written and read.

use std::io::{BufRead, Write};

use anyhow::{Context, Result};

use crate::plan::TICKS_PER_S;

/// Writes `steps.csv` as the steps are made: time in s, and the position of the three motors in
/// steps from home.
#[derive(Debug)]
pub struct StepLog<W: Write> {
    out: W,
}

impl<W: Write> StepLog<W> {
    /// Begins a table, at home.
    ///
    /// # Errors
    /// `out` does not take it.
    pub fn new(mut out: W) -> Result<Self> {
        writeln!(out, "t_s,s1,s2,s3")?;
        let mut log = Self { out };
        log.step(0, [0; 3])?;
        Ok(log)
    }

    /// Writes the position after a step, at a time in ticks of 0.1 microseconds.
    ///
    /// # Errors
    /// `out` does not take it.
    pub fn step(&mut self, ticks: u64, [a, b, c]: [i32; 3]) -> Result<()> {
        let per_s = u64::from(TICKS_PER_S);
        let (s, ticks) = (ticks / per_s, ticks % per_s);
        Ok(writeln!(self.out, "{s}.{ticks:07},{a},{b},{c}")?)
    }

    /// Ends the table.
    ///
    /// # Errors
    /// `out` does not take it.
    pub fn finish(mut self) -> Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}

/// The times in s and the positions of a table.
pub(crate) fn read(table: impl BufRead) -> impl Iterator<Item = Result<(f64, [i32; 3])>> {
    table.lines().skip(1).map(|line| {
        let line = line?;
        let mut fields = line.split(',');
        let mut next = || fields.next().context("a column is missing");
        let t_s = next()?.parse()?;
        Ok((t_s, [next()?.parse()?, next()?.parse()?, next()?.parse()?]))
    })
}
