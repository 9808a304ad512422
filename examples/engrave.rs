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
//! `cargo run --release --example engrave -- [--svg FILE] [--machine FILE] [--tolerance MM]
//! [--controller pattern|timed] [--out DIR]`

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use command_line::{Artefacts, Progress, print_notes, print_summary, read};
use engraver::{
    Drawing, Machine, Placement, Plan, PlanSettings, PulseLog, Report, Run, TimedPlan, Tolerance,
    Wires, simulate, simulate_timed,
};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/engraver");

/// Above it, `pulses.vcd` is written on demand only: 36 bytes a pulse make 18 MB.
const MAX_LOGGED_PULSES: u64 = 500_000;

/// What drives the motors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ControllerKind {
    /// The source's, which gets nothing but the pattern bytes.
    Pattern,
    /// One that runs the joints' cubics: the tool at its feed wherever joints and disc allow.
    Timed,
}

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
    /// What drives the motors; with `timed` the pattern is played too, and the report compares both.
    #[arg(long, value_enum, default_value_t = ControllerKind::Pattern)]
    controller: ControllerKind,
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

/// Runs the whole chain; exit status 2 where the simulated tool left the drawing by more than the
/// bound.
fn engrave(args: &Args) -> Result<ExitCode> {
    let settings = PlanSettings {
        tolerance: Tolerance::from_mm(args.tolerance).context("--tolerance")?,
        placement: args.placement,
        keep_order: args.keep_order,
    };
    let machine = read(&args.machine, Machine::parse)?;
    let drawing = read(&args.svg, Drawing::parse)?;

    let mut artefacts = Artefacts::new(&args.out)?;
    let progress = Progress::new("planning");
    let plan = Plan::new(&machine, &drawing, &settings, |done, all| {
        progress.at(done, all);
    });
    drop(progress);
    let plan = plan.with_context(|| args.svg.display().to_string())?;
    artefacts.write("pattern.bin", plan.pattern())?;

    let is_logged = args.vcd || plan.pulses() <= MAX_LOGGED_PULSES;
    let mut pulses = None;
    if is_logged {
        pulses = Some(PulseLog::new(artefacts.create("pulses.vcd")?, &machine)?);
    } else {
        artefacts.leave_out("pulses.vcd");
    }
    let is_timed = args.controller == ControllerKind::Timed;
    let progress = Progress::new("engraving");
    let (pattern, reference) = (plan.pattern(), plan.reference());
    let mut of_pattern = pulses.take_if(|_| !is_timed);
    let run = simulate(
        &machine,
        pattern,
        reference,
        &mut of_pattern,
        |done, all| {
            progress.at(done, all);
        },
    )?;
    drop(progress);
    let timed = match is_timed {
        true => Some(engrave_timed(
            args,
            &machine,
            &drawing,
            &settings,
            &mut pulses,
        )?),
        false => None,
    };
    let shown = timed.as_ref().unwrap_or(&run);
    if let Some(pulses) = pulses.or(of_pattern) {
        pulses.finish(shown.ticks())?;
    }
    artefacts.write("engraved.svg", shown.picture().to_string())?;
    let mut report = Report::new(&machine, &drawing, &plan, &run);
    if let Some(timed) = &timed {
        report = report.with_timed(timed);
    }
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
    let is_timed_kept = timed.as_ref().is_none_or(Run::is_within_bound);
    Ok(match run.is_within_bound() && is_timed_kept {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(2),
    })
}

/// Plans and plays timed strokes.
fn engrave_timed(
    args: &Args,
    machine: &Machine,
    drawing: &Drawing,
    settings: &PlanSettings,
    pulses: &mut impl Wires,
) -> Result<Run> {
    let progress = Progress::new("timing");
    let plan = TimedPlan::new(machine, drawing, settings, |done, all| {
        progress.at(done, all);
    });
    let plan = plan.with_context(|| args.svg.display().to_string())?;
    let run = simulate_timed(machine, &plan, pulses, |_, _| ())?;
    drop(progress);
    Ok(run)
}
