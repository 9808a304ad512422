//! Programs that refuse what they are given.

use std::process::Command;

use crate::tools::command::{lines, run};

/// Exit code 1, and on standard error this line alone.
pub(crate) fn assert_refused(command: &mut Command, line: &str) {
    let output = run(command, b"");
    assert_eq!(lines(&output.stderr), [line]);
    assert_eq!(output.status.code(), Some(1), "{line}");
}
