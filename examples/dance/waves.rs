//! Bus, strobes and latches over time as a value change dump, for GTKWave or PulseView.

use std::io::Write;

use anyhow::Result;
use pose2pulse::pattern_codec::dance::Timing;
use pose2pulse::stepper_sync::{LatchWrites, Latches};
use vcd::{IdCode, SimulationCommand, TimescaleUnit, Value};

use crate::MOTORS;

/// From one write of the bus to the next: two machine cycles of a 8051 at 12 MHz.
const WRITE_NS: u64 = 2000;

/// Writes `dance.vcd`.
pub(crate) struct Waves<W: Write> {
    vcd: vcd::Writer<W>,
    data: IdCode,
    strobes: [IdCode; MOTORS],
    latches: [IdCode; MOTORS],
    bus: u8,
    tick_ns: u64,
    write_ns: u64,
    ticks: u64,
}

impl<W: Write> Waves<W> {
    pub(crate) fn new(out: W, timing: Timing) -> Result<Self> {
        let mut vcd = vcd::Writer::new(out);
        vcd.comment("a latch follows the data while its strobe is high")?;
        vcd.timescale(1, TimescaleUnit::NS)?;
        vcd.add_module("dancer")?;
        let data = vcd.add_wire(4, "data")?;
        let mut strobes = [data; MOTORS];
        for (number, strobe) in strobes.iter_mut().enumerate() {
            *strobe = vcd.add_wire(1, &format!("strobe{number}"))?;
        }
        let mut latches = [data; MOTORS];
        for (number, latch) in latches.iter_mut().enumerate() {
            *latch = vcd.add_wire(4, &format!("motor{number}"))?;
        }
        vcd.upscope()?;
        vcd.enddefinitions()?;
        vcd.timestamp(0)?;
        vcd.begin(SimulationCommand::Dumpvars)?;
        vcd.change_vector(data, nibble(0))?;
        for strobe in strobes {
            vcd.change_scalar(strobe, false)?;
        }
        for latch in latches {
            vcd.change_vector(latch, nibble(0))?;
        }
        vcd.end()?;
        let tick_ns = u64::from(timing.tick_us()) * 1000;
        // Three writes a motor fit into any tick.
        let writes = 3 * u64::try_from(MOTORS)? + 1;
        Ok(Self {
            vcd,
            data,
            strobes,
            latches,
            bus: 0,
            tick_ns,
            write_ns: WRITE_NS.min(tick_ns / writes),
            ticks: 0,
        })
    }

    /// The writes of one tick, through the latches.
    pub(crate) fn tick(
        &mut self,
        latches: &mut Latches<MOTORS>,
        writes: LatchWrites<MOTORS>,
    ) -> Result<()> {
        let mut ns = self.ticks * self.tick_ns;
        let mut open = None;
        for write in writes {
            let before = latches.outputs();
            latches.write(write)?;
            ns += self.write_ns;
            self.vcd.timestamp(ns)?;
            if write.data != self.bus {
                self.bus = write.data;
                self.vcd.change_vector(self.data, nibble(write.data))?;
            }
            for (number, strobe) in self.strobes.into_iter().enumerate() {
                let (was, is) = (open == Some(number), write.strobe == Some(number));
                if was != is {
                    self.vcd.change_scalar(strobe, is)?;
                }
            }
            open = write.strobe;
            let changes = before.into_iter().zip(latches.outputs()).zip(self.latches);
            for ((before, after), latch) in changes {
                if before != after {
                    self.vcd.change_vector(latch, nibble(after))?;
                }
            }
        }
        self.ticks += 1;
        Ok(())
    }

    pub(crate) fn finish(mut self) -> Result<()> {
        self.vcd.timestamp(self.ticks * self.tick_ns)?;
        Ok(self.vcd.flush()?)
    }
}

/// The low four bits, the highest first.
fn nibble(byte: u8) -> impl Iterator<Item = Value> {
    [3, 2, 1, 0]
        .map(|bit| Value::from(byte >> bit & 1 == 1))
        .into_iter()
}
