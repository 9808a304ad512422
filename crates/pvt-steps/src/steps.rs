//! The steps of N axes in time order.

use crate::axis::AxisSegments;
use crate::row::{PvtKnot, PvtRow};
use crate::row_error::RowError;
use crate::segment::SegmentPlayer;
use crate::{Direction, MinIntervals};

/// One step of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Step {
    /// Time since the start, in ticks.
    pub ticks: u64,
    /// Index of the axis.
    pub axis: usize,
    /// Its direction.
    pub direction: Direction,
}

/// No step left in the row. None falls there: rows of 2^32 ticks would have to sum up to it.
const NEVER: u64 = u64::MAX;

/// The steps of N axes along the cubics of a PVT table, in time order; those of the same tick in
/// axis order.
#[derive(Clone, Debug)]
#[must_use = "iterators are lazy"]
pub struct PvtSteps<const N: usize> {
    /// The next step of each axis.
    ticks: [u64; N],
    directions: [Direction; N],
    players: [SegmentPlayer; N],
    axes: [AxisSegments; N],
    /// The last step of each axis before the present row.
    last_ticks: [u64; N],
}

impl<const N: usize> PvtSteps<N> {
    /// N axes at their knots.
    pub fn new(start: [PvtKnot; N], min_intervals: MinIntervals) -> Self {
        Self {
            ticks: [NEVER; N],
            directions: [Direction::Positive; N],
            players: [const { SegmentPlayer::new() }; N],
            axes: start.map(|knot| AxisSegments::new(knot, min_intervals)),
            last_ticks: [0; N],
        }
    }

    /// Takes the next row.
    ///
    /// # Errors
    /// [`RowError`]: the whole row is checked here, and the state is as before then.
    pub fn push(&mut self, row: &PvtRow<N>) -> Result<(), RowError> {
        let mut starts = [const { None }; N];
        let axes = self.axes.iter().zip(row.knots).enumerate();
        for (start, (index, (axis, knot))) in starts.iter_mut().zip(axes) {
            *start = axis.check(index, row.ticks, knot)?;
        }
        for ((axis, knot), start) in self.axes.iter_mut().zip(row.knots).zip(starts) {
            axis.begin(row.ticks, knot, start);
        }
        for (axis, last) in self.last_ticks.into_iter().enumerate() {
            self.load(axis, last);
        }
        Ok(())
    }

    /// Takes the next segment of an axis whose last step was at `last`.
    #[inline(never)]
    fn load(&mut self, axis: usize, last: u64) -> Option<()> {
        let ticks = self.ticks.get_mut(axis)?;
        match self.axes.get_mut(axis)?.next() {
            Some(segment) => {
                *self.directions.get_mut(axis)? = segment.direction();
                *ticks = last.wrapping_add(self.players.get_mut(axis)?.load(&segment));
            }
            None => {
                *ticks = NEVER;
                *self.last_ticks.get_mut(axis)? = last;
            }
        }
        Some(())
    }

    /// Whole steps from zero of each axis, after all steps of the present row.
    #[must_use]
    pub fn steps(&self) -> [i64; N] {
        self.axes.each_ref().map(AxisSegments::steps)
    }

    /// The end of the present row, in ticks since the start.
    #[must_use]
    pub fn end_ticks(&self) -> u64 {
        self.axes.first().map_or(0, AxisSegments::end_ticks)
    }
}

impl<const N: usize> Iterator for PvtSteps<N> {
    type Item = Step;

    /// The next step of the present row; `None` when the next row may come.
    #[inline]
    fn next(&mut self) -> Option<Step> {
        let mut first = NEVER;
        let mut axis = 0;
        for (index, &ticks) in self.ticks.iter().enumerate() {
            if ticks < first {
                first = ticks;
                axis = index;
            }
        }
        if first == NEVER {
            return None;
        }
        let step = Step {
            ticks: first,
            axis,
            direction: *self.directions.get(axis)?,
        };
        match self.players.get_mut(axis)?.next() {
            Some(interval) => {
                *self.ticks.get_mut(axis)? = first.wrapping_add(u64::from(interval));
            }
            None => self.load(axis, first)?,
        }
        Some(step)
    }
}
