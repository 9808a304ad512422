//! A whole program on the simulated stage, and what comes of it.

use anyhow::Result;
use machine_sim::Figure;

use crate::controller::{BrokenOff, Controller, StepObserver};
use crate::gcode::Program;
use crate::motors::FollowedAxes;
use crate::picture;
use crate::record::{Record, Seen, over_time};
use crate::report::Report;
use crate::settings::Settings;

/// What the stage did, in a closed loop and without corrections.
#[derive(Debug, Clone)]
pub struct Run {
    pub(crate) settings: Settings,
    pub(crate) commanded: [i32; 2],
    pub(crate) duration_s: f64,
    /// From the programmed end: in a closed loop, and without.
    pub(crate) closing_mm: [f64; 2],
    pub(crate) lost: [u64; 2],
    pub(crate) followed: FollowedAxes,
    /// The same motions at their feeds from the first step to the last.
    pub(crate) at_feed: FollowedAxes,
    pub(crate) record: Record,
}

impl Run {
    /// The numbers.
    #[must_use]
    pub fn report(&self) -> Report {
        Report::new(self)
    }

    /// The stage whose lost steps are corrected.
    #[must_use]
    pub const fn closed_loop(&self) -> &Seen {
        &self.record.closed
    }

    /// The stage beside it, without corrections.
    #[must_use]
    pub const fn open_loop(&self) -> &Seen {
        &self.record.open
    }

    /// Points of each programmed motion, X and Y in mm, near enough for a picture.
    pub fn programmed(&self) -> impl Iterator<Item = Vec<[f64; 2]>> {
        let motions = self.record.programmed.iter();
        motions.map(|motion| motion.points().iter().map(|at| [at.x, at.y]).collect())
    }

    /// Time in s and the mean speed along the path around it in mm/s, by the steps.
    pub fn speeds(&self) -> impl Iterator<Item = [f64; 2]> {
        self.followed.motion.speeds()
    }

    /// Time in s, and by the steps the acceleration in mm/s² of the axis that has the larger one.
    pub fn axis_accelerations(&self) -> impl Iterator<Item = [f64; 2]> {
        self.followed.motion.axis_accelerations()
    }

    /// Time in s, and the steps corrected until then; where some were.
    pub fn corrections(&self) -> impl Iterator<Item = [f64; 2]> {
        over_time(&self.record.corrections).filter(|[_, steps]| steps.is_finite())
    }

    /// The programmed path and both stages' as an SVG figure.
    #[must_use]
    pub fn picture(&self) -> Figure {
        picture::picture(self)
    }
}

/// Runs a program on a stage that has just been switched on.
///
/// # Errors
/// A limit switch is met or more steps are lost than the loop corrects, with the line of the
/// program; or the observer's.
pub fn run(program: &Program, settings: &Settings, observer: StepObserver<'_>) -> Result<Run> {
    let mut controller = Controller::homed(settings, observer)?;
    let motions: Vec<_> = program.lines.iter().map(|line| line.motion).collect();
    controller
        .run(&motions)
        .map_err(|BrokenOff { motion, error }| {
            let number = program.lines.get(motion).map_or(0, |line| line.number);
            error.context(format!("line {number}"))
        })?;
    controller.finish()
}
