//! From an SVG file to outlines, in the file's own units.

use core::str::FromStr as _;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use kurbo::{
    Affine, BezPath, ParamCurve, ParamCurveExtrema, PathEl, PathSeg, Point, Rect, Shape, Vec2,
};
use nalgebra::Point2;
use quick_xml::escape::escape;
use svgtypes::{Length, LengthUnit};
use usvg::roxmltree::{Document, ParsingOptions};
use usvg::tiny_skia_path::PathSegment;
use usvg::{Group, Node, Options, Transform, Tree};

use crate::elements::Elements;
use crate::{left_out, unreadable};

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
    /// What a user unit is by the file's own size, where that is in a unit of length.
    own_mm_per_unit: Option<f64>,
}

impl Drawing {
    pub(crate) fn read(file: &Path) -> Result<Self> {
        let place = || file.display().to_string();
        let text = fs::read_to_string(file).with_context(place)?;
        Self::parse(&text).with_context(place)
    }

    /// Reads the text of an SVG file.
    pub(crate) fn parse(text: &str) -> Result<Self> {
        let document = parse_xml(text)?;
        let (elements, numbered) = Elements::numbered(text, &document);
        let tree = Tree::from_xmltree(&parse_xml(&numbered)?, &Options::default())?;
        let user_units = user_units(&document)?;
        let mut notes = unreadable::notes(&elements);
        notes.merge(left_out::notes(&tree, &elements));
        let mut drawing = Self {
            outlines: Vec::new(),
            notes: notes.lines(),
            own_mm_per_unit: own_mm_per_unit(&document, user_units),
        };
        drawing.collect(tree.root(), affine(user_units).inverse());
        if drawing.outlines.is_empty() {
            let why = ["there is nothing to draw".to_owned()];
            bail!("{}", [&why, drawing.notes()].concat().join(": "));
        }
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

    /// What the file holds that is not engraved, or otherwise.
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The mm of a user unit where the file says how large it is.
    pub(crate) const fn own_mm_per_unit(&self) -> Option<f64> {
        self.own_mm_per_unit
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
    line_of(&[cubic.p0, cubic.p1, cubic.p2, cubic.p3])
}

/// Whether points lie on one line.
pub(crate) fn are_on_a_line(points: &[Point]) -> bool {
    points.is_empty() || line_of(points).is_some()
}

/// The direction of the line that all points lie on, to the farthest from the first.
fn line_of(points: &[Point]) -> Option<Vec2> {
    let (first, rest) = points.split_first()?;
    let ways = rest.iter().map(|point| *point - *first);
    let longest = ways.clone().map(|way| (way.hypot2(), way));
    let (_, longest) = longest
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap_or_default();
    let allowed = ON_A_LINE * longest.hypot2();
    let mut ways = ways;
    ways.all(|way| way.cross(longest).abs() <= allowed)
        .then_some(longest)
}

/// Where a curve along `way` turns back, and its end.
fn turning_points(curve: PathSeg, way: Vec2) -> impl Iterator<Item = Point> {
    let turns = (Affine::rotate(-way.atan2()) * curve).extrema();
    turns.into_iter().chain([1.0]).map(move |t| curve.eval(t))
}

/// One path for each stroke of the tool.
pub(crate) fn subpaths(path: &BezPath) -> Vec<BezPath> {
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

pub(crate) fn bez_path(path: &usvg::tiny_skia_path::Path) -> BezPath {
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

pub(crate) fn affine(t: Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// As usual in files from drawing programs, with a document type.
fn parse_xml(text: &str) -> Result<Document<'_>> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Ok(Document::parse_with_options(text, options)?)
}

/// What a user unit is where the file's width or height is in a unit of length. The parser's own
/// unit is a 96th of an inch.
fn own_mm_per_unit(document: &Document<'_>, user_units: Transform) -> Option<f64> {
    const MM: f64 = 25.4 / 96.0;
    let root = document.root_element();
    let has_length = ["width", "height"].into_iter().any(|name| {
        let length = root.attribute(name).map(Length::from_str);
        let unit = length.and_then(|length| Some(length.ok()?.unit));
        use LengthUnit::{Cm, In, Mm, Pc, Pt};
        matches!(unit, Some(Mm | Cm | In | Pt | Pc))
    });
    has_length.then(|| affine(user_units).determinant().abs().sqrt() * MM)
}

/// From user units of the root element to what the parser makes of them: a shape under
/// a root element with the same frame tells.
fn user_units(document: &Document<'_>) -> Result<Transform> {
    let frame: String = [
        "width",
        "height",
        "viewBox",
        "preserveAspectRatio",
        "transform",
        "transform-origin",
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
