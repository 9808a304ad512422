//! Reads the command line's options, and runs a program with them.

use core::fmt::Display;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context as _, Result, anyhow, ensure};
use clap::Parser;

/// The options, or one line that says what is wrong with them. `--help` prints and exits.
fn arguments<O: Parser>() -> Result<O> {
    O::try_parse().map_err(|error| {
        if error.use_stderr() {
            anyhow!(one_line(&error.to_string()))
        } else {
            error.exit()
        }
    })
}

/// Reads a fraction within 0..=1, as 0.001 or 0.1%: for clap's `value_parser`.
///
/// # Errors
/// It is no number, or outside of 0..=1.
pub fn fraction(text: &str) -> Result<f64> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let fraction = number.trim().parse::<f64>()? * unit;
    ensure!(
        (0.0..=1.0).contains(&fraction),
        "not a fraction within 0..=1"
    );
    Ok(fraction)
}

/// Runs a program with its options; an error is one line on standard error and exit status 1.
pub fn run<O: Parser>(program: impl FnOnce(&O) -> Result<ExitCode>) -> ExitCode {
    let ended = arguments().and_then(|options| program(&options));
    ended.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}

/// The exit status of a run that came to its end: 2 where its result is not as it should be.
#[must_use]
pub fn exit_code(is_good: bool) -> ExitCode {
    if is_good {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(2)
    }
}

/// Prints what a person wants to know first on standard output.
///
/// # Errors
/// Nobody reads it.
pub fn print_summary(summary: impl Display) -> Result<()> {
    let mut out = std::io::stdout().lock();
    write!(out, "{summary}")
        .and_then(|()| out.flush())
        .context("standard output")
}

/// Prints notes on an input file on standard error.
pub fn print_notes(file: &Path, notes: &[String]) {
    for note in notes {
        eprintln!("note: {}: {note}", file.display());
    }
}

/// The first paragraph of clap's message, without its `error: `.
fn one_line(message: &str) -> String {
    let paragraph: Vec<_> = message
        .lines()
        .map(str::trim)
        .take_while(|line| !line.is_empty())
        .collect();
    let line = paragraph.join(" ");
    line.strip_prefix("error: ").unwrap_or(&line).to_owned()
}
