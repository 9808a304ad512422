//! Lines of moves to any neighbour.

use super::{Line, size_of_rest};
use crate::Move;
use core::iter::FusedIterator;

/// Bresenham's line: an iterator of [`Move`]s, the longer axis in each of them.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct LineMoves {
    left: u32,
    // -1 - remainder of the shorter axis; 0 <= credit < major after each move.
    credit: i32,
    major: i32,
    minor: i32,
    straight: Move,
    diagonal: Move,
}

impl LineMoves {
    pub(super) fn new(line: &Line) -> Self {
        let [x, y] = line.axes();
        let [dx, dy] = line.to().map(i64::from);
        let ((major, straight), (minor, _)) = if x.0 >= y.0 { (x, y) } else { (y, x) };
        Self {
            left: major.unsigned_abs(),
            // A half is rounded up, as in 2 dy - dx >= 0.
            credit: major.saturating_sub(1) >> 1,
            major,
            minor,
            straight,
            diagonal: Move::of_signs(dx, dy).unwrap_or(straight),
        }
    }

    /// Moves still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.left.into()
    }
}

impl Iterator for LineMoves {
    type Item = Move;

    #[inline]
    fn next(&mut self) -> Option<Move> {
        self.left = self.left.checked_sub(1)?;
        // 0 <= minor <= major and 0 <= credit < major: no overflow either way.
        let credit = self.credit.wrapping_sub(self.minor);
        let (carry, step) = if credit < 0 {
            (self.major, self.diagonal)
        } else {
            (0, self.straight)
        };
        self.credit = credit.wrapping_add(carry);
        Some(step)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl FusedIterator for LineMoves {}
