//! The elements of paths that come without an id.
//!
//! usvg drops the ids of all that a `<use>` or a marker draws. Such a path is known by its form: usvg resolves the shapes of the
//! document once more, each alone and with an id. A path with the very same commands and points draws what the element says, so the
//! element may speak for it, whichever of several equal ones it came from.

use core::fmt::Write as _;
use std::collections::HashMap;

use usvg::roxmltree::{Document, Node};
use usvg::tiny_skia_path::PathSegment;
use usvg::{Group, Options, Tree};

use super::source::is_shape;

/// The attributes that the points of shapes come from.
const GEOMETRY: [&str; 15] =
    ["cx", "cy", "d", "height", "points", "r", "rx", "ry", "width", "x", "x1", "x2", "y", "y1", "y2"];

/// The attributes of the root that percentages refer to.
const VIEWPORT: [&str; 3] = ["height", "viewBox", "width"];

/// Commands and points, as bits.
type Form = Vec<u32>;

/// Elements that draw, by what usvg makes of them in the viewport of the root.
pub(super) struct Forms<'a>(HashMap<Form, Node<'a, 'a>>);

impl<'a> Forms<'a> {
    /// Those of all shapes of a document; of equal ones the first.
    ///
    /// # Errors
    /// [`usvg::Error`] if usvg refuses the document.
    pub(super) fn new(document: &'a Document<'a>) -> Result<Self, usvg::Error> {
        let elements: Vec<Node<'_, '_>> = document.descendants().filter(|node| is_shape(*node)).collect();
        // With a pen even lines, which enclose nothing, are drawn.
        let mut text = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" stroke=\"#000\"");
        copy(document.root_element(), &VIEWPORT, &mut text);
        text.push('>');
        for (k, element) in elements.iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = write!(text, "<{} id=\"{k}\"", element.tag_name().name());
            copy(*element, &GEOMETRY, &mut text);
            text.push_str("/>");
        }
        text.push_str("</svg>");
        let tree = Tree::from_str(&text, &Options::default())?;
        let mut forms = HashMap::new();
        collect(tree.root(), &elements, &mut forms);
        Ok(Self(forms))
    }

    /// An element that draws the same as a path.
    pub(super) fn get(&self, path: &usvg::Path) -> Option<Node<'a, 'a>> {
        self.0.get(&form(path)).copied()
    }
}

/// Appends attributes; those that are no numbers may be left out.
fn copy(node: Node<'_, '_>, names: &[&str], text: &mut String) {
    for name in names {
        if let Some(value) = node.attribute(*name).filter(|value| !value.contains(['"', '<', '&'])) {
            text.extend([" ", name, "=\"", value, "\""]);
        }
    }
}

fn collect<'a>(group: &Group, elements: &[Node<'a, 'a>], forms: &mut HashMap<Form, Node<'a, 'a>>) {
    for child in group.children() {
        match child {
            usvg::Node::Group(group) => collect(group, elements, forms),
            usvg::Node::Path(path) => {
                if let Some(&element) = path.id().parse::<usize>().ok().and_then(|k| elements.get(k)) {
                    forms.entry(form(path)).or_insert(element);
                }
            }
            usvg::Node::Image(_) | usvg::Node::Text(_) => (),
        }
    }
}

fn form(path: &usvg::Path) -> Form {
    let mut form = Form::new();
    for segment in path.data().segments() {
        let (command, points) = match segment {
            PathSegment::MoveTo(to) => (0, vec![to]),
            PathSegment::LineTo(to) => (1, vec![to]),
            PathSegment::QuadTo(control, to) => (2, vec![control, to]),
            PathSegment::CubicTo(first, second, to) => (3, vec![first, second, to]),
            PathSegment::Close => (4, Vec::new()),
        };
        form.push(command);
        form.extend(points.iter().flat_map(|point| [point.x.to_bits(), point.y.to_bits()]));
    }
    form
}
