//! Frequency and damping of a machine from an accelerometer's log, and the input shaper that fits
//! them: the command line of `machines/commissioning`.
//!
//! ```text
//! #time,accel_x,accel_y,accel_z -> modes of a column -> shapers, the best first
//! ```
//!
//! The log is of a move's end: from where the commanded move has ended, some half a second of
//! ringing.
//!
//! `cargo run --release --example resonance -- [--log FILE] [--column NAME] [--from S] [--to S] [--acceleration MM_S2] [--out DIR]`

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::Parser;
use command_line::{Artefacts, print_summary, read};
use commissioning::{Choice, RingDown, picture};

/// Finds in what modes a machine rings, and the input shaper that fits them.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// CSV with a column `time` in s, and accelerations in mm/s².
    #[arg(long, value_name = "FILE", default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/commissioning/inputs/ring-down.csv"))]
    log: PathBuf,
    /// The column of the log: an axis of the machine.
    #[arg(long, value_name = "NAME", default_value = "accel_x")]
    column: String,
    /// Where the commanded move has ended, in s after the first reading.
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    from: f64,
    /// Where readings are not looked at any more.
    #[arg(long, value_name = "S", default_value_t = f64::INFINITY)]
    to: f64,
    /// Of the tool, at which the departure of shaped moves is told.
    #[arg(long, value_name = "MM_S2", default_value_t = 5000.0)]
    acceleration: f64,
    /// Where the figure goes.
    #[arg(long, value_name = "DIR", default_value = "target/resonance")]
    out: PathBuf,
}

fn main() -> ExitCode {
    command_line::run(resonance)
}

fn resonance(args: &Args) -> Result<ExitCode> {
    let ring_down = read(&args.log, |text| {
        RingDown::parse(text, &args.column, args.from..args.to)
    })?;
    let modes = ring_down.modes().with_context(|| args.column.clone())?;
    let choices = Choice::all(&modes, args.acceleration)?;
    let mut artefacts = Artefacts::new(&args.out)?;
    let figure = picture(&ring_down, &modes, &choices)?;
    artefacts.write("resonance.svg", figure.to_string())?;
    let modes = modes.iter().map(ToString::to_string);
    let lines = modes.chain(choices.iter().map(ToString::to_string));
    let summary: String = lines.map(|line| line + "\n").collect();
    let names = artefacts.keep()?;
    print_summary(format!("{summary}in {}: {names}\n", args.out.display()))?;
    Ok(ExitCode::SUCCESS)
}
