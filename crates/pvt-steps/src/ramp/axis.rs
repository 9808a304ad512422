//! The edges of one axis of a ramp.

use super::rows::AxisRows;
use crate::{AxisSegments, MinIntervals, SegmentPlayer};
use core::iter::FusedIterator;

/// The edges of one axis of a [`Ramp`](crate::Ramp): an iterator of the intervals between them, in
/// ticks.
///
/// Most edges cost the three additions of a [`SegmentPlayer`]; one in some dozens makes the next
/// segment. An interrupt handler that cannot wait for that plays segments that the main loop makes
/// from [`Ramp::rows`](crate::Ramp::rows) by [`AxisSegments`]. No panic.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct AxisRamp {
    rows: AxisRows,
    segments: AxisSegments,
    player: SegmentPlayer,
    pulse_ticks: u64,
    /// Ticks of the pulse before the next edge, if it begins a pulse.
    since_step: u64,
    edges_left: u32,
}

impl AxisRamp {
    pub(super) fn new(rows: AxisRows, pulse_ticks: u64, steps: i32) -> Self {
        // A plan keeps the least intervals of any driver by itself.
        let min_intervals = MinIntervals {
            step_ticks: 0,
            reversal_ticks: 0,
        };
        Self {
            segments: AxisSegments::new(rows.knot(), min_intervals),
            rows,
            player: SegmentPlayer::new(),
            pulse_ticks,
            since_step: 0,
            // 2n in all, which fits.
            edges_left: steps.unsigned_abs().wrapping_mul(2),
        }
    }

    /// Edges still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        u64::from(self.edges_left)
    }

    /// Ticks from the last step, or the start, to the next one.
    fn next_step(&mut self) -> Option<u64> {
        loop {
            if let Some(ticks) = self.player.next() {
                return Some(u64::from(ticks));
            }
            if let Some(segment) = self.segments.next() {
                return Some(self.player.load(&segment));
            }
            let (ticks, knot) = self.rows.next()?;
            self.segments.push_one_way(ticks, knot);
        }
    }
}

impl Iterator for AxisRamp {
    type Item = u64;

    #[inline]
    fn next(&mut self) -> Option<u64> {
        self.edges_left = self.edges_left.checked_sub(1)?;
        // An even number is left after the end of a pulse.
        if self.edges_left & 1 == 0 {
            self.since_step = self.pulse_ticks;
            return Some(self.pulse_ticks);
        }
        let ticks = self.next_step()?;
        Some(ticks.wrapping_sub(self.since_step))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::try_from(self.edges_left);
        (left.unwrap_or(usize::MAX), left.ok())
    }
}

impl FusedIterator for AxisRamp {}
