//! A score becomes the frames of the dancing robot, and the frames its steps.
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

mod law;
mod picture;
mod report;
mod simulation;
mod waves;

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context as _, Result};
use clap::Parser;
use pose2pulse::pattern_codec::dance::{Choreography, Data, DataHeader, Score, Sizes};

use command_line::Artefacts;
use law::Law;
use report::Report;
use simulation::{Firmware, simulate};
use waves::Waves;

/// Motors of the robot: one latch and one byte of the frame each.
const MOTORS: usize = 8;

const SCORE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/dance/score.toml");

/// Dances a score with a simulated robot that gets nothing but the C header of its firmware.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// The score, as in examples/dance/score.toml.
    #[arg(long, value_name = "FILE", default_value = SCORE)]
    score: PathBuf,
    /// What the firmware does with an accumulator at its threshold: reset it, carry the rest, or
    /// carry it with its sign.
    #[arg(long, value_enum, default_value_t)]
    law: Law,
    /// Bytes of the firmware's code, which share the program memory with the frames; those of the
    /// largest build of firmware/mcs51/dance.c unless given.
    #[arg(long, value_name = "N", default_value_t = 589)]
    code_bytes: u64,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/dance")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let danced = command_line::arguments().and_then(|args| dance(&args));
    match danced {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(2),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the whole chain; false where a simulated motor ends a turn more than a half step away.
fn dance(args: &Args) -> Result<bool> {
    let place = || args.score.display().to_string();
    let score = fs::read_to_string(&args.score).with_context(place)?;
    let score: Score = score.parse().with_context(place)?;
    let dance: Choreography<MOTORS> = score.compile(args.law.into()).with_context(place)?;

    let mut artefacts = Artefacts::new(&args.out)?;
    write_data(&score, &dance, &mut artefacts).with_context(place)?;
    let mut text = String::new();
    artefacts.reopen("data.h")?.read_to_string(&mut text)?;
    let data = Data::<MOTORS>::read(&text).context("data.h")?;

    let firmware = Firmware::new(&data, args.law.into())?;
    let waves = Waves::new(artefacts.create("dance.vcd")?, data.timing())?;
    let danced = simulate(firmware, data.frames(), waves)?;
    let other = Firmware::new(&data, args.law.other().into())?.count(data.frames());

    let labels = score.motors().map(|(name, _)| name);
    let report = Report::new(args, labels.collect(), &data, &dance, &danced, &other);
    picture::write(
        artefacts.create("dance.svg")?,
        args.law,
        &score,
        &danced,
        &other,
    )?;
    artefacts.write_json("report.json", &report)?;
    artefacts.keep()?;
    report
        .write_summary(std::io::stdout().lock(), &args.score, &args.out)
        .context("standard output")?;
    Ok(report.is_as_asked())
}

/// `data.h` in the packing of the fewest bytes.
fn write_data(
    score: &Score,
    dance: &Choreography<MOTORS>,
    artefacts: &mut Artefacts,
) -> Result<()> {
    let frames = || dance.frames.iter().copied();
    let header = DataHeader::new()
        .with_timing(score.timing())
        .with_threshold(score.threshold())?
        .with_packing(Sizes::of(frames()).smallest());
    let mut text = String::new();
    header.write(frames(), &mut text)?;
    let mut file = artefacts.create("data.h")?;
    file.write_all(text.as_bytes())?;
    Ok(file.flush()?)
}
