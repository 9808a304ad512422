//! A whole program on the simulated stage, and what comes of it.

use anyhow::{Context, Result};
use machine_sim::Figure;

use crate::controller::{Controller, Settings, StepObserver};
use crate::gcode::Program;
use crate::motors::Followed;
use crate::picture;
use crate::record::Record;
use crate::report::Report;

/// What the stage did, in a closed loop and without corrections.
#[derive(Debug, Clone)]
pub struct Run {
    pub(crate) settings: Settings,
    pub(crate) commanded: [i32; 2],
    pub(crate) duration_s: f64,
    /// From the programmed end: in a closed loop, and without.
    pub(crate) closing_mm: [f64; 2],
    pub(crate) lost: [u64; 2],
    pub(crate) followed: Followed,
    /// The same motions at constant speed.
    pub(crate) constant: Followed,
    pub(crate) record: Record,
}

impl Run {
    /// The numbers.
    #[must_use]
    pub fn report(&self) -> Report {
        Report::new(self)
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
    let mut clock = controller.plan(program.lines.iter().map(|line| &line.motion))?;
    for line in &program.lines {
        let ran = controller.run(&line.motion, &mut clock);
        ran.with_context(|| format!("line {}", line.number))?;
    }
    controller.rest(clock);
    controller.finish()
}
