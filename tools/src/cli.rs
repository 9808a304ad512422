//! The command line.

mod monitor;
mod serial;
mod station;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Brings up a Siemens 3964 or 3964R line.
#[derive(Parser)]
#[command(version)]
struct Options {
    #[command(subcommand)]
    program: Program,
}

#[derive(Subcommand)]
enum Program {
    Station(station::Options),
    Monitor(monitor::Options),
}

/// Runs what the arguments of this process ask for.
#[must_use]
pub fn main() -> ExitCode {
    let ended = match Options::parse().program {
        Program::Station(options) => station::run(&options),
        Program::Monitor(options) => monitor::run(&options),
    };
    ended.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}
