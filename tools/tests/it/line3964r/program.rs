//! Running the program.

use std::io::Write as _;
use std::process::{Command, Output, Stdio};

use serialport::{SerialPort as _, TTYPort};

/// `line3964r` with one of its subcommands.
pub(crate) fn program(subcommand: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_line3964r"));
    command.arg(subcommand);
    command
}

/// Runs a command to its end with `input` on its standard input.
pub(crate) fn run(command: &mut Command, input: &[u8]) -> Output {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that refuses its options does not read: the pipe is then closed.
    drop(child.stdin.take().unwrap().write_all(input));
    child.wait_with_output().unwrap()
}

/// The address of a pseudo-terminal's end that somebody else has made.
pub(crate) fn instant(end: &TTYPort) -> String {
    format!("{}?line=instant", end.name().unwrap())
}

pub(crate) fn lines(text: &[u8]) -> Vec<String> {
    let text = String::from_utf8(text.to_vec()).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Exit status 1, and on standard error this line alone.
pub(crate) fn assert_refused(command: &mut Command, line: &str) {
    let output = run(command, b"");
    assert_eq!(lines(&output.stderr), [line]);
    assert_eq!(output.status.code(), Some(1), "{line}");
}

/// Exit status 2, and on standard error this paragraph first, then how it is used.
pub(crate) fn assert_misused(command: &mut Command, paragraph: &str) {
    let output = run(command, b"");
    let errors = lines(&output.stderr);
    let first = errors.iter().map(|line| line.trim());
    let first: Vec<_> = first.take_while(|line| !line.is_empty()).collect();
    assert_eq!(first.join(" "), paragraph);
    assert!(errors.last().unwrap().contains("--help"), "{errors:?}");
    assert_eq!(output.status.code(), Some(2), "{paragraph}");
}
