//! G-code becomes step pulses for a two-axis stage, with the loop closed over its scales.
//!
//! ```text
//! G-code -> lines and arcs in mm -> steps -> pulses -> simulated motors, which may lose some
//!                                     ^                              |
//!                                     +------- corrections <--- linear scales
//! ```
//! The simulated stage gets nothing but the pulses. Beside it runs one without corrections.
//!
//! `cargo run --release --example stage -- [--gcode FILE | --port TTY] [--rule RULE] [--lose-steps P] [--seed N] [--out DIR]`

mod arc;
mod block;
mod codes;
mod console;
mod controller;
mod geometry;
mod interpreter;
mod picture;
mod plan;
mod program;
mod report;
mod simulation;
mod words;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use clap::Parser;

use command_line::Artefacts;
use controller::Controller;
use plan::PathRule;
use program::Program;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/stage");

/// Moves a simulated two-axis stage along G-code.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// The drawing: G0 G1 G2 G3 with I J or R, G20 G21 G90 G91 G90.1 G91.1, F, M2 M30. What else
    /// moves neither X nor Y is passed over with a note, what would is refused.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("drawings/test.gcode"))]
    gcode: PathBuf,
    /// Takes lines from this terminal instead, and answers each; `?` reports the position, the
    /// keys < > v ^ jog by a millimetre, M2 ends.
    #[arg(long, value_name = "TTY", conflicts_with = "gcode")]
    port: Option<String>,
    /// Which axis steps next.
    #[arg(long, value_enum, default_value_t = PathRule::Centred)]
    rule: PathRule,
    /// The share of steps that the motors lose, as 0.001 or 0.1%.
    #[arg(long, value_name = "P", default_value = "0", value_parser = share, allow_negative_numbers = true)]
    lose_steps: f64,
    /// Which steps are lost.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/stage")]
    out: PathBuf,
}

fn share(text: &str) -> Result<f64> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let share = number.trim().parse::<f64>()? * unit;
    ensure!((0.0..=1.0).contains(&share), "not a share within 0..=1");
    Ok(share)
}

fn main() -> ExitCode {
    let run = || -> Result<()> {
        let args: Args = command_line::arguments()?;
        stage(&args)
    };
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn stage(args: &Args) -> Result<()> {
    let program = match args.port {
        Some(_) => Program::default(),
        // All of it is checked before anything moves.
        None => read(&args.gcode)?,
    };
    let mut artefacts = Artefacts::new(&args.out)?;
    let steps = artefacts.create("steps.csv")?;
    let mut controller = Controller::homed(args.lose_steps, args.seed, args.rule, steps)?;
    let notes = match &args.port {
        Some(port) => console::serve(port, &mut controller).with_context(|| port.clone())?,
        None => {
            for line in &program.lines {
                let place = || format!("{}: line {}", args.gcode.display(), line.number);
                controller.run(&line.motion).with_context(place)?;
            }
            let notes = program.notes.lines();
            for note in &notes {
                eprintln!("note: {}: {note}", args.gcode.display());
            }
            notes
        }
    };
    let run = controller.finish(notes)?;
    picture::write(artefacts.create("stage.svg")?, &run)?;
    artefacts.write_json("report.json", &run.report)?;
    artefacts.keep()?;
    report::summary(std::io::stdout().lock(), &run.report, &args.out).context("standard output")
}

fn read(file: &Path) -> Result<Program> {
    let place = || file.display().to_string();
    let bytes = fs::read(file).with_context(place)?;
    // Where bytes are no text, in a comment of an old program, nothing is lost.
    let program = program::read(&String::from_utf8_lossy(&bytes)).with_context(place)?;
    if program.lines.is_empty() {
        let why: Vec<_> = [place(), "nothing moves".to_owned()].into();
        bail!("{}", [why, program.notes.lines()].concat().join(": "));
    }
    Ok(program)
}
