//! A chain of motions within what the motors follow: lines smoothed and all planned by path-timing.

mod arcs;

use anyhow::{Context, Result};
use kurbo::{Point, Vec2};
use path_timing::{
    AxisLimits, Corner, Curve, Knot, LookAhead, Path, PathPoint, PlanError, Promise, Row, Smoothed,
    Span, ToolLimits, Verifier, Vertex, Waypoint, segments_within,
};

use crate::motion::{Motion, Shape};

/// The acceleration of each axis at most.
pub const ACCELERATION_MM_S2: f64 = 500.0;
/// The speed of each axis at most, in mm/s: its motor follows 70 at this acceleration, and loses steps
/// at 80.
pub const MAX_AXIS_MM_S: f64 = 60.0;
/// By what an axis may change its speed at once: what its motor starts and stops with.
pub(crate) const START_STOP_MM_S: f64 = 5.0;

/// Vertices of the lines in sight at a time.
const VERTICES: usize = 64;
/// Knots in sight: the braking distance of 3.6 mm twice, in segments of points 0.01 mm apart.
const KNOTS: usize = 1024;
/// A segment for each of so many mm, and at least so many a curve.
const SEGMENT_MM: f64 = 0.5;
const LEAST_SEGMENTS: u32 = 2;
/// By what the axes' cubics leave the curves at most, in mm: a tenth of a step.
const CUBICS_MM: f64 = 0.001;

/// A curve of a chain of motions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChainCurve {
    curve: Curve<2>,
    /// The motions on which it begins and ends.
    pub(crate) motions: [usize; 2],
}

impl Path for ChainCurve {
    type Axes = [f64; 2];
    type Error = <Curve<2> as Path>::Error;

    fn length(&self) -> f64 {
        self.curve.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, Self::Error> {
        self.curve.point(s)
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.curve.tool()
    }

    fn corner(&self) -> Corner<[f64; 2]> {
        Corner::Jump([START_STOP_MM_S; 2])
    }
}

impl ChainCurve {
    fn departure(&self, span: &Span<[f64; 2]>) -> f64 {
        self.curve.departure(span)
    }

    fn segments(&self) -> Result<u32, PlanError<<Self as Path>::Error>> {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "saturates"
        )]
        let segments = (self.length() / SEGMENT_MM).ceil() as u32;
        segments_within(
            self,
            segments.max(LEAST_SEGMENTS),
            CUBICS_MM,
            Self::departure,
        )
    }
}

/// The curves along a chain of motions, from rest to rest.
#[derive(Debug, Default)]
pub(crate) struct ChainPath {
    curves: Vec<ChainCurve>,
    /// How far they leave lines at most, by the proof.
    pub(crate) departure_mm: f64,
}

impl ChainPath {
    /// The curves along `motions`: lines within a tolerance, arcs as they are.
    ///
    /// # Errors
    /// A number that is too large to compute with.
    pub(crate) fn new(motions: &[Motion], tolerance_mm: f64) -> Result<Self> {
        let mut path = Self::default();
        let Some(first) = motions.first() else {
            return Ok(path);
        };
        // Where the curves so far end: of an arc, but for rounding.
        let mut end = first.from;
        let mut begun = 0;
        while let Some(rest) = motions.get(begun..).filter(|rest| !rest.is_empty()) {
            let is_line = |motion: &&Motion| matches!(motion.shape, Shape::Line);
            let lines = rest.iter().take_while(is_line).count();
            if lines > 0 {
                path.add_lines(end, rest.iter().take(lines), begun, tolerance_mm)?;
            } else if let Some(motion) = rest.first() {
                path.add_arc(end, motion, begun)?;
            }
            end = path.curves.last().map_or(end, |curve| {
                let [x, y] = curve.curve.end();
                Point::new(x, y)
            });
            begun += lines.max(1);
        }
        Ok(path)
    }

    fn add_lines<'m>(
        &mut self,
        from: Point,
        lines: impl Iterator<Item = &'m Motion>,
        first: usize,
        tolerance_mm: f64,
    ) -> Result<()> {
        let start = Waypoint::from([from.x, from.y]);
        let points = lines.map(|line| Waypoint {
            point: [line.to.x, line.to.y],
            tool: Some(tool(line)),
        });
        let mut vertices = [Vertex::default(); VERTICES];
        let points = core::iter::once(start).chain(points);
        let mut curves = Smoothed::new(points, tolerance_mm, &mut vertices)?;
        for curve in &mut curves {
            let curve = curve?;
            let [from, to] = curve.between().context("a smoothed curve has its points")?;
            let last = to.saturating_sub(1).max(from);
            self.curves.push(ChainCurve {
                curve,
                motions: [first + from, first + last],
            });
        }
        self.departure_mm = self.departure_mm.max(curves.departure());
        Ok(())
    }

    fn add_arc(&mut self, from: Point, motion: &Motion, number: usize) -> Result<()> {
        for curve in arcs::curves(from, motion)? {
            self.curves.push(ChainCurve {
                curve: curve.with_tool(tool(motion)),
                motions: [number; 2],
            });
        }
        Ok(())
    }

    /// The curve of a row.
    pub(crate) fn curve(&self, row: &Row<[f64; 2]>) -> Option<&ChainCurve> {
        self.curves.get(row.leg)
    }

    /// Calls `each` with every row after the first, which is where the path begins, when the verifier has
    /// passed it.
    ///
    /// # Errors
    /// The path cannot be planned; or the error of `each`.
    pub(crate) fn rows(&self, mut each: impl FnMut(&Row<[f64; 2]>) -> Result<()>) -> Result<()> {
        let limits = [AxisLimits {
            speed: MAX_AXIS_MM_S,
            acceleration: ACCELERATION_MM_S2,
            jerk: None,
        }; 2];
        let mut window = vec![Knot::default(); KNOTS];
        let segments = |curve: &&ChainCurve| curve.segments();
        let rows = LookAhead::new(self.curves.iter(), limits, segments, &mut window)?;
        let mut verifier = Verifier::new(Promise {
            limits,
            start_stop: [START_STOP_MM_S; 2],
            max_departure: CUBICS_MM,
            // The feed may be far below what the motors follow.
            max_slowness: f64::INFINITY,
        });
        for (number, row) in rows.enumerate() {
            let row = row?;
            verifier.add(
                &row,
                |leg| self.curves.get(leg),
                |curve, span| curve.departure(span),
            )?;
            if number > 0 {
                each(&row)?;
            }
        }
        Ok(())
    }
}

fn tool(motion: &Motion) -> ToolLimits {
    ToolLimits {
        feed: motion.feed_mm_s,
        acceleration: None,
    }
}

/// The feed of a motion in mm/s, as far as both axes can go along it.
pub(crate) fn axis_feed(motion: &Motion) -> f64 {
    let fastest = match motion.shape {
        Shape::Line => MAX_AXIS_MM_S / largest(motion.directions()[0]),
        // Somewhere along it one axis has all of the speed, or nearly so.
        Shape::Arc { .. } => MAX_AXIS_MM_S,
    };
    motion.feed_mm_s.min(fastest)
}

/// Of both axes.
const fn largest(direction: Vec2) -> f64 {
    direction.x.abs().max(direction.y.abs())
}
