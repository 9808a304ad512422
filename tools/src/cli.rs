//! The command line.

mod input;
mod monitor;
mod probe;
mod simulate;
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
    Probe(probe::Options),
    Simulate(simulate::Options),
    #[cfg(feature = "gateway")]
    Gateway(crate::gateway::Options),
}

/// Runs what the arguments of this process ask for.
#[must_use]
pub fn main() -> ExitCode {
    let ended = match Options::parse().program {
        Program::Station(options) => station::run(&options),
        Program::Monitor(options) => monitor::run(&options),
        Program::Probe(options) => probe::run(&options),
        Program::Simulate(options) => simulate::run(&options),
        #[cfg(feature = "gateway")]
        Program::Gateway(options) => crate::gateway::run(&options),
    };
    ended.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}
