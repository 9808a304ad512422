//! The table that goes to the controller of the axes: planned, and written.

use core::fmt::Write as _;

use anyhow::{Error, Result, anyhow, ensure};
use nalgebra::Vector3;
use pose_pt::{Blend, Knot, Path, PathError, PlanError, Platform, PtTable, PvtTable, Segmentation};

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
        let path = Path::new(&poses, self.settings.interpolation());
        let path = match path {
            Ok(path) if !blends.is_empty() => path.with_blends(&blends),
            other => other,
        };
        let path = path.map_err(|error| match error {
            PathError::HalfTurn { angle, .. } => {
                anyhow!(
                    "the body would turn by {angle} rad, half a turn: either direction is as short"
                )
            }
            PathError::Blend { pose, .. } => Error::new(error).context(format!("via {pose}")),
            PathError::ScrewBlend => Error::new(error).context("[[path.via]]"),
            other => other.into(),
        })?;
        let max_distance_error_mm = self.settings.max_distance_error_mm();
        let segmentation = Segmentation::max_distance_error(max_distance_error_mm);
        let placed = |error: PlanError| match error {
            PlanError::Limit { .. } => anyhow!(error),
            _ => anyhow!("[path]: max_distance_error_mm = {max_distance_error_mm}: {error}"),
        };
        let mut csv = self.header();
        let (points, distance_error_bound_mm) = match self.mode {
            Mode::Pt => {
                let table = PtTable::plan(&self.platform, &path, segmentation).map_err(placed)?;
                table.fits(MAX_POINTS).map_err(placed)?;
                is_short(table.duration_s())?;
                for point in table.points() {
                    self.row(&mut csv, point.time_s, &point.axes, None)?;
                }
                (table.len(), table.distance_error_bound())
            }
            Mode::Pvt => {
                let mut knots = vec![Knot::default(); MAX_POINTS];
                let table = PvtTable::plan(&self.platform, &path, segmentation, &mut knots);
                let table = table.map_err(placed)?;
                is_short(table.duration_s())?;
                for point in table.points() {
                    self.row(&mut csv, point.time_s, &point.axes, Some(&point.velocities))?;
                }
                (table.len(), table.distance_error_bound())
            }
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
