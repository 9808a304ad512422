//! The simulated machine: four steppers on the controller's wires, and the arm on them.

use std::fs::File;
use std::io::BufWriter;

use anyhow::{Context, Result};
use kurbo::BezPath;
use nalgebra::Point2;
use pose2pulse::pattern_codec::engraving::{Axis, PerAxis};
use pose2pulse::stepper_sync::{Direction, Level};

use crate::artefacts::Artefacts;
use crate::gauge::{Deviation, Gauge};
use crate::machine::Machine;
use crate::pace::{self, Pace};
use crate::picture::Picture;
use crate::plan::Plan;
use crate::playback::Wires;
use crate::progress::Progress;
use crate::pulses::PulseWriter;

/// How far around the tool the drawing is looked for, in bounds.
const REACH: f64 = 1.25;

/// What the simulated machine did.
pub(crate) struct Outcome {
    pub(crate) deviation: Deviation,
    pub(crate) records: u64,
    /// Pulses of each axis, either way.
    pub(crate) pulses: PerAxis<u64>,
    pub(crate) duration_s: f64,
    /// Where the steppers ended, counted from home.
    pub(crate) end: PerAxis<i32>,
    pub(crate) pace: pace::Outcome,
}

/// Steppers that count their step pins' rising edges, an arm that follows at once, a
/// tool that engraves while it is down.
pub(crate) struct Simulation<'a> {
    machine: &'a Machine,
    pulse_log: PulseWriter<BufWriter<File>>,
    picture: Picture<BufWriter<File>>,
    gauge: Gauge,
    pace: Pace,
    progress: Progress,
    now: u64,
    position: PerAxis<i32>,
    negative: PerAxis<bool>,
    pulses: PerAxis<u64>,
    records: u64,
    /// Where the tool is in the glass.
    engraving: Option<Point2<f64>>,
    moved: bool,
}

impl<'a> Simulation<'a> {
    /// A machine at home. Of the plan it takes what scales the measuring and the
    /// progress bar, nothing of the way.
    pub(crate) fn new(
        machine: &'a Machine,
        outlines: &[BezPath],
        plan: &Plan,
        artefacts: &mut Artefacts,
    ) -> Result<Self> {
        Ok(Self {
            machine,
            pulse_log: PulseWriter::new(artefacts.create("pulses.vcd")?, machine.timer)?,
            picture: Picture::new(artefacts.create("engraved.svg")?, outlines)?,
            gauge: Gauge::new(outlines, plan.tolerance_mm, plan.bound_mm * REACH),
            pace: Pace::default(),
            progress: Progress::new("engraving", plan.fast_records + plan.slow_records),
            now: 0,
            position: PerAxis::default(),
            negative: PerAxis::default(),
            pulses: PerAxis::default(),
            records: 0,
            engraving: None,
            moved: false,
        })
    }

    pub(crate) fn finish(mut self) -> Result<Outcome> {
        self.settle()?;
        self.pulse_log.finish(self.now)?;
        self.picture.finish()?;
        let ns = self.machine.timer.ticks_to_ns(self.now);
        Ok(Outcome {
            deviation: self.gauge.finish(),
            records: self.records,
            pulses: self.pulses,
            duration_s: seconds(ns)?,
            end: self.position,
            pace: self.pace.finish(self.machine.tick_s()),
        })
    }

    /// All edges of a tick are made: the arm stands at whole steps.
    fn settle(&mut self) -> Result<()> {
        if !core::mem::take(&mut self.moved) {
            return Ok(());
        }
        if self.position.vertical > -self.machine.lift_pulses {
            self.engraving = None;
            return Ok(());
        }
        let tool = self.machine.arm.forward(self.machine.joints(self.position));
        match self.engraving.replace(tool) {
            Some(before) => {
                self.gauge.engraved(before, tool);
                self.picture.line_to(tool)
            }
            None => {
                // A dot is no way, but drawn.
                self.gauge.engraved(tool, tool);
                self.picture.move_to(tool)
            }
        }
    }

    fn advance(&mut self, ticks: u64) -> Result<()> {
        if ticks != self.now {
            self.settle()?;
            self.now = ticks;
        }
        Ok(())
    }
}

impl Wires for Simulation<'_> {
    fn direction(&mut self, ticks: u64, axis: Axis, direction: Direction) -> Result<()> {
        self.advance(ticks)?;
        *self.negative.get_mut(axis) = direction == Direction::Negative;
        self.pulse_log.direction(ticks, axis, direction)
    }

    fn step(&mut self, ticks: u64, axis: Axis, level: Level) -> Result<()> {
        self.advance(ticks)?;
        if level == Level::High {
            let step = if *self.negative.get(axis) { -1 } else { 1 };
            let position = self.position.get_mut(axis);
            *position = position
                .checked_add(step)
                .with_context(|| format!("{axis} leaves 32 bits"))?;
            *self.pulses.get_mut(axis) += 1;
            self.moved = true;
        }
        if axis == Axis::Theta3 {
            self.pace.disc_edge(ticks);
        }
        self.pulse_log.step(ticks, axis, level)
    }

    fn record(&mut self, ticks: u64) -> Result<()> {
        self.advance(ticks)?;
        self.settle()?;
        self.pace.record(ticks, self.engraving);
        self.records += 1;
        self.progress.advance(1);
        Ok(())
    }
}

fn seconds(ns: u128) -> Result<f64> {
    let whole = u64::try_from(ns).context("the pattern lasts over 500 years")?;
    Ok(core::time::Duration::from_nanos(whole).as_secs_f64())
}
