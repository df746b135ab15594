//! An SVG of ours to its pixels and, from the same text, to its label map.

use core::ops::Range;

use image::{ImageBuffer, Luma, RgbaImage};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::roxmltree::{Document, Node};
use resvg::usvg::{Options, Tree};

/// Elements that put color on the picture.
const SHAPES: [&str; 7] = ["circle", "ellipse", "rect", "path", "polygon", "polyline", "line"];

/// Attributes that make a mask other than full.
const OPACITIES: [&str; 4] = ["opacity", "fill-opacity", "stroke-opacity", "filter"];

/// Masks are drawn with this many pixels per pixel along each side: the anti-aliasing of one pixel knows few shares.
const FINER: u8 = 4;

/// A picture with the truth about it.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The pixels, transparent where the SVG leaves them so.
    pub picture: RgbaImage,
    /// Per pixel k for the k-th element with an `id` (in document order, from 1) where it is the topmost one that covers at
    /// least half of the pixel, else 0.
    pub labels: ImageBuffer<Luma<u16>, Vec<u16>>,
}

/// Draws a picture and its label map with resvg.
///
/// Each object is one element with an `id`; elements without one belong to the background. Every shape says its own
/// `fill` or `stroke`. The label map takes translucent objects for opaque ones: the topmost object owns the pixel. What is
/// drawn without anti-aliasing (`shape-rendering="crispEdges"`) owns what it colors.
///
/// # Errors
/// A sentence, if the text is no such SVG.
pub fn draw_with_labels(text: &str) -> Result<Drawn, String> {
    let picture = draw_enlarged(text, 1)?;
    let mut labels = ImageBuffer::new(picture.width(), picture.height());
    for (label, mask) in masks(text)? {
        label_covered(&mask, label, &mut labels)?;
    }
    Ok(Drawn { picture, labels })
}

/// Draws a picture with `factor` pixels per pixel along each side.
///
/// # Errors
/// A sentence, if the text is no SVG.
pub fn draw_enlarged(text: &str, factor: u8) -> Result<RgbaImage, String> {
    let tree = tree(text)?;
    let size = tree.size().to_int_size();
    let [width, height] = [size.width(), size.height()].map(|side| side * u32::from(factor));
    let mut pixels = Pixmap::new(width, height).ok_or("an empty picture")?;
    resvg::render(&tree, Transform::from_scale(factor.into(), factor.into()), &mut pixels.as_mut());
    let straight = pixels.pixels().iter().flat_map(|pixel| {
        let color = pixel.demultiply();
        [color.red(), color.green(), color.blue(), color.alpha()]
    });
    Ok(RgbaImage::from_raw(width, height, straight.collect()).ok_or("an empty picture")?)
}

fn tree(text: &str) -> Result<Tree, String> {
    Tree::from_str(text, &Options::default()).map_err(|error| error.to_string())
}

/// The same SVG with one shape alone, for each shape, with the label of its pixels.
fn masks(text: &str) -> Result<Vec<(u16, String)>, String> {
    let document = Document::parse(text).map_err(|error| error.to_string())?;
    let is_shape = |node: &Node<'_, '_>| SHAPES.contains(&node.tag_name().name());
    let shapes: Vec<Node<'_, '_>> = document.descendants().filter(is_shape).collect();
    let attributes = document.descendants().flat_map(|node| node.attributes());
    let opacities: Vec<Range<usize>> = attributes
        .filter(|attribute| OPACITIES.contains(&attribute.name()))
        .map(|attribute| attribute.range())
        .collect();
    let mut masks = Vec::new();
    let mut objects = 0;
    for shape in &shapes {
        if !shape.attributes().any(|a| ["fill", "stroke"].contains(&a.name()) && a.value() != "none") {
            return Err(format!("{}: neither fill nor stroke of its own", &text[shape.range()]));
        }
        objects += u16::from(shape.has_attribute("id"));
        let others = shapes.iter().filter(|other| *other != shape).map(Node::range);
        let mut cuts: Vec<Range<usize>> = opacities.clone();
        cuts.retain(|cut| shapes.iter().all(|other| other == shape || !other.range().contains(&cut.start)));
        cuts.extend(others);
        cuts.sort_by_key(|cut| cut.start);
        let mut mask = text.to_owned();
        cuts.into_iter().rev().for_each(|cut| mask.replace_range(cut, ""));
        masks.push((if shape.has_attribute("id") { objects } else { 0 }, mask));
    }
    Ok(masks)
}

/// Gives what an SVG of one shape covers by at least half to `label`.
fn label_covered(mask: &str, label: u16, labels: &mut ImageBuffer<Luma<u16>, Vec<u16>>) -> Result<(), String> {
    let tree = tree(mask)?;
    let finer = if mask.contains("crispEdges") { 1 } else { FINER };
    let bounds = tree.root().abs_layer_bounding_box();
    let range = |low: f32, high: f32, side: u32| {
        let inside = |&at: &u32| f64::from(at + 1) > f64::from(low) && f64::from(at) < f64::from(high);
        let mut pixels = (0..side).filter(inside);
        pixels.next().map(|first| (first, 1 + pixels.next_back().unwrap_or(first) - first))
    };
    let columns = range(bounds.left(), bounds.right(), labels.width());
    let rows = range(bounds.top(), bounds.bottom(), labels.height());
    let (Some((left, width)), Some((top, height))) = (columns, rows) else { return Ok(()) };
    let step = u32::from(finer);
    let mut pixels = Pixmap::new(width * step, height * step).ok_or("an empty mask")?;
    let offset = |from: u32| u16::try_from(from * step).map(|from| -f32::from(from)).map_err(|error| error.to_string());
    let scale = f32::from(finer);
    let transform = Transform::from_row(scale, 0.0, 0.0, scale, offset(left)?, offset(top)?);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let parts = (0..step * step).filter_map(|i| pixels.pixel(x * step + i % step, y * step + i / step));
        let covered: u32 = parts.map(|part| u32::from(part.alpha())).sum();
        if 2 * covered >= 255 * step * step {
            labels.put_pixel(left + x, top + y, Luma([label]));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::draw_with_labels;

    #[test]
    fn the_topmost_element_with_an_id_owns_a_pixel() {
        let text = r##"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="4">
            <rect width="8" height="4" fill="#fff"/>
            <rect id="a" width="4" height="4" fill="#f00" opacity="0.5"/>
            <rect id="b" x="2" width="4.6" height="4" fill="#00f" shape-rendering="auto"/>
            <rect x="5" width="1" height="4" fill="#fff"/>
            <line id="c" x1="0" y1="3.5" x2="1" y2="3.5" stroke="#000"/>
        </svg>"##;
        let drawn = draw_with_labels(text).unwrap();
        let row = |y| (0..8).map(|x| drawn.labels.get_pixel(x, y).0[0]).collect::<Vec<u16>>();
        // The right side of b at 6.6 covers more than half of pixel 6; the strip over it is background.
        assert_eq!(row(0), [1, 1, 2, 2, 2, 0, 2, 0]);
        assert_eq!(row(3), [3, 1, 2, 2, 2, 0, 2, 0]);
        // Half of red over white: 127.5, which may be rounded either way.
        let [red, green, ..] = drawn.picture.get_pixel(0, 0).0;
        assert!(red == 255 && (127..=128).contains(&green), "{red} {green}");
    }

    #[test]
    fn a_shape_without_color_of_its_own_is_refused() {
        let text = r#"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="4"><rect id="a" width="4"/></svg>"#;
        assert!(draw_with_labels(text).unwrap_err().contains("neither fill nor stroke"));
    }
}
