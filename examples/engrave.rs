//! A drawing becomes pulses on the glass engraver, and the pulses a drawing: the command line of
//! `machines/engraver`.
//!
//! ```text
//! SVG -> strokes -> joint waypoints -> pattern.bin
//!        pattern.bin -> records -> pulse trains -> simulated arm -> tool path
//! ```
//!
//! The second line reads nothing but the bytes of the first.
//!
//! `cargo run --release --example engrave -- [--svg FILE] [--controller pattern|timed] [--out DIR]`

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::Parser;
use command_line::{Artefacts, Progress, exit_code, print_notes, print_summary, read};
use engraver::{
    Drawing, Engraving, Machine, MotorController, Placement, Plan, PlanSettings, PulseLog,
    Tolerance,
};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/engraver");

/// Above it, `pulses.vcd` is written on demand only: 36 bytes a pulse make 18 MB.
const MAX_LOGGED_PULSES: u64 = 500_000;

/// Engraves an SVG drawing with a simulated two-link arm that gets nothing but the
/// pattern bytes.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// The drawing; text must be converted to paths.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("drawings/rosette.svg"))]
    svg: PathBuf,
    /// The machine, as in machines/engraver/machine.toml.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("machine.toml"))]
    machine: PathBuf,
    /// How far the planned path may be from the drawing, besides the motors' resolution.
    #[arg(
        long,
        value_name = "MM",
        default_value_t = 0.05,
        allow_negative_numbers = true
    )]
    tolerance: f64,
    /// Drawing to machine, `a,b,c,d,e,f`: x' = ax + cy + e, y' = bx + dy + f, in mm.
    /// Without it the drawing is fitted into the machine's bed.
    #[arg(long, value_name = "MATRIX", allow_hyphen_values = true)]
    placement: Option<Placement>,
    /// What drives the motors: the source's, by the `pattern` bytes, or one that runs cubics, the
    /// tool at its feed, `timed`; then the pattern is played too, and the report compares both.
    #[arg(long, default_value_t)]
    controller: MotorController,
    /// Engraves the strokes in the order and direction of the file; without it, the nearest next.
    #[arg(long)]
    keep_order: bool,
    /// Writes pulses.vcd whatever its size; without it, up to 500,000 pulses, which are 18 MB.
    #[arg(long)]
    vcd: bool,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/engrave")]
    out: PathBuf,
}

fn main() -> ExitCode {
    command_line::run(engrave)
}

/// Exit status 2 where the simulated tool left the drawing by more than the bound.
fn engrave(args: &Args) -> Result<ExitCode> {
    let settings = PlanSettings {
        tolerance: Tolerance::from_mm(args.tolerance).context("--tolerance")?,
        placement: args.placement,
        keep_order: args.keep_order,
    };
    let machine = read(&args.machine, Machine::parse)?;
    let drawing = read(&args.svg, Drawing::parse)?;

    let mut artefacts = Artefacts::new(&args.out)?;
    let plan = Progress::during("planning", |at| {
        Plan::new(&machine, &drawing, &settings, at)
    });
    let plan = plan.with_context(|| args.svg.display().to_string())?;
    artefacts.write("pattern.bin", plan.pattern())?;

    let is_logged = args.vcd || plan.pulses() <= MAX_LOGGED_PULSES;
    let vcd = artefacts.create_if(is_logged, "pulses.vcd")?;
    let mut pulses = vcd.map(|file| PulseLog::new(file, &machine)).transpose()?;
    let engraving = Progress::during("engraving", |at| {
        Engraving::run(
            &machine,
            &drawing,
            &settings,
            &plan,
            args.controller,
            &mut pulses,
            at,
        )
    });
    let engraving = engraving.with_context(|| args.svg.display().to_string())?;
    if let Some(pulses) = pulses {
        pulses.finish(engraving.shown().ticks())?;
    }
    artefacts.write("engraved.svg", engraving.shown().picture().to_string())?;
    let report = engraving.report(&machine, &drawing, &plan);
    artefacts.write_json("report.json", &report)?;
    let names = artefacts.keep()?;

    print_notes(&args.svg, drawing.notes());
    let name = args.svg.file_name().unwrap_or(args.svg.as_os_str());
    let mut summary = format!("{}: {report}", name.display());
    if !is_logged {
        let megabytes = plan.pulses() * 36 / 1_000_000;
        summary += &format!("pulses.vcd: some {megabytes} MB, written with --vcd only\n");
    }
    print_summary(format!("{summary}in {}: {names}\n", args.out.display()))?;
    Ok(exit_code(engraving.is_within_bound()))
}
