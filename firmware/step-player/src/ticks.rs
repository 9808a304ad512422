//! Blocks change by change.

use crate::{Source, Word};

/// Takes blocks of a source apart into ticks.
pub(crate) struct Ticks<S: Source> {
    block: Option<S::Block>,
    next: usize,
    /// Of the next word.
    left: u32,
    /// Of the block before, until the source has been told that there is no other.
    last: Option<S::End>,
    end: Option<S::End>,
}

impl<S: Source> Ticks<S> {
    /// At rest.
    pub(crate) const fn new() -> Self {
        Self {
            block: None,
            next: 0,
            left: 0,
            last: None,
            end: None,
        }
    }

    fn word(&self) -> Option<Word> {
        self.block.as_ref()?.as_ref().get(self.next).copied()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.word().is_none()
    }

    /// Takes the next block, where there is one.
    pub(crate) fn next_block(&mut self, source: &S) {
        match source.try_next_block() {
            Some(block) => {
                self.last = Some(S::end(&block));
                (self.block, self.next) = (Some(block), 0);
                self.left = self.word().map_or(0, Word::wait);
            }
            None => {
                if let Some(last) = self.last.take() {
                    source.ran_out_after(last);
                }
            }
        }
    }

    /// Goes on by at most so many ticks, to the next change: how many that were, and the levels of
    /// the pins in the last of them, if they change.
    pub(crate) fn advance(&mut self, most: u32) -> (u32, Option<u8>) {
        let Some(word) = self.word() else {
            return (most, None);
        };
        let ticks = self.left;
        if ticks > most {
            self.left -= most;
            return (most, None);
        }
        self.next += 1;
        match self.word() {
            Some(next) => self.left = next.wait(),
            None => self.end = self.last,
        }
        (ticks, Some(word.levels))
    }

    /// The end of the block, once.
    pub(crate) fn take_end(&mut self) -> Option<S::End> {
        self.end.take()
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use core::cell::RefCell;
    use std::collections::VecDeque;
    use std::vec::Vec;
    use std::{format, string::String, vec};

    use super::*;

    /// Blocks with their numbers, and what was told of them.
    #[derive(Default)]
    struct Recorded {
        blocks: RefCell<VecDeque<(Vec<Word>, u32)>>,
        told: RefCell<Vec<String>>,
    }

    struct Numbered(Vec<Word>, u32);

    impl AsRef<[Word]> for Numbered {
        fn as_ref(&self) -> &[Word] {
            &self.0
        }
    }

    impl Source for Recorded {
        type Block = Numbered;
        type End = u32;

        async fn next_block(&self) -> Numbered {
            core::future::pending().await
        }

        fn try_next_block(&self) -> Option<Numbered> {
            let (words, number) = self.blocks.borrow_mut().pop_front()?;
            Some(Numbered(words, number))
        }

        fn end(block: &Numbered) -> u32 {
            block.1
        }

        fn ran_out_after(&self, end: u32) {
            self.told.borrow_mut().push(format!("ran out after {end}"));
        }
    }

    fn word(ticks: u32, levels: u8) -> Word {
        Word { ticks, levels }
    }

    /// The ticks at which something was, from 1; in pieces of at most so many.
    fn play(source: &Recorded, ticks: &mut Ticks<Recorded>, count: u32, piece: u32) -> Vec<String> {
        let (mut seen, mut tick) = (Vec::new(), 0);
        while tick < count {
            if ticks.is_empty() {
                ticks.next_block(source);
            }
            let (passed, levels) = ticks.advance(piece.min(count - tick));
            assert!(passed > 0);
            tick += passed;
            if let Some(levels) = levels {
                seen.push(format!("{tick}: {levels}"));
            }
            if let Some(end) = ticks.take_end() {
                seen.push(format!("{tick}: end of {end}"));
            }
        }
        assert_eq!(tick, count);
        seen
    }

    #[test]
    fn words_follow_each_other_from_block_to_block() {
        for piece in [1, 2, 3, 20] {
            words_follow_each_other_in_pieces_of(piece);
        }
    }

    fn words_follow_each_other_in_pieces_of(piece: u32) {
        let source = Recorded::default();
        let blocks = [
            (vec![word(2, 1), word(1, 0)], 7),
            (vec![word(3, 1), word(0, 2)], 8),
        ];
        source.blocks.borrow_mut().extend(blocks);
        let mut ticks = Ticks::new();
        let seen = play(&source, &mut ticks, 20, piece);
        // A word of no ticks takes one.
        let expected = ["2: 1", "3: 0", "3: end of 7", "6: 1", "7: 2", "7: end of 8"];
        assert_eq!(seen, expected);
        assert_eq!(*source.told.borrow(), ["ran out after 8"]);
        // At rest nothing is told; what comes then comes later.
        source.blocks.borrow_mut().push_back((vec![word(1, 3)], 9));
        assert_eq!(play(&source, &mut ticks, 5, piece), ["1: 3", "1: end of 9"]);
        let told = ["ran out after 8", "ran out after 9"];
        assert_eq!(*source.told.borrow(), told);
    }
}
