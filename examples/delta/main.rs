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
//! the machine stays where it is. `#` begins a comment, `end` ends the input.
//!
//! `cargo run --release --example delta -- [--input FILE|-] [--geometry FILE] [--port PATH] [--out DIR]`

#[path = "../common/arguments.rs"]
mod arguments;
#[path = "../common/artefacts.rs"]
mod artefacts;
mod command;
mod drive;
mod input;
mod machine;
mod picture;
mod report;
#[path = "../common/settings.rs"]
mod settings;
mod simulation;

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use clap::Parser;
use nalgebra::Point3;

use artefacts::{Artefacts, write_json};
use command::Command;
use drive::{Plan, seconds};
use input::Terminal;
use machine::Machine;
use report::{Report, Tick};
use simulation::Asked;

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
    let served = arguments::read()
        .map_err(|error| anyhow!("{error}"))
        .and_then(|args| run(&args));
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
    let served = serve(&machine, &mut terminal, artefacts.create("steps.csv")?)?;

    let steps = simulation::positions(artefacts.reopen("steps.csv")?);
    let outcome = simulation::run(&machine, &served.asked, steps)?;
    let ticks = drive::ticked(served.asked.iter().map(|asked| asked.answer));
    let mut tick_count = 0_u32;
    let ticks = ticks.inspect(|_| tick_count += 1);
    let ticks = core::iter::once([0; 3]).chain(ticks).map(Ok);
    let ticked = simulation::run(&machine, &served.asked, ticks)?;

    let report = Report {
        moves: served.asked.len(),
        refused: served.refused,
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
    write_json(artefacts.create("report.json")?, &report)?;
    artefacts.keep()?;
    let folder = args.out.display().to_string();
    report
        .write_summary(std::io::stdout().lock(), &folder)
        .context("standard output")
}

/// What came of the lines.
struct Served {
    asked: Vec<Asked>,
    refused: usize,
    duration_s: f64,
}

/// Answers line after line and writes the steps of those that can be done.
fn serve(machine: &Machine, terminal: &mut Terminal, mut csv: impl Write) -> Result<Served> {
    writeln!(csv, "t_s,s1,s2,s3\n0.0000000,0,0,0")?;
    let mut served = Served {
        asked: Vec::new(),
        refused: 0,
        duration_s: 0.0,
    };
    let (mut position, mut now) = ([0; 3], 0);
    let mut place = machine.point(position)?;
    let mut number = 0_usize;
    while let Some(line) = terminal.line()? {
        number += 1;
        let planned = match line.and_then(|line| command::parse(&line)) {
            Ok(None) => continue,
            Ok(Some(Command::End)) => break,
            Ok(Some(Command::Move { to, feed_mm_s })) => {
                plan(machine, (place, position), to, feed_mm_s)
            }
            Err(error) => Err(error),
        };
        let (plan, to, answer) = match planned {
            Ok(planned) => planned,
            Err(error) => {
                served.refused += 1;
                terminal.answer(&format!("error: line {number}: {error:#}"))?;
                continue;
            }
        };
        now = plan.run(position, now, |ticks, [a, b, c]| {
            Ok(writeln!(csv, "{:.7},{a},{b},{c}", seconds(ticks))?)
        })?;
        let [a, b, c] = answer;
        served.asked.push(Asked {
            from: place,
            to,
            answer,
        });
        (position, place) = (answer, to);
        terminal.answer(&format!("ok {a} {b} {c}"))?;
    }
    csv.flush()?;
    served.duration_s = seconds(now);
    Ok(served)
}

/// The move to a point, and the steps at which it ends.
fn plan(
    machine: &Machine,
    from: (Point3<f64>, [i32; 3]),
    to: Point3<f64>,
    feed_mm_s: Option<f64>,
) -> Result<(Plan, Point3<f64>, [i32; 3])> {
    let place = || format!("{} {} {}", to.x, to.y, to.z);
    let feed = feed_mm_s.unwrap_or(machine.feed_mm_s);
    let plan = Plan::new(machine, from, to, feed).with_context(place)?;
    let answer = plan.end();
    Ok((plan, to, answer))
}
