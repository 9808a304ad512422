//! Outlines: from the parser's paths to strokes, and strokes to lines.

use kurbo::{Affine, BezPath, ParamCurve, ParamCurveExtrema, PathEl, PathSeg, Point, Shape, Vec2};
use nalgebra::Point2;
use usvg::Transform;
use usvg::tiny_skia_path::PathSegment;

/// A curve whose control points are this near to a line, as a fraction of its length, is
/// that line, there and back: the rounding of the parser's numbers.
const ON_A_LINE: f64 = 1e-6;

/// The finest flattening, as a fraction of the path's size.
const FINEST: f64 = 1e-12;

/// A path as lines that are within `tolerance` of it, or within a fraction of its size
/// that no machine tells apart: the number of lines is limited wherever it is placed.
pub(crate) fn flatten(path: &BezPath, tolerance: f64) -> Vec<Point2<f64>> {
    let bounds = path.bounding_box();
    let tolerance = tolerance.max(bounds.width().max(bounds.height()) * FINEST);
    let mut points = Vec::new();
    let mut start = Point::ZERO;
    kurbo::flatten(path, tolerance, |element| match element {
        PathEl::MoveTo(point) => {
            start = point;
            points.push(point);
        }
        PathEl::LineTo(point) => points.push(point),
        PathEl::ClosePath => points.push(start),
        PathEl::QuadTo(..) | PathEl::CurveTo(..) => {}
    });
    points.dedup();
    points.into_iter().map(|p| Point2::new(p.x, p.y)).collect()
}

/// The path with every curve that runs along a line, and maybe back, as lines between
/// its turning points: flattening as a curve would lose these.
pub(super) fn unfolded(path: &BezPath) -> BezPath {
    let mut lines = BezPath::new();
    for (number, element) in (0..).zip(path.elements()) {
        match path.get_seg(number) {
            Some(curve) if !matches!(curve, PathSeg::Line(_)) => match along(curve) {
                Some(direction) => {
                    turning_points(curve, direction).for_each(|point| lines.line_to(point));
                }
                None => lines.push(*element),
            },
            _ => lines.push(*element),
        }
    }
    lines
}

/// The direction of the line that all control points of a curve lie on, if any.
fn along(curve: PathSeg) -> Option<Vec2> {
    let cubic = curve.to_cubic();
    line_of(&[cubic.p0, cubic.p1, cubic.p2, cubic.p3])
}

/// Whether points lie on one line.
pub(super) fn are_on_a_line(points: &[Point]) -> bool {
    points.is_empty() || line_of(points).is_some()
}

/// The direction of the line that all points lie on, to the farthest from the first.
fn line_of(points: &[Point]) -> Option<Vec2> {
    let (first, rest) = points.split_first()?;
    let mut offsets = rest.iter().map(|point| *point - *first);
    let by_length = |a: &Vec2, b: &Vec2| a.hypot2().total_cmp(&b.hypot2());
    let longest = offsets.clone().max_by(by_length).unwrap_or_default();
    let allowed = ON_A_LINE * longest.hypot2();
    offsets
        .all(|offset| offset.cross(longest).abs() <= allowed)
        .then_some(longest)
}

/// Where a curve along `direction` turns back, and its end.
fn turning_points(curve: PathSeg, direction: Vec2) -> impl Iterator<Item = Point> {
    let turns = (Affine::rotate(-direction.atan2()) * curve).extrema();
    turns.into_iter().chain([1.0]).map(move |t| curve.eval(t))
}

/// One path for each stroke of the tool.
pub(super) fn subpaths(path: &BezPath) -> Vec<BezPath> {
    let mut strokes: Vec<BezPath> = Vec::new();
    for element in path.elements() {
        match (element, strokes.last_mut()) {
            (PathEl::MoveTo(_), _) | (_, None) => {
                strokes.push(BezPath::from_vec(vec![*element]));
            }
            (_, Some(stroke)) => stroke.push(*element),
        }
    }
    strokes.retain(|stroke| stroke.elements().len() > 1);
    strokes
}

pub(super) fn bez_path(path: &usvg::tiny_skia_path::Path) -> BezPath {
    let at = |p: usvg::tiny_skia_path::Point| Point::new(f64::from(p.x), f64::from(p.y));
    path.segments()
        .map(|segment| match segment {
            PathSegment::MoveTo(p) => PathEl::MoveTo(at(p)),
            PathSegment::LineTo(p) => PathEl::LineTo(at(p)),
            PathSegment::QuadTo(p1, p2) => PathEl::QuadTo(at(p1), at(p2)),
            PathSegment::CubicTo(p1, p2, p3) => PathEl::CurveTo(at(p1), at(p2), at(p3)),
            PathSegment::Close => PathEl::ClosePath,
        })
        .collect()
}

pub(super) fn affine(t: Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}
