//! The points of a table, computed from its knots.

use core::iter::FusedIterator;

use nalgebra::Vector3;

use super::track::Track;
use super::{Knot, first_track, moving};
use crate::Platform;
use crate::course::Place;
use crate::path::Path;

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
    /// A place that is passed at a speed of the parameter.
    pub(crate) fn new(place: &Place<N, f64>, speed: f64, time_s: f64, segment_s: f64) -> Self {
        Self {
            time_s,
            segment_s,
            axes: place.axes,
            velocities: place.slope.map(|slope| slope * speed),
        }
    }
}

/// The points of a [`PvtTable`](super::PvtTable).
#[derive(Debug, Clone)]
pub struct PvtPoints<'a, const N: usize> {
    platform: &'a Platform<N>,
    path: Path<'a>,
    /// Knots that are still to come.
    knots: &'a [Knot],
    /// The next leg, and knots of the present one that are still to come.
    leg: usize,
    left: u32,
    track: Option<Track<'a, N>>,
    stretch: f64,
    time_s: f64,
    segment_s: f64,
    remaining: usize,
}

impl<'a, const N: usize> PvtPoints<'a, N> {
    pub(super) fn new(
        platform: &'a Platform<N>,
        path: &Path<'a>,
        knots: &'a [Knot],
        stretch: f64,
        points: usize,
    ) -> Self {
        Self {
            platform,
            path: *path,
            knots,
            leg: 0,
            left: 0,
            track: None,
            stretch,
            time_s: 0.0,
            segment_s: 0.0,
            remaining: points,
        }
    }

    /// The next knot.
    fn knot(&mut self) -> Option<Knot> {
        let (knot, rest) = self.knots.split_first()?;
        self.knots = rest;
        self.segment_s = knot.segment_s * self.stretch;
        Some(*knot)
    }

    /// Begins the next leg on which something moves; its first knot.
    fn begin(&mut self) -> Option<Knot> {
        let track = moving(self.platform, &self.path, self.leg).next()?;
        self.leg = track.number.saturating_add(1);
        self.track = Some(track);
        let knot = self.knot()?;
        self.left = knot.parts;
        Some(knot)
    }

    /// The first point of all; the first pose where nothing moves anywhere.
    fn first(&mut self) -> Option<PvtPoint<N>> {
        let track = first_track(self.platform, &self.path)?;
        if self.begin().is_none() {
            self.track = Some(track);
        }
        Some(PvtPoint::new(&track.place(0.0), 0.0, 0.0, 0.0))
    }
}

impl<const N: usize> Iterator for PvtPoints<'_, N> {
    type Item = PvtPoint<N>;

    fn next(&mut self) -> Option<PvtPoint<N>> {
        self.remaining = self.remaining.checked_sub(1)?;
        if self.track.is_none() {
            return self.first();
        }
        if self.left == 0 {
            // The first knot of a leg is the last of the leg before.
            self.begin()?;
        }
        self.left = self.left.saturating_sub(1);
        let segment_s = self.segment_s;
        self.time_s += segment_s;
        let knot = self.knot()?;
        let place = self.track.as_ref()?.place(knot.s);
        let speed = knot.speed / self.stretch;
        Some(PvtPoint::new(&place, speed, self.time_s, segment_s))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.remaining, Some(self.remaining))
    }
}

impl<const N: usize> ExactSizeIterator for PvtPoints<'_, N> {}

impl<const N: usize> FusedIterator for PvtPoints<'_, N> {}
