//! Runs of the example `stage`, and the path that its steps make.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::tools::artefacts::run_into;
use crate::tools::report::{number, report_in};

/// A step, in mm.
pub(crate) const STEP_MM: f64 = 0.01;
/// What decimals of report.json and f64 lose.
pub(crate) const ROUNDING_MM: f64 = 1e-9;

/// A finished run's files.
pub(crate) struct Run {
    pub(crate) folder: TempDir,
    pub(crate) report: Value,
    /// Standard error.
    pub(crate) notes: Vec<String>,
}

impl Run {
    pub(crate) fn of(arguments: &[&str]) -> Self {
        let folder = TempDir::new().unwrap();
        let output = run_into(folder.path(), "stage", arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        let notes = errors.lines().map(str::to_owned).collect();
        let run = Self {
            notes,
            ..Self::read(folder)
        };
        // Its own status, and the first line, where the motors do not follow.
        let lost = ["x", "y"].map(|of| run.number(&format!("/motors/{of}/lost_steps")));
        let is_lost = lost.iter().any(|steps| steps.abs() > 0.5);
        let status = if is_lost { 2 } else { 0 };
        assert_eq!(output.status.code(), Some(status), "{errors}");
        let summary = String::from_utf8_lossy(&output.stdout);
        assert_eq!(
            summary.starts_with("the motors lose "),
            is_lost,
            "{summary}"
        );
        run
    }

    pub(crate) fn read(folder: TempDir) -> Self {
        Self {
            report: report_in(folder.path()),
            folder,
            notes: Vec::new(),
        }
    }

    pub(crate) fn of_text(gcode: &str, options: &[&str]) -> Self {
        let folder = TempDir::new().unwrap();
        let file = folder.path().join("some.gcode");
        fs::write(&file, gcode).unwrap();
        Self::of(&[&["--gcode", file.to_str().unwrap()], options].concat())
    }

    pub(crate) fn number(&self, pointer: &str) -> f64 {
        number(&self.report, pointer)
    }

    /// Time in s, and the place after each step, in mm.
    pub(crate) fn path(&self) -> Vec<(f64, [f64; 2])> {
        let text = fs::read_to_string(self.folder.path().join("steps.csv")).unwrap();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("t_s,dx,dy"));
        let mut at = [0_i32; 2];
        lines
            .map(|line| {
                let cells: Vec<&str> = line.split(',').collect();
                for (at, cell) in at.iter_mut().zip(&cells[1..]) {
                    let step: i32 = cell.parse().unwrap();
                    assert!(step.abs() <= 1, "{line}");
                    *at += step;
                }
                (
                    cells[0].parse().unwrap(),
                    at.map(|n| f64::from(n) * STEP_MM),
                )
            })
            .collect()
    }
}
