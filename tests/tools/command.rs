//! Running a command.

use std::io::Write as _;
use std::process::{Command, Output, Stdio};

/// Runs a command to its end with `input` on its standard input.
pub(crate) fn run(command: &mut Command, input: &[u8]) -> Output {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A tool that refuses its options does not read: the pipe is then closed.
    drop(child.stdin.take().unwrap().write_all(input));
    child.wait_with_output().unwrap()
}

pub(crate) fn lines(text: &[u8]) -> Vec<String> {
    let text = String::from_utf8(text.to_vec()).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Exit code 1, and on standard error this line alone.
pub(crate) fn assert_refused(command: &mut Command, line: &str) {
    let output = run(command, b"");
    assert_eq!(lines(&output.stderr), [line]);
    assert_eq!(output.status.code(), Some(1), "{line}");
}
