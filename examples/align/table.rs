//! The table that goes to the controller of the axes: planned, written, and read back.

use core::fmt::Write as _;

use anyhow::{Context, Result, anyhow, ensure};
use clap::ValueEnum;
use nalgebra::{Isometry3, Matrix3, Point3, Vector3};
use pose2pulse::pose_pt::{Cut, Knot, Path, PathError, PlanError, Platform, PtTable, PvtTable};

use crate::platform::Settings;
use crate::run::{Pose, vector};

/// What the table says of each point.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Mode {
    /// Positions: the axes move linearly between two points. Speeds are kept, accelerations and
    /// jerks are not.
    Pt,
    /// Positions and velocities: the axes run cubics within speed, acceleration and jerk.
    Pvt,
}

impl Mode {
    pub(crate) const fn file(self) -> &'static str {
        match self {
            Self::Pt => "pt.csv",
            Self::Pvt => "pvt.csv",
        }
    }

    /// The limits of the platform file that the plan keeps.
    pub(crate) const fn keeps(self) -> &'static [&'static str] {
        match self {
            Self::Pt => &["speed_mm_s"],
            Self::Pvt => &["speed_mm_s", "acceleration_mm_s2", "jerk_mm_s3"],
        }
    }
}

/// Most points that the controller has room for.
const MOST_POINTS: usize = 1 << 16;

/// Longest motion that is run here: each second is a thousand cycles of the drives.
const MOST_S: f64 = 10_000.0;

/// What the coordinates of a table may round off, as a share of the largest length.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// What every motion of the body is planned with.
#[derive(Clone, Copy)]
pub(crate) struct Planner<'a, const N: usize> {
    pub(crate) platform: &'a Platform<N>,
    settings: &'a Settings,
    mode: Mode,
}

/// A planned motion.
pub(crate) struct Plan {
    /// The file that the controller gets, and nothing else.
    pub(crate) csv: String,
    pub(crate) strain_bound_mm: f64,
}

impl<'a, const N: usize> Planner<'a, N> {
    pub(crate) const fn new(platform: &'a Platform<N>, settings: &'a Settings, mode: Mode) -> Self {
        Self {
            platform,
            settings,
            mode,
        }
    }

    pub(crate) fn isometry(&self, pose: Pose) -> Isometry3<f64> {
        vector(pose).to_isometry(self.settings.convention())
    }

    pub(crate) fn plan(&self, from: Pose, to: Pose) -> Result<Plan> {
        let poses = [from, to].map(|pose| self.isometry(pose));
        let interpolation = self.settings.interpolation();
        let path = Path::new(&poses, interpolation).map_err(|error| match error {
            PathError::HalfTurn { angle, .. } => {
                anyhow!(
                    "the body would turn by {angle} rad, half a turn: both ways are the shorter one"
                )
            }
            other => other.into(),
        })?;
        let strain_mm = self.settings.strain_mm();
        let cut = Cut::strain(strain_mm);
        let placed = |error: PlanError| match error {
            PlanError::Limit { .. } => anyhow!(error),
            _ => anyhow!("[path]: strain_mm = {strain_mm}: {error}"),
        };
        let mut csv = self.header();
        let (points, strain_bound_mm) = match self.mode {
            Mode::Pt => {
                let table = PtTable::plan(self.platform, &path, cut).map_err(placed)?;
                table.fits(MOST_POINTS).map_err(placed)?;
                is_short(table.duration_s())?;
                for point in table.points() {
                    self.row(&mut csv, point.time_s, &point.axes, None)?;
                }
                (table.len(), table.strain_bound())
            }
            Mode::Pvt => {
                let mut knots = vec![Knot::default(); MOST_POINTS];
                let table = PvtTable::plan(self.platform, &path, cut, &mut knots);
                let table = table.map_err(placed)?;
                is_short(table.duration_s())?;
                for point in table.points() {
                    self.row(&mut csv, point.time_s, &point.axes, Some(&point.velocities))?;
                }
                (table.len(), table.strain_bound())
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
            strain_bound_mm: strain_bound_mm + rounding_mm,
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
        duration_s <= MOST_S,
        "the motion would take {duration_s:.1e} s, {MOST_S} s are simulated at most"
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

/// One axis of one locator between two points of the table: a cubic, or a line.
#[derive(Clone, Copy)]
struct AxisSegment {
    from: f64,
    to: f64,
    /// Speeds at both ends.
    speeds: Option<[f64; 2]>,
}

impl AxisSegment {
    /// Position and speed at a part `s` of a segment that takes `time_s`.
    fn at(&self, s: f64, time_s: f64) -> (f64, f64) {
        let way = self.to - self.from;
        let Some([v0, v1]) = self.speeds else {
            return (self.from + s * way, way / time_s);
        };
        let (a, b) = (v0 * time_s - way, way - v1 * time_s);
        let rest = 1.0 - s;
        let position = self.from + s * way + s * rest * (a * rest + b * s);
        let slope = way + (rest - s) * (a * rest + b * s) + s * rest * (b - a);
        (position, slope / time_s)
    }
}

/// What an axis does at a moment.
#[derive(Clone, Copy, Default)]
pub(crate) struct AxisState {
    /// In mm.
    pub(crate) position: f64,
    /// In mm per second.
    pub(crate) speed: f64,
}

/// Three axes of each locator.
pub(crate) type States<const N: usize> = [[AxisState; 3]; N];

/// The positions of all axes.
pub(crate) fn positions<const N: usize>(states: &States<N>) -> [Vector3<f64>; N] {
    states.map(|axes| Vector3::from(axes.map(|axis| axis.position)))
}

/// A table as the controller has read it: axis by axis.
pub(crate) struct Table<const N: usize> {
    times_s: Vec<f64>,
    /// At each time: positions, and speeds where there are some.
    positions: Vec<[Vector3<f64>; N]>,
    speeds: Option<Vec<[Vector3<f64>; N]>>,
}

impl<const N: usize> Table<N> {
    /// Reads the file; each locator turns the world's coordinates into those of its axes.
    pub(crate) fn read(csv: &str, platform: &Platform<N>) -> Result<Self> {
        let mut lines = csv.lines();
        let header = lines.next().context("the table is empty")?;
        let has_speeds = header.split(',').count() > 1 + 3 * N;
        let mut to_axes = [Matrix3::identity(); N];
        for (locator, inverse) in platform.locators().iter().zip(&mut to_axes) {
            *inverse = locator.axes.try_inverse().context("dependent axes")?;
        }
        let mut table = Self {
            times_s: Vec::new(),
            positions: Vec::new(),
            speeds: has_speeds.then(Vec::new),
        };
        for line in lines {
            let numbers = line
                .split(',')
                .map(str::parse)
                .collect::<Result<Vec<f64>, _>>()?;
            let (&time_s, values) = numbers.split_first().context("an empty line")?;
            let (positions, speeds) = values.split_at_checked(3 * N).context("a short line")?;
            let mut axes = [Vector3::zeros(); N];
            let places = axes.iter_mut().zip(&to_axes).zip(positions.chunks_exact(3));
            for (((axes, inverse), world), locator) in places.zip(platform.locators()) {
                *axes = inverse * (Point3::from_slice(world) - locator.origin);
            }
            table.times_s.push(time_s);
            table.positions.push(axes);
            if let Some(rows) = &mut table.speeds {
                let mut axes = [Vector3::zeros(); N];
                let places = axes.iter_mut().zip(&to_axes).zip(speeds.chunks_exact(3));
                for ((axes, inverse), world) in places {
                    *axes = inverse * Vector3::from_column_slice(world);
                }
                rows.push(axes);
            }
        }
        ensure!(
            table.times_s.len() > 1,
            "a table of one point moves nothing"
        );
        Ok(table)
    }

    pub(crate) fn points(&self) -> usize {
        self.times_s.len()
    }

    pub(crate) fn duration_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or_default()
    }

    /// Segments, and their times.
    pub(crate) fn segments(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        let ends = self.times_s.iter().skip(1);
        let pairs = self.times_s.iter().zip(ends).enumerate();
        pairs.map(|(number, (start, end))| (number, [*start, *end]))
    }

    /// The segment under way at a time.
    pub(crate) fn segment_at(&self, time_s: f64) -> usize {
        let begun = self.times_s.partition_point(|start| *start <= time_s);
        begun.saturating_sub(1).min(self.points().saturating_sub(2))
    }

    /// Where every axis is, and how fast it moves, at a part `s` of a segment.
    pub(crate) fn states(&self, segment: usize, s: f64) -> Option<States<N>> {
        let next = segment + 1;
        let time_s = self.times_s.get(next)? - self.times_s.get(segment)?;
        let (from, to) = (self.positions.get(segment)?, self.positions.get(next)?);
        let speeds = match &self.speeds {
            Some(speeds) => Some((speeds.get(segment)?, speeds.get(next)?)),
            None => None,
        };
        let mut states = [[AxisState::default(); 3]; N];
        for (locator, states) in states.iter_mut().enumerate() {
            for (axis, state) in states.iter_mut().enumerate() {
                let of = |rows: &[Vector3<f64>; N]| Some(*rows.get(locator)?.get(axis)?);
                let segment = AxisSegment {
                    from: of(from)?,
                    to: of(to)?,
                    speeds: match speeds {
                        Some((v0, v1)) => Some([of(v0)?, of(v1)?]),
                        None => None,
                    },
                };
                let (position, speed) = segment.at(s, time_s);
                *state = AxisState { position, speed };
            }
        }
        Some(states)
    }

    /// The states at a time of the table.
    pub(crate) fn at(&self, time_s: f64) -> Option<States<N>> {
        let segment = self.segment_at(time_s);
        let start = self.times_s.get(segment)?;
        let length = self.times_s.get(segment + 1)? - start;
        self.states(segment, ((time_s - start) / length).clamp(0.0, 1.0))
    }
}
