//! From steps to blocks for the pins.

use pvt_steps::Direction;

use crate::panel::Panel;
use crate::pulses::{Block, Pulses, Word};
use crate::settings::Machine;

/// Blocks a second, at least: a block is closed when it takes longer, however few words it has.
const BLOCK_HZ: u32 = 200;

/// Puts the edges of steps into blocks, and these on the panel.
pub(crate) struct BlockWriter<'p> {
    panel: &'p Panel,
    pulses: Pulses,
    block: Block,
    block_ticks: u32,
    max_block_ticks: u32,
    levels: u8,
    steps: [i32; 2],
}

impl<'p> BlockWriter<'p> {
    pub(crate) fn new(machine: &Machine, panel: &'p Panel) -> Self {
        let max_block_ticks = (machine.tick_hz / BLOCK_HZ).max(1);
        Self {
            panel,
            pulses: Pulses::new(machine.pins, max_block_ticks),
            block: Block::default(),
            block_ticks: 0,
            max_block_ticks,
            levels: 0,
            steps: [0; 2],
        }
    }

    /// What the steps from zero are here: at rest.
    pub(crate) fn set_steps(&mut self, steps: [i32; 2]) {
        self.steps = steps;
        self.panel.set_steps(steps);
    }

    /// At rest: times count from `ticks` on.
    pub(crate) fn restart(&mut self, ticks: u64) {
        self.pulses.restart(ticks);
    }

    /// A step of a joint, 0 or 1, at a tick. Steps come in the order of their times.
    pub(crate) async fn step(&mut self, joint: usize, ticks: u64, direction: Direction) {
        while let Some(word) = self.pulses.next_before(ticks) {
            self.push(word).await;
        }
        self.pulses.add(joint, ticks, direction);
    }

    /// All edges go out, and the machine rests until `ticks`, from where times count on.
    pub(crate) async fn rest(&mut self, ticks: u64) {
        while let Some(word) = self.pulses.next_before(u64::MAX) {
            self.push(word).await;
        }
        while let Some(word) = self.pulses.wait_until(ticks) {
            self.push(word).await;
        }
        self.pulses.restart(ticks);
        if !self.block.words.is_empty() {
            self.block.end.rests = true;
            self.put().await;
        }
    }

    async fn push(&mut self, word: Word) {
        let is_long = self.block_ticks + word.ticks > self.max_block_ticks;
        // Not before there is another word: the last block says that the machine rests.
        if self.block.words.is_full() || (is_long && !self.block.words.is_empty()) {
            self.put().await;
        }
        for (joint, steps) in self.steps.iter_mut().enumerate() {
            let rises = word.levels & !self.levels;
            if rises >> (2 * joint) & 1 == 1 {
                let positive = word.levels >> (2 * joint + 1) & 1 == 1;
                *steps += if positive { 1 } else { -1 };
            }
        }
        self.levels = word.levels;
        self.block_ticks += word.ticks;
        // There is room.
        let _ = self.block.words.push(word);
    }

    async fn put(&mut self) {
        self.block.end.steps = self.steps;
        self.block_ticks = 0;
        self.panel.put(core::mem::take(&mut self.block)).await;
    }
}
