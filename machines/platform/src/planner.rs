//! The table that goes to the controller of the axes: planned, and written.

use core::fmt::{Display, Write as _};

use anyhow::{Error, Result, anyhow, ensure};
use nalgebra::Vector3;
use path_timing::{Accuracy, Knot, PlanError, Promise, Table, Verifier};
use pose_pt::{
    Blend, BodyPath, BodyPathError, Platform, PosePath, PosePathError, PtTable, Segmentation,
};

use crate::machine::isometry;
use crate::mode::Mode;
use crate::pose::Pose;
use crate::settings::Settings;

/// Most points that the controller has room for.
const MAX_POINTS: usize = 1 << 16;

/// Longest motion that is run here: each second is a thousand cycles of the drives.
const MAX_S: f64 = 10_000.0;

/// What the coordinates of a table may round off, as a fraction of the largest length.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// What every motion of the body is planned with.
pub(crate) struct Planner<const N: usize> {
    pub(crate) platform: Platform<N>,
    pub(crate) settings: Settings,
    /// Poses between the first and the last of each motion, and how near to them it passes.
    via: Vec<(Pose, Blend)>,
    mode: Mode,
}

/// A planned motion.
pub(crate) struct Plan {
    /// The file that the controller gets, and nothing else.
    pub(crate) csv: String,
    pub(crate) distance_error_bound_mm: f64,
}

impl<const N: usize> Planner<N> {
    pub(crate) fn new(
        platform: &Platform<N>,
        settings: &Settings,
        via: Vec<(Pose, Blend)>,
        mode: Mode,
    ) -> Self {
        Self {
            platform: *platform,
            settings: settings.clone(),
            via,
            mode,
        }
    }

    pub(crate) fn plan(&self, from: Pose, to: Pose) -> Result<Plan> {
        let (via, blends): (Vec<Pose>, Vec<Blend>) = self.via.iter().copied().unzip();
        let poses = core::iter::once(from).chain(via).chain([to]);
        let poses: Vec<_> = poses.map(isometry).collect();
        let path = PosePath::new(&poses, self.settings.interpolation());
        let path = match path {
            Ok(path) if !blends.is_empty() => path.with_blends(&blends),
            other => other,
        };
        let path = path.map_err(|error| match error {
            PosePathError::HalfTurn { angle, .. } => {
                anyhow!(
                    "the body would turn by {angle} rad, half a turn: either direction is as short"
                )
            }
            PosePathError::Blend { pose, .. } => Error::new(error).context(format!("via {pose}")),
            PosePathError::ScrewBlend => Error::new(error).context("[[path.via]]"),
            other => other.into(),
        })?;
        let mut csv = self.header();
        let (points, distance_error_bound_mm) = match self.mode {
            Mode::Pt => self.linear(&path, &mut csv)?,
            Mode::Pvt => self.cubic(&path, &mut csv)?,
        };
        ensure!(points > 1, "from and to are the same pose: nothing moves");
        let places = poses.iter().flat_map(|pose| self.platform.positions(pose));
        let origins = self.platform.locators().iter().map(|it| it.origin);
        let apart = self.platform.largest_anchor_distance();
        let far = places
            .chain(origins)
            .map(|it| it.coords.amax())
            .fold(apart, f64::max);
        let rounding_mm = ROUNDING * far;
        Ok(Plan {
            csv,
            distance_error_bound_mm: distance_error_bound_mm + rounding_mm,
        })
    }

    /// A table for linear motion between its points: how many there are, and the bound.
    fn linear(&self, path: &PosePath<'_>, csv: &mut String) -> Result<(usize, f64)> {
        let segmentation = Segmentation::max_distance_error(self.settings.max_distance_error_mm());
        let placed = |error: pose_pt::PtError| match error {
            pose_pt::PtError::Limit { .. } => anyhow!(error),
            _ => self.too_accurate(error),
        };
        let table = PtTable::plan(&self.platform, path, segmentation).map_err(placed)?;
        table.fits(MAX_POINTS).map_err(placed)?;
        is_short(table.duration_s())?;
        for point in table.points() {
            self.row(csv, point.time_s, &point.axes, None)?;
        }
        Ok((table.len(), table.distance_error_bound()))
    }

    /// A table for cubics between its points, each of which the verifier has passed.
    fn cubic(&self, path: &PosePath<'_>, csv: &mut String) -> Result<(usize, f64)> {
        let max_departure = self.settings.max_distance_error_mm();
        let accuracy = Accuracy {
            min_segments: 2,
            max_departure,
            max_time_ratio: f64::INFINITY,
        };
        let placed = |error: PlanError<BodyPathError>| match error {
            PlanError::Path { reason, .. } => anyhow!(reason),
            _ => self.too_accurate(error),
        };
        let (paths, limits) = (self.platform.paths(path), self.platform.axis_limits());
        let mut knots = vec![Knot::default(); MAX_POINTS];
        let table = Table::plan_within(paths, limits, accuracy, BodyPath::departure, &mut knots);
        let table = table.map_err(placed)?;
        is_short(table.duration_s())?;
        let legs: Vec<_> = paths.collect();
        let mut verifier = Verifier::new(Promise {
            limits,
            start_stop: [[0.0; 3]; N],
            max_departure,
            // Few rows take long.
            max_slowness: f64::INFINITY,
            tool_feed: Some(1.0),
        });
        for row in table.rows() {
            verifier.add(&row, |leg| legs.get(leg), |leg, span| leg.departure(span))?;
            let [axes, velocities] = [row.position, row.velocity].map(|it| it.map(Vector3::from));
            self.row(csv, row.time_s, &axes, Some(&velocities))?;
        }
        let spans = table.spans().zip(table.rows().skip(1));
        let bounds = spans.filter_map(|(span, row)| Some(legs.get(row.leg)?.departure(&span)));
        Ok((table.len(), bounds.fold(0.0, f64::max)))
    }

    fn too_accurate(&self, error: impl Display) -> Error {
        let allowed_mm = self.settings.max_distance_error_mm();
        anyhow!("[path]: max_distance_error_mm = {allowed_mm}: {error}")
    }

    fn header(&self) -> String {
        let columns = |letter: char| {
            (1..=N).flat_map(move |number| {
                ["x", "y", "z"].map(|axis| format!(",{letter}{number}{axis}"))
            })
        };
        let velocities = (self.mode == Mode::Pvt).then(|| columns('v'));
        let columns = columns('p').chain(velocities.into_iter().flatten());
        let header: String = columns.collect();
        format!("time_s{header}\n")
    }

    /// World coordinates.
    fn row(
        &self,
        csv: &mut String,
        time_s: f64,
        axes: &[Vector3<f64>; N],
        velocities: Option<&[Vector3<f64>; N]>,
    ) -> Result<()> {
        number(csv, time_s)?;
        let positions = self.platform.locator_positions(axes);
        let locators = self.platform.locators().iter();
        let speeds = locators
            .zip(velocities.into_iter().flatten())
            .map(|(locator, velocity)| locator.axes * velocity);
        for vector in positions.iter().map(|it| it.coords).chain(speeds) {
            for value in &vector {
                csv.push(',');
                number(csv, *value)?;
            }
        }
        csv.push('\n');
        Ok(())
    }
}

fn is_short(duration_s: f64) -> Result<()> {
    ensure!(
        duration_s <= MAX_S,
        "the motion would take {duration_s:.1e} s, {MAX_S} s are simulated at most"
    );
    Ok(())
}

/// With 15 significant digits at least, however small, and 15 decimals.
fn number(csv: &mut String, value: f64) -> core::fmt::Result {
    let size = value.abs();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a logarithm; 0 where the size is 0 or above 1"
    )]
    let zeros = if size > 0.0 { -size.log10() } else { 0.0 } as usize;
    write!(csv, "{value:.*}", 15 + zeros)
}
