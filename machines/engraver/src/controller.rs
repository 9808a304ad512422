//! The controller: takes the records of a pattern and drives pins.

use anyhow::Result;
use pattern_codec::engraving::{Axis, JointPulses, Record};
use pvt_steps::{Ramp, RampLimits};
use stepper_sync::{Direction, Edge, Level, Timer, Trains};

use crate::machine::Machine;

/// What the controller's pins are wired to; times in timer ticks, never going back.
pub trait Wires {
    /// An axis' direction pin is set.
    ///
    /// # Errors
    /// What is wired there cannot take it; the run ends.
    fn direction(&mut self, ticks: u64, axis: Axis, direction: Direction) -> Result<()>;

    /// An axis' step pin changes.
    ///
    /// # Errors
    /// What is wired there cannot take it; the run ends.
    fn step(&mut self, ticks: u64, axis: Axis, level: Level) -> Result<()>;
}

/// Nothing is wired.
impl Wires for () {
    fn direction(&mut self, _: u64, _: Axis, _: Direction) -> Result<()> {
        Ok(())
    }

    fn step(&mut self, _: u64, _: Axis, _: Level) -> Result<()> {
        Ok(())
    }
}

/// Something is wired, or nothing.
impl<W: Wires> Wires for Option<W> {
    fn direction(&mut self, ticks: u64, axis: Axis, direction: Direction) -> Result<()> {
        match self {
            Some(wires) => wires.direction(ticks, axis, direction),
            None => Ok(()),
        }
    }

    fn step(&mut self, ticks: u64, axis: Axis, level: Level) -> Result<()> {
        match self {
            Some(wires) => wires.step(ticks, axis, level),
            None => Ok(()),
        }
    }
}

/// The controller between two records.
pub(crate) struct Controller {
    timer: Timer,
    half_period_ticks: u64,
    rapid: RampLimits,
    now: u64,
}

impl Controller {
    pub(crate) const fn new(machine: &Machine) -> Self {
        Self {
            timer: machine.timer,
            half_period_ticks: machine.half_period_ticks,
            rapid: machine.rapid,
            now: 0,
        }
    }

    /// The end of what has been played, in ticks.
    pub(crate) const fn now(&self) -> u64 {
        self.now
    }

    /// Goes on at a time, in ticks, that is not before the end of what has been played.
    pub(crate) fn wait_until(&mut self, ticks: u64) {
        self.now = self.now.max(ticks);
    }

    /// Plays a record; returns the time of its end.
    pub(crate) fn play(&mut self, record: Record, wires: &mut impl Wires) -> Result<u64> {
        match record {
            Record::Fast(fast) => {
                let ramp = Ramp::new([fast.pulses()], &self.rapid, self.timer.tick_rate())?;
                self.start([fast.axis()], ramp.directions(), wires)?;
                self.run([fast.axis()], ramp.edges(), ramp.end_ticks(), wires)?;
            }
            Record::Slow(slow) => {
                let JointPulses {
                    elbow,
                    shoulder,
                    disc,
                } = slow.pulses();
                // The disc turns first, then both arms together.
                self.process([Axis::Disc], [disc], wires)?;
                self.process([Axis::Elbow, Axis::Shoulder], [elbow, shoulder], wires)?;
            }
        }
        Ok(self.now)
    }

    fn process<const N: usize>(
        &mut self,
        axes: [Axis; N],
        steps: [i32; N],
        wires: &mut impl Wires,
    ) -> Result<()> {
        let trains = Trains::new(steps, self.half_period_ticks)?;
        self.start(axes, trains.directions(), wires)?;
        self.run(axes, trains.edges(), trains.end_ticks(), wires)
    }

    fn start<const N: usize>(
        &self,
        axes: [Axis; N],
        directions: [Option<Direction>; N],
        wires: &mut impl Wires,
    ) -> Result<()> {
        for (axis, direction) in axes.into_iter().zip(directions) {
            if let Some(direction) = direction {
                wires.direction(self.now, axis, direction)?;
            }
        }
        Ok(())
    }

    fn run<const N: usize>(
        &mut self,
        axes: [Axis; N],
        edges: impl Iterator<Item = Edge>,
        end_ticks: u64,
        wires: &mut impl Wires,
    ) -> Result<()> {
        for edge in edges {
            if let Some(axis) = axes.get(edge.axis) {
                wires.step(self.now + edge.ticks, *axis, edge.level)?;
            }
        }
        self.now += end_ticks;
        Ok(())
    }
}
