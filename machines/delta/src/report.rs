//! The numbers of a run, for programs and for people.

use core::fmt;

use anyhow::{Result, bail};
use serde::Serialize;

use crate::plan::seconds;
use crate::record::Refusal;
use crate::simulation::Run;

/// `report.json`; displayed, a summary in lines.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Lines answered with `ok`.
    moves: usize,
    /// Lines answered with `error:`.
    refused: usize,
    refusals: Vec<Refusal>,
    /// What else was not done.
    notes: Vec<String>,
    /// Farthest that the simulated platform was from the lines asked for, driven by the trains.
    max_path_error_mm: f64,
    duration_s: f64,
    /// Of all motors, either way.
    steps: u64,
    rad_per_step: f64,
    /// Angle of each arm at home, from straight down, outward positive.
    home_rad: [f64; 3],
    /// Steps from home at the end.
    end: [i32; 3],
    /// The same moves driven by the thesis' control tick.
    tick: Tick,
}

#[derive(Debug, Clone, Serialize)]
struct Tick {
    tick_s: f64,
    max_path_error_mm: f64,
    duration_s: f64,
}

impl Report {
    pub(crate) fn new(run: &Run<'_>) -> Self {
        let (machine, record) = (run.machine, run.record);
        Self {
            moves: record.moves.len(),
            refused: record.refusals.len(),
            refusals: record.refusals.clone(),
            notes: record.notes(),
            max_path_error_mm: run.trains.max_path_error_mm,
            duration_s: seconds(record.duration_ticks()),
            steps: run.trains.steps,
            rad_per_step: machine.rad_per_step,
            home_rad: machine.home_rad(),
            end: run.trains.end,
            tick: Tick {
                tick_s: machine.tick_s,
                max_path_error_mm: run.ticked.max_path_error_mm,
                duration_s: f64::from(run.ticks) * machine.tick_s,
            },
        }
    }

    /// Whether all lines were done.
    ///
    /// # Errors
    /// Lines were refused: how many, and the first.
    pub fn check(&self) -> Result<()> {
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
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} moves, {} refused, {} steps",
            self.moves, self.refused, self.steps
        )?;
        writeln!(
            f,
            "trains:    {:.3} s, at most {:.4} mm off the lines",
            self.duration_s, self.max_path_error_mm
        )?;
        writeln!(
            f,
            "{:.0} ms tick: {:.3} s, at most {:.4} mm off the lines",
            self.tick.tick_s * 1000.0,
            self.tick.duration_s,
            self.tick.max_path_error_mm
        )
    }
}
