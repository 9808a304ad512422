//! From an outline to curves of the tool, in the order and direction in which it is engraved.

use anyhow::Result;
use kurbo::{BezPath, ParamCurve as _, PathEl, PathSeg, Point};
use path_timing::{Curve, CurveError, Smoothed, Vertex};

/// The curves of an outline: its Bézier curves as they are, its lines smoothed within
/// `tolerance_mm`, but for corners above `corner_rad`.
pub(super) fn curves_of(
    outline: &BezPath,
    is_reversed: bool,
    tolerance_mm: f64,
    corner_rad: f64,
) -> Result<Vec<Curve<2>>> {
    let mut segments: Vec<_> = outline.segments().collect();
    if is_reversed {
        segments.reverse();
        for segment in &mut segments {
            *segment = segment.reverse();
        }
    }
    let mut collected = Collected {
        tolerance_mm,
        corner_rad,
        lines: Vec::new(),
        curves: Vec::new(),
    };
    for segment in segments {
        collected.add(segment)?;
    }
    collected.end_lines()?;
    Ok(collected.curves)
}

/// Vertices of lines in sight at a time.
const VERTICES: usize = 32;

struct Collected {
    tolerance_mm: f64,
    corner_rad: f64,
    /// Points of lines that are not curves yet.
    lines: Vec<[f64; 2]>,
    curves: Vec<Curve<2>>,
}

impl Collected {
    fn add(&mut self, segment: PathSeg) -> Result<()> {
        if let PathSeg::Line(line) = segment {
            self.line(xy(line.p0), xy(line.p1));
            return Ok(());
        }
        let cubic = segment.to_cubic();
        match Curve::bezier([cubic.p0, cubic.p1, cubic.p2, cubic.p3].map(xy)) {
            Ok(curve) => {
                self.end_lines()?;
                self.curves.push(curve);
                Ok(())
            }
            // A curve that turns back, or that begins with no speed, is followed as lines.
            Err(CurveError::Cusp { .. }) => {
                let (mut from, mut points) = (xy(segment.start()), Vec::new());
                let path = BezPath::from_path_segments(core::iter::once(segment));
                kurbo::flatten(&path, self.tolerance_mm, |element| {
                    if let PathEl::LineTo(point) = element {
                        points.push(xy(point));
                    }
                });
                for to in points {
                    self.line(from, to);
                    from = to;
                }
                Ok(())
            }
            Err(CurveError::NoLength { .. }) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    fn line(&mut self, from: [f64; 2], to: [f64; 2]) {
        if self.lines.is_empty() {
            self.lines.push(from);
        }
        self.lines.push(to);
    }

    fn end_lines(&mut self) -> Result<()> {
        let mut memory = [Vertex::default(); VERTICES];
        let curves = Smoothed::new(self.lines.drain(..), self.tolerance_mm, &mut memory)?;
        for curve in curves.with_stops_above(self.corner_rad) {
            self.curves.push(curve?);
        }
        Ok(())
    }
}

fn xy(point: Point) -> [f64; 2] {
    [point.x, point.y]
}

/// By how much the direction turns from the end of one curve to the start of the next, in -π..=π.
pub(super) fn kink_rad(before: &Curve<2>, after: &Curve<2>) -> f64 {
    let [ax, ay] = before.at(before.length()).tangent;
    let [bx, by] = after.at(0.0).tangent;
    (ax * by - ay * bx).atan2(ax * bx + ay * by)
}
