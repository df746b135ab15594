//! Refuses numbers so large that their curves would fill the memory before anything is drawn.

use svgtypes::{Length, LengthUnit, PathParser, PathSegment};
use usvg::roxmltree::Node;

use super::error::SvgError;
use super::source::is_shape;

/// Largest number, in whatever unit: well above all that pictures are made of, and good to a thousandth in 32 bits and less.
const LARGEST: f64 = 1e7;

/// Attributes that are lengths.
const LENGTHS: [&str; 14] =
    ["cx", "cy", "height", "r", "rx", "ry", "width", "x", "x1", "x2", "y", "y1", "y2", "stroke-width"];

/// Refuses an element with such numbers.
///
/// # Errors
/// [`SvgError::TooLarge`], [`SvgError::FontUnits`].
pub(super) fn check(node: Node<'_, '_>) -> Result<(), SvgError> {
    let place = || (node.tag_name().name().to_owned(), node.document().text_pos_at(node.range().start).row);
    let too_large = |value: f64| {
        let (tag, line) = place();
        Err(SvgError::TooLarge { tag, line, value, limit: LARGEST })
    };
    for attribute in node.attributes().filter(|attribute| LENGTHS.contains(&attribute.name())) {
        let Ok(length) = attribute.value().trim().parse::<Length>() else { continue };
        if is_too_large(length.number) {
            return too_large(length.number);
        }
        // Elements that draw nothing here, such as text, are no reason to refuse the others.
        let is_drawn = is_shape(node) || node.tag_name().name() == "svg" && node.parent_element().is_some();
        if is_drawn && matches!(length.unit, LengthUnit::Em | LengthUnit::Ex) {
            let (tag, line) = place();
            return Err(SvgError::FontUnits { tag, line });
        }
    }
    let view_box = node.attribute("viewBox").and_then(|text| text.parse::<svgtypes::ViewBox>().ok());
    if let Some(view_box) = view_box {
        let numbers = [view_box.x, view_box.y, view_box.w, view_box.h];
        if let Some(&value) = numbers.iter().find(|value| is_too_large(**value)) {
            return too_large(value);
        }
    }
    let arcs = node.attribute("d").into_iter().flat_map(|data| PathParser::from(data).map_while(Result::ok));
    for segment in arcs {
        if let PathSegment::EllipticalArc { rx, ry, .. } = segment
            && (is_too_large(rx) || is_too_large(ry))
        {
            return too_large(rx.abs().max(ry.abs()));
        }
    }
    Ok(())
}

fn is_too_large(value: f64) -> bool {
    !value.is_finite() || value.abs() > LARGEST
}
