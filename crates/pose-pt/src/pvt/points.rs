//! The points of a table: rows of `path-timing` as those of a platform.

use core::iter::FusedIterator;

use nalgebra::Vector3;
use path_timing::{Row, Rows};

use super::PvtTable;
use super::moving::Moving;

/// A line of a PVT table: where every axis is at a time, and how fast it moves then.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct PvtPoint<const N: usize> {
    /// Seconds since the start.
    pub time_s: f64,
    /// Seconds since the point before; zero at the first.
    pub segment_s: f64,
    /// Coordinates of each locator's three axes.
    pub axes: [Vector3<f64>; N],
    /// Speeds of each locator's three axes, per second.
    pub velocities: [Vector3<f64>; N],
}

impl<const N: usize> PvtPoint<N> {
    pub(crate) fn new(row: &Row<[[f64; 3]; N]>) -> Self {
        Self {
            time_s: row.time_s,
            segment_s: row.duration_s,
            axes: row.position.map(Vector3::from),
            velocities: row.velocity.map(Vector3::from),
        }
    }

    /// The same as a row.
    pub(super) fn row(&self) -> Row<[[f64; 3]; N]> {
        Row {
            time_s: self.time_s,
            duration_s: self.segment_s,
            position: self.axes.map(Into::into),
            velocity: self.velocities.map(Into::into),
        }
    }
}

/// The points of a [`PvtTable`].
#[derive(Debug, Clone)]
pub struct PvtPoints<'a, const N: usize> {
    rows: Rows<'a, Moving<'a, N>>,
    /// The only point where nothing moves.
    still: Option<PvtPoint<N>>,
}

impl<'a, const N: usize> PvtPoints<'a, N> {
    pub(super) fn new(table: &PvtTable<'a, N>) -> Self {
        Self {
            rows: table.table.rows(),
            still: table.still_point(),
        }
    }

    /// The moving leg, from 0, on which the segment before the next point lies.
    pub(super) fn leg(&self) -> usize {
        self.rows.leg()
    }
}

impl<const N: usize> Iterator for PvtPoints<'_, N> {
    type Item = PvtPoint<N>;

    fn next(&mut self) -> Option<PvtPoint<N>> {
        if let Some(point) = self.still.take() {
            return Some(point);
        }
        let Ok(row) = self.rows.next()?;
        Some(PvtPoint::new(&row))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let remaining = self
            .rows
            .len()
            .saturating_add(usize::from(self.still.is_some()));
        (remaining, Some(remaining))
    }
}

impl<const N: usize> ExactSizeIterator for PvtPoints<'_, N> {}

impl<const N: usize> FusedIterator for PvtPoints<'_, N> {}
