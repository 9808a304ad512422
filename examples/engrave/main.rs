//! A drawing becomes pulses on the glass engraver, and the pulses a drawing.
//!
//! ```text
//! SVG -> strokes -> joint waypoints -> pattern.bin
//!        pattern.bin -> records -> pulse trains -> simulated arm -> tool path
//! ```
//!
//! The second line reads nothing but the bytes of the first.
//!
//! `cargo run --release --example engrave -- [--svg FILE] [--machine FILE] [--tolerance MM] [--out DIR]`

#[path = "../common/arguments.rs"]
mod arguments;
#[path = "../common/artefacts.rs"]
mod artefacts;
mod drawing;
mod elements;
mod gauge;
mod left_out;
mod machine;
#[path = "../common/notes.rs"]
mod notes;
mod pace;
mod picture;
mod plan;
mod playback;
mod progress;
mod pulses;
mod report;
#[path = "../common/settings.rs"]
mod settings;
mod simulation;
mod unreadable;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow, ensure};
use clap::Parser;
use kurbo::Affine;

use artefacts::{Artefacts, write_json};
use drawing::Drawing;
use machine::Machine;
use simulation::Simulation;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/engrave");

/// A thousandth of what fine mechanics hold; the work grows without end below it.
const LEAST_TOLERANCE_MM: f64 = 1e-6;

/// Engraves an SVG drawing with a simulated two-link arm that gets nothing but the
/// pattern bytes.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// The drawing; text must be converted to paths.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("drawings/rosette.svg"))]
    svg: PathBuf,
    /// The machine, as in examples/engrave/machine.toml.
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
    #[arg(long, value_name = "MATRIX", value_parser = placement, allow_hyphen_values = true)]
    placement: Option<Affine>,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/engrave")]
    out: PathBuf,
}

fn placement(text: &str) -> Result<Affine> {
    let numbers = text
        .split(',')
        .map(|number| {
            number
                .trim()
                .parse::<f64>()
                .with_context(|| format!("{number:?}"))
        })
        .collect::<Result<Vec<_>>>()?;
    let count = numbers.len();
    let numbers: [f64; 6] = numbers
        .try_into()
        .map_err(|_| anyhow!("{count} numbers, six are needed"))?;
    let affine = Affine::new(numbers);
    ensure!(affine.is_finite(), "a number is not finite");
    ensure!(affine.determinant() != 0.0, "the matrix has no area");
    Ok(affine)
}

fn main() -> ExitCode {
    let engraved = arguments::read()
        .map_err(|error| anyhow!("{error}"))
        .and_then(|args| engrave(&args));
    match engraved {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(2),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the whole chain; false where the simulated tool left the drawing by more than
/// the bound.
fn engrave(args: &Args) -> Result<bool> {
    ensure!(
        args.tolerance.is_finite() && args.tolerance > 0.0,
        "--tolerance: {} is not above 0 mm",
        args.tolerance
    );
    ensure!(
        args.tolerance >= LEAST_TOLERANCE_MM,
        "--tolerance: {:e} is below {LEAST_TOLERANCE_MM:e} mm",
        args.tolerance
    );
    let machine = Machine::read(&args.machine)?;
    let drawing = Drawing::read(&args.svg)?;
    let placement = match args.placement {
        Some(placement) => placement,
        None => machine.bed.fit(drawing.bounds()),
    };

    let mut artefacts = Artefacts::new(&args.out)?;
    let plan = plan::write_pattern(
        &machine,
        &drawing,
        placement,
        args.tolerance,
        artefacts.create("pattern.bin")?,
    )
    .with_context(|| args.svg.display().to_string())?;

    let outlines = drawing.placed(placement);
    let mut simulation = Simulation::new(&machine, &outlines, &plan, &mut artefacts)?;
    playback::play(&machine, artefacts.reopen("pattern.bin")?, &mut simulation)?;
    let outcome = simulation.finish()?;

    let report = report::Report::new(&machine, &drawing, &plan, &outcome, placement);
    write_json(artefacts.create("report.json")?, &report)?;
    artefacts.keep()?;
    for note in drawing.notes() {
        eprintln!("note: {}: {note}", args.svg.display());
    }
    report
        .write_summary(std::io::stdout().lock(), &args.svg, &args.out)
        .context("standard output")?;
    Ok(report.is_within_bound())
}
