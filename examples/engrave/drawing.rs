//! From an SVG file to outlines, in the file's own units.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use kurbo::{
    Affine, BezPath, ParamCurve, ParamCurveExtrema, PathEl, PathSeg, Point, Rect, Shape, Vec2,
};
use nalgebra::Point2;
use quick_xml::escape::escape;
use usvg::tiny_skia_path::PathSegment;
use usvg::{Group, Node, Options, Transform, Tree, roxmltree};

/// A curve whose control points are this near to a line, as a share of its length, is
/// that line, there and back: the rounding of the parser's numbers.
const ON_A_LINE: f64 = 1e-6;

/// The finest flattening, as a share of the path's size.
const FINEST: f64 = 1e-12;

/// The outlines of all visible shapes, in the order of the file, in user units of the
/// root element (y down).
///
/// The parser works in single precision and hands out arcs as cubics, which are within
/// 0.0003 of the radius of the true arc: below that the measured deviation says nothing.
pub(crate) struct Drawing {
    outlines: Vec<BezPath>,
    notes: Vec<String>,
}

impl Drawing {
    pub(crate) fn read(file: &Path) -> Result<Self> {
        let place = || file.display().to_string();
        let text = fs::read_to_string(file).with_context(place)?;
        Self::parse(&text).with_context(place)
    }

    fn parse(text: &str) -> Result<Self> {
        let document = roxmltree::Document::parse(text)?;
        let tree = Tree::from_xmltree(&document, &Options::default())?;
        let to_user = affine(user_units(&document)?).inverse();
        let mut drawing = Self {
            outlines: Vec::new(),
            notes: unsupported(&document),
        };
        drawing.collect(tree.root(), to_user);
        ensure!(
            !drawing.outlines.is_empty(),
            "there is nothing to draw{}",
            drawing
                .notes
                .iter()
                .map(|note| format!(": {note}"))
                .collect::<String>()
        );
        ensure!(
            drawing.bounds().is_finite(),
            "a coordinate is too large to be drawn"
        );
        Ok(drawing)
    }

    fn collect(&mut self, group: &Group, to_user: Affine) {
        for node in group.children() {
            match node {
                Node::Group(group) => self.collect(group, to_user),
                Node::Path(path) if path.is_visible() => {
                    let outline = to_user * affine(path.abs_transform()) * bez_path(path.data());
                    self.outlines.extend(subpaths(&unfolded(&outline)));
                }
                Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
            }
        }
    }

    /// What the file holds that is not engraved.
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Bounding box in user units.
    pub(crate) fn bounds(&self) -> Rect {
        self.outlines
            .iter()
            .map(Shape::bounding_box)
            .reduce(|a, b| a.union(b))
            .unwrap_or_default()
    }

    /// The outlines placed on the machine, in mm.
    pub(crate) fn placed(&self, placement: Affine) -> Vec<BezPath> {
        self.outlines
            .iter()
            .map(|outline| placement * outline)
            .collect()
    }
}

/// A path as lines that are within `tolerance` of it, or within a share of its size
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
fn unfolded(path: &BezPath) -> BezPath {
    let mut lines = BezPath::new();
    for (number, element) in (0..).zip(path.elements()) {
        match path.get_seg(number) {
            Some(curve) if !matches!(curve, PathSeg::Line(_)) => match along(curve) {
                Some(way) => turning_points(curve, way).for_each(|point| lines.line_to(point)),
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
    let ways = [cubic.p1, cubic.p2, cubic.p3].map(|point| point - cubic.p0);
    let longest = ways
        .into_iter()
        .max_by(|a, b| a.hypot2().total_cmp(&b.hypot2()))?;
    let allowed = ON_A_LINE * longest.hypot2();
    ways.iter()
        .all(|way| way.cross(longest).abs() <= allowed)
        .then_some(longest)
}

/// Where a curve along `way` turns back, and its end.
fn turning_points(curve: PathSeg, way: Vec2) -> impl Iterator<Item = Point> {
    let turns = (Affine::rotate(-way.atan2()) * curve).extrema();
    turns.into_iter().chain([1.0]).map(move |t| curve.eval(t))
}

/// One path for each stroke of the tool.
fn subpaths(path: &BezPath) -> Vec<BezPath> {
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

fn bez_path(path: &usvg::tiny_skia_path::Path) -> BezPath {
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

fn affine(t: Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// From user units of the root element to what the parser makes of them: a shape under
/// a root element with the same frame tells.
fn user_units(document: &roxmltree::Document<'_>) -> Result<Transform> {
    let frame: String = [
        "width",
        "height",
        "viewBox",
        "preserveAspectRatio",
        "transform",
    ]
    .into_iter()
    .filter_map(|name| {
        let value = document.root_element().attribute(name)?;
        Some(format!(" {name}=\"{}\"", escape(value)))
    })
    .collect();
    let probe =
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\"{frame}><path d=\"M0 0H1V1Z\"/></svg>");
    let tree = Tree::from_str(&probe, &Options::default())?;
    first_path(tree.root())
        .map(usvg::Path::abs_transform)
        .ok_or_else(|| anyhow!("the root element has no area"))
}

fn first_path(group: &Group) -> Option<&usvg::Path> {
    group.children().iter().find_map(|node| match node {
        Node::Path(path) => Some(path.as_ref()),
        Node::Group(group) => first_path(group),
        Node::Image(_) | Node::Text(_) => None,
    })
}

fn unsupported(document: &roxmltree::Document<'_>) -> Vec<String> {
    [
        ("text", "convert text to paths"),
        ("image", "pictures cannot be engraved"),
        ("clipPath", "shapes are not clipped"),
        ("mask", "shapes are not masked"),
    ]
    .into_iter()
    .filter_map(|(name, advice)| {
        let count = document
            .descendants()
            .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", name)))
            .count();
        (count > 0).then(|| format!("{count} <{name}>: {advice}"))
    })
    .collect()
}
