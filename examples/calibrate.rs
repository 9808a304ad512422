//! The geometry of a machine from points where its tool was found: the command line of both arms'
//! calibrations.
//!
//! ```text
//! engraver:  shoulder,elbow,x_mm,y_mm        pulses from home, and the tool
//! delta:     a,b,c,x_mm,y_mm,z_mm           steps from home, and the platform's centre
//! ```
//!
//! The columns are read by their names; a comma, semicolon or tabulator is between them. What was
//! found is printed with its standard deviation, and what the points do not tell is named.
//!
//! `cargo run --release --example calibrate -- engraver|delta [--points FILE] [--machine FILE] [--fit WHAT] [--out DIR]`

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, ValueEnum};
use command_line::{Artefacts, print_summary, read};

const MACHINES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/machines");

/// Fits a machine file to measured points.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// The machine.
    kind: Kind,
    /// The points, as CSV; without it, those of an example.
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// The machine file, as machines/engraver/machine.toml and machines/delta/machine.toml.
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// What may change: homes, links (engraver), lower (Delta's lower arms), all.
    #[arg(long, default_value = "all")]
    fit: String,
    /// Where the machine file with what was found goes.
    #[arg(long, value_name = "DIR", default_value = "target/calibrate")]
    out: PathBuf,
}

#[derive(ValueEnum, Debug, Clone, Copy)]
enum Kind {
    Engraver,
    Delta,
}

fn main() -> ExitCode {
    command_line::run(calibrate)
}

fn calibrate(args: &Args) -> Result<ExitCode> {
    let folder = Path::new(MACHINES).join(match args.kind {
        Kind::Engraver => "engraver",
        Kind::Delta => "delta",
    });
    let or = |given: &Option<PathBuf>, name| given.clone().unwrap_or_else(|| folder.join(name));
    let machine = read(&or(&args.machine, "machine.toml"), |text| {
        Ok(text.to_owned())
    })?;
    let points = or(&args.points, "inputs/measured.csv");
    let (summary, file) = match args.kind {
        Kind::Engraver => {
            let found = read(&points, |points| {
                engraver::Machine::parse(&machine)?.calibrate(points, args.fit.parse()?)
            })?;
            (found.to_string(), found.machine_file(&machine)?)
        }
        Kind::Delta => {
            let found = read(&points, |points| {
                delta::Machine::parse(&machine)?.calibrate(points, args.fit.parse()?)
            })?;
            (found.to_string(), found.machine_file(&machine)?)
        }
    };
    let mut artefacts = Artefacts::new(&args.out)?;
    artefacts.write("machine.toml", file)?;
    let names = artefacts.keep()?;
    print_summary(format!("{summary}in {}: {names}\n", args.out.display()))?;
    Ok(ExitCode::SUCCESS)
}
