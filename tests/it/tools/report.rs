//! What a run reports.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// The report in a folder of artefacts.
pub(crate) fn report_in(folder: &Path) -> Value {
    let text = fs::read(folder.join("report.json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

/// A number of it, by its JSON pointer.
pub(crate) fn number(report: &Value, pointer: &str) -> f64 {
    let value = report.pointer(pointer).and_then(Value::as_f64);
    value.unwrap_or_else(|| panic!("{pointer}"))
}

/// What notes on standard error say, from the line on that they name.
pub(crate) fn without_file(notes: &[String]) -> Vec<String> {
    let behind_file = |note: &String| {
        let (file, note) = note.split_once(": line ").unwrap();
        assert!(file.starts_with("note: "), "{file}");
        format!("line {note}")
    };
    notes.iter().map(behind_file).collect()
}
