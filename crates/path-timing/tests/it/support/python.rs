//! Judges in Python.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// Whether `python3` has a module, which it must where an environment variable is set.
pub(crate) fn has(module: &str, required: &str) -> bool {
    let mut python = Command::new("python3");
    let status = python
        .args(["-c", &format!("import {module}")])
        .stderr(Stdio::null())
        .status();
    let has = status.is_ok_and(|status| status.success());
    let is_required = std::env::var_os(required).is_some();
    assert!(has || !is_required, "python3 has no {module}");
    has
}

/// What a script of the tests' folder answers to each line.
pub(crate) fn ask(script: &str, lines: &str) -> Vec<f64> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut python = Command::new("python3")
        .arg(folder.join(script))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = python.stdin.take().unwrap();
    stdin.write_all(lines.as_bytes()).unwrap();
    drop(stdin);
    let output = python.wait_with_output().unwrap();
    assert!(output.status.success());
    let output = String::from_utf8(output.stdout).unwrap();
    let answers: Vec<_> = output.lines().map(|line| line.parse().unwrap()).collect();
    assert_eq!(answers.len(), lines.lines().count());
    answers
}
