//! The command line.

mod input;
mod monitor;
mod probe;
pub(crate) mod settings;
mod simulate;
mod station;

use core::future::Future;
use std::process::ExitCode;

use anyhow::{Context as _, Result};
use clap::{Parser, Subcommand};
use tokio::signal::ctrl_c;

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

/// Runs a program on this thread.
pub(crate) fn block_on<T>(program: impl Future<Output = Result<T>>) -> Result<T> {
    let mut runtime = tokio::runtime::Builder::new_current_thread();
    let runtime = runtime.enable_all().build();
    runtime
        .context("the asynchronous runtime")?
        .block_on(program)
}

/// Returns when the program is to end: Ctrl-C, or SIGTERM on Unix.
pub(crate) async fn interrupted() -> Result<()> {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        let mut terminated = signal(SignalKind::terminate()).context("SIGTERM")?;
        tokio::select! {
            pressed = ctrl_c() => pressed.context("Ctrl-C"),
            _ = terminated.recv() => Ok(()),
        }
    }
    #[cfg(not(unix))]
    ctrl_c().await.context("Ctrl-C")
}
