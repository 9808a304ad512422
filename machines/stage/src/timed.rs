//! A chain of motions within what the motors follow: lines smoothed and all planned by path-timing.

mod arcs;

use core::f64::consts::FRAC_1_SQRT_2;

use anyhow::{Context, Result, ensure};
use kurbo::{Point, Vec2};
use path_timing::{
    AxisLimits, Corner, Curve, Knot, LookAhead, Path, PathPoint, PlanError, Promise, Row, Smoothed,
    Span, ToolLimits, Verifier, Vertex, Waypoint, segments_within,
};

use crate::machine::Machine;
use crate::motion::{Motion, Shape};

/// Vertices of the lines in sight at a time.
const VERTICES: usize = 64;
/// Knots in sight: the braking distance of 3.6 mm twice, in segments of points 0.01 mm apart.
const KNOTS: usize = 1024;
/// A segment for each of so many mm, and at least so many a curve; shorter ones where the
/// acceleration depends on the speed.
const SEGMENT_MM: f64 = 0.5;
const KNOWN_SEGMENT_MM: f64 = 0.1;
const LEAST_SEGMENTS: u32 = 2;
/// By what the axes' cubics leave the curves at most, in mm: a tenth of a step.
const CUBICS_MM: f64 = 0.001;

/// The part of the tolerance by which shaping may take the stage off its path.
const SHAPED: f64 = 0.5;
/// And the part of that which is for jumps of the speed.
const JUMPS: f64 = 0.25;

/// What the axes may do along a chain of motions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChainLimits {
    pub(crate) axes: [AxisLimits; 2],
    /// By what they may change their speeds at once.
    pub(crate) start_stop: [f64; 2],
    /// By what lines are smoothed.
    smoothed_mm: f64,
    /// By what each axis may be off its place for being shaped.
    pub(crate) shaped_mm: f64,
    /// A segment is at most so long.
    segment_mm: f64,
}

impl ChainLimits {
    /// What the machine may do, less what would take a shaped axis too far off its place.
    ///
    /// # Errors
    /// The tolerance leaves nothing for shaping.
    fn new(machine: &Machine, tolerance_mm: f64) -> Result<Self> {
        let mut limits = Self {
            axes: machine.axis_limits(),
            start_stop: [machine.start_stop_mm_s; 2],
            smoothed_mm: tolerance_mm,
            shaped_mm: 0.0,
            segment_mm: if machine.is_known() {
                KNOWN_SEGMENT_MM
            } else {
                SEGMENT_MM
            },
        };
        let Some(shapers) = machine.shapers() else {
            return Ok(limits);
        };
        ensure!(
            tolerance_mm > 0.0,
            "a tolerance of 0 mm leaves nothing for the shapers of [mode_x] and [mode_y]"
        );
        limits.smoothed_mm = tolerance_mm * (1.0 - SHAPED);
        limits.shaped_mm = tolerance_mm * SHAPED * FRAC_1_SQRT_2;
        let axes = limits.axes.iter_mut().zip(&mut limits.start_stop);
        for ((axis, start_stop), shaper) in axes.zip(shapers) {
            let most = limits.shaped_mm * (1.0 - JUMPS) / shaper.departure(1.0);
            axis.acceleration = axis.acceleration.min(most);
            let most = limits.shaped_mm * JUMPS / shaper.departure_of_jumps(1.0);
            *start_stop = start_stop.min(most);
        }
        Ok(limits)
    }

    /// So much of all accelerations and jumps.
    pub(crate) fn at(&self, share: f64) -> Self {
        let mut limits = *self;
        let axes = limits.axes.iter_mut().zip(&mut limits.start_stop);
        for (axis, start_stop) in axes {
            axis.acceleration *= share;
            *start_stop *= share;
        }
        limits
    }
}

/// A curve of a chain of motions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChainCurve {
    curve: Curve<2>,
    start_stop: [f64; 2],
    segment_mm: f64,
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

    fn tool_rate(&self, s: f64) -> f64 {
        self.curve.tool_rate(s)
    }

    fn corner(&self) -> Corner<[f64; 2]> {
        Corner::Jump(self.start_stop)
    }
}

impl ChainCurve {
    const fn new(curve: Curve<2>, motions: [usize; 2], limits: &ChainLimits) -> Self {
        Self {
            curve,
            start_stop: limits.start_stop,
            segment_mm: limits.segment_mm,
            motions,
        }
    }

    /// The same within other limits.
    pub(crate) const fn within(self, limits: &ChainLimits) -> Self {
        Self {
            start_stop: limits.start_stop,
            ..self
        }
    }

    /// What it is cut into, so that the axes' cubics stay near.
    pub(crate) fn segments(&self) -> Result<u32, PlanError<<Self as Path>::Error>> {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "saturates"
        )]
        let segments = (self.length() / self.segment_mm).ceil() as u32;
        segments_within(
            self,
            segments.max(LEAST_SEGMENTS),
            CUBICS_MM,
            Self::departure,
        )
    }

    fn departure(&self, span: &Span<[f64; 2]>) -> f64 {
        self.curve.departure(span)
    }
}

/// The curves along a chain of motions, from rest to rest.
#[derive(Debug)]
pub(crate) struct ChainPath {
    pub(crate) curves: Vec<ChainCurve>,
    pub(crate) limits: ChainLimits,
    /// How far they leave lines at most, by the proof.
    pub(crate) departure_mm: f64,
}

impl ChainPath {
    /// The curves along `motions`: lines within a tolerance, arcs as they are.
    ///
    /// # Errors
    /// A number that is too large to compute with, or a tolerance that leaves nothing for shaping.
    pub(crate) fn new(machine: &Machine, motions: &[Motion], tolerance_mm: f64) -> Result<Self> {
        let mut path = Self {
            curves: Vec::new(),
            limits: ChainLimits::new(machine, tolerance_mm)?,
            departure_mm: 0.0,
        };
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
                path.add_lines(end, rest.iter().take(lines), begun)?;
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
    ) -> Result<()> {
        let start = Waypoint::from([from.x, from.y]);
        let points = lines.map(|line| Waypoint {
            point: [line.to.x, line.to.y],
            tool: Some(tool(line)),
        });
        let mut vertices = [Vertex::default(); VERTICES];
        let points = core::iter::once(start).chain(points);
        let mut curves = Smoothed::new(points, self.limits.smoothed_mm, &mut vertices)?;
        for curve in &mut curves {
            let curve = curve?;
            let [from, to] = curve.between().context("a smoothed curve has its points")?;
            let last = to.saturating_sub(1).max(from);
            let motions = [first + from, first + last];
            self.curves
                .push(ChainCurve::new(curve, motions, &self.limits));
        }
        self.departure_mm = self.departure_mm.max(curves.departure());
        Ok(())
    }

    fn add_arc(&mut self, from: Point, motion: &Motion, number: usize) -> Result<()> {
        for curve in arcs::curves(from, motion)? {
            let curve = curve.with_tool(tool(motion));
            self.curves
                .push(ChainCurve::new(curve, [number; 2], &self.limits));
        }
        Ok(())
    }

    /// The curve of a row.
    pub(crate) fn curve(&self, row: &Row<[f64; 2]>) -> Option<&ChainCurve> {
        self.curves.get(row.leg)
    }

    /// Calls `each` with every row after the first, which is where the path begins, when the
    /// verifier has passed it.
    ///
    /// # Errors
    /// The path cannot be planned; or the error of `each`.
    pub(crate) fn rows(&self, mut each: impl FnMut(&Row<[f64; 2]>) -> Result<()>) -> Result<()> {
        let mut window = vec![Knot::default(); KNOTS];
        let segments = |curve: &&ChainCurve| curve.segments();
        let rows = LookAhead::new(self.curves.iter(), self.limits.axes, segments, &mut window)?;
        let mut verifier = self.verifier();
        for (number, row) in rows.enumerate() {
            let row = row?;
            self.verify(&mut verifier, &row)?;
            if number > 0 {
                each(&row)?;
            }
        }
        Ok(())
    }

    /// Of rows along it.
    pub(crate) fn verifier(&self) -> Verifier<[f64; 2]> {
        Verifier::new(Promise {
            limits: self.limits.axes,
            start_stop: self.limits.start_stop,
            max_departure: CUBICS_MM,
            // The feed may be far below what the motors follow.
            max_slowness: f64::INFINITY,
            tool_feed: Some(1.0),
        })
    }

    /// Passes a row, or not.
    pub(crate) fn verify(
        &self,
        verifier: &mut Verifier<[f64; 2]>,
        row: &Row<[f64; 2]>,
    ) -> Result<()> {
        let curve = |leg: usize| self.curves.get(leg);
        Ok(verifier.add(row, curve, |curve, span| curve.departure(span))?)
    }
}

fn tool(motion: &Motion) -> ToolLimits {
    ToolLimits {
        feed: motion.feed_mm_s,
        acceleration: None,
    }
}

/// The feed of a motion in mm/s, as far as both axes can go along it.
pub(crate) fn axis_feed(motion: &Motion, max_axis_mm_s: f64) -> f64 {
    let fastest = match motion.shape {
        Shape::Line => max_axis_mm_s / largest(motion.directions()[0]),
        // Somewhere along it one axis has all of the speed, or nearly so.
        Shape::Arc { .. } => max_axis_mm_s,
    };
    motion.feed_mm_s.min(fastest)
}

/// Of both axes.
const fn largest(direction: Vec2) -> f64 {
    direction.x.abs().max(direction.y.abs())
}
