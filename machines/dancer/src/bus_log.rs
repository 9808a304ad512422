//! Bus, strobes and latches over time as a value change dump, for GTKWave or PulseView.

use std::io::Write;

use anyhow::Result;
use machine_sim::{VcdWriter, Wire};
use motor_phases::{LatchWrites, Latches};
use pattern_codec::dance::Timing;

use crate::MOTORS;

/// From one write of the bus to the next: two machine cycles of a 8051 at 12 MHz.
const WRITE_NS: u64 = 2000;

/// The wires: those of the bus, then a strobe for each motor, then what its latch holds.
const DATA: usize = 0;
const STROBE: usize = 1;
const LATCH: usize = STROBE + MOTORS;

/// Writes `dance.vcd` as the bus is written.
#[derive(Debug)]
pub(crate) struct BusLog<W: Write> {
    vcd: VcdWriter<W>,
    tick_ns: u64,
    write_ns: u64,
    ticks: u64,
}

impl<W: Write> BusLog<W> {
    pub(crate) fn new(out: W, timing: Timing) -> Result<Self> {
        let strobes = (0..MOTORS).map(|motor| Wire::pin(format!("strobe{motor}")));
        let latches = (0..MOTORS).map(|motor| Wire::bus(format!("motor{motor}"), 4));
        let wires: Vec<_> = [Wire::bus("data", 4)]
            .into_iter()
            .chain(strobes)
            .chain(latches)
            .collect();
        let comment = "a latch follows the data while its strobe is high";
        let tick_ns = u64::from(timing.tick_us()) * 1000;
        // Three writes a motor fit into any tick.
        let writes = 3 * u64::try_from(MOTORS)? + 1;
        Ok(Self {
            vcd: VcdWriter::new(out, "dancer", comment, &wires)?,
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
        for write in writes {
            latches.write(write)?;
            ns += self.write_ns;
            self.vcd.set(ns, DATA, nibble(write.data))?;
            for motor in 0..MOTORS {
                let is_open = write.strobe == Some(motor);
                self.vcd.set(ns, STROBE + motor, is_open.into())?;
            }
            for (motor, byte) in latches.outputs().into_iter().enumerate() {
                self.vcd.set(ns, LATCH + motor, nibble(byte))?;
            }
        }
        self.ticks += 1;
        Ok(())
    }

    pub(crate) fn finish(self) -> Result<()> {
        Ok(self.vcd.finish(self.ticks * self.tick_ns)?)
    }
}

/// The four bits that the bus has.
const fn nibble(byte: u8) -> u64 {
    byte as u64 & 0xF
}
