//! Lines of single steps.

use super::{Line, size_of_rest};
use crate::{Move, Rule};
use core::iter::FusedIterator;

/// The single steps of a [`Line`]: an iterator of [`Move`]s of one axis.
///
/// Two comparisons and two additions a step, in 32 bits.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct LineSteps {
    left: u32,
    // F, moved by half its window for the nearest rule: -y_len <= decision < x_len.
    decision: i32,
    x_len: i32,
    y_len: i32,
    x_move: Move,
    y_move: Move,
}

impl LineSteps {
    pub(super) fn new(line: &Line, rule: Rule) -> Self {
        let [(x_len, x_move), (y_len, y_move)] = line.axes();
        let decision = match rule {
            // F = 0 would step x first, and F would never fall: with nothing to do in x, y goes.
            Rule::Published => {
                if x_len == 0 {
                    -1
                } else {
                    0
                }
            }
            // |F - ye| <= |F + xe| is F >= (ye - xe) / 2.
            Rule::Nearest => x_len.wrapping_sub(y_len) >> 1,
        };
        Self {
            // Below 2^32.
            left: x_len.unsigned_abs().wrapping_add(y_len.unsigned_abs()),
            decision,
            x_len,
            y_len,
            x_move,
            y_move,
        }
    }

    /// Steps still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.left.into()
    }
}

impl Iterator for LineSteps {
    type Item = Move;

    #[inline]
    fn next(&mut self) -> Option<Move> {
        self.left = self.left.checked_sub(1)?;
        let (change, step) = if self.decision >= 0 {
            (self.y_len.wrapping_neg(), self.x_move)
        } else {
            (self.x_len, self.y_move)
        };
        // Down from 0.. by at most y_len, up from ..-1 by at most x_len: 32 bits hold it.
        self.decision = self.decision.wrapping_add(change);
        Some(step)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl FusedIterator for LineSteps {}
