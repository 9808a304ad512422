//! Position-time tables.

use core::iter::FusedIterator;

use nalgebra::Vector3;

use crate::distance_error::linear_distance_error;
use crate::leg_axes::{LegAxes, Walk};
use crate::number::{larger, magnitude};
use crate::path::{Leg, PosePath};
use crate::{Locator, Platform, PtError, Segmentation};

/// A line of a PT table: where every axis is at a time. Between two lines it moves linearly.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct PtPoint<const N: usize> {
    /// Seconds since the start.
    pub time_s: f64,
    /// Seconds since the point before; zero at the first.
    pub segment_s: f64,
    /// Coordinates of each locator's three axes.
    pub axes: [Vector3<f64>; N],
}

/// A checked position-time table [Alignment 2010].
///
/// Each leg of the path is divided into equal segments; each takes as long as its slowest axis
/// does at its rated speed:
///
/// ```text
/// segment time = max over the axes of |Δq| / rated speed
/// ```
///
/// Poses between the first and the last are passed without a stop: speeds step at every point of a
/// PT table, and no acceleration limit is looked at. Controllers that run cubics can do better,
/// with `Platform::paths`.
#[derive(Debug, Clone, Copy)]
pub struct PtTable<'a, const N: usize> {
    platform: &'a Platform<N>,
    path: PosePath<'a>,
    segmentation: Segmentation,
    points: usize,
    duration_s: f64,
}

impl<'a, const N: usize> PtTable<'a, N> {
    /// Plans the table and walks it once: every point is within all strokes, and so is
    /// every position between, where the axes move linearly.
    ///
    /// # Errors
    /// [`PtError`].
    pub fn plan(
        platform: &'a Platform<N>,
        path: &PosePath<'a>,
        segmentation: Segmentation,
    ) -> Result<Self, PtError> {
        segmentation.check(platform)?;
        let mut points = 1_usize;
        for number in 0..path.legs() {
            let segments = segmentation.checked_segments(platform, path, number)?;
            points = usize::try_from(segments)
                .ok()
                .and_then(|segments| points.checked_add(segments))
                .ok_or(PtError::TooManyPoints {
                    needed: usize::MAX,
                    available: usize::MAX,
                })?;
        }
        let table = Self {
            platform,
            path: *path,
            segmentation,
            points,
            duration_s: 0.0,
        };
        let mut walk = table.points();
        let mut last_s = None;
        while let Some(point) = walk.next() {
            let PtPoint {
                time_s,
                segment_s,
                axes,
            } = point;
            let (leg, point) = (walk.leg, walk.index);
            platform
                .check_axes(&axes)
                .map_err(|reason| PtError::Limit { leg, point, reason })?;
            let takes_time = |last_s| segment_s > 0.0 && time_s > last_s;
            if last_s.is_some_and(|last_s| !takes_time(last_s)) {
                return Err(PtError::Indistinct { leg, point });
            }
            last_s = Some(time_s);
        }
        Ok(Self {
            duration_s: walk.clock.time_s,
            ..table
        })
    }

    /// The number of points: one more than segments.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is a first point")]
    pub const fn len(&self) -> usize {
        self.points
    }

    /// Refuses a table of more points than the controller has memory for.
    ///
    /// # Errors
    /// [`PtError::TooManyPoints`].
    pub const fn fits(&self, available: usize) -> Result<(), PtError> {
        if self.points <= available {
            return Ok(());
        }
        Err(PtError::TooManyPoints {
            needed: self.points,
            available,
        })
    }

    /// Seconds from the first point to the last.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// A bound on how much two locators come closer than their anchors are, between any two
    /// points of the table.
    ///
    /// Proof. Between two points the vector from one locator to the other runs along the
    /// chord from D₀ to D₁. These differ by a turn δ about an axis n; with D⊥ the component of D
    /// perpendicular to n, the square of the distance is
    ///
    /// ```text
    /// |D₀ + τ (D₁ - D₀)|² = L² - 4 τ (1-τ) D⊥² sin²(δ/2)
    /// distance error = L - √(L² - D⊥² sin²(δ/2)) ≤ L (1 - cos(δ/2)) ≈ L δ² / 8
    /// ```
    ///
    /// For straight and screw motion δ is the same in all segments, and fewer points cannot
    /// keep the distance error, however they are spread. Along pose vectors δ and n differ: the
    /// largest of all segments is returned, and [`Segmentation::max_distance_error`] takes δ from
    /// the largest angular speed and D⊥ as L, which may be more segments than the fewest.
    #[must_use]
    pub fn distance_error_bound(&self) -> f64 {
        self.path
            .numbered_legs()
            .map(|(number, leg)| self.leg_distance_error(number, &leg))
            .fold(0.0, f64::max)
    }

    fn leg_distance_error(&self, number: usize, leg: &Leg) -> f64 {
        let leg_axes = LegAxes::new(self.platform, leg);
        let segments = self.segments(number);
        let looked_at = if leg.is_even() {
            segments.min(1)
        } else {
            segments
        };
        let mut walk = leg_axes.walk(segments);
        let mut from = leg_axes.axes(&walk);
        (0..looked_at).fold(0.0, |worst, _| {
            walk.advance();
            let to = leg_axes.axes(&walk);
            let distance_error = linear_distance_error(self.platform, &from, &to);
            from = to;
            worst.max(distance_error)
        })
    }

    /// Axes of the point `number`, with the bits that the iterator gives.
    #[must_use]
    pub fn axes(&self, number: usize) -> Option<[Vector3<f64>; N]> {
        let mut number = number;
        for leg in 0..self.path.legs() {
            let segments = self.segments(leg);
            match u32::try_from(number) {
                Ok(index) if index <= segments => {
                    let leg_axes = LegAxes::new(self.platform, &self.path.leg(leg)?);
                    let mut walk = leg_axes.walk(segments);
                    walk.seek(index);
                    return Some(leg_axes.axes(&walk));
                }
                _ => number = number.saturating_sub(usize::try_from(segments).ok()?),
            }
        }
        None
    }

    /// The points in their order.
    #[must_use]
    pub fn points(&self) -> PtPoints<'a, N> {
        PtPoints {
            table: *self,
            leg: 0,
            index: 0,
            segments: 0,
            leg_axes: None,
            axes: [Vector3::zeros(); N],
            clock: Clock::zero(),
            remaining: self.points,
        }
    }

    fn segments(&self, leg: usize) -> u32 {
        self.segmentation
            .linear_segments(self.platform, &self.path, leg)
    }
}

/// Seconds that the slowest axis needs at its rated speed.
#[inline]
fn slowest<const N: usize>(
    locators: &[Locator; N],
    from: &[Vector3<f64>; N],
    to: &[Vector3<f64>; N],
) -> f64 {
    let mut longest = 0.0;
    for (locator, (from, to)) in locators.iter().zip(from.iter().zip(to)) {
        for (limits, (from, to)) in locator.limits.iter().zip(from.iter().zip(to.iter())) {
            longest = larger(longest, magnitude(*to - *from) / limits.speed);
        }
    }
    longest
}

/// The points of a [`PtTable`].
#[derive(Debug, Clone)]
pub struct PtPoints<'a, const N: usize> {
    table: PtTable<'a, N>,
    /// The leg on which the last point lies, and its number there.
    leg: usize,
    index: u32,
    segments: u32,
    leg_axes: Option<(LegAxes<'a, N>, Walk)>,
    axes: [Vector3<f64>; N],
    clock: Clock,
    remaining: usize,
}

/// A sum of times that loses nothing to rounding, however many there are (Kahan).
#[derive(Debug, Clone, Copy)]
struct Clock {
    time_s: f64,
    /// What the sum has too much.
    excess_s: f64,
}

impl Clock {
    fn zero() -> Self {
        Self {
            time_s: 0.0,
            excess_s: 0.0,
        }
    }

    #[inline]
    fn advance(&mut self, segment_s: f64) {
        let step_s = segment_s - self.excess_s;
        let time_s = self.time_s + step_s;
        self.excess_s = (time_s - self.time_s) - step_s;
        self.time_s = time_s;
    }
}

impl<'a, const N: usize> PtPoints<'a, N> {
    /// Begins the next leg on which something moves.
    #[cold]
    fn begin(&mut self, mut leg: usize) -> Option<()> {
        while self.table.segments(leg) == 0 && leg < self.table.path.legs() {
            leg = leg.saturating_add(1);
        }
        self.segments = self.table.segments(leg);
        self.leg = leg;
        self.index = 0;
        let leg_axes = LegAxes::new(self.table.platform, &self.table.path.leg(leg)?);
        let walk = leg_axes.walk(self.segments);
        self.leg_axes = Some((leg_axes, walk));
        Some(())
    }

    /// The first point of all.
    #[cold]
    fn first(&mut self) -> Option<[Vector3<f64>; N]> {
        if self.begin(0).is_none() {
            // Nothing moves anywhere: the first pose is the whole table.
            self.leg = 0;
            let leg = self.table.path.leg(0)?;
            let leg_axes = LegAxes::new(self.table.platform, &leg);
            self.leg_axes = Some((leg_axes, leg_axes.walk(1)));
        }
        let (leg_axes, walk) = self.leg_axes.as_ref()?;
        Some(leg_axes.axes(walk))
    }
}

impl<'a, const N: usize> Iterator for PtPoints<'a, N> {
    type Item = PtPoint<N>;

    #[inline]
    fn next(&mut self) -> Option<PtPoint<N>> {
        self.remaining = self.remaining.checked_sub(1)?;
        if self.leg_axes.is_none() {
            self.axes = self.first()?;
            return Some(PtPoint {
                time_s: self.clock.time_s,
                segment_s: 0.0,
                axes: self.axes,
            });
        }
        if self.index == self.segments {
            self.begin(self.leg.saturating_add(1))?;
        }
        let (leg_axes, walk) = self.leg_axes.as_mut()?;
        walk.advance();
        self.index = self.index.saturating_add(1);
        let axes = leg_axes.axes(walk);
        let segment_s = slowest(self.table.platform.locators(), &self.axes, &axes);
        self.clock.advance(segment_s);
        self.axes = axes;
        Some(PtPoint {
            time_s: self.clock.time_s,
            segment_s,
            axes,
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.remaining, Some(self.remaining))
    }
}

impl<const N: usize> ExactSizeIterator for PtPoints<'_, N> {}

impl<const N: usize> FusedIterator for PtPoints<'_, N> {}
