//! The controller of timed strokes: rows to edges, rapid moves between them.

extern crate alloc;

use alloc::collections::BinaryHeap;
use core::cmp::Reverse;

use anyhow::{Context, Result, ensure};
use known_load::TorqueUsed;
use path_timing::Row;
use pattern_codec::engraving::{Axis, Builder, PerAxis};
use pvt_steps::{PvtQuantiser, PvtSteps};
use stepper_sync::{Direction, Level, StepDirTiming};

use super::{Move, TimedPlan, TimedRow};
use crate::controller::{Controller, Wires};
use crate::machine::Machine;
use crate::simulation::{Run, Simulation};

/// The driver's input times. The drivers of the source are not known; these are slower than chips
/// ask.
const TIMING: StepDirTiming = StepDirTiming {
    pulse_ns: 20_000,
    pause_ns: 20_000,
    setup_ns: 10_000,
    hold_ns: 10_000,
};

/// From one look at the tool's speed to the next at least, where rows are shaped, in s.
const LOOK_S: f64 = 0.02;

/// Shoulder, elbow and disc, as the rows have them.
const AXES: [Axis; 3] = [Axis::Shoulder, Axis::Elbow, Axis::Disc];

/// What happens at a tick, in the order in which it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Event {
    PulseEnd(usize),
    /// The direction pin: whether it is negative.
    Turn(usize, bool),
    Pulse(usize),
    /// The end of a row.
    Row,
}

/// Plays a plan on the simulated machine, which gets nothing but edges, and measures the engraved
/// path; `probe` is wired to the same pins.
///
/// # Errors
/// A row that the driver cannot follow, or the probe cannot take a change.
pub fn simulate_timed(
    machine: &Machine,
    plan: &TimedPlan,
    probe: &mut impl Wires,
    mut progress: impl FnMut(u64, u64),
) -> Result<Run> {
    let mut simulation = Simulation::new(machine, &plan.reference, probe)?;
    if let Some(elastic) = &machine.elastic {
        simulation.swings(elastic);
    }
    let mut player = Player {
        machine,
        controller: Controller::new(machine),
        position: PerAxis::default(),
        rows: Vec::new(),
        torque: machine.load.map(|load| TorqueUsed::none(load.reserve)),
    };
    let total = plan.moves.len() as u64;
    for (done, next) in (1..).zip(&plan.moves) {
        match next {
            Move::Rapid { axis, to } => player.rapid(*axis, *to, &mut simulation)?,
            Move::Stroke(number, rows) => player.stroke(*number, rows, &mut simulation)?,
        }
        progress(done, total);
    }
    let mut run = simulation.finish(&plan.reference)?;
    run.rows = player.rows;
    run.torque = player.torque;
    Ok(run)
}

struct Player<'a> {
    machine: &'a Machine,
    controller: Controller,
    /// In pulses from home.
    position: PerAxis<i32>,
    /// What has been run so far.
    rows: Vec<TimedRow>,
    /// What it has asked of motors whose load is known.
    torque: Option<TorqueUsed<3>>,
}

impl Player<'_> {
    fn rapid<P: Wires>(
        &mut self,
        axis: Axis,
        to: i32,
        simulation: &mut Simulation<'_, P>,
    ) -> Result<()> {
        let by = to.checked_sub(*self.position.get(axis));
        let by = by.with_context(|| format!("{axis} leaves 32 bits"))?;
        for record in Builder::at(self.position).fast(axis, by)? {
            let ticks = self.controller.play(record, simulation)?;
            simulation.record(ticks);
        }
        *self.position.get_mut(axis) = to;
        Ok(())
    }

    fn stroke<P: Wires>(
        &mut self,
        stroke: usize,
        rows: &[Row<[f64; 3]>],
        simulation: &mut Simulation<'_, P>,
    ) -> Result<()> {
        let Some((start, rest)) = rows.split_first() else {
            return Ok(());
        };
        let machine = self.machine;
        let joints = [machine.shoulder, machine.elbow, machine.disc];
        let home = joints.map(|joint| joint.home_rad);
        let from_home = |position: [f64; 3]| {
            let [q0, q1, q2] = position;
            let [h0, h1, h2] = home;
            [q0 - h0, q1 - h1, q2 - h2]
        };
        let rate = machine.timer.tick_rate();
        let scales = joints.map(|joint| joint.scale());
        let mut quantiser = PvtQuantiser::new(rate, scales, from_home(start.position))?
            .with_start_stop_speeds(machine.start_speeds());
        let mut steps = PvtSteps::new(quantiser.knots(), TIMING.min_intervals(rate));
        let is_there = AXES
            .iter()
            .zip(steps.steps())
            .all(|(axis, steps)| i64::from(*self.position.get(*axis)) == steps);
        ensure!(is_there, "a stroke does not begin where the machine stands");
        simulation.begin_stroke(self.controller.now());
        let mut edges = Edges::new(self.controller.now(), machine);
        let start_s = edges.start_s(machine);
        if let (Some(torque), Some(load)) = (&mut self.torque, &machine.load) {
            torque.add(load, rows, start_s);
        }
        self.rows
            .extend((0_u32..).zip(rows).map(|(number, row)| TimedRow {
                time_s: start_s + row.time_s,
                position_rad: row.position,
                velocity_rad_s: row.velocity,
                stroke,
                is_first: number == 0,
            }));
        for row in rest {
            let position = from_home(row.position);
            steps.push(&quantiser.row(row.time_s, position, row.velocity)?)?;
            for step in &mut steps {
                edges.step(step.ticks, step.axis, step.direction, simulation)?;
            }
            if edges.is_worth_a_look(steps.end_ticks(), machine) || row.is_at_rest() {
                edges.end_row(steps.end_ticks());
            }
        }
        let end = edges.finish(simulation)?;
        simulation.end_stroke(end);
        for (axis, steps) in AXES.into_iter().zip(steps.steps()) {
            *self.position.get_mut(axis) = i32::try_from(steps)?;
        }
        self.controller.wait_until(end);
        Ok(())
    }
}

/// Edges of pulses that are as long as the driver asks, in time order.
struct Edges {
    start: u64,
    pulse_ticks: u64,
    setup_ticks: u64,
    directions: [Option<Direction>; 3],
    /// The end of the last row at which the tool was looked at, since the start.
    looked_ticks: u64,
    waiting: BinaryHeap<Reverse<(u64, Event)>>,
}

impl Edges {
    /// From a time in ticks on.
    fn new(now: u64, machine: &Machine) -> Self {
        let min = TIMING.min_intervals(machine.timer.tick_rate());
        let (pulse_ticks, setup_ticks) = (min.step_ticks / 2, min.reversal_ticks / 4);
        Self {
            // The first direction is set before the first step.
            start: now + setup_ticks,
            pulse_ticks,
            setup_ticks,
            directions: [None; 3],
            looked_ticks: 0,
            waiting: BinaryHeap::new(),
        }
    }

    /// When the rows begin, in s.
    fn start_s(&self, machine: &Machine) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks are centuries")]
        let ticks = self.start as f64;
        ticks * machine.tick_s()
    }

    /// A step, and all that comes before what its direction may need.
    fn step<P: Wires>(
        &mut self,
        ticks: u64,
        axis: usize,
        direction: Direction,
        simulation: &mut Simulation<'_, P>,
    ) -> Result<()> {
        let now = self.start + ticks;
        self.until(now - self.setup_ticks, simulation)?;
        if let Some(last) = self.directions.get_mut(axis)
            && *last != Some(direction)
        {
            *last = Some(direction);
            let turn = Event::Turn(axis, direction == Direction::Negative);
            self.waiting.push(Reverse((now - self.setup_ticks, turn)));
        }
        self.waiting.push(Reverse((now, Event::Pulse(axis))));
        let end = now + self.pulse_ticks;
        self.waiting.push(Reverse((end, Event::PulseEnd(axis))));
        Ok(())
    }

    /// Whether a speed can be told of the steps since the last look: shaped rows may hold none.
    fn is_worth_a_look(&self, ticks: u64, machine: &Machine) -> bool {
        let since = ticks.saturating_sub(self.looked_ticks);
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks are centuries")]
        let since_s = since as f64 * machine.tick_s();
        machine.elastic.is_none() || since_s >= LOOK_S
    }

    fn end_row(&mut self, ticks: u64) {
        self.looked_ticks = ticks;
        self.waiting.push(Reverse((self.start + ticks, Event::Row)));
    }

    /// All that comes before a time.
    fn until<P: Wires>(&mut self, end: u64, simulation: &mut Simulation<'_, P>) -> Result<()> {
        while let Some(Reverse((ticks, event))) = self.waiting.peek().copied()
            && ticks < end
        {
            self.waiting.pop();
            happen(ticks, event, simulation)?;
        }
        Ok(())
    }

    /// All that is left; the time of the last.
    fn finish<P: Wires>(mut self, simulation: &mut Simulation<'_, P>) -> Result<u64> {
        let mut end = self.start;
        while let Some(Reverse((ticks, event))) = self.waiting.pop() {
            end = ticks;
            happen(ticks, event, simulation)?;
        }
        Ok(end)
    }
}

fn happen<P: Wires>(ticks: u64, event: Event, simulation: &mut Simulation<'_, P>) -> Result<()> {
    let axis = |index: usize| AXES.get(index).copied().context("there are three axes");
    match event {
        Event::PulseEnd(index) => simulation.step(ticks, axis(index)?, Level::Low),
        Event::Turn(index, is_negative) => {
            let direction = if is_negative {
                Direction::Negative
            } else {
                Direction::Positive
            };
            simulation.direction(ticks, axis(index)?, direction)
        }
        Event::Pulse(index) => simulation.step(ticks, axis(index)?, Level::High),
        Event::Row => {
            simulation.record(ticks);
            Ok(())
        }
    }
}
