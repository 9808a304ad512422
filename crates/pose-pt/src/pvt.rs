//! Position-velocity-time tables: the body's motion along a path, timed by `path-timing`.

mod moving;
mod points;
mod run;
mod strokes;

use core::convert::Infallible;

use path_timing::{Accuracy, AxisLimits, Knot, Span, Table};

use crate::distance_error::hermite_distance_error;
use crate::number::larger_or_nan;
use crate::path::Path;
use crate::segmentation::Rule;
use crate::{PlanError, Platform, Segmentation};
pub(crate) use moving::Moving;
pub use points::{PvtPoint, PvtPoints};
pub use run::PvtRun;

/// A checked position-velocity-time table: every axis runs a cubic from each point to the next,
/// with the positions and velocities of the body's own motion at the points.
///
/// Along each leg it is the fastest such table that keeps the limits of all axes: see
/// [`path_timing::Table`]. The machine stops at every pose, where the direction changes, except where
/// the path may be rounded: see [`Path::with_blends`].
#[derive(Debug, Clone, Copy)]
pub struct PvtTable<'a, const N: usize> {
    /// Without a row where nothing moves.
    table: Table<'a, [[f64; 3]; N]>,
    moving: Moving<'a, N>,
}

impl<'a, const N: usize> PvtTable<'a, N> {
    /// Plans the table in memory of the caller: for each leg, and for each blend, one knot
    /// more than segments.
    ///
    /// With [`Segmentation::max_distance_error`] each leg and each blend has a number of segments that keeps the
    /// allowed distance error while one segment fewer does not, by [`hermite_distance_error`]; it
    /// is found by bisection, and each trial is a plan.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan(
        platform: &'a Platform<N>,
        path: &Path<'a>,
        segmentation: Segmentation,
        knots: &'a mut [Knot<[[f64; 3]; N]>],
    ) -> Result<Self, PlanError> {
        segmentation.check(platform)?;
        let moving = Moving::new(platform, path);
        let limits = limits(platform);
        let table = match segmentation.rule {
            Rule::DistanceError(allowed) => {
                let distance_error = |_: &_, span: &Span<_>| {
                    let [from, to] = span.rows.each_ref().map(PvtPoint::new);
                    hermite_distance_error(platform, &from, &to)
                };
                let accuracy = Accuracy {
                    min_segments: segmentation.at_least,
                    max_departure: allowed,
                    max_time_ratio: f64::INFINITY,
                };
                Table::plan_within(moving, limits, accuracy, distance_error, knots)
            }
            _ => {
                let segments = |leg: &moving::Track<'_, N>| segmentation.segments_over(leg.travel);
                Table::plan(moving, limits, segments, knots)
            }
        };
        let table = table.map_err(|error| PlanError::of_timing(error, &moving))?;
        let table = Self { table, moving };
        if let Some(point) = table.still_point() {
            let (leg, point, axes) = (0, 0, point.axes);
            let left = |reason| PlanError::Limit { leg, point, reason };
            platform.check_axes(&axes).map_err(left)?;
        }
        Ok(table)
    }

    /// The same motion at a fraction of its speed, above 0 and at most 1: room for a feed above
    /// 100 %.
    ///
    /// # Errors
    /// [`SpeedScale`](path_timing::PlanError::SpeedScale).
    pub fn at_speed_scale(self, scale: f64) -> Result<Self, path_timing::PlanError<Infallible>> {
        Ok(Self {
            table: self.table.at_speed(scale)?,
            ..self
        })
    }

    /// The number of points: one more than segments.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is a first point")]
    pub fn len(&self) -> usize {
        self.table.len().max(1)
    }

    /// Seconds from the first point to the last.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.table.duration_s()
    }

    /// The platform of the table.
    #[must_use]
    pub const fn platform(&self) -> &'a Platform<N> {
        self.moving.platform
    }

    /// A bound on how far the distance of two locators ever departs from that of their anchors:
    /// the largest [`hermite_distance_error`] of all segments.
    #[must_use]
    pub fn distance_error_bound(&self) -> f64 {
        let mut points = self.points();
        let Some(mut from) = points.next() else {
            return 0.0;
        };
        points.fold(0.0, |worst, to| {
            let distance_error = hermite_distance_error(self.platform(), &from, &to);
            from = to;
            larger_or_nan(worst, distance_error)
        })
    }

    /// The points in their order.
    #[must_use]
    pub fn points(&self) -> PvtPoints<'a, N> {
        PvtPoints::new(self)
    }

    /// The only point of a table where nothing moves.
    fn still_point(&self) -> Option<PvtPoint<N>> {
        self.table.is_empty().then(|| self.moving.first_point())?
    }
}

/// What the axes of each locator may do.
fn limits<const N: usize>(platform: &Platform<N>) -> [[AxisLimits; 3]; N] {
    platform.locators().map(|locator| {
        locator.limits.map(|limits| AxisLimits {
            speed: limits.speed,
            acceleration: limits.acceleration,
            jerk: limits.jerk,
        })
    })
}
