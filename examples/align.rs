//! A hand-held pendant moves a body on three-axis locators: the command line of
//! `machines/platform`.
//!
//! ```text
//! operator -> pendant -> 3964R on a pseudo-terminal -> driver -> panel -> jogs, pose change
//!             pendant <- 3964R <- display blocks, LEDs <---------------+
//!             pose change -> PVT or PT table -> locators, each axis for itself
//! ```
//!
//! The locators get nothing but the table. Time is counted, not waited for: bytes take as long
//! as at 9600 bit/s, and the same arguments give the same files.
//!
//! `cargo run --release --example align -- [--platform FILE] [--from POSE] [--to POSE] [--mode pvt|pt] [--out DIR]`

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, ValueEnum};
use command_line::{Artefacts, PseudoTerminal, exit_code, print_summary, read};
use platform::{Alignment, Machine, Pose, Side, parse_pose};

const PLATFORM: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/machines/platform/platform.toml"
);

/// Aligns a body on simulated three-axis locators with a simulated EUCHNER hand-held pendant.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// The platform, as in machines/platform/platform.toml.
    #[arg(long, value_name = "FILE", default_value = PLATFORM)]
    platform: PathBuf,
    /// Where the body is, `x y z alpha beta gamma` in mm and degrees; else as in the platform file.
    #[arg(long, value_name = "POSE", value_parser = parse_pose, allow_hyphen_values = true)]
    from: Option<Pose>,
    /// Where it goes, likewise.
    #[arg(long, value_name = "POSE", value_parser = parse_pose, allow_hyphen_values = true)]
    to: Option<Pose>,
    /// Position-velocity-time table, or position-time.
    #[arg(long, value_enum, default_value_t = Mode::Pvt)]
    mode: Mode,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/align")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Mode {
    /// Positions: the axes move linearly between two points. Speeds are kept, accelerations and
    /// jerks are not.
    Pt,
    /// Positions and velocities: the axes run cubics within speed, acceleration and jerk.
    Pvt,
}

fn main() -> ExitCode {
    command_line::run(align)
}

fn align(args: &Args) -> Result<ExitCode> {
    let machine = read(&args.platform, Machine::parse)?;
    let mode = match args.mode {
        Mode::Pt => platform::Mode::Pt,
        Mode::Pvt => platform::Mode::Pvt,
    };
    let (from, to) = (args.from, args.to);
    let alignment = Alignment { from, to, mode };
    let mut terminal = PseudoTerminal::open()?;
    let mut wire = |side, byte| terminal.carry(side == Side::Control, byte);
    let run = platform::run(&machine, &alignment, &mut wire)?;
    if let Some(note) = run.note() {
        eprintln!("note: {note}");
    }
    let mut artefacts = Artefacts::new(&args.out)?;
    artefacts.write("line.log", run.line_log())?;
    artefacts.write(mode.file(), run.table())?;
    artefacts.write("jog.svg", run.jog_picture().to_string())?;
    artefacts.write("align.svg", run.align_picture().to_string())?;
    artefacts.write_json("report.json", run.report())?;
    let names = artefacts.keep()?;
    print_summary(format!(
        "{}in {}: {names}\n",
        run.report(),
        args.out.display()
    ))?;
    Ok(exit_code(run.report().is_within_bounds()))
}
