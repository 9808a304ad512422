//! What stands in a drawing's file and is no shape, or is not understood by the parser.

use core::str::FromStr as _;

use svgtypes::{Length, NumberListParser, SimplifyingPathParser, Transform, ViewBox};
use usvg::roxmltree::{Node as Element, NodeType};

use super::elements::{Elements, name};
use machine_sim::input::Notes;

const TEXT: &str = "convert text to paths";
const IMAGE: &str = "pictures cannot be engraved";
const NO_SHAPE: &str = "no shape, not engraved";
const MOVING: &str = "does not run, engraved as at the start";
const CUT_SHORT: &str = "has an error, what follows it is not engraved";
const NOT_READ: &str = "cannot be read, engraved as if it were not there";
const NO_CSS: &str = "styles that are not read, engraved as if they were not there";

/// Elements that are nothing to draw, or say how something is drawn.
const KNOWN: [&str; 27] = [
    "svg",
    "g",
    "a",
    "defs",
    "symbol",
    "use",
    "switch",
    "path",
    "rect",
    "circle",
    "ellipse",
    "line",
    "polyline",
    "polygon",
    "clipPath",
    "mask",
    "marker",
    "pattern",
    "linearGradient",
    "radialGradient",
    "stop",
    "filter",
    "style",
    "title",
    "desc",
    "metadata",
    "view",
];
const MOVES: [&str; 6] = [
    "animate",
    "animateColor",
    "animateMotion",
    "animateTransform",
    "set",
    "script",
];
const LENGTHS: [&str; 13] = [
    "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry", "x1", "y1", "x2", "y2",
];
/// What the parser knows as attributes and not as properties of a style.
const GEOMETRY: [&str; 10] = [
    "d", "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry",
];
/// Rules that say nothing of what is drawn, or of what is drawn at the start.
const OTHER_RULES: [&str; 4] = ["font-face", "charset", "namespace", "keyframes"];
/// Of a value, in characters.
const SHOWN: usize = 24;

/// Looks at all elements, whether they are drawn or not.
pub(super) fn notes(elements: &Elements<'_>) -> Notes {
    let mut notes = Notes::default();
    for element in elements.all() {
        for (name, kind) in of_element(element) {
            notes.add(elements.location(element), name, kind);
        }
    }
    let instructions = elements.document().root().children();
    for node in instructions.filter(|node| node.node_type() == NodeType::PI) {
        if node.pi().is_some_and(|pi| pi.target == "xml-stylesheet") {
            notes.add(elements.location(node), "xml-stylesheet", NO_CSS);
        }
    }
    notes
}

/// What stands there, and what becomes of it.
type Found = Vec<(String, &'static str)>;

fn of_element(element: Element<'_, '_>) -> Found {
    let tag = element.tag_name().name();
    let parent = element.parent_element().map(|it| it.tag_name().name());
    // What is in an unknown element, or in text, is noted as a whole.
    if parent.is_some_and(|parent| !KNOWN.contains(&parent)) {
        return Found::new();
    }
    match tag {
        "text" => vec![(name(element), TEXT)],
        "image" => vec![(name(element), IMAGE)],
        "style" => of_sheet(element.text().unwrap_or_default()),
        _ if MOVES.contains(&tag) => vec![(name(element), MOVING)],
        _ if KNOWN.contains(&tag) => of_attributes(element),
        // One of several ways to show something.
        _ if parent == Some("switch") => Found::new(),
        // Parts of filters and fonts.
        _ if tag.starts_with("fe") || tag.starts_with("font") => Found::new(),
        _ => vec![(name(element), NO_SHAPE)],
    }
}

fn of_attributes(element: Element<'_, '_>) -> Found {
    let is_root = element.parent_element().is_none();
    let mut found = Found::new();
    for attribute in element.attributes().filter(|it| it.namespace().is_none()) {
        let (name, value) = (attribute.name(), attribute.value());
        let kind = match name {
            "d" if !is_path(value) => CUT_SHORT,
            "points" if !is_points(value) => CUT_SHORT,
            "transform" if !is_transform(value) => NOT_READ,
            "viewBox" if ViewBox::from_str(value).is_err() => NOT_READ,
            "style" => {
                // How large the page is shown says nothing of the drawing.
                let shown = |name: &str| is_root && matches!(name, "width" | "height");
                found.extend(
                    declarations(value)
                        .filter(|it| !shown(it.0))
                        .filter_map(unread),
                );
                continue;
            }
            _ if LENGTHS.contains(&name) && !is_length(value) => NOT_READ,
            _ => continue,
        };
        found.push((format!("{name}={:?}", shortened(value)), kind));
    }
    found
}

/// Rules and properties of a style sheet.
fn of_sheet(text: &str) -> Found {
    let name = |rule: &str| -> String {
        let is_name = |c: &char| c.is_ascii_alphanumeric() || *c == '-';
        rule.chars().take_while(is_name).collect()
    };
    let rules = text.split('@').skip(1).map(name);
    let lost = rules.filter(|rule| !OTHER_RULES.iter().any(|other| rule.ends_with(other)));
    let lost = lost.map(|rule| (format!("@{rule}"), NO_CSS));
    let blocks = text.split(['{', '}']).flat_map(declarations);
    lost.chain(blocks.filter_map(unread)).collect()
}

fn declarations(style: &str) -> impl Iterator<Item = (&str, &str)> {
    let pairs = style.split(';').filter_map(|it| it.split_once(':'));
    pairs.map(|(name, value)| (name.trim(), value.trim()))
}

/// A property that the parser does not read.
fn unread((name, value): (&str, &str)) -> Option<(String, &'static str)> {
    let is_unread = GEOMETRY.contains(&name) || (name == "transform" && !is_transform(value));
    is_unread.then(|| (format!("{name}: {}", shortened(value)), NO_CSS))
}

fn is_path(data: &str) -> bool {
    SimplifyingPathParser::from(data).all(|segment| segment.is_ok())
}

fn is_points(list: &str) -> bool {
    let numbers: Result<Vec<_>, _> = NumberListParser::from(list).collect();
    numbers.is_ok_and(|numbers| numbers.len() % 2 == 0)
}

fn is_transform(value: &str) -> bool {
    value.trim() == "none" || Transform::from_str(value).is_ok()
}

fn is_length(value: &str) -> bool {
    value == "auto" || Length::from_str(value).is_ok()
}

fn shortened(value: &str) -> String {
    value.chars().take(SHOWN).collect()
}
