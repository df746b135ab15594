//! How often and how deep the elements of a document are used: what is small as a text may be huge as a drawing.
//!
//! Elements use others by `href` and by `url(#...)`, in attributes, in `style` and in style sheets.

use std::collections::HashMap;

use simplecss::{AttributeOperator, Declaration, DeclarationTokenizer, PseudoClass, StyleSheet};
use usvg::roxmltree::{Document, Node, NodeId};

use super::error::SvgError;

/// Most elements, each counted as often as it is used.
const MOST_ELEMENTS: usize = 1 << 18;

/// Elements are not nested so deep, nor used by elements that are used by others.
const DEEPEST: usize = 128;

/// Most tests of a rule of the style sheet against an element.
const MOST_STYLE_TESTS: usize = 1 << 27;

/// Elements whose `href` leads to no part of the drawing.
const NOT_USING: [&str; 7] = ["a", "animate", "animateMotion", "animateTransform", "mpath", "script", "set"];

/// Refuses documents that draw too many elements, too deep, or elements that use themselves.
///
/// # Errors
/// [`SvgError::TooManyElements`], [`SvgError::TooDeep`], [`SvgError::Recursive`], [`SvgError::Styles`].
pub(super) fn check(document: &Document<'_>) -> Result<(), SvgError> {
    let elements = document.descendants().filter(Node::is_element).count();
    let mut styles = StyleSheet::new();
    let sheets = document.descendants().filter(|node| node.has_tag_name("style"));
    sheets.filter_map(|node| node.text()).for_each(|text| styles.parse_more(text));
    let rules = styles.rules.len();
    if elements.saturating_mul(rules) > MOST_STYLE_TESTS {
        return Err(SvgError::Styles { rules, elements });
    }
    styles.rules.retain(|rule| rule.declarations.iter().any(|declaration| declaration.value.contains("url(")));
    let mut by_id: HashMap<&str, Vec<Node<'_, '_>>> = HashMap::new();
    for node in document.descendants().filter(Node::is_element) {
        if let Some(id) = node.attribute("id") {
            by_id.entry(id).or_default().push(node);
        }
    }
    let mut count = Count { styles, by_id, known: HashMap::new() };
    count.of(document.root_element(), 0).map(|_| ())
}

/// What an element comes to with all that is in it and all that it uses.
#[derive(Clone, Copy)]
struct Total {
    elements: usize,
    depth: usize,
}

struct Count<'a, 'input> {
    /// The rules that use elements.
    styles: StyleSheet<'a>,
    by_id: HashMap<&'a str, Vec<Node<'a, 'input>>>,
    /// None for elements that are being counted.
    known: HashMap<NodeId, Option<Total>>,
}

impl<'a, 'input> Count<'a, 'input> {
    fn of(&mut self, node: Node<'a, 'input>, depth: usize) -> Result<Total, SvgError> {
        let line = || node.document().text_pos_at(node.range().start).row;
        if depth >= DEEPEST {
            return Err(SvgError::TooDeep { limit: DEEPEST, line: line() });
        }
        match self.known.insert(node.id(), None) {
            Some(None) => return Err(SvgError::Recursive { tag: node.tag_name().name().to_owned(), line: line() }),
            Some(Some(total)) if depth + total.depth >= DEEPEST => {
                return Err(SvgError::TooDeep { limit: DEEPEST, line: line() });
            }
            Some(Some(total)) => {
                self.known.insert(node.id(), Some(total));
                return Ok(total);
            }
            None => (),
        }
        let mut total = Total { elements: 1, depth: 0 };
        for used in node.children().filter(Node::is_element).chain(self.used_by(node)) {
            let part = self.of(used, depth + 1)?;
            let times = if used.has_tag_name("marker") { vertices(node) } else { 1 };
            total.elements = total.elements.saturating_add(part.elements.saturating_mul(times));
            total.depth = total.depth.max(part.depth + 1);
        }
        if total.elements > MOST_ELEMENTS {
            return Err(SvgError::TooManyElements { limit: MOST_ELEMENTS });
        }
        self.known.insert(node.id(), Some(total));
        Ok(total)
    }

    /// The elements that an element uses.
    fn used_by(&self, node: Node<'a, 'input>) -> Vec<Node<'a, 'input>> {
        let mut ids: Vec<&str> = Vec::new();
        for attribute in node.attributes() {
            let value = attribute.value();
            match attribute.name() {
                "href" if !NOT_USING.contains(&node.tag_name().name()) => ids.extend(value.trim().strip_prefix('#')),
                "style" => {
                    DeclarationTokenizer::from(value).for_each(|Declaration { value, .. }| ids.extend(urls(value)))
                }
                _ => ids.extend(urls(value)),
            }
        }
        for rule in self.styles.rules.iter().filter(|rule| rule.selector.matches(&Styled(node))) {
            rule.declarations.iter().for_each(|declaration| ids.extend(urls(declaration.value)));
        }
        ids.iter().filter_map(|id| self.by_id.get(id)).flatten().copied().collect()
    }
}

/// At most so many vertices has what an element draws: each takes two letters at least. Markers stand at every one.
fn vertices(node: Node<'_, '_>) -> usize {
    let length = |name: &str| node.attribute(name).map_or(0, str::len);
    2 + (length("d") + length("points")) / 2
}

/// The ids in a value such as `url(#a) blur(2px)`.
fn urls(value: &str) -> impl Iterator<Item = &str> {
    value.split("url(").skip(1).filter_map(|rest| {
        let inside = rest.split(')').next()?.trim().trim_matches(['"', '\'']).trim();
        inside.strip_prefix('#')
    })
}

/// An element as style sheets see it.
struct Styled<'a, 'input>(Node<'a, 'input>);

impl simplecss::Element for Styled<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(Self)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(Self)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, local_name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0.attribute(local_name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        matches!(class, PseudoClass::FirstChild) && self.0.prev_sibling_element().is_none()
    }
}
