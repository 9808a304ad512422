//! The table as the controller of the axes reads it: axis by axis.

use anyhow::{Context as _, Result, ensure};
use nalgebra::{Matrix3, Point3, Vector3};
use pose_pt::Platform;

/// One axis of one locator between two points of the table: a cubic, or a line.
#[derive(Clone, Copy)]
struct AxisSegment {
    from: f64,
    to: f64,
    /// Speeds at both ends.
    speeds: Option<[f64; 2]>,
}

impl AxisSegment {
    /// Position and speed at a fraction `s` of a segment that takes `time_s`.
    fn at(&self, s: f64, time_s: f64) -> (f64, f64) {
        let travel = self.to - self.from;
        let Some([v0, v1]) = self.speeds else {
            return (self.from + s * travel, travel / time_s);
        };
        let (a, b) = (v0 * time_s - travel, travel - v1 * time_s);
        let rest = 1.0 - s;
        let position = self.from + s * travel + s * rest * (a * rest + b * s);
        let slope = travel + (rest - s) * (a * rest + b * s) + s * rest * (b - a);
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

    /// The segment that runs at a time.
    pub(crate) fn segment_at(&self, time_s: f64) -> usize {
        let begun = self.times_s.partition_point(|start| *start <= time_s);
        begun.saturating_sub(1).min(self.points().saturating_sub(2))
    }

    /// Where every axis is, and how fast it moves, at a fraction `s` of a segment.
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
