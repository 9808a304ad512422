//! From steps to levels of pins.

use heapless::Vec;
use pvt_steps::Direction;
use step_player::Word;

use crate::settings::PinTicks;

/// The most words of a block.
const MAX_WORDS: usize = 64;

/// Words that are handed to a board at a time. Bit 0 of their levels steps the first axis, bit 1 is
/// its direction, bits 2 and 3 are the second's, bits 4 and 5 the third's.
#[derive(Clone, Debug)]
pub struct Block<const N: usize> {
    /// At least one; each waits for 5 ms at the most.
    pub words: Vec<Word, MAX_WORDS>,
    /// What is so when all are played.
    pub end: BlockEnd<N>,
}

impl<const N: usize> AsRef<[Word]> for Block<N> {
    fn as_ref(&self) -> &[Word] {
        &self.words
    }
}

impl<const N: usize> Default for Block<N> {
    fn default() -> Self {
        Self {
            words: Vec::new(),
            end: BlockEnd::default(),
        }
    }
}

/// What is so at the end of a block, to be told to the [`Panel`](crate::Panel).
#[derive(Clone, Copy, Debug)]
pub struct BlockEnd<const N: usize> {
    /// Steps of all axes from zero.
    pub(crate) steps: [i32; N],
    /// The time of the block.
    pub(crate) ticks: u32,
    /// Whether the machine rests: no block needs to follow at once.
    pub(crate) rests: bool,
}

impl<const N: usize> Default for BlockEnd<N> {
    fn default() -> Self {
        Self {
            steps: [0; N],
            ticks: 0,
            rests: false,
        }
    }
}

/// The edges of step and direction pins, from steps in time order.
///
/// A step at tick t is a change of direction at t, if there is one, the start of the pulse at t and
/// the setup time, its end the pulse time later: so all pulses are late by the setup time, and
/// their intervals are those of the steps.
#[derive(Clone, Debug)]
pub(crate) struct Pulses<const N: usize> {
    pins: PinTicks,
    max_ticks: u32,
    levels: u8,
    /// The tick of the last word.
    last_ticks: u64,
    /// Of each axis: change of direction, start and end of the pulse.
    edges: [[Option<Edge>; 3]; N],
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    ticks: u64,
    mask: u8,
    high: bool,
}

impl<const N: usize> Pulses<N> {
    /// For words of at most `max_ticks`; all pins are low.
    pub(crate) const fn new(pins: PinTicks, max_ticks: u32) -> Self {
        Self {
            pins,
            max_ticks,
            levels: 0,
            last_ticks: 0,
            edges: [[None; 3]; N],
        }
    }

    /// After a rest, when all edges are out: the next step's time counts from `ticks`.
    pub(crate) fn restart(&mut self, ticks: u64) {
        self.last_ticks = ticks;
    }

    /// The edges of a step of an axis. Those before `ticks` have been taken, so that none of
    /// the axis' step before are left, as [`PinTicks::step`] makes it.
    pub(crate) fn add(&mut self, axis: usize, ticks: u64, direction: Direction) {
        let high = direction == Direction::Positive;
        let (step_mask, direction_mask) = (1 << (2 * axis), 2 << (2 * axis));
        let start = ticks + self.pins.setup;
        let edge = |ticks, mask, high| Some(Edge { ticks, mask, high });
        if let Some(edges) = self.edges.get_mut(axis) {
            *edges = [
                edge(ticks, direction_mask, high),
                edge(start, step_mask, true),
                edge(start + self.pins.pulse, step_mask, false),
            ];
        }
    }

    /// The next word of edges before a tick.
    pub(crate) fn next_before(&mut self, before: u64) -> Option<Word> {
        let edges = || self.edges.iter().flatten().flatten();
        let next = edges().map(|edge| edge.ticks).min()?;
        if next >= before {
            return None;
        }
        let wait = next.saturating_sub(self.last_ticks);
        if wait > u64::from(self.max_ticks) {
            return Some(self.word(self.max_ticks));
        }
        let levels_before = self.levels;
        for place in self.edges.iter_mut().flatten() {
            if let Some(edge) = place.take_if(|edge| edge.ticks == next) {
                self.levels &= !edge.mask;
                self.levels |= if edge.high { edge.mask } else { 0 };
            }
        }
        if self.levels == levels_before {
            // A direction that stays.
            return self.next_before(before);
        }
        // After a rest the last pulse may have ended later than that.
        Some(self.word(wait.max(1) as u32))
    }

    /// A word without an edge, if a tick has not come.
    pub(crate) fn wait_until(&mut self, ticks: u64) -> Option<Word> {
        let wait = ticks.saturating_sub(self.last_ticks);
        (wait > 0).then(|| self.word(wait.min(self.max_ticks.into()) as u32))
    }

    fn word(&mut self, ticks: u32) -> Word {
        self.last_ticks += u64::from(ticks);
        Word {
            ticks,
            levels: self.levels,
        }
    }
}
