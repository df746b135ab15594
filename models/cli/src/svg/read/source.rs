//! The text of a drawing, checked, with a name for every element that draws.
//!
//! usvg resolves styles, units, transforms and uses, but makes paths of all shapes. Each of these paths has the id of its element, so that
//! the element can be looked up and the shape stays what it was: elements without an id are given one before usvg reads them.

use std::collections::HashMap;

use usvg::roxmltree::{Document, Node, ParsingOptions};

use super::error::SvgError;
use super::{numbers, references};

/// Longest text that is read, bytes.
const MAX_TEXT: usize = 16 << 20;

/// Longest text that entities may become, bytes.
const MAX_ENTITIES: usize = 256 << 20;

/// Most uses of other entities in what stands for one use of an entity.
const MAX_INNER_ENTITIES: usize = 256;

/// What stands for one character.
const PLAIN: [&str; 6] = ["amp;", "lt;", "gt;", "quot;", "apos;", "#"];

/// The elements that draw shapes.
const SHAPES: [&str; 7] = ["circle", "ellipse", "line", "path", "polygon", "polyline", "rect"];

/// The text with an id in every element that draws.
///
/// # Errors
/// [`SvgError`] if the text is no XML, or too large in one of many ways.
pub(super) fn labeled(text: &str) -> Result<String, SvgError> {
    if text.len() > MAX_TEXT {
        return Err(SvgError::TooLong { bytes: text.len(), limit: MAX_TEXT });
    }
    let declared: usize = text.split("<!ENTITY").skip(1).map(|rest| rest.find('>').unwrap_or(rest.len())).sum();
    let uses = text.split('&').skip(1).filter(|rest| !PLAIN.iter().any(|plain| rest.starts_with(plain))).count();
    if uses.saturating_mul(MAX_INNER_ENTITIES).saturating_mul(declared) > MAX_ENTITIES {
        return Err(SvgError::Entities { limit: MAX_ENTITIES });
    }
    let document = parse(text)?;
    references::check(&document)?;
    document.descendants().filter(Node::is_element).try_for_each(numbers::check)?;
    let mut prefix = String::from("dvp-");
    while text.contains(&prefix) {
        prefix.push('-');
    }
    let mut labeled = String::with_capacity(text.len() + 64);
    // What comes from an entity stands where the entity was declared, before the root, and perhaps more than once.
    let root = document.root_element().range().start;
    let mut done = 0;
    for (k, node) in document.descendants().filter(|node| is_shape(*node) && !node.has_attribute("id")).enumerate() {
        let tag = node.range().start + 1;
        let name = text.get(tag..).and_then(|rest| rest.find([' ', '\t', '\r', '\n', '/', '>']));
        if let (Some(length), true) = (name, tag > done.max(root) && text[..tag].ends_with('<')) {
            labeled.push_str(&text[done..tag + length]);
            labeled.push_str(&format!(" id=\"{prefix}{k}\""));
            done = tag + length;
        }
    }
    labeled.push_str(&text[done..]);
    Ok(labeled)
}

/// The document of a text that was checked.
///
/// # Errors
/// [`SvgError::Xml`].
pub(super) fn parse(text: &str) -> Result<Document<'_>, SvgError> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Ok(Document::parse_with_options(text, options)?)
}

/// The elements that draw, by their ids; empty ones, and those that several elements have, are left out.
pub(super) fn by_id<'a, 'input>(document: &'a Document<'input>) -> HashMap<&'a str, Node<'a, 'input>> {
    let mut found: HashMap<&str, Option<Node<'_, '_>>> = HashMap::new();
    for node in document.descendants().filter(Node::is_element) {
        if let Some(id) = node.attribute("id").filter(|id| !id.is_empty()) {
            found.entry(id).and_modify(|node| *node = None).or_insert(Some(node));
        }
    }
    found.into_iter().filter_map(|(id, node)| Some((id, node.filter(|node| is_shape(*node))?))).collect()
}

/// Whether an element draws.
pub(super) fn is_shape(node: Node<'_, '_>) -> bool {
    node.is_element() && SHAPES.contains(&node.tag_name().name())
}
