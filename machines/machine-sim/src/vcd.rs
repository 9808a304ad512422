//! Pins and buses over time as a value change dump, for GTKWave or PulseView.

use core::fmt;
use std::io::{self, Write};

use thiserror::Error;
use vcd::{IdCode, SimulationCommand, TimescaleUnit, Value, Writer};

/// A pin or a bus of a dump.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wire {
    name: String,
    bits: u8,
}

impl Wire {
    /// One bit.
    pub fn pin(name: impl Into<String>) -> Self {
        Self::bus(name, 1)
    }

    /// Several bits, of which 64 can be other than 0.
    pub fn bus(name: impl Into<String>, bits: u8) -> Self {
        let name = name.into();
        Self { name, bits }
    }
}

/// Why a change cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum VcdError {
    /// The dump is written in the order of time.
    #[error("a change at {ns} ns after one at {last_ns} ns")]
    Backwards {
        /// Time of the change.
        ns: u64,
        /// Time of the change before.
        last_ns: u64,
    },
    /// There are fewer wires.
    #[error("wire {wire} of {wires}")]
    NoSuchWire {
        /// Its index.
        wire: usize,
        /// How many there are.
        wires: usize,
    },
    /// What takes the dump does not.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Writes a dump as the changes come, in constant memory; all wires begin at 0.
///
/// # Examples
/// ```
/// use machine_sim::{VcdWriter, Wire};
/// let mut dump = Vec::new();
/// let wires = [Wire::pin("step"), Wire::bus("data", 4)];
/// let mut vcd = VcdWriter::new(&mut dump, "arm", "step is high while a pulse lasts", &wires)?;
/// vcd.set(1000, 0, 1)?;
/// vcd.set(1000, 1, 0b1001)?;
/// vcd.finish(2000)?;
/// let dump = String::from_utf8(dump)?;
/// assert!(dump.ends_with("#1000\n1!\nb1001 \"\n#2000\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct VcdWriter<W: Write> {
    vcd: Writer<W>,
    wires: Vec<Line>,
    last_ns: u64,
}

#[derive(Debug)]
struct Line {
    code: IdCode,
    bits: u8,
    value: u64,
}

impl<W: Write> fmt::Debug for VcdWriter<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VcdWriter")
            .field("wires", &self.wires)
            .field("last_ns", &self.last_ns)
            .finish_non_exhaustive()
    }
}

impl<W: Write> VcdWriter<W> {
    /// Begins a dump of a module's wires, with a comment for its reader.
    ///
    /// # Errors
    /// `out` does not take it.
    pub fn new(out: W, module: &str, comment: &str, wires: &[Wire]) -> io::Result<Self> {
        let mut vcd = Writer::new(out);
        vcd.comment(comment)?;
        vcd.timescale(1, TimescaleUnit::NS)?;
        vcd.add_module(module)?;
        let lines = wires.iter().map(|wire| {
            Ok(Line {
                code: vcd.add_wire(u32::from(wire.bits), &wire.name)?,
                bits: wire.bits,
                value: 0,
            })
        });
        let wires = lines.collect::<io::Result<Vec<_>>>()?;
        vcd.upscope()?;
        vcd.enddefinitions()?;
        vcd.timestamp(0)?;
        vcd.begin(SimulationCommand::Dumpvars)?;
        for wire in &wires {
            write_value(&mut vcd, wire)?;
        }
        vcd.end()?;
        Ok(Self {
            vcd,
            wires,
            last_ns: 0,
        })
    }

    /// A wire, by its index, has a value from here on.
    ///
    /// # Errors
    /// An earlier time than that of the change before, no such wire, or `out` does not take it.
    pub fn set(&mut self, ns: u64, wire: usize, value: u64) -> Result<(), VcdError> {
        let wires = self.wires.len();
        let line = self.wires.get_mut(wire);
        let line = line.ok_or(VcdError::NoSuchWire { wire, wires })?;
        if line.value != value {
            line.value = value;
            stamp(&mut self.vcd, &mut self.last_ns, ns)?;
            write_value(&mut self.vcd, line)?;
        }
        Ok(())
    }

    /// Ends the dump at a time.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn finish(mut self, ns: u64) -> Result<(), VcdError> {
        stamp(&mut self.vcd, &mut self.last_ns, ns)?;
        Ok(self.vcd.flush()?)
    }
}

fn stamp<W: Write>(vcd: &mut Writer<W>, last_ns: &mut u64, ns: u64) -> Result<(), VcdError> {
    if ns < *last_ns {
        let last_ns = *last_ns;
        return Err(VcdError::Backwards { ns, last_ns });
    }
    if ns > *last_ns {
        *last_ns = ns;
        vcd.timestamp(ns)?;
    }
    Ok(())
}

fn write_value<W: Write>(vcd: &mut Writer<W>, wire: &Line) -> io::Result<()> {
    // Above its 64 bits a value is 0.
    let bit = |bit: u8| Value::from(wire.value.checked_shr(bit.into()).unwrap_or(0) & 1 == 1);
    match wire.bits {
        1 => vcd.change_scalar(wire.code, bit(0)),
        bits => vcd.change_vector(wire.code, (0..bits).rev().map(bit)),
    }
}
