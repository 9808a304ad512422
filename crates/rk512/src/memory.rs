//! A ready data source: the memory of a simulated PLC.

use crate::area::AreaKind;
use crate::command::Command;
use crate::coordination::CoordinationFlag;
use crate::reaction::ReactionError;
use crate::source::DataSource;

/// One DB or DX over the caller's bytes: data words, high byte first.
#[derive(Debug)]
pub struct DataBlock<'a> {
    kind: AreaKind,
    number: u8,
    bytes: &'a mut [u8],
}

impl<'a> DataBlock<'a> {
    /// Data block `number`; an odd last byte is out of reach.
    #[must_use]
    pub const fn db(number: u8, bytes: &'a mut [u8]) -> Self {
        let kind = AreaKind::DataBlock;
        Self {
            kind,
            number,
            bytes,
        }
    }

    /// Extended data block `number`; an odd last byte is out of reach.
    #[must_use]
    pub const fn dx(number: u8, bytes: &'a mut [u8]) -> Self {
        let kind = AreaKind::ExtendedDataBlock;
        Self {
            kind,
            number,
            bytes,
        }
    }
}

/// Memory of a simulated PLC with `B` data blocks, all over the caller's bytes.
///
/// ```
/// use rk512::{DataBlock, Memory};
///
/// let (mut db5, mut flags) = ([0; 200], [0; 32]);
/// let plc = Memory {
///     flags: &mut flags,
///     ..Memory::new([DataBlock::db(5, &mut db5)])
/// };
/// ```
/// It refuses what a PLC refuses: a missing block or one that is too short (14h), an area that it
/// does not have (12h), a set coordination flag (32h), one outside its flags (0Ah). When a job's
/// data have moved it sets the job's coordination flag. CPU numbers are ignored.
///
/// A SEND of more than 128 bytes is visible from its first telegram on, whether or not the rest
/// comes.
#[derive(Debug)]
#[expect(
    clippy::exhaustive_structs,
    reason = "the areas of a PLC, to be written as a literal on top of none"
)]
pub struct Memory<'a, const B: usize> {
    /// Data blocks; of two with the same number the first counts.
    pub blocks: [DataBlock<'a>; B],
    /// Inputs.
    pub inputs: &'a mut [u8],
    /// Outputs.
    pub outputs: &'a mut [u8],
    /// Flags; coordination flags are among them.
    pub flags: &'a mut [u8],
    /// Timers, two bytes each.
    pub timers: &'a mut [u8],
    /// Counters, two bytes each.
    pub counters: &'a mut [u8],
}

impl<'a, const B: usize> Memory<'a, B> {
    /// Memory with data blocks alone.
    #[must_use]
    pub const fn new(blocks: [DataBlock<'a>; B]) -> Self {
        Self {
            blocks,
            inputs: &mut [],
            outputs: &mut [],
            flags: &mut [],
            timers: &mut [],
            counters: &mut [],
        }
    }

    /// The bytes of an area; `number` is that of a DB or DX, else 0. `None` if there is no such.
    fn bytes(&mut self, kind: AreaKind, number: u8) -> Option<&mut [u8]> {
        let bytes: &mut [u8] = match kind {
            AreaKind::Inputs => self.inputs,
            AreaKind::Outputs => self.outputs,
            AreaKind::Flags => self.flags,
            AreaKind::Timers => self.timers,
            AreaKind::Counters => self.counters,
            _ => {
                return self
                    .blocks
                    .iter_mut()
                    .find(|block| block.kind == kind && block.number == number)
                    .map(|block| &mut *block.bytes);
            }
        };
        (!bytes.is_empty()).then_some(bytes)
    }

    fn area(&mut self, command: &Command) -> Result<&mut [u8], ReactionError> {
        let area = command.area();
        let missing = match area.kind() {
            AreaKind::DataBlock | AreaKind::ExtendedDataBlock => ReactionError::NoSuchBlock,
            _ => ReactionError::RequestType,
        };
        self.bytes(area.kind(), area.number()).ok_or(missing)
    }

    /// What stands `offset` bytes after the start of the job.
    fn bytes_of(
        &mut self,
        command: &Command,
        offset: usize,
        len: usize,
    ) -> Result<&mut [u8], ReactionError> {
        let start = command.byte_start() + offset;
        self.area(command)?
            .get_mut(start..)
            .and_then(|rest| rest.get_mut(..len))
            .ok_or(ReactionError::NoSuchBlock)
    }

    fn flag_byte(&mut self, flag: CoordinationFlag) -> Result<&mut u8, ReactionError> {
        self.flags
            .get_mut(usize::from(flag.byte()))
            .ok_or(ReactionError::AccessDenied)
    }
}

impl<const B: usize> DataSource for Memory<'_, B> {
    fn size(&mut self, command: &Command) -> Result<usize, ReactionError> {
        Ok(self.area(command)?.len() / command.area().kind().bytes_per_unit())
    }

    fn open(&mut self, command: &Command) -> Result<(), ReactionError> {
        match command.coordination().flag {
            Some(flag) if *self.flag_byte(flag)? & flag.mask() != 0 => Err(ReactionError::Locked),
            _ => Ok(()),
        }
    }

    fn read(
        &mut self,
        command: &Command,
        offset: usize,
        data: &mut [u8],
    ) -> Result<(), ReactionError> {
        data.copy_from_slice(self.bytes_of(command, offset, data.len())?);
        Ok(())
    }

    fn write(
        &mut self,
        command: &Command,
        offset: usize,
        data: &[u8],
    ) -> Result<(), ReactionError> {
        self.bytes_of(command, offset, data.len())?
            .copy_from_slice(data);
        Ok(())
    }

    fn close(&mut self, command: &Command) -> Result<(), ReactionError> {
        if let Some(flag) = command.coordination().flag {
            *self.flag_byte(flag)? |= flag.mask();
        }
        Ok(())
    }
}
