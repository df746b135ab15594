//! SVG to scenes: what is drawn stays the shape that it is.
//!
//! usvg resolves styles, units, transforms and uses; the document itself says what each of its paths was. Circles, ellipses, rectangles,
//! polygons, paths and strokes keep their kind under every transform that keeps it; otherwise they are paths with the transform
//! in their numbers. An element with fill and stroke is two objects. What a scene has not is counted in [`Losses`].
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `source` | text | the same, checked, an id in every element that draws |
//! | `references` | document | whether it is small enough with all its uses |
//! | `numbers` | element | whether its numbers are small enough |
//! | `walk` | usvg's tree | objects |
//! | `forms` | document | elements of the paths that usvg hands on without an id |
//! | `figure` | element | what it draws, in its own numbers |
//! | `path_data` | path data | rings of lines, arcs and cubics |
//! | `place` | figure, transform | shape and pose |
//! | `stroke` | figure, transform, style | stroke |
//! | `paint` | paint | color or ramp of colors, and opacity |
//! | `gradient` | gradient | ramp, or mean color |
//! | `clip` | clip paths, masks | regions |
//! | `losses` | | what was not kept |

mod clip;
mod error;
mod figure;
mod forms;
mod gradient;
mod losses;
mod numbers;
mod paint;
mod path_data;
mod place;
mod references;
mod source;
mod stroke;
#[cfg(test)]
mod tests;
mod walk;

use dvp_core::dims::SizeError;
use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::{AnyShape, Rectangle};
use dvp_core::{ImageSize, Object, Real as _, Scene};
use usvg::roxmltree::{Document, Node};
use usvg::{ImageHrefResolver, Options, Tree};

pub use error::SvgError;
pub use losses::Losses;

use walk::{Inherited, Walk};

/// Longest side, pixels.
const LONGEST_PX: f32 = 32_768.0;

/// How far a rectangle may stay inside of the border and still be the background, pixels.
const BORDER_PX: f64 = 1e-3;

/// A drawing as a scene.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SvgDrawing {
    /// What is drawn: edges by exact area, later objects over earlier ones; transparent unless the first object covers
    /// everything, which is the background then. One whose color changes stays, before its mean color.
    pub scene: Scene<f64>,
    /// The viewport, its sides rounded up to whole pixels.
    pub size: ImageSize,
    /// What could not be kept.
    pub losses: Losses,
}

/// Reads an SVG text.
///
/// # Errors
/// [`SvgError`] if it is no SVG, or has too much of something: text, elements, nesting, lines and curves, stops of gradients, distance.
pub fn from_svg(text: &str) -> Result<SvgDrawing, SvgError> {
    let labeled = source::labeled(text)?;
    let document = source::parse(&labeled)?;
    let nothing = ImageHrefResolver { resolve_data: Box::new(|_, _, _| None), resolve_string: Box::new(|_, _| None) };
    let options = Options { image_href_resolver: nothing, ..Options::default() };
    let tree = Tree::from_xmltree(&document, &options)?;
    let (width, height) = (tree.size().width(), tree.size().height());
    let size = whole(width, height).map_err(|_| SvgError::Size { width, height, limit: LONGEST_PX })?;
    let unit = f64::of_usize(size.unit_px());
    let mut walk = Walk::new(&document, 1.0 / unit);
    walk.group(tree.root(), &Inherited::default())?;
    let Walk { mut objects, mut losses, .. } = walk;
    unseen(&document, &mut losses);
    let extent = [width, height].map(|side| f64::from(side) / unit);
    let background = objects.first().and_then(|object| background(object, extent, BORDER_PX / unit));
    if background.is_some() && objects.first().is_some_and(|object| object.paint.ramp().is_none()) {
        objects.remove(0);
    }
    let scene = Scene {
        background: background.unwrap_or([1.0; 3]),
        transparent: background.is_none(),
        objects,
        edge: EdgeProfile::area(),
        compositing: Compositing::Over,
    };
    Ok(SvgDrawing { scene, size, losses })
}

/// Sides rounded up; a thousandth of a pixel more than a whole number is none.
fn whole(width: f32, height: f32) -> Result<ImageSize, SizeError> {
    let side = |side: f32| if side > 0.0 && side <= LONGEST_PX { (side - 1e-3).ceil().to_count().max(1) } else { 0 };
    ImageSize::new(side(width), side(height))
}

/// The color of an object that covers the whole picture, or the mean of its colors.
fn background(object: &Object<f64>, [width, height]: [f64; 2], border: f64) -> Option<[f64; 3]> {
    let AnyShape::Rectangle(Rectangle { size, corner_radius }) = object.shape else { return None };
    let is_plain = object.confidence >= 1.0 && corner_radius <= 0.0 && object.pose.rotation == 0.0;
    let covers =
        |center: f64, side: f64, extent: f64| center - 0.5 * side <= border && center + 0.5 * side >= extent - border;
    let [x, y] = object.pose.translation;
    (is_plain && covers(x, size[0], width) && covers(y, size[1], height)).then(|| object.color())
}

/// Counts elements that usvg leaves out without a word.
fn unseen(document: &Document<'_>, losses: &mut Losses) {
    const DEFINITIONS: [&str; 7] = ["clipPath", "defs", "filter", "marker", "mask", "pattern", "symbol"];
    let is_drawn = |node: &Node<'_, '_>| {
        node.ancestors()
            .all(|node| !DEFINITIONS.contains(&node.tag_name().name()) && node.attribute("display") != Some("none"))
    };
    for node in document.descendants().filter(is_drawn) {
        match node.tag_name().name() {
            "text" => losses.add("text: not drawn"),
            "image" => losses.add("image: not drawn"),
            "foreignObject" => losses.add("foreignObject: not drawn"),
            _ => (),
        }
    }
}
