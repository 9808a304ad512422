//! The pins over time as a value change dump, for GTKWave or PulseView.

use std::io::Write;

use anyhow::{Context, Result};
use pose2pulse::pattern_codec::engraving::{Axis, PerAxis};
use pose2pulse::stepper_sync::{Direction, Level, Timer};
use vcd::{IdCode, SimulationCommand, TimescaleUnit, Value};

/// Writes `pulses.vcd`; a direction wire is high for negative pulses, as in the bytes.
pub(crate) struct PulseWriter<W: Write> {
    vcd: vcd::Writer<W>,
    timer: Timer,
    step: PerAxis<IdCode>,
    direction: PerAxis<IdCode>,
    stamped_ticks: Option<u64>,
}

impl<W: Write> PulseWriter<W> {
    pub(crate) fn new(out: W, timer: Timer) -> Result<Self> {
        let mut vcd = vcd::Writer::new(out);
        vcd.comment("direction wires are high for negative pulses")?;
        vcd.timescale(1, TimescaleUnit::NS)?;
        vcd.add_module("engraver")?;
        let mut wires = |kind: &str| -> Result<PerAxis<IdCode>> {
            let mut wire = |axis: Axis| vcd.add_wire(1, &format!("{axis}_{kind}"));
            Ok(PerAxis {
                theta1: wire(Axis::Theta1)?,
                theta2: wire(Axis::Theta2)?,
                theta3: wire(Axis::Theta3)?,
                vertical: wire(Axis::Vertical)?,
            })
        };
        let (step, direction) = (wires("step")?, wires("dir")?);
        vcd.upscope()?;
        vcd.enddefinitions()?;
        vcd.timestamp(0)?;
        vcd.begin(SimulationCommand::Dumpvars)?;
        for wires in [&step, &direction] {
            for wire in [wires.theta1, wires.theta2, wires.theta3, wires.vertical] {
                vcd.change_scalar(wire, Value::V0)?;
            }
        }
        vcd.end()?;
        Ok(Self {
            vcd,
            timer,
            step,
            direction,
            stamped_ticks: Some(0),
        })
    }

    pub(crate) fn direction(&mut self, ticks: u64, axis: Axis, to: Direction) -> Result<()> {
        self.stamp(ticks)?;
        let wire = *self.direction.get(axis);
        Ok(self.vcd.change_scalar(wire, to == Direction::Negative)?)
    }

    pub(crate) fn step(&mut self, ticks: u64, axis: Axis, level: Level) -> Result<()> {
        self.stamp(ticks)?;
        let wire = *self.step.get(axis);
        Ok(self.vcd.change_scalar(wire, level == Level::High)?)
    }

    pub(crate) fn finish(mut self, ticks: u64) -> Result<()> {
        self.stamp(ticks)?;
        Ok(self.vcd.flush()?)
    }

    fn stamp(&mut self, ticks: u64) -> Result<()> {
        if self.stamped_ticks != Some(ticks) {
            let ns = u64::try_from(self.timer.ticks_to_ns(ticks));
            self.vcd
                .timestamp(ns.context("the pattern lasts over 500 years")?)?;
            self.stamped_ticks = Some(ticks);
        }
        Ok(())
    }
}
