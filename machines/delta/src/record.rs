//! What came of the lines of an input.

use anyhow::{Result, bail};
use known_load::TorqueUsed;
use machine_sim::input::Notes;
use nalgebra::Point3;
use serde::Serialize;

use crate::motion::Motion;

/// A line that has been answered with `ok`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Move {
    /// Of the input, from 1.
    pub(crate) line: usize,
    pub(crate) from: Point3<f64>,
    pub(crate) to: Point3<f64>,
    pub(crate) feed_mm_s: f64,
    /// Where it ends, in steps from home.
    pub(crate) end: [i32; 3],
    pub(crate) end_ticks: u64,
    /// From when to when the curves are run that begin, pass or end on it; none where nothing
    /// moves.
    pub(crate) curves_ticks: Option<[u64; 2]>,
}

/// The end of a row of rounded lines: from one to the next each arm runs the cubic between them.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct TimedRow {
    /// Seconds from the start.
    pub time_s: f64,
    /// Of the arms, in radians.
    pub position_rad: [f64; 3],
    /// Of the arms, in rad/s.
    pub velocity_rad_s: [f64; 3],
    /// The line of the input that the row ends on, from 1.
    pub line: usize,
    /// What the platform may do along the curve that the row ends on, in mm/s.
    pub feed_mm_s: f64,
    /// As the feed, in mm/s², if there is such a limit.
    pub acceleration_mm_s2: Option<f64>,
}

/// A line that has been answered with `error:`.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Refusal {
    pub(crate) line: usize,
    pub(crate) reason: String,
    /// Where the machine was left, and the next move starts.
    pub(crate) stays_at_mm: [f64; 3],
}

/// What came of the lines: moves, refusals, and what else was not done.
#[derive(Debug, Clone)]
pub struct Record {
    pub(crate) motion: Motion,
    pub(crate) moves: Vec<Move>,
    /// Of lines with rounded corners.
    pub(crate) departure_bound_mm: Option<f64>,
    pub(crate) smoothed_bound_mm: Option<f64>,
    /// Where shaped.
    pub(crate) shaped_bound_mm: Option<f64>,
    /// How long shaped rows still have of the motion before.
    pub(crate) delay_s: f64,
    /// Where the machine's load is known.
    pub(crate) torque: Option<TorqueUsed<3>>,
    pub(crate) refusals: Vec<Refusal>,
    pub(crate) notes: Notes,
    /// Of lines with rounded corners.
    pub(crate) rows: Vec<TimedRow>,
}

impl Record {
    pub(crate) fn new(motion: Motion) -> Self {
        Self {
            motion,
            moves: Vec::new(),
            departure_bound_mm: None,
            smoothed_bound_mm: None,
            shaped_bound_mm: None,
            delay_s: 0.0,
            torque: None,
            refusals: Vec::new(),
            notes: Notes::default(),
            rows: Vec::new(),
        }
    }

    /// What else was not done, one line for each kind.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.notes.lines()
    }

    /// The numbers of the lines that were refused.
    pub fn refused_lines(&self) -> impl Iterator<Item = usize> {
        self.refusals.iter().map(|refusal| refusal.line)
    }

    /// The rows of lines with rounded corners; none where each line is run by itself.
    #[must_use]
    pub fn rows(&self) -> &[TimedRow] {
        &self.rows
    }

    /// How long shaped rows still have of the motion before, in s.
    #[must_use]
    pub const fn shaping_s(&self) -> f64 {
        self.delay_s
    }

    /// Whether all lines were done.
    ///
    /// # Errors
    /// Lines were refused: how many, and the first.
    pub fn check(&self) -> Result<()> {
        check(&self.refusals, self.moves.len())
    }

    /// The time of the last move's end.
    pub(crate) fn duration_ticks(&self) -> u64 {
        self.moves.last().map_or(0, |last| last.end_ticks)
    }
}

/// Refuses what was not done of an input.
pub(crate) fn check(refusals: &[Refusal], moves: usize) -> Result<()> {
    let Some(first) = refusals.first() else {
        return Ok(());
    };
    let (refused, all) = (refusals.len(), refusals.len() + moves);
    bail!(
        "{refused} of {all} lines refused, the first: line {}: {}",
        first.line,
        first.reason
    )
}
