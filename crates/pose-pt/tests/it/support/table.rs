//! Tables of `path-timing` as those of a platform.

use path_timing::{Accuracy, Knot, PlanError, Row, Table};
use pose_pt::nalgebra::Vector3;
use pose_pt::{BodyPath, BodyPathError, Platform, PosePath, hermite_distance_error};

/// A row, with the axes of each locator as a vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point<const N: usize> {
    pub(crate) time_s: f64,
    pub(crate) segment_s: f64,
    pub(crate) axes: [Vector3<f64>; N],
    pub(crate) velocities: [Vector3<f64>; N],
}

impl<const N: usize> From<Row<[[f64; 3]; N]>> for Point<N> {
    fn from(row: Row<[[f64; 3]; N]>) -> Self {
        Self {
            time_s: row.time_s,
            segment_s: row.duration_s,
            axes: row.position.map(Vector3::from),
            velocities: row.velocity.map(Vector3::from),
        }
    }
}

/// Rows as points.
pub(crate) fn points_of<const N: usize>(
    rows: impl IntoIterator<Item = Row<[[f64; 3]; N]>>,
) -> Vec<Point<N>> {
    rows.into_iter().map(Point::from).collect()
}

/// How finely each leg and each rounding is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cut {
    Into(u32),
    Within(f64),
}

/// Rows of three locators or more.
pub(crate) type BodyTable<'a, const N: usize> = Table<'a, [[f64; 3]; N]>;

/// The table of a platform along a path.
pub(crate) fn plan<'a, const N: usize>(
    platform: &Platform<N>,
    path: &PosePath<'_>,
    cut: Cut,
    knots: &'a mut [Knot<[[f64; 3]; N]>],
) -> Result<BodyTable<'a, N>, PlanError<BodyPathError>> {
    let (paths, limits) = (platform.paths(path), platform.axis_limits());
    match cut {
        Cut::Into(segments) => Table::plan(paths, limits, |_| segments, knots),
        Cut::Within(max_departure) => {
            let accuracy = Accuracy {
                min_segments: 1,
                max_departure,
                max_time_ratio: f64::INFINITY,
            };
            Table::plan_within(paths, limits, accuracy, BodyPath::departure, knots)
        }
    }
}

/// The largest distance error of all segments.
pub(crate) fn bound<const N: usize>(platform: &Platform<N>, table: &BodyTable<'_, N>) -> f64 {
    let each = table.spans();
    let each = each.map(|span| hermite_distance_error(platform, &span.rows));
    // What is no number is the largest.
    each.max_by(f64::total_cmp).unwrap_or(0.0)
}
