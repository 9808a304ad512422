//! The numbers of a run, for programs and for people.

use std::io::Write;
use std::path::Path;

use anyhow::Result;
use serde::Serialize;

/// `report.json`. Steps are those of the path, as in steps.csv; corrections are counted apart.
#[derive(Serialize)]
pub(crate) struct Report {
    pub(crate) rule: &'static str,
    /// Either way.
    pub(crate) steps_x: u64,
    /// Either way.
    pub(crate) steps_y: u64,
    /// From the drawing's zero.
    pub(crate) end_steps: [i32; 2],
    /// Of the stage from the programmed curve.
    pub(crate) max_deviation_mm: f64,
    /// Of the stage from the programmed end.
    pub(crate) closing_error_mm: f64,
    pub(crate) lost_steps: u64,
    pub(crate) corrected_steps: u64,
    pub(crate) duration_s: f64,
    pub(crate) open_loop: OpenLoop,
    pub(crate) lose_steps: f64,
    pub(crate) seed: u64,
    /// What the program asked for that was left out or done otherwise.
    pub(crate) notes: Vec<String>,
}

/// The stage beside it, without corrections.
#[derive(Serialize)]
pub(crate) struct OpenLoop {
    pub(crate) max_deviation_mm: f64,
    pub(crate) closing_error_mm: f64,
    pub(crate) lost_steps: u64,
}

/// Writes what a person wants to know first.
pub(crate) fn summary(mut out: impl Write, report: &Report, folder: &Path) -> Result<()> {
    writeln!(
        out,
        "{} + {} steps by the {} rule in {:.1} s",
        report.steps_x, report.steps_y, report.rule, report.duration_s
    )?;
    writeln!(
        out,
        "closed loop: {} steps lost, {} corrected; {:.3} mm off the curve at most, {:.3} mm at the end",
        report.lost_steps, report.corrected_steps, report.max_deviation_mm, report.closing_error_mm
    )?;
    let open = &report.open_loop;
    writeln!(
        out,
        "open loop:   {} steps lost; {:.3} mm off the curve at most, {:.3} mm at the end",
        open.lost_steps, open.max_deviation_mm, open.closing_error_mm
    )?;
    writeln!(
        out,
        "in {}: steps.csv, stage.svg, report.json",
        folder.display()
    )?;
    Ok(())
}
