//! A score becomes the frames of the dancing robot, and the frames its steps: the command line of
//! `machines/dancer`.
//!
//! ```text
//! score -> frames -> data.h
//!          data.h -> frames -> accumulators -> phases -> bus -> latches -> motors -> dance.svg
//! ```
//!
//! The second line reads nothing but the header of the first, and the motors nothing but their
//! latches.
//!
//! `cargo run --release --example dance -- [--score FILE] [--law LAW] [--out DIR]`

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context as _, Result};
use clap::Parser;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser as _};
use command_line::{Artefacts, Progress, exit_code, print_summary, read};
use dancer::{Law, MOTORS, Report, Score, picture, simulate};
use pose2pulse::pattern_codec::dance::Data;

const SCORE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/dancer/score.toml");

/// Dances a score with a simulated robot that gets nothing but the C header of its firmware.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// The score, as in machines/dancer/score.toml.
    #[arg(long, value_name = "FILE", default_value = SCORE)]
    score: PathBuf,
    /// What the firmware does with an accumulator at its threshold: reset it, carry the rest, or
    /// carry it with its sign.
    #[arg(long, default_value = "reset", value_parser = laws().try_map(|law| law.parse::<Law>()))]
    law: Law,
    /// Bytes of the firmware's code, which share the program memory with the frames; those of the
    /// largest build of firmware/mcs51/dance.c unless given.
    #[arg(long, value_name = "N", default_value_t = 589)]
    code_bytes: u64,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/dance")]
    out: PathBuf,
}

fn laws() -> PossibleValuesParser {
    let law = |law: Law, help| PossibleValue::new(law.name()).help(help);
    PossibleValuesParser::new([
        law(
            Law::Reset,
            "Back to 0, as in the source: the overshoot is lost",
        ),
        law(Law::CarryMagnitude, "The overshoot is kept"),
        law(Law::CarrySigned, "The overshoot is kept with its sign"),
    ])
}

fn main() -> ExitCode {
    command_line::run(dance)
}

/// Runs the whole chain; exit status 2 where a simulated motor ends a turn more than a half step
/// away.
fn dance(args: &Args) -> Result<ExitCode> {
    let place = || args.score.display().to_string();
    let score: Score = read(&args.score, |text| Ok(text.parse()?))?;
    let dance = score.compile(args.law).with_context(place)?;

    let mut artefacts = Artefacts::new(&args.out)?;
    let header = dancer::header(&score, &dance).with_context(place)?;
    artefacts.write("data.h", &header)?;
    let data = Data::<MOTORS>::read(&header).context("data.h")?;

    let vcd = artefacts.create("dance.vcd")?;
    let run = Progress::during("dancing", |at| simulate(&data, args.law, vcd, at))?;

    let report = Report::new(&score, &dance, &data, &run, args.code_bytes);
    artefacts.write("dance.svg", picture(&score, &run).to_string())?;
    artefacts.write_json("report.json", &report)?;
    let names = artefacts.keep()?;
    let name = args.score.file_name().unwrap_or(args.score.as_os_str());
    let (name, out) = (name.display(), args.out.display());
    print_summary(format!("{name}: {report}in {out}: {names}\n"))?;
    Ok(exit_code(report.is_as_asked()))
}
