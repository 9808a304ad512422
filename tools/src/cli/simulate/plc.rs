//! A PLC that serves RK512.

use alloc::collections::{BTreeMap, VecDeque};
use core::{array, time::Duration};

use anyhow::{Result, anyhow, ensure};
use rk512::{AbandonCause, Config, DataBlock, Memory, Server, ServerEvent};
use serde::Deserialize;

use super::Partner;
use crate::{settings, text};

/// Data blocks that a file may have.
const BLOCKS: usize = 64;

pub(super) struct Plc {
    areas: Areas,
    server: Server,
    notes: VecDeque<String>,
}

/// The memory of the PLC.
#[derive(Default)]
struct Areas {
    blocks: Vec<Block>,
    inputs: Vec<u8>,
    outputs: Vec<u8>,
    flags: Vec<u8>,
    timers: Vec<u8>,
    counters: Vec<u8>,
}

struct Block {
    is_extended: bool,
    number: u8,
    bytes: Vec<u8>,
}

/// As it stands in a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
struct File {
    db: BTreeMap<String, Content>,
    dx: BTreeMap<String, Content>,
    inputs: Content,
    outputs: Content,
    flags: Content,
    timers: Content,
    counters: Content,
}

/// Bytes in hexadecimal, or how many of them are 0.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "bytes in hexadecimal, or their number up to 65535"
)]
enum Content {
    Zeros(u16),
    Hex(String),
}

impl Default for Content {
    fn default() -> Self {
        Self::Zeros(0)
    }
}

impl Content {
    fn bytes(self, name: &str) -> Result<Vec<u8>> {
        match self {
            Self::Zeros(count) => Ok(vec![0; count.into()]),
            Self::Hex(hex) => {
                let bytes = text::bytes(hex.split_whitespace());
                bytes.map_err(|error| anyhow!("{name}: {error}"))
            }
        }
    }
}

impl Plc {
    /// From the memory as TOML.
    pub(super) fn new(text: &str) -> Result<Self> {
        let file: File = settings::parse(text)?;
        let mut blocks = Vec::new();
        for (kind, list) in [("db", file.db), ("dx", file.dx)] {
            for (number, content) in list {
                let name = format!("{kind}.{number}");
                blocks.push(Block {
                    is_extended: kind == "dx",
                    number: number
                        .parse()
                        .map_err(|_| anyhow!("{name}: a block has a number from 0 to 255"))?,
                    bytes: content.bytes(&name)?,
                });
            }
        }
        let count = blocks.len();
        ensure!(count <= BLOCKS, "{count} data blocks: at most {BLOCKS}");
        Ok(Self {
            areas: Areas {
                blocks,
                inputs: file.inputs.bytes("inputs")?,
                outputs: file.outputs.bytes("outputs")?,
                flags: file.flags.bytes("flags")?,
                timers: file.timers.bytes("timers")?,
                counters: file.counters.bytes("counters")?,
            },
            server: Server::new(Config::DEFAULT),
            notes: VecDeque::new(),
        })
    }

    fn note_events(&mut self) {
        while let Some(event) = self.server.poll_event() {
            self.notes.push_back(match event {
                ServerEvent::Served(command) => format!("served {command}"),
                ServerEvent::Refused(error) => format!("refused: {error}"),
                ServerEvent::Abandoned(command, cause) => {
                    format!("abandoned {command}: {}", sentence(cause))
                }
                other => format!("{other:?}"),
            });
        }
    }
}

const fn sentence(cause: AbandonCause) -> &'static str {
    match cause {
        AbandonCause::NoContinuation => "the continuation did not come",
        AbandonCause::NewCommand => "another command came",
        AbandonCause::Transport => "the reaction was not delivered",
        _ => "given up",
    }
}

impl Areas {
    fn memory(&mut self) -> Memory<'_, BLOCKS> {
        let mut blocks = self.blocks.iter_mut();
        let blocks = array::from_fn(|_| match blocks.next() {
            Some(block) if block.is_extended => DataBlock::dx(block.number, &mut block.bytes),
            Some(block) => DataBlock::db(block.number, &mut block.bytes),
            None => DataBlock::db(0, &mut []),
        });
        Memory {
            blocks,
            inputs: &mut self.inputs,
            outputs: &mut self.outputs,
            flags: &mut self.flags,
            timers: &mut self.timers,
            counters: &mut self.counters,
        }
    }
}

impl Partner for Plc {
    fn receive(&mut self, _now: Duration, telegram: &[u8]) {
        self.server.handle_block(telegram, &mut self.areas.memory());
        self.note_events();
    }

    fn poll_transmit(&mut self, _now: Duration) -> Option<Vec<u8>> {
        let telegram = self.server.poll_transmit()?;
        Some(telegram.to_vec())
    }

    fn handle_outcome(&mut self, now: Duration, is_sent: bool) {
        if is_sent {
            self.server.handle_delivered(now);
        } else {
            self.server.handle_failed(&mut self.areas.memory());
        }
        self.note_events();
    }

    fn handle_timeout(&mut self, now: Duration) {
        self.server.handle_timeout(now, &mut self.areas.memory());
        self.note_events();
    }

    fn poll_timeout(&self) -> Option<Duration> {
        self.server.poll_timeout()
    }

    fn wants_recall(&self) -> bool {
        self.server.wants_recall()
    }

    fn poll_note(&mut self) -> Option<String> {
        self.notes.pop_front()
    }

    fn order(&mut self, line: &str) -> Result<(), String> {
        Err(format!("`{line}`: a PLC takes no orders"))
    }
}
