//! What a drawing shows and the engraver does not, as the parser has understood it.

use std::collections::HashSet;

use kurbo::{PathEl, Point, Rect, Shape as _};
use usvg::roxmltree::{Node as Element, NodeId};
use usvg::{BlendMode, ClipPath, Group, Node, Paint, Path, Tree};

use super::elements::{Elements, name};
use super::outline::{affine, are_on_a_line, bez_path, subpaths};
use machine_sim::input::Notes;

const FILLED: &str = "filled, only the outline is engraved";
const THIN: &str = "filled without an area, which does not show, engraved all the same";
const SHADED: &str = "a gradient or a pattern, only the outline is engraved";
const DASHED: &str = "dashed, cut solid";
const WIDE: &str = "with a stroke-width, engraved as wide as the disc cuts";
const TRANSPARENT: &str = "transparent or blended, engraved like the rest";
const CLIPPED: &str = "clipped, engraved whole";
const MASKED: &str = "masked, engraved whole";
const FILTERED: &str = "filtered, engraved without the filter";
const OUTSIDE: &str = "beyond the page, engraved all the same";
const UNPAINTED: &str = "hidden, or neither filled nor stroked, not engraved";
const HIDDEN: &str = "not displayed, not engraved";
const NOT_DRAWN: &str =
    "without size, data or a valid reference, or hidden by a style sheet, not engraved";

/// The width of a stroke of which nothing is said.
const DEFAULT_WIDTH: f32 = 1.0;
/// What may stand out of the page, as a fraction of its size: rounding.
const EDGE: f64 = 1e-3;

const SHAPES: [&str; 8] = [
    "path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "use",
];
/// What stands in these alone is drawn where it stands; of alternatives, one is.
const CONTAINERS: [&str; 3] = ["svg", "g", "a"];

/// Compares the parser's tree with the elements that it comes from.
pub(super) fn notes(tree: &Tree, elements: &Elements<'_>) -> Notes {
    let size = tree.size();
    let (width, height) = (f64::from(size.width()), f64::from(size.height()));
    let edge = EDGE * width.max(height);
    let mut watcher = Watcher {
        elements,
        page: Rect::new(0.0, 0.0, width, height).inflate(edge, edge),
        seen: HashSet::new(),
        notes: Notes::default(),
    };
    watcher.group(tree.root(), elements.document().root_element());
    watcher.missing();
    watcher.notes
}

struct Watcher<'e, 'd> {
    elements: &'e Elements<'d>,
    page: Rect,
    /// Elements of which something has become a path.
    seen: HashSet<NodeId>,
    notes: Notes,
}

impl<'d> Watcher<'_, 'd> {
    fn note(&mut self, element: Element<'d, 'd>, kind: &'static str) {
        let place = self.elements.location(element);
        self.notes.add(place, name(element), kind);
    }

    /// Looks at a group that comes from within `owner`.
    fn group(&mut self, group: &Group, owner: Element<'d, 'd>) {
        let element = self.element(group).unwrap_or(owner);
        let is_blended = group.blend_mode() != BlendMode::Normal;
        let is_clipped = group
            .clip_path()
            .is_some_and(|clip| !shows_all(clip, group));
        for (is_so, kind) in [
            (is_clipped, CLIPPED),
            (group.mask().is_some(), MASKED),
            (!group.filters().is_empty(), FILTERED),
            (is_blended || group.opacity().get() < 1.0, TRANSPARENT),
        ] {
            if is_so {
                self.note(element, kind);
            }
        }
        for node in group.children() {
            match node {
                Node::Group(child) => self.group(child, element),
                Node::Path(path) => {
                    let element = self.elements.by_id(path.id()).unwrap_or(element);
                    self.path(path, element);
                }
                Node::Image(_) | Node::Text(_) => {}
            }
        }
    }

    /// Where a group comes from: it has an id, or it is around one element alone.
    fn element(&self, group: &Group) -> Option<Element<'d, 'd>> {
        if let Some(element) = self.elements.by_id(group.id()) {
            return Some(element);
        }
        match group.children() {
            [Node::Path(path)] => self.elements.by_id(path.id()),
            [Node::Group(child)] => self.element(child),
            _ => None,
        }
    }

    fn path(&mut self, path: &Path, element: Element<'d, 'd>) {
        self.seen.extend(element.ancestors().map(|it| it.id()));
        if !path.is_visible() {
            self.note(element, UNPAINTED);
            return;
        }
        match path.fill() {
            Some(fill) if has_area(path) => {
                self.note(element, paint(fill.paint()).unwrap_or(FILLED));
            }
            Some(_) if path.stroke().is_none() => self.note(element, THIN),
            _ => {}
        }
        if let Some(stroke) = path.stroke() {
            if let Some(kind) = paint(stroke.paint()) {
                self.note(element, kind);
            }
            if stroke.dasharray().is_some() {
                self.note(element, DASHED);
            }
            if stroke.width().get() != DEFAULT_WIDTH {
                self.note(element, WIDE);
            }
        }
        let fill = path.fill().map(|fill| fill.opacity().get());
        let stroke = path.stroke().map(|stroke| stroke.opacity().get());
        if fill.into_iter().chain(stroke).any(|opacity| opacity < 1.0) {
            self.note(element, TRANSPARENT);
        }
        if !contains(self.page, rect(path.abs_bounding_box())) {
            self.note(element, OUTSIDE);
        }
    }

    /// Shapes of which nothing has become a path.
    fn missing(&mut self) {
        let elements = self.elements;
        for element in elements.identified() {
            let around = element.ancestors().skip(1).filter(|it| it.is_element());
            let is_drawn = around
                .map(|it| it.tag_name().name())
                .all(|tag| CONTAINERS.contains(&tag));
            let is_shape = SHAPES.contains(&element.tag_name().name());
            if !is_shape || !is_drawn || self.seen.contains(&element.id()) {
                continue;
            }
            let is_hidden = element.ancestors().any(|it| is_not_displayed(&it));
            self.note(element, if is_hidden { HIDDEN } else { NOT_DRAWN });
        }
    }
}

/// Whether there is anything to fill, and not only lines there and back.
fn has_area(path: &Path) -> bool {
    subpaths(&bez_path(path.data())).iter().any(|subpath| {
        let points = subpath.elements().iter().flat_map(points);
        let points: Vec<_> = points.collect();
        !are_on_a_line(&points)
    })
}

fn points(element: &PathEl) -> Vec<Point> {
    match *element {
        PathEl::MoveTo(a) | PathEl::LineTo(a) => vec![a],
        PathEl::QuadTo(a, b) => vec![a, b],
        PathEl::CurveTo(a, b, c) => vec![a, b, c],
        PathEl::ClosePath => Vec::new(),
    }
}

/// What is said of a paint that is no plain colour.
const fn paint(paint: &Paint) -> Option<&'static str> {
    match paint {
        Paint::Color(_) => None,
        Paint::LinearGradient(_) | Paint::RadialGradient(_) | Paint::Pattern(_) => Some(SHADED),
    }
}

/// By its own attribute or style; what a style sheet says is not asked for.
fn is_not_displayed(element: &Element<'_, '_>) -> bool {
    let style = element.attribute("style").unwrap_or_default();
    let mut declarations = style.split(';').filter_map(|it| it.split_once(':'));
    element.attribute("display") == Some("none")
        || declarations.any(|(name, value)| {
            name.trim() == "display" && value.trim().trim_end_matches("!important").trim() == "none"
        })
}

/// Whether a clip path is one upright rectangle around all that it clips, as around pages.
fn shows_all(clip: &ClipPath, group: &Group) -> bool {
    let Some(path) = only_path(clip.root()) else {
        return false;
    };
    let outline = affine(group.abs_transform())
        * affine(clip.transform())
        * affine(path.abs_transform())
        * bez_path(path.data());
    let window = outline.bounding_box();
    let is_rectangle = (outline.area().abs() - window.area()).abs() <= EDGE * window.area();
    let edge = EDGE * window.width().max(window.height());
    let drawn = rect(group.abs_bounding_box());
    clip.clip_path().is_none() && is_rectangle && contains(window.inflate(edge, edge), drawn)
}

fn only_path(group: &Group) -> Option<&Path> {
    match group.children() {
        [Node::Path(path)] => Some(path),
        [Node::Group(child)] => only_path(child),
        _ => None,
    }
}

fn rect(rect: usvg::tiny_skia_path::Rect) -> Rect {
    let [x0, y0, x1, y1] = [rect.left(), rect.top(), rect.right(), rect.bottom()].map(f64::from);
    Rect::new(x0, y0, x1, y1)
}

/// A line has no area, and is in a rectangle all the same.
fn contains(outer: Rect, inner: Rect) -> bool {
    outer.x0 <= inner.x0 && outer.y0 <= inner.y0 && inner.x1 <= outer.x1 && inner.y1 <= outer.y1
}
