//! The elements of a drawing, each under an id, so that what the parser makes of it can be found.

use core::fmt::Write as _;
use std::collections::HashMap;

use usvg::roxmltree::{Document, Node, NodeId};

use machine_sim::input::Location;

/// The namespace of all that is drawn.
const SVG: &str = "http://www.w3.org/2000/svg";

/// Elements by their ids, own or given.
pub(super) struct Elements<'d> {
    document: &'d Document<'d>,
    by_id: HashMap<String, NodeId>,
    locations: HashMap<NodeId, Location>,
}

impl<'d> Elements<'d> {
    /// The elements of a document, and its text with an id for all of them.
    pub(super) fn numbered(text: &str, document: &'d Document<'d>) -> (Self, String) {
        // An id that nothing in the text refers to.
        let mut prefix = "element-".to_owned();
        while text.contains(&prefix) {
            prefix.push('-');
        }
        let body = document.root_element().range().start;
        let mut by_id = HashMap::new();
        let (mut numbered, mut done) = (String::new(), 0);
        for (number, node) in document.descendants().filter(is_svg).enumerate() {
            if let Some(id) = node.attribute("id") {
                by_id.entry(id.to_owned()).or_insert(node.id());
                continue;
            }
            let start = node.range().start;
            // What comes from an entity stands before the root.
            let Some(name) = text.get(start + 1..).filter(|_| start >= body.max(done)) else {
                continue;
            };
            let is_name = |c: char| !c.is_whitespace() && c != '>' && c != '/';
            let length = name.find(|c| !is_name(c)).unwrap_or(name.len());
            let end = start + 1 + length;
            numbered.push_str(text.get(done..end).unwrap_or_default());
            // A string takes what is written.
            let _ = write!(numbered, " id='{prefix}{number}'");
            by_id.insert(format!("{prefix}{number}"), node.id());
            done = end;
        }
        numbered.push_str(text.get(done..).unwrap_or_default());
        let elements = Self {
            document,
            by_id,
            locations: locations(text, document),
        };
        (elements, numbered)
    }

    pub(super) fn by_id(&self, id: &str) -> Option<Node<'d, 'd>> {
        self.document.get_node(*self.by_id.get(id)?)
    }

    /// All that are drawn or say how.
    pub(super) fn all(&self) -> impl Iterator<Item = Node<'d, 'd>> {
        self.document.descendants().filter(is_svg)
    }

    /// Those that the parser's paths can be traced back to, in the order of the file: not what
    /// comes from entities without an id.
    pub(super) fn identified(&self) -> impl Iterator<Item = Node<'d, 'd>> {
        let mut ids: Vec<_> = self.by_id.values().copied().collect();
        ids.sort_unstable_by_key(|id| id.get());
        ids.into_iter().filter_map(|id| self.document.get_node(id))
    }

    pub(super) const fn document(&self) -> &'d Document<'d> {
        self.document
    }

    /// Where a node of the document begins, in lines and characters.
    #[expect(
        clippy::indexing_slicing,
        reason = "all nodes of the document are in it"
    )]
    pub(super) fn location(&self, node: Node<'d, 'd>) -> Location {
        self.locations[&node.id()]
    }
}

/// Where all nodes begin, in one pass through the text: a file can be one long line.
fn locations(text: &str, document: &Document<'_>) -> HashMap<NodeId, Location> {
    let begin = (0, 1, 1);
    let (mut at, mut line, mut column) = begin;
    let mut locations = HashMap::new();
    for node in document.descendants() {
        let start = node.range().start;
        // What comes from an entity stands before.
        if start < at {
            (at, line, column) = begin;
        }
        for c in text.get(at..start).unwrap_or_default().chars() {
            (line, column) = match c {
                '\n' => (line + 1, 1),
                _ => (line, column + 1),
            };
        }
        at = start;
        locations.insert(node.id(), (line, column).into());
    }
    locations
}

fn is_svg(node: &Node<'_, '_>) -> bool {
    node.is_element() && matches!(node.tag_name().namespace(), None | Some(SVG))
}

/// As it is written.
pub(super) fn name(node: Node<'_, '_>) -> String {
    format!("<{}>", node.tag_name().name())
}
