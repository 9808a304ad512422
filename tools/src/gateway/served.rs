//! Areas of RK512 that are the gateway's own: the partner fetches from them and sends to them.

use alloc::{collections::BTreeMap, sync::Arc};
use core::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use rk512::{AreaKind, Command, CoordinationFlag, DataSource, ReactionError};
use toml::Spanned;

use super::{area::Area, config, hub::Hub};

/// What stands in the areas of a line, for the line and for the task that answers the partner.
#[derive(Clone)]
pub(super) struct Memory(Arc<Mutex<Content>>);

#[derive(Default)]
struct Content {
    /// By the names of the areas.
    areas: BTreeMap<String, Vec<u8>>,
    /// Of the partner's job: what has come, or what is fetched.
    moving: Vec<u8>,
}

impl Memory {
    pub(super) fn new(areas: BTreeMap<String, Vec<u8>>) -> Self {
        let moving = Vec::new();
        Self(Arc::new(Mutex::new(Content { areas, moving })))
    }

    fn lock(&self) -> MutexGuard<'_, Content> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The areas that are served and whose kept bytes are of another length than theirs.
    pub(super) fn of_another_length<'a>(
        &self,
        line: &'a config::Line,
    ) -> impl Iterator<Item = (&'a Area, usize)> {
        let areas = line.areas.iter().map(Spanned::get_ref);
        areas.filter(|area| area.served).filter_map(|area| {
            let kept = self.lock().areas.get(area.name.as_str())?.len();
            (kept != area.bytes()).then_some((area, kept))
        })
    }

    /// What stands in an area: zeros, as long as nobody has written it in its length.
    pub(super) fn read(&self, area: &Area) -> Vec<u8> {
        let content = self.lock();
        let known = content.areas.get(area.name.as_str());
        let fits = known.filter(|bytes| bytes.len() == area.bytes());
        fits.cloned().unwrap_or_else(|| vec![0; area.bytes()])
    }

    pub(super) fn set(&self, area: &Area, bytes: Vec<u8>) {
        self.lock().areas.insert(area.name.to_string(), bytes);
    }

    /// The data of the SEND whose last telegram has just come.
    pub(super) fn take_sent(&self) -> Vec<u8> {
        core::mem::take(&mut self.lock().moving)
    }
}

/// What the partner's commands are answered from.
pub(super) struct Served {
    pub(super) hub: Arc<Hub>,
    pub(super) line: Arc<config::Line>,
    pub(super) memory: Memory,
}

impl Served {
    fn areas(&self) -> impl Iterator<Item = &Area> {
        let areas = self.line.areas.iter().map(Spanned::get_ref);
        areas.filter(|area| area.served)
    }

    /// The area in which all of a job lies, and its bytes there.
    pub(super) fn find(&self, command: &Command) -> Option<(&Area, Range<usize>)> {
        let (start, length) = (command.byte_start(), command.byte_len());
        self.areas().find_map(|area| {
            let own = area.start.0;
            let is_it =
                own.kind() == command.area().kind() && own.number() == command.area().number();
            let from = start.checked_sub(area.units().start * own.kind().bytes_per_unit())?;
            (is_it && from + length <= area.bytes()).then_some((area, from..from + length))
        })
    }

    /// The area of flags in which a coordination flag lies, and its byte there.
    pub(super) fn find_flag(&self, flag: CoordinationFlag) -> Option<(&Area, usize)> {
        let byte = usize::from(flag.byte());
        let mut flags = self
            .areas()
            .filter(|area| area.start.0.kind() == AreaKind::Flags);
        let area = flags.find(|area| area.units().contains(&byte))?;
        Some((area, byte - area.units().start))
    }

    fn refuse(&self, command: &Command, error: ReactionError) -> ReactionError {
        let name = self.line.name.get_ref().as_str();
        let message = format!("refused to the partner: {command}: {error}");
        self.hub.log_refusal(name, &message);
        error
    }
}

impl DataSource for Served {
    fn size(&mut self, command: &Command) -> Result<usize, ReactionError> {
        let (kind, number) = (command.area().kind(), command.area().number());
        let of_it = self
            .areas()
            .filter(|area| (area.start.0.kind(), area.start.0.number()) == (kind, number));
        let size = of_it.map(|area| area.units().end).max();
        size.ok_or_else(|| {
            let error = match kind {
                AreaKind::DataBlock | AreaKind::ExtendedDataBlock => ReactionError::NoSuchBlock,
                _ => ReactionError::RequestType,
            };
            self.refuse(command, error)
        })
    }

    fn open(&mut self, command: &Command) -> Result<(), ReactionError> {
        let Some((area, bytes)) = self.find(command) else {
            return Err(self.refuse(command, ReactionError::NoSuchBlock));
        };
        if let Some(flag) = command.coordination().flag {
            let Some((flags, byte)) = self.find_flag(flag) else {
                return Err(self.refuse(command, ReactionError::AccessDenied));
            };
            let flags = self.memory.read(flags);
            if flags.get(byte).is_some_and(|byte| byte & flag.mask() != 0) {
                return Err(self.refuse(command, ReactionError::Locked));
            }
        }
        // As it stands now: what is fetched is of one moment, and what is sent is not seen in part.
        let now = self.memory.read(area);
        self.memory.lock().moving = now.get(bytes).unwrap_or_default().to_vec();
        Ok(())
    }

    fn read(&mut self, _: &Command, offset: usize, data: &mut [u8]) -> Result<(), ReactionError> {
        let content = self.memory.lock();
        let moving = content.moving.get(offset..offset + data.len());
        data.copy_from_slice(moving.ok_or(ReactionError::JobFailed)?);
        Ok(())
    }

    fn write(&mut self, _: &Command, offset: usize, data: &[u8]) -> Result<(), ReactionError> {
        let mut content = self.memory.lock();
        let moving = content.moving.get_mut(offset..offset + data.len());
        moving
            .ok_or(ReactionError::JobFailed)?
            .copy_from_slice(data);
        Ok(())
    }

    /// What changes something is stored before its reaction goes out.
    fn holds(&self, command: &Command) -> bool {
        command.is_send() || command.coordination().flag.is_some()
    }
}
