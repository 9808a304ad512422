//! Two RK512 stations on pseudo-terminals: a PC and a PLC that write and read each other's data
//! blocks at the same time, over 3964R, through a line that damages bytes.
//!
//! ```text
//! plc [--out DIR] [--rounds N] [--spacing N] [--seed N]
//! ```
//! Of every `N` to `2 N` bytes of the line one is flipped, lost or doubled (`--spacing`, 300; 0 for
//! a clean line). Each side writes a data block, reads it back, compares, and repeats a job that
//! failed. Writes `line.log` (what each side received: time in s, `>` from the PC, `<` from the
//! PLC, bytes) and `report.json`.

#[cfg(unix)]
mod line;
#[cfg(unix)]
mod party;
#[cfg(unix)]
mod run;

use std::process::ExitCode;

#[cfg(unix)]
fn main() -> ExitCode {
    match command_line::arguments()
        .map_err(Into::into)
        .and_then(|options| run::run(&options))
    {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("plc: {error}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(not(unix))]
fn main() -> ExitCode {
    eprintln!("plc: pseudo-terminals need a Unix system");
    ExitCode::FAILURE
}
