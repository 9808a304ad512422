//! The numbers of a run, for programs and for people.

use std::io::Write;

use anyhow::{Result, bail};
use serde::Serialize;

use crate::session::Refusal;

/// `report.json`.
#[derive(Serialize)]
pub(crate) struct Report {
    /// Lines answered with `ok`.
    pub(crate) moves: usize,
    /// Lines answered with `error:`.
    pub(crate) refused: usize,
    pub(crate) refusals: Vec<Refusal>,
    /// What else was not done.
    pub(crate) notes: Vec<String>,
    /// Farthest that the simulated platform was from the lines asked for, driven by the trains.
    pub(crate) max_path_error_mm: f64,
    pub(crate) duration_s: f64,
    /// Of all motors, either way.
    pub(crate) steps: u64,
    pub(crate) rad_per_step: f64,
    /// Angle of each arm at home, from straight down, outward positive.
    pub(crate) home_rad: [f64; 3],
    /// Steps from home at the end.
    pub(crate) end: [i32; 3],
    /// The same moves driven by the thesis' control tick.
    pub(crate) tick: Tick,
}

#[derive(Serialize)]
pub(crate) struct Tick {
    pub(crate) tick_s: f64,
    pub(crate) max_path_error_mm: f64,
    pub(crate) duration_s: f64,
}

impl Report {
    /// An error where lines were refused.
    pub(crate) fn check(&self) -> Result<()> {
        let Some(first) = self.refusals.first() else {
            return Ok(());
        };
        let (refused, all) = (self.refused, self.refused + self.moves);
        bail!(
            "{refused} of {all} lines refused, the first: line {}: {}",
            first.line,
            first.reason
        )
    }

    /// Writes what a person wants to know first.
    pub(crate) fn write_summary(&self, mut out: impl Write, folder: &str) -> Result<()> {
        writeln!(
            out,
            "{} moves, {} refused, {} steps",
            self.moves, self.refused, self.steps
        )?;
        writeln!(
            out,
            "trains:    {:.3} s, at most {:.4} mm off the lines",
            self.duration_s, self.max_path_error_mm
        )?;
        writeln!(
            out,
            "{:.0} ms tick: {:.3} s, at most {:.4} mm off the lines",
            self.tick.tick_s * 1000.0,
            self.tick.duration_s,
            self.tick.max_path_error_mm
        )?;
        writeln!(out, "in {folder}: steps.csv, delta.svg, report.json")?;
        Ok(())
    }
}
