//! A Delta robot on the end of a serial line, points in, steps out, and the steps on a simulated
//! machine: the command line of `machines/delta`.
//!
//! ```text
//! x y z [feed] -> lines, rounded corners -> PVT rows -> steps.csv
//!                 steps.csv -> simulated arms -> path of the platform
//! ```
//!
//! The second line reads nothing but the steps of the first. Lines are in mm and mm/s; each is
//! answered with `ok a b c`, the steps of the three motors from home, or `error: ...`, and then
//! the machine stays where it is, which is said, and the exit status is 1. A file is looked at as a
//! whole before anything moves: with a line that is refused nothing does, unless `--skip` leaves it
//! out. `#` begins a comment, `end` ends the input.
//!
//! `cargo run --release --example delta -- [--input FILE|-] [--geometry FILE] [--motion MOTION] [--skip] [--port PATH] [--out DIR]`

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::Parser;
use command_line::{Artefacts, Terminal, print_notes, print_summary, read, read_bytes};
use delta::{Machine, Motion, Record, Session, StepLog, simulate};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/delta");

/// Moves a simulated Delta robot by lines of `x y z [feed]`.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// Lines in mm and mm/s; `-` for standard input.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("inputs/pick-and-place.txt"), conflicts_with = "port")]
    input: PathBuf,
    /// The machine, as in machines/delta/machine.toml.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("machine.toml"))]
    geometry: PathBuf,
    /// How it goes along the lines: `rounded` corners from rest to rest within the limits of all
    /// motors, or `trains`, each line at its feed from the first step to the last.
    #[arg(long, default_value_t)]
    motion: Motion,
    /// A serial port or pseudo-terminal that brings the lines and takes the answers.
    #[arg(long, value_name = "PATH")]
    port: Option<String>,
    /// Leaves out the lines of a file that are refused, in place of not moving at all.
    #[arg(long, conflicts_with = "port")]
    skip: bool,
    /// Bits per second of the port.
    #[arg(long, default_value_t = 115_200, value_parser = clap::value_parser!(u32).range(1..))]
    baud: u32,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/delta")]
    out: PathBuf,
}

fn main() -> ExitCode {
    command_line::run(run)
}

fn run(args: &Args) -> Result<ExitCode> {
    let machine = read(&args.geometry, Machine::parse)?;
    let terminal = match &args.port {
        Some(port) => Terminal::open_port(port, args.baud)?,
        None => Terminal::open_file(&args.input)?,
    };
    if terminal.is_file() && !args.skip {
        let lines = read_bytes(&args.input)?;
        delta::check(&machine, args.motion, &lines).with_context(|| {
            format!(
                "{} (--skip leaves out what is refused)",
                args.input.display()
            )
        })?;
    }
    let mut artefacts = Artefacts::new(&args.out)?;
    let record = serve(
        terminal,
        (&machine, args.motion),
        artefacts.create("steps.csv")?,
    )?;
    let run = simulate(&machine, &record, artefacts.reopen("steps.csv")?)?;
    artefacts.write("delta.svg", run.picture()?.to_string())?;
    let report = run.report();
    artefacts.write_json("report.json", &report)?;
    let names = artefacts.keep()?;
    print_notes(&args.input, &record.notes());
    print_summary(format!("{report}in {}: {names}\n", args.out.display()))?;
    report.check().map(|()| ExitCode::SUCCESS)
}

/// Answers line after line and writes the steps of those that can be done.
fn serve(
    mut terminal: Terminal,
    (machine, motion): (&Machine, Motion),
    csv: impl Write,
) -> Result<Record> {
    let mut log = StepLog::new(csv)?;
    let mut observer = |ticks, steps| log.step(ticks, steps);
    let mut session = Session::new(machine, motion, &mut observer)?;
    // In a file, what comes after the end is noted.
    while !session.is_over() || terminal.is_file() {
        let byte = terminal.read_byte()?;
        let answer = match byte {
            Some(byte) => session.handle_byte(byte)?,
            None => session.handle_end()?,
        };
        if let Some(answer) = answer {
            terminal.answer(&answer)?;
        }
        if byte.is_none() {
            break;
        }
    }
    let record = session.finish()?;
    log.finish()?;
    Ok(record)
}
