//! A Delta robot on the end of a serial line: points in, steps out, and the steps on a simulated
//! machine.
//!
//! ```text
//! x y z [feed] -> line -> joint waypoints -> pulse trains -> steps.csv
//!                 steps.csv -> simulated arms -> platform path
//! ```
//!
//! The second line reads nothing but the steps of the first. Lines are in mm and mm/s; each is
//! answered with `ok a b c`, the steps of the three motors from home, or `error: ...`, and then
//! the machine stays where it is, which is said, and the exit status is 1. `#` begins a comment,
//! `end` ends the input.
//!
//! `cargo run --release --example delta -- [--input FILE|-] [--geometry FILE] [--port PATH] [--out DIR]`

mod command;
mod drive;
mod input;
mod machine;
mod picture;
mod report;
mod session;
mod simulation;

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use clap::Parser;

use command_line::Artefacts;
use drive::seconds;
use input::Terminal;
use machine::Machine;
use machine_sim::input::Notes;
use report::{Report, Tick};
use session::{Outcome, Session};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/delta");

/// Moves a simulated Delta robot by lines of `x y z [feed]`.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// Lines in mm and mm/s; `-` for standard input.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("inputs/pick-and-place.txt"), conflicts_with = "port")]
    input: PathBuf,
    /// The machine, as in examples/delta/machine.toml.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("machine.toml"))]
    geometry: PathBuf,
    /// A serial port or pseudo-terminal that brings the lines and takes the answers.
    #[arg(long, value_name = "PATH")]
    port: Option<String>,
    /// Bits per second of the port.
    #[arg(long, default_value_t = 115_200, value_parser = clap::value_parser!(u32).range(1..))]
    baud: u32,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/delta")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let served = command_line::arguments().and_then(|args| run(&args));
    match served {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<()> {
    let machine = Machine::read(&args.geometry)?;
    let mut terminal = match &args.port {
        Some(port) => Terminal::port(port, args.baud)?,
        None => Terminal::file(&args.input)?,
    };
    let mut artefacts = Artefacts::new(&args.out)?;
    let mut session = Session::new(&machine)?;
    let served = serve(&mut session, &mut terminal, artefacts.create("steps.csv")?)?;
    let Session {
        asked, refusals, ..
    } = session;

    let steps = simulation::positions(artefacts.reopen("steps.csv")?);
    let outcome = simulation::run(&machine, &asked, steps)?;
    let ticks = drive::ticked(asked.iter().map(|asked| asked.answer));
    let mut tick_count = 0_u32;
    let ticks = ticks.inspect(|_| tick_count += 1);
    let ticks = core::iter::once([0; 3]).chain(ticks).map(Ok);
    let ticked = simulation::run(&machine, &asked, ticks)?;

    let report = Report {
        moves: asked.len(),
        refused: refusals.len(),
        refusals,
        notes: served.notes.lines(),
        max_path_error_mm: outcome.max_path_error_mm,
        duration_s: served.duration_s,
        steps: outcome.steps,
        rad_per_step: machine.rad_per_step,
        home_rad: machine.home_rad(),
        end: outcome.end,
        tick: Tick {
            tick_s: machine.tick_s,
            max_path_error_mm: ticked.max_path_error_mm,
            duration_s: f64::from(tick_count) * machine.tick_s,
        },
    };
    picture::write(artefacts.create("delta.svg")?, &machine, &outcome, &ticked)?;
    artefacts.write_json("report.json", &report)?;
    artefacts.keep()?;
    for note in &report.notes {
        eprintln!("note: {}: {note}", args.input.display());
    }
    let folder = args.out.display().to_string();
    report
        .write_summary(std::io::stdout().lock(), &folder)
        .context("standard output")?;
    report.check()
}

/// What came of the lines.
struct Served {
    notes: Notes,
    duration_s: f64,
}

/// Answers line after line and writes the steps of those that can be done.
fn serve(
    session: &mut Session<'_>,
    terminal: &mut Terminal,
    mut csv: impl Write,
) -> Result<Served> {
    writeln!(csv, "t_s,s1,s2,s3\n0.0000000,0,0,0")?;
    let (mut now, mut number) = (0, 0);
    let mut has_ended = false;
    let mut notes = Notes::default();
    while let Some(line) = terminal.line()? {
        number += 1;
        if has_ended {
            let line = line.unwrap_or_else(|error| error.to_string());
            if !command::is_empty(&line) {
                notes.add(number, format!("{line:?}"), "behind `end`, not done");
            }
            continue;
        }
        match session.line(
            number,
            line.as_deref().map_err(|error| anyhow!("{error:#}")),
        ) {
            Outcome::Nothing => {}
            Outcome::End if terminal.is_file() => has_ended = true,
            Outcome::End => break,
            Outcome::Refused(answer) => terminal.answer(&answer)?,
            Outcome::Move { from, plan } => {
                now = plan.run(from, now, |ticks, [a, b, c]| {
                    Ok(writeln!(csv, "{:.7},{a},{b},{c}", seconds(ticks))?)
                })?;
                let [a, b, c] = plan.end();
                terminal.answer(&format!("ok {a} {b} {c}"))?;
            }
        }
    }
    csv.flush()?;
    Ok(Served {
        notes,
        duration_s: seconds(now),
    })
}
