//! One leg of a path as the axes run it.

use nalgebra::Vector3;

use crate::Platform;
use crate::course::{Course, Place};
use crate::path::Path;

/// A leg with both ends exactly where its neighbours have them: a controller gets one position for
/// the end of a leg and the start of the next, while each leg by itself would round it anew.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Track<'a, const N: usize> {
    /// The leg, from 0.
    pub(super) number: usize,
    course: Course<'a, N, f64>,
    ends: [[Vector3<f64>; N]; 2],
}

impl<'a, const N: usize> Track<'a, N> {
    /// `None` past the last leg.
    pub(super) fn new(platform: &'a Platform<N>, path: &Path<'_>, number: usize) -> Option<Self> {
        Some(Self {
            number,
            course: Course::new(platform, &path.leg(number)?),
            ends: [
                path.axes(platform, number)?,
                path.axes(platform, number.checked_add(1)?)?,
            ],
        })
    }

    /// Axes and slopes at a parameter, 0..=1.
    pub(crate) fn place(&self, s: f64) -> Place<N, f64> {
        let mut place = self.course.place(s);
        let [start, end] = self.ends;
        if s <= 0.0 {
            place.axes = start;
        } else if s >= 1.0 {
            place.axes = end;
        }
        place
    }
}
