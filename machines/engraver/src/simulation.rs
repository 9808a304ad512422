//! The simulated machine: four steppers on the controller's wires, and the arm on them.

use anyhow::{Context, Result};
use known_load::{Elastic, Tool, TorqueUsed, Vibration};
use nalgebra::Point2;
use pattern_codec::engraving::{Axis, PerAxis};
use stepper_sync::{Direction, Level};

use crate::controller::{Controller, Wires};
use crate::drawing::flatten;
use crate::gauge::{Deviation, Gauge};
use crate::machine::Machine;
use crate::motors::{FollowedAxes, Motors};
use crate::plan::Reference;
use crate::timed::TimedRow;
use crate::tool_speed::{Meter, Pace, Spread, ToolSpeed};
use crate::tool_trace::ToolTrace;

/// How far around the tool the drawing is looked for, in bounds.
const REACH: f64 = 1.25;
/// Points of the picture are this far apart, in bounds.
const PICTURE_SPACING: f64 = 0.25;
/// Lines of the picture are this near to the drawing's curves.
const PICTURE_MM: f64 = 0.01;

/// What the simulated machine did with a pattern.
#[derive(Debug, Clone)]
pub struct Run {
    pub(crate) deviation: Deviation,
    pub(crate) bound_mm: f64,
    /// Pulses of each axis, either way.
    pub(crate) pulses: PerAxis<u64>,
    pub(crate) records: u64,
    pub(crate) ticks: u64,
    pub(crate) tick_s: f64,
    pub(crate) duration_s: f64,
    /// Where the steppers ended, counted from home.
    pub(crate) end: PerAxis<i32>,
    pub(crate) tool_speed: ToolSpeed,
    pub(crate) spread: Option<Spread>,
    pub(crate) motors: FollowedAxes,
    pub(crate) trace: ToolTrace,
    /// The placed drawing as lines.
    pub(crate) drawing: Vec<Vec<Point2<f64>>>,
    /// Of timed strokes.
    pub(crate) rows: Vec<TimedRow>,
    /// What they ask of the motors, where the load is known.
    pub(crate) torque: Option<TorqueUsed<3>>,
    /// How the tool swings in them, where its mode is known.
    pub(crate) vibration: Option<Vibration>,
    /// The same without a shaper.
    pub(crate) unshaped: Option<Vibration>,
}

impl Run {
    /// The rows of timed strokes; none of a pattern.
    #[must_use]
    pub fn rows(&self) -> &[TimedRow] {
        &self.rows
    }

    /// Duration in ticks of the controller's timer.
    #[must_use]
    pub const fn ticks(&self) -> u64 {
        self.ticks
    }

    /// Largest distance between path and drawing, in mm: of the path from the drawing, and of the
    /// drawing from the path.
    #[must_use]
    pub const fn max_deviation_mm(&self) -> f64 {
        let deviation = &self.deviation;
        deviation
            .path_to_drawing_mm
            .max(deviation.drawing_to_path_mm)
    }

    /// Whether path and drawing are as close as tolerance and resolution allow.
    #[must_use]
    pub fn is_within_bound(&self) -> bool {
        self.max_deviation_mm() <= self.bound_mm
    }
}

/// Plays a pattern on the simulated machine, which gets nothing but these bytes, and measures the
/// engraved path.
///
/// `probe` is wired to the same pins; `progress` is told how many bytes are done, of how many.
///
/// # Errors
/// The bytes are no pattern of this machine, or the probe cannot take a change.
pub fn simulate(
    machine: &Machine,
    pattern: &[u8],
    reference: &Reference,
    probe: &mut impl Wires,
    mut progress: impl FnMut(u64, u64),
) -> Result<Run> {
    let mut simulation = Simulation::new(machine, reference, probe)?;
    let mut controller = Controller::new(machine);
    let total = pattern.len() as u64;
    for located in machine.format.records(pattern) {
        let located = located?;
        let ticks = controller.play(located.record, &mut simulation)?;
        simulation.record(ticks);
        progress(located.offset, total);
    }
    simulation.finish(reference)
}

/// Steppers that count their step pins' rising edges, an arm that follows at once, a tool that
/// engraves while it is down.
pub(crate) struct Simulation<'a, P> {
    machine: &'a Machine,
    probe: &'a mut P,
    gauge: Gauge,
    meter: Meter,
    pace: Pace,
    motors: Motors,
    /// Looked at in timed strokes.
    swinging: Option<Tool<2>>,
    trace: ToolTrace,
    now: u64,
    position: PerAxis<i32>,
    is_negative: PerAxis<bool>,
    pulses: PerAxis<u64>,
    records: u64,
    /// Where the tool is in the glass.
    engraving: Option<Point2<f64>>,
    has_moved: bool,
    /// The disc turns while the arms move, not before.
    turns_while_moving: bool,
}

impl<'a, P: Wires> Simulation<'a, P> {
    /// A machine at home.
    ///
    /// # Errors
    /// A load without inertia.
    pub(crate) fn new(
        machine: &'a Machine,
        reference: &Reference,
        probe: &'a mut P,
    ) -> Result<Self> {
        let position = PerAxis::default();
        let home = machine.arm.forward(machine.joints(position));
        let reach = reference.bound_mm * REACH;
        Ok(Self {
            machine,
            probe,
            gauge: Gauge::new(&reference.outlines, reference.tolerance_mm, reach),
            meter: Meter::default(),
            pace: Pace::default(),
            motors: Motors::new(machine)?,
            swinging: None,
            trace: ToolTrace::new(home, reference.bound_mm * PICTURE_SPACING),
            now: 0,
            position,
            is_negative: PerAxis::default(),
            pulses: PerAxis::default(),
            records: 0,
            engraving: None,
            has_moved: false,
            turns_while_moving: false,
        })
    }

    /// The tool swings, from here on.
    pub(crate) fn swings(&mut self, elastic: &Elastic) {
        let mut tool = Tool::new(elastic, self.tool().into());
        tool.work(false);
        self.swinging = Some(tool);
    }

    /// A timed stroke begins at a time.
    pub(crate) fn begin_stroke(&mut self, ticks: u64) {
        self.turns_while_moving = true;
        self.advance(ticks);
        if let Some(tool) = &mut self.swinging {
            tool.work(true);
        }
    }

    /// The last step of a timed stroke was at a time.
    pub(crate) fn end_stroke(&mut self, ticks: u64) {
        self.turns_while_moving = false;
        self.advance(ticks);
        self.settle();
        let now_s = self.now_s();
        if let Some(tool) = &mut self.swinging {
            tool.rest(now_s);
            tool.work(false);
        }
    }

    fn now_s(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks are centuries")]
        let ticks = self.now as f64;
        ticks * self.machine.tick_s()
    }

    fn tool(&self) -> Point2<f64> {
        self.machine.arm.forward(self.machine.joints(self.position))
    }

    /// All edges of a tick are made: the arm stands at whole steps.
    fn settle(&mut self) {
        if !core::mem::take(&mut self.has_moved) {
            return;
        }
        let tool = self.tool();
        let now_s = self.now_s();
        if let Some(swinging) = &mut self.swinging {
            swinging.follow(now_s, tool.into());
        }
        let in_glass = self.position.vertical <= -self.machine.lift_pulses;
        self.trace.at(tool, in_glass);
        if !in_glass {
            self.engraving = None;
            self.pace.lifted();
            return;
        }
        // A dot has no length, but is engraved.
        let before = self.engraving.replace(tool).unwrap_or(tool);
        self.pace.at(self.now, tool);
        self.gauge.engraved(before, tool, self.now);
    }

    fn advance(&mut self, ticks: u64) {
        if ticks != self.now {
            self.settle();
            self.now = ticks;
        }
    }

    /// A record is done.
    pub(crate) fn record(&mut self, ticks: u64) {
        self.advance(ticks);
        self.settle();
        let speed = self.meter.record(ticks, self.engraving);
        let speed_mm_s = speed.map(|speed| speed / self.machine.tick_s());
        self.trace.record(self.tool(), speed_mm_s);
        self.records += 1;
    }

    pub(crate) fn finish(mut self, reference: &Reference) -> Result<Run> {
        self.settle();
        self.trace.finish(self.tool());
        let now_s = self.now_s();
        let ns = self.machine.timer.ticks_to_ns(self.now);
        let ns = u64::try_from(ns).context("the pattern lasts over 500 years")?;
        let drawing = reference.outlines.iter();
        Ok(Run {
            deviation: self.gauge.finish(),
            bound_mm: reference.bound_mm,
            pulses: self.pulses,
            records: self.records,
            ticks: self.now,
            tick_s: self.machine.tick_s(),
            duration_s: core::time::Duration::from_nanos(ns).as_secs_f64(),
            end: self.position,
            tool_speed: self.meter.finish(self.machine.tick_s()),
            spread: self.pace.finish(self.machine.tick_s()),
            motors: self.motors.finish(self.machine),
            trace: self.trace,
            drawing: drawing
                .map(|outline| flatten(outline, PICTURE_MM))
                .collect(),
            rows: Vec::new(),
            torque: None,
            vibration: self.swinging.map(|tool| tool.finish(now_s)),
            unshaped: None,
        })
    }
}

impl<P: Wires> Wires for Simulation<'_, P> {
    fn direction(&mut self, ticks: u64, axis: Axis, direction: Direction) -> Result<()> {
        self.advance(ticks);
        *self.is_negative.get_mut(axis) = direction == Direction::Negative;
        self.probe.direction(ticks, axis, direction)
    }

    fn step(&mut self, ticks: u64, axis: Axis, level: Level) -> Result<()> {
        self.advance(ticks);
        if level == Level::High {
            let step = if *self.is_negative.get(axis) { -1 } else { 1 };
            self.motors
                .step(ticks, (axis, step), (self.machine, self.position))?;
            let position = self.position.get_mut(axis);
            *position = position
                .checked_add(step)
                .with_context(|| format!("{axis} leaves 32 bits"))?;
            *self.pulses.get_mut(axis) += 1;
            self.has_moved = true;
        }
        if axis == Axis::Disc && !self.turns_while_moving {
            self.meter.disc_edge(ticks);
        }
        self.probe.step(ticks, axis, level)
    }
}
