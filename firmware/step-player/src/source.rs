//! What is played.

/// Levels of all pins from a tick on: the pins wait, then change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// Ticks since the word before: 1 to [`MAX_TICKS`](Self::MAX_TICKS). What is outside counts as
    /// the nearer end; longer waits are several words.
    pub ticks: u32,
    /// Level of each pin, the first in bit 0: up to eight.
    pub levels: u8,
}

impl Word {
    /// The longest wait, in ticks: those of 80 ms of an RP2040.
    pub const MAX_TICKS: u32 = 1_000_000;

    /// Ticks within their range.
    #[cfg(any(feature = "_rp", feature = "stm32", test))]
    pub(crate) fn wait(self) -> u32 {
        self.ticks.clamp(1, Self::MAX_TICKS)
    }
}

/// Where a player takes its words, a block at a time, and whom it tells what the pins have done.
///
/// As long as the next block is there before the pins have come to the end of the one before, words
/// follow each other to the tick. Else the pins stay as they are, and what comes then comes later.
pub trait Source {
    /// Words, one at least: all levels of a block follow each other.
    type Block: AsRef<[Word]>;
    /// What is so when the pins have come to the end of a block.
    type End: Copy;

    /// The next block, when there is one. Given up, it loses none.
    fn next_block(&self) -> impl Future<Output = Self::Block>;

    /// The next block, if there is one already.
    fn try_next_block(&self) -> Option<Self::Block>;

    /// What is so at the end of a block.
    fn end(block: &Self::Block) -> Self::End;

    /// The pins have come to the end of a block. Nobody cares unless the source does.
    fn played(&self, end: Self::End) {
        let _ = end;
    }

    /// The pins have come to the end of a block, or nearly, and there is no other.
    fn ran_out_after(&self, end: Self::End) {
        let _ = end;
    }
}
