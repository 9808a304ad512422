//! The legs of a path on which something moves, as the axes run them.

use core::convert::Infallible;

use nalgebra::Vector3;
use path_timing::Place;

use crate::course::{Course, is_still};
use crate::path::Path;
use crate::{Platform, PvtPoint};

/// A leg with both ends exactly where its neighbours have them: a controller gets one position for
/// the end of a leg and the start of the next, while each leg by itself would round it anew.
#[derive(Debug, Clone, Copy)]
pub(super) struct Track<'a, const N: usize> {
    /// The leg of the path, from 0.
    pub(super) number: usize,
    course: Course<'a, N>,
    ends: [[Vector3<f64>; N]; 2],
}

impl<const N: usize> path_timing::Path for Track<'_, N> {
    type Axes = [[f64; 3]; N];
    type Error = Infallible;

    fn length(&self) -> f64 {
        1.0
    }

    fn place(&self, s: f64) -> Result<Place<[[f64; 3]; N]>, Infallible> {
        let place = self.course.place(s);
        let [start, end] = self.ends;
        let axes = if s <= 0.0 {
            start
        } else if s >= 1.0 {
            end
        } else {
            place.axes
        };
        Ok(Place {
            position: axes.map(Into::into),
            slope: place.slope.map(Into::into),
        })
    }
}

/// The legs on which something moves, from either end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moving<'a, const N: usize> {
    pub(super) platform: &'a Platform<N>,
    path: Path<'a>,
    /// The legs that are still to come.
    first: usize,
    end: usize,
}

impl<'a, const N: usize> Moving<'a, N> {
    pub(super) const fn new(platform: &'a Platform<N>, path: &Path<'a>) -> Self {
        Self {
            platform,
            path: *path,
            first: 0,
            end: path.legs(),
        }
    }

    /// The legs' numbers in the path.
    fn numbers(self) -> impl DoubleEndedIterator<Item = usize> {
        (self.first..self.end).filter(move |number| !self.is_still(*number))
    }

    /// The number in the path of leg `leg` of these.
    pub(super) fn number(&self, leg: usize) -> usize {
        let mut number = self.first;
        let mut before = leg;
        while before > 0 || self.is_still(number) {
            before = before.saturating_sub(usize::from(!self.is_still(number)));
            number = number.saturating_add(1);
        }
        number
    }

    /// At the first pose, at rest.
    pub(super) fn first_point(&self) -> Option<PvtPoint<N>> {
        let axes = self.path.axes(self.platform, 0)?;
        Some(PvtPoint {
            time_s: 0.0,
            segment_s: 0.0,
            axes,
            velocities: [Vector3::zeros(); N],
        })
    }

    fn is_still(&self, number: usize) -> bool {
        is_still(self.platform, &self.path, number)
    }

    fn track(&self, number: usize) -> Option<Track<'a, N>> {
        let axes = |number| self.path.axes(self.platform, number);
        Some(Track {
            number,
            course: Course::new(self.platform, &self.path.leg(number)?),
            ends: [axes(number)?, axes(number.checked_add(1)?)?],
        })
    }
}

impl<'a, const N: usize> Iterator for Moving<'a, N> {
    type Item = Track<'a, N>;

    fn next(&mut self) -> Option<Track<'a, N>> {
        let number = self.numbers().next()?;
        self.first = number.saturating_add(1);
        self.track(number)
    }
}

impl<const N: usize> DoubleEndedIterator for Moving<'_, N> {
    fn next_back(&mut self) -> Option<Self::Item> {
        let number = self.numbers().next_back()?;
        self.end = number;
        self.track(number)
    }
}
