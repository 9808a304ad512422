//! A run: the poses are checked, the operator works, the pictures show what came of it.

use anyhow::{Context as _, Result};
use machine_sim::Figure;
use pose_pt::Platform;

use crate::examination::Examination;
use crate::line::Wire;
use crate::machine::{Locators, Machine, isometry};
use crate::mode::Mode;
use crate::moments::{self, PlatformAt};
use crate::operator::{self, Task};
use crate::picture;
use crate::planner::Planner;
use crate::pose::Pose;
use crate::report::Report;
use crate::table::Table;
use crate::world::World;

/// Where the body is and goes, and by what kind of table.
#[derive(Debug, Clone, Copy, Default)]
#[expect(clippy::exhaustive_structs, reason = "plain settings")]
pub struct Alignment {
    /// Where the body is; without, as in the platform file.
    pub from: Option<Pose>,
    /// Where it goes, likewise.
    pub to: Option<Pose>,
    /// Of the table.
    pub mode: Mode,
}

/// What has come of an alignment.
#[derive(Debug)]
pub struct Run {
    line_log: String,
    table: String,
    jog: Figure,
    align: Figure,
    report: Report,
    note: Option<String>,
    moments: Vec<PlatformAt>,
}

impl Run {
    /// The bytes of both ends of the line with their times.
    #[must_use]
    pub fn line_log(&self) -> &str {
        &self.line_log
    }

    /// The table, as the controller of the axes has got it.
    #[must_use]
    pub fn table(&self) -> &str {
        &self.table
    }

    /// The jog: wheel counts, and the speeds they become.
    #[must_use]
    pub const fn jog_picture(&self) -> &Figure {
        &self.jog
    }

    /// The pose change: axes, distance error, and the body before and after.
    #[must_use]
    pub const fn align_picture(&self) -> &Figure {
        &self.align
    }

    /// The locators and the body over the time of the table.
    #[must_use]
    pub fn moments(&self) -> &[PlatformAt] {
        &self.moments
    }

    /// The numbers.
    #[must_use]
    pub const fn report(&self) -> &Report {
        &self.report
    }

    /// What the pendant's steps leave of the target.
    #[must_use]
    pub fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }
}

/// Aligns the body: the operator switches the pendant on, jogs a locator there and back, sets the
/// pose change and runs it. Every byte between pendant and control goes through `wire`.
///
/// # Errors
/// A pose out of reach, or further away than the pendant can set; a motion that cannot be
/// planned; a wire that fails. Nothing has moved when poses or plan are wrong.
pub fn run(machine: &Machine, alignment: &Alignment, wire: Wire<'_>) -> Result<Run> {
    match &machine.locators {
        Locators::Three(platform) => align(machine, platform, alignment, wire),
        Locators::Four(platform) => align(machine, platform, alignment, wire),
        Locators::Five(platform) => align(machine, platform, alignment, wire),
        Locators::Six(platform) => align(machine, platform, alignment, wire),
    }
}

fn align<const N: usize>(
    machine: &Machine,
    platform: &Platform<N>,
    alignment: &Alignment,
    wire: Wire<'_>,
) -> Result<Run> {
    let [from, to] = machine.settings.poses();
    let from = alignment.from.unwrap_or(from);
    let to = alignment.to.unwrap_or(to);
    let task = Task::new(from, to, &machine.panel)?;
    let via: Vec<_> = machine.settings.via().collect();
    let named = (1..)
        .zip(&via)
        .map(|(n, (pose, _))| (format!("via {n}"), *pose));
    let ends = [("from", from), ("to", task.reached)].map(|(name, pose)| (name.to_owned(), pose));
    for (name, pose) in ends.into_iter().chain(named) {
        let axes = platform.checked_axes(&isometry(pose));
        axes.with_context(|| format!("{name}: out of reach"))?;
    }
    let planner = Planner::new(platform, &machine.settings, via.clone(), alignment.mode);
    // Whatever is wrong with the motion is said before anything moves.
    planner.plan(from, task.reached)?;

    let mut world = World::new(planner, machine.panel, from, wire)?;
    operator::work(&mut world, &task)?;
    let done = world.finish()?;
    let plan = done.plan.as_ref().context("no pose change was run")?;

    let table = Table::read(&plan.csv, platform)?;
    let examination = Examination::of(&table, platform)?;
    let passed = via.iter().map(|via| examination.passing(platform, via));
    let report = Report::new(
        &done,
        plan,
        &table,
        &examination,
        &isometry(to),
        alignment.mode,
    )
    .with_passed(passed.collect::<Result<_>>()?);
    let via: Vec<_> = via.into_iter().map(|(pose, _)| pose).collect();
    Ok(Run {
        jog: picture::jog(&done.jog, &machine.panel),
        align: picture::align(
            machine,
            platform,
            &examination,
            [from, task.reached],
            &via,
            plan.distance_error_bound_mm,
        ),
        report,
        note: task.rounding_note(),
        moments: moments::of_table(&examination, platform, &machine.settings)?,
        table: plan.csv.clone(),
        line_log: done.line_log,
    })
}
