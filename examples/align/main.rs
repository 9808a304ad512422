//! A hand-held unit moves a body on three-axis locators.
//!
//! ```text
//! operator -> unit -> 3964R on a pseudo-terminal -> driver -> panel -> jogs, pose change
//!             unit <- 3964R <- display blocks, lamps   <-----+
//!             pose change -> PT or PVT table -> locators, each axis for itself
//! ```
//!
//! The locators read nothing but the table. Time is counted, not waited for: bytes take as long
//! as at 9600 bit/s, and the same arguments give the same files.
//!
//! `cargo run --release --example align -- [--platform FILE] [--from POSE] [--to POSE] [--mode pt|pvt] [--out DIR]`

extern crate alloc;

#[cfg(unix)]
mod chart;
#[cfg(unix)]
mod drives;
#[cfg(unix)]
mod line;
#[cfg(unix)]
mod operator;
#[cfg(unix)]
mod picture;
#[cfg(unix)]
mod platform;
#[cfg(unix)]
mod report;
#[cfg(unix)]
mod run;
#[cfg(unix)]
mod table;
#[cfg(unix)]
mod unit;
#[cfg(unix)]
mod workstation;
#[cfg(unix)]
mod world;

use std::process::ExitCode;

#[cfg(unix)]
fn main() -> ExitCode {
    let arguments = command_line::arguments();
    match arguments.and_then(|arguments| run::run(&arguments)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(2),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(not(unix))]
fn main() -> ExitCode {
    eprintln!("error: pseudo-terminals need a Unix system");
    ExitCode::FAILURE
}
