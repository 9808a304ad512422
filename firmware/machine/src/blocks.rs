//! From steps to blocks for the pins.

use pvt_steps::Direction;
use step_player::Word;

use crate::panel::Panel;
use crate::pulses::{Block, Pulses};
use crate::settings::Machine;

/// Longest words a second. A block that takes half as long as one is closed before another one,
/// however few words it has: so none is too short for the next one to be there in time.
const LONGEST_WORD_HZ: u32 = 200;

/// Puts the edges of steps into blocks, and these on the panel.
pub(crate) struct BlockWriter<'p, const N: usize> {
    panel: &'p Panel<N>,
    pulses: Pulses<N>,
    block: Block<N>,
    max_word_ticks: u32,
    levels: u8,
    steps: [i32; N],
}

/// The longest word of a machine.
pub(crate) fn max_word_ticks<K, const N: usize>(machine: &Machine<K, N>) -> u32 {
    (machine.tick_hz / LONGEST_WORD_HZ).max(1)
}

impl<'p, const N: usize> BlockWriter<'p, N> {
    pub(crate) fn new<K>(machine: &Machine<K, N>, panel: &'p Panel<N>) -> Self {
        let max_word_ticks = max_word_ticks(machine);
        Self {
            panel,
            pulses: Pulses::new(machine.pins, max_word_ticks),
            block: Block::default(),
            max_word_ticks,
            levels: 0,
            steps: [0; N],
        }
    }

    /// What the steps from zero are here: at rest.
    pub(crate) fn set_steps(&mut self, steps: [i32; N]) {
        self.steps = steps;
        self.panel.set_steps(steps);
    }

    /// At rest: times count from `ticks` on.
    pub(crate) fn restart(&mut self, ticks: u64) {
        self.pulses.restart(ticks);
    }

    /// A step of an axis at a tick. Steps come in the order of their times.
    pub(crate) async fn step(&mut self, axis: usize, ticks: u64, direction: Direction) {
        while let Some(word) = self.pulses.next_before(ticks) {
            self.push(word).await;
        }
        self.pulses.add(axis, ticks, direction);
    }

    /// All edges go out, and the machine rests until `ticks`, from where times count on.
    pub(crate) async fn rest(&mut self, ticks: u64) {
        self.wait(ticks).await;
        if !self.block.words.is_empty() {
            self.block.end.rests = true;
            self.put().await;
        }
    }

    /// All edges go out, with the time until a tick before `ticks`; there, more will follow in
    /// time.
    pub(crate) async fn go_on(&mut self, ticks: u64) {
        self.wait(ticks - 1).await;
        if !self.block.words.is_empty() {
            self.put().await;
        }
    }

    async fn wait(&mut self, ticks: u64) {
        while let Some(word) = self.pulses.next_before(u64::MAX) {
            self.push(word).await;
        }
        while let Some(word) = self.pulses.wait_until(ticks) {
            self.push(word).await;
        }
        self.pulses.restart(ticks);
    }

    async fn push(&mut self, word: Word) {
        let ticks = self.block.end.ticks;
        let is_long = ticks >= self.max_word_ticks / 2 && ticks + word.ticks > self.max_word_ticks;
        // Not before there is another word: the last block says that the machine rests.
        if self.block.words.is_full() || is_long {
            self.put().await;
        }
        for (axis, steps) in self.steps.iter_mut().enumerate() {
            let rises = word.levels & !self.levels;
            if rises >> (2 * axis) & 1 == 1 {
                let positive = word.levels >> (2 * axis + 1) & 1 == 1;
                *steps += if positive { 1 } else { -1 };
            }
        }
        self.levels = word.levels;
        self.block.end.ticks += word.ticks;
        // There is room.
        let _ = self.block.words.push(word);
    }

    async fn put(&mut self) {
        self.block.end.steps = self.steps;
        self.panel.put(core::mem::take(&mut self.block)).await;
    }
}
