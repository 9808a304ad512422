//! The points of a table: rows of `path-timing` as those of a platform.

use core::iter::FusedIterator;

use nalgebra::Vector3;
use path_timing::{Row, Rows};

use super::PvtTable;

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
}

/// The points of a [`PvtTable`].
#[derive(Debug, Clone)]
pub struct PvtPoints<'a, const N: usize> {
    rows: Rows<'a, [[f64; 3]; N]>,
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
}

impl<const N: usize> Iterator for PvtPoints<'_, N> {
    type Item = PvtPoint<N>;

    fn next(&mut self) -> Option<PvtPoint<N>> {
        if let Some(point) = self.still.take() {
            return Some(point);
        }
        self.rows.next().as_ref().map(PvtPoint::new)
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
