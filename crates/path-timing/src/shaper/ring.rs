//! The rows within the longest delay, in memory of the caller.

use crate::{Axes, Row};

/// Rows, of which the newest takes the place of the oldest.
#[derive(Debug)]
pub(super) struct Ring<'m, A: Axes> {
    rows: &'m mut [Row<A>],
    /// Index of the row that came last.
    newest: usize,
}

impl<'m, A: Axes> Ring<'m, A> {
    pub(super) const fn new(rows: &'m mut [Row<A>]) -> Self {
        Self { rows, newest: 0 }
    }

    pub(super) const fn len(&self) -> usize {
        self.rows.len()
    }

    pub(super) fn push(&mut self, row: Row<A>) {
        self.newest = self.newest.saturating_add(1);
        if self.newest >= self.rows.len() {
            self.newest = 0;
        }
        if let Some(slot) = self.rows.get_mut(self.newest) {
            *slot = row;
        }
    }

    /// The row that so many have come after.
    #[inline]
    pub(super) fn row(&self, behind: usize) -> Option<&Row<A>> {
        let index = if self.newest >= behind {
            self.newest.wrapping_sub(behind)
        } else {
            let wrapped = self.newest.wrapping_add(self.rows.len());
            wrapped.wrapping_sub(behind)
        };
        self.rows.get(index)
    }

    /// Position and velocity of an axis at that row, and the duration of the segment before.
    #[inline]
    pub(super) fn of_axis(&self, behind: usize, axis: usize) -> Option<([f64; 2], f64)> {
        let row = self.row(behind)?;
        Some((of_axis(row, axis), row.duration_s))
    }
}

/// Position and velocity of an axis at a row.
pub(super) fn of_axis<A: Axes>(row: &Row<A>, axis: usize) -> [f64; 2] {
    let numbers = [&row.position, &row.velocity].map(Axes::as_slice);
    numbers.map(|numbers| numbers.get(axis).copied().unwrap_or(0.0))
}
