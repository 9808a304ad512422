//! The pins over time as a value change dump, for GTKWave or PulseView.

use std::io::Write;

use anyhow::{Context, Result};
use machine_sim::{VcdWriter, Wire};
use pattern_codec::engraving::{Axis, PerAxis};
use stepper_sync::{Direction, Level, Timer};

use crate::controller::Wires;
use crate::machine::Machine;

/// Writes `pulses.vcd` as the pins change, some 36 bytes a pulse.
#[derive(Debug)]
pub struct PulseLog<W: Write> {
    vcd: VcdWriter<W>,
    timer: Timer,
}

impl<W: Write> PulseLog<W> {
    /// Begins a dump of a machine's step and direction pins.
    ///
    /// # Errors
    /// `out` does not take it.
    pub fn new(out: W, machine: &Machine) -> Result<Self> {
        let pins = |kind: &str| Axis::ALL.map(|axis| Wire::pin(format!("{axis}_{kind}")));
        let wires = [pins("step"), pins("dir")].concat();
        let comment = "direction wires are high for negative pulses";
        Ok(Self {
            vcd: VcdWriter::new(out, "engraver", comment, &wires)?,
            timer: machine.timer(),
        })
    }

    /// Ends the dump at a time in timer ticks.
    ///
    /// # Errors
    /// What is wired there does not take it.
    pub fn finish(self, ticks: u64) -> Result<()> {
        let ns = self.ns(ticks)?;
        Ok(self.vcd.finish(ns)?)
    }

    fn ns(&self, ticks: u64) -> Result<u64> {
        let ns = u64::try_from(self.timer.ticks_to_ns(ticks));
        ns.context("the pattern lasts over 500 years")
    }
}

/// The wires of step pins; those of direction pins come after all of them.
const STEP: PerAxis<usize> = PerAxis {
    elbow: 0,
    shoulder: 1,
    disc: 2,
    vertical: 3,
};

impl<W: Write> Wires for PulseLog<W> {
    fn direction(&mut self, ticks: u64, axis: Axis, direction: Direction) -> Result<()> {
        let wire = Axis::ALL.len() + STEP.get(axis);
        let value = u64::from(direction == Direction::Negative);
        Ok(self.vcd.set(self.ns(ticks)?, wire, value)?)
    }

    fn step(&mut self, ticks: u64, axis: Axis, level: Level) -> Result<()> {
        let value = u64::from(level == Level::High);
        Ok(self.vcd.set(self.ns(ticks)?, *STEP.get(axis), value)?)
    }
}
