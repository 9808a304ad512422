//! From the text of an SVG file to outlines, in the file's own units.

mod elements;
mod left_out;
mod outline;
mod unreadable;

use core::str::FromStr as _;

use anyhow::{Result, anyhow, bail, ensure};
use kurbo::{Affine, BezPath, Rect, Shape};
use quick_xml::escape::escape;
use svgtypes::{Length, LengthUnit};
use usvg::roxmltree::{Document, ParsingOptions};
use usvg::{Group, Node, Options, Transform, Tree};

use self::elements::Elements;
pub(crate) use self::outline::flatten;
use self::outline::{affine, bez_path, subpaths, unfolded};
use crate::placement::Placement;

/// The outlines of all visible shapes, in the order of the file, in user units of the
/// root element (y down).
///
/// The parser works in single precision and hands out arcs as cubics, which are within
/// 0.0003 of the radius of the true arc: below that the measured deviation says nothing.
#[derive(Debug, Clone)]
pub struct Drawing {
    outlines: Vec<BezPath>,
    notes: Vec<String>,
    /// What a user unit is by the file's own size, where that is in a unit of length.
    own_mm_per_unit: Option<f64>,
}

impl Drawing {
    /// Reads the text of an SVG file; text in it must have been converted to paths.
    ///
    /// # Errors
    /// It cannot be read, or holds nothing to draw.
    pub fn parse(text: &str) -> Result<Self> {
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
    #[must_use]
    pub fn notes(&self) -> &[String] {
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

    /// The outlines placed on the machine, in mm, in the order of the file.
    pub(crate) fn placed(&self, placement: Placement) -> Vec<BezPath> {
        self.outlines
            .iter()
            .map(|outline| placement.0 * outline)
            .collect()
    }
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
