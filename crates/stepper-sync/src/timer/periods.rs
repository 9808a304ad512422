//! Long intervals as periods of one timer.

use super::CounterWidth;
use crate::edges::size_of_rest;
use core::iter::FusedIterator;

/// Periods of one timer that sum to a longer interval: an iterator of ticks.
///
/// ```text
/// left > 2·max          a full period, max = 2^width
/// max < left <= 2·max   the larger half, then the rest
/// left <= max           left
/// ```
/// That is ceil(interval / max) periods, the fewest possible, none shorter than max / 2 unless the
/// interval itself is. No division.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct Periods {
    left: u64,
    width: CounterWidth,
}

impl Periods {
    pub(super) const fn new(ticks: u64, width: CounterWidth) -> Self {
        Self { left: ticks, width }
    }

    pub(super) const fn is_over(&self) -> bool {
        self.left == 0
    }

    /// Periods still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        // ceil(left / 2^bits) without the sum that could overflow.
        let full = self.left >> self.width.bits();
        let part = u64::from(self.left & self.width.max_value() != 0);
        full.wrapping_add(part)
    }
}

impl Iterator for Periods {
    type Item = u64;

    #[inline]
    fn next(&mut self) -> Option<u64> {
        let max = self.width.max_ticks();
        let period = match self.left {
            0 => return None,
            left if left <= max => left,
            // The two halves; 2 max <= 2^33.
            left if left <= max << 1 => left.wrapping_sub(left >> 1),
            _ => max,
        };
        self.left = self.left.wrapping_sub(period);
        Some(period)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl FusedIterator for Periods {}
