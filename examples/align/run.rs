//! Command line, and the order of things.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result, anyhow, ensure};
use clap::Parser;
use pose2pulse::pose_pt::{Platform, PoseVector};

use crate::drives::Examination;
use crate::operator::Task;
use crate::platform::Settings;
use crate::report::Report;
use crate::table::{Mode, Planner, Table};
use crate::world::World;
use crate::{operator, picture};
use command_line::{Artefacts, write_json};

const PLATFORM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/align/platform.toml");

/// Aligns a body on simulated three-axis locators with a simulated EUCHNER hand-held unit.
#[derive(Parser)]
#[command(version)]
pub(crate) struct Arguments {
    /// The platform, as in examples/align/platform.toml.
    #[arg(long, value_name = "FILE", default_value = PLATFORM)]
    platform: PathBuf,
    /// Where the body is, `x y z alpha beta gamma` in mm and degrees; else as in the platform file.
    #[arg(long, value_name = "POSE", value_parser = pose, allow_hyphen_values = true)]
    from: Option<Pose>,
    /// Where it goes, likewise.
    #[arg(long, value_name = "POSE", value_parser = pose, allow_hyphen_values = true)]
    to: Option<Pose>,
    /// Position-time table, or position-velocity-time.
    #[arg(long, value_enum, default_value_t = Mode::Pt)]
    mode: Mode,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/align")]
    out: PathBuf,
}

/// mm and degrees, as written.
pub(crate) type Pose = [f64; 6];

fn pose(text: &str) -> Result<Pose> {
    let words = text.split(|c: char| c.is_whitespace() || c == ',');
    let numbers = words
        .filter(|word| !word.is_empty())
        .map(|word| {
            let number = word.parse::<f64>();
            number.map_err(|_| anyhow!("{word:?} is no number"))
        })
        .collect::<Result<Vec<_>>>()?;
    ensure!(
        numbers.iter().all(|number| number.is_finite()),
        "a number is not finite"
    );
    let count = numbers.len();
    Pose::try_from(numbers).map_err(|_| anyhow!("{count} numbers, six are needed"))
}

/// The pose vector in mm and radians.
pub(crate) fn vector([x, y, z, alpha, beta, gamma]: Pose) -> PoseVector {
    let [alpha, beta, gamma] = [alpha, beta, gamma].map(f64::to_radians);
    PoseVector::new(x, y, z, alpha, beta, gamma)
}

/// Runs everything; false where the simulation left a bound.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let settings = Settings::read(&arguments.platform)?;
    match settings.locators() {
        3 => align::<3>(arguments, &settings),
        4 => align::<4>(arguments, &settings),
        5 => align::<5>(arguments, &settings),
        6 => align::<6>(arguments, &settings),
        count => Err(anyhow!("{count} locators: this example takes 3 to 6"))
            .with_context(|| arguments.platform.display().to_string()),
    }
}

fn align<const N: usize>(arguments: &Arguments, settings: &Settings) -> Result<bool> {
    let place = || arguments.platform.display().to_string();
    let platform: Platform<N> = settings.platform().with_context(place)?;
    let panel = settings.panel().with_context(place)?;
    let [from, to] = settings.poses();
    let (from, to) = (arguments.from.unwrap_or(from), arguments.to.unwrap_or(to));
    let mode = arguments.mode;
    let task = Task::new(from, to, &panel)?;
    for (name, pose) in [("--from", from), ("--to", task.reached)] {
        let axes = platform.checked_axes(&vector(pose).to_isometry(settings.convention()));
        axes.with_context(|| format!("{name}: out of reach"))?;
    }
    let planner = Planner::new(&platform, settings, mode);
    // Whatever is wrong with the motion is said before anything moves.
    planner.plan(from, task.reached)?;
    if let Some(note) = task.rounding_note() {
        eprintln!("note: {note}");
    }

    // All files, so that none is refused when the motion is over.
    let mut artefacts = Artefacts::new(&arguments.out)?;
    let log = artefacts.create("line.log")?;
    let mut table_file = artefacts.create(mode.file())?;
    let [jog, align, json] = ["jog.svg", "align.svg", "report.json"].map(|it| artefacts.create(it));
    let (jog, align, json) = (jog?, align?, json?);

    let mut world = World::new(&planner, panel, from)?;
    operator::work(&mut world, &task)?;
    let course = world.finish()?;
    let plan = course.plan.as_ref().context("no pose change was run")?;

    course.line.write_log(log)?;
    table_file.write_all(plan.csv.as_bytes())?;
    table_file.flush()?;
    let csv = std::io::read_to_string(artefacts.reopen(mode.file())?)?;
    let table = Table::read(&csv, &platform)?;
    let examination = Examination::of(&table, &platform)?;
    picture::jog(&course.jog, &panel, jog)?;
    let body = [from, task.reached].map(|pose| settings.outline(&planner.isometry(pose)));
    picture::align(&examination, &platform, plan.strain_bound_mm, &body, align)?;
    let target = planner.isometry(to);
    let report = Report::new(&course, plan, &table, &examination, &target, mode);
    write_json(json, &report)?;
    artefacts.keep()?;
    report
        .write_summary(std::io::stdout().lock(), mode, &arguments.out)
        .context("standard output")?;
    Ok(report.is_within_bounds())
}
