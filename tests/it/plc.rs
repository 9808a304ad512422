//! The example `plc`: nothing is lost on a line that damages bytes.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::tools::artefacts::{assert_all_or_none, assert_refused, run_into};
use crate::tools::command::{lines, run};
use crate::tools::example::example;
use crate::tools::report::report_in;

const ROUNDS: u64 = 6;

/// A run's report.
fn plc(options: &[&str]) -> Value {
    let folder = TempDir::new().unwrap();
    let mut command = example("plc");
    command
        .args(["--rounds", &ROUNDS.to_string()])
        .args(options);
    let output = run(command.arg("--out").arg(folder.path()), b"");
    assert_eq!(lines(&output.stderr), [""; 0]);
    assert!(output.status.success());
    let log = fs::read_to_string(folder.path().join("line.log")).unwrap();
    assert!(log.contains(" > ") && log.contains(" < "));
    report_in(folder.path())
}

fn assert_whole(report: &Value) {
    for side in ["pc", "plc"] {
        assert_eq!(report[side]["done"], ROUNDS, "{report}");
        assert_eq!(report[side]["different"], 0, "{report}");
    }
    assert_eq!(report["memories_as_written"], true, "{report}");
}

#[test]
fn damaged_line() {
    for seed in ["1", "2", "3"] {
        let report = plc(&["--seed", seed]);
        assert_whole(&report);
        assert!(report["damaged_bytes"].as_u64().unwrap() > 0, "{report}");
    }
}

#[test]
fn clean_line() {
    let report = plc(&["--spacing", "0"]);
    assert_whole(&report);
    assert_eq!(report["damaged_bytes"], 0);
}

#[test]
fn wrong_options() {
    for (options, error) in [
        (
            ["--rounds", "0"],
            "invalid value '0' for '--rounds <ROUNDS>': 0 is not in 1..=60",
        ),
        (
            ["--spacing", "279"],
            "invalid value '279' for '--spacing <SPACING>': must be 0 or at least 280, so that no block is hit twice",
        ),
        (
            ["--spacing", "x"],
            "invalid value 'x' for '--spacing <SPACING>': invalid digit found in string",
        ),
        (
            ["--seed", ""],
            "invalid value '' for '--seed <SEED>': cannot parse integer from empty string",
        ),
    ] {
        assert_refused("plc", &options, &format!("error: {error}\n"));
    }
}

#[test]
fn unwritable_folder() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let output = run_into(&file, "plc", &[]);
    let line = format!("error: {}: File exists (os error 17)", file.display());
    assert_eq!(lines(&output.stderr), [line]);
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn a_folder_in_an_artefacts_place_is_refused_before_any_is_written() {
    assert_all_or_none("plc", &["--rounds", "1"], &["line.log", "report.json"]);
}
