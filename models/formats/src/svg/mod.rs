//! Scenes to SVG: circles, ellipses, rectangles, polygons, paths and strokes that people can edit.
//!
//! In: a scene and an image size. Out: one element per object, named `object-1` and so on, in pixels, with the pose in its numbers; a `transform` only
//! where an ellipse or a rectangle is turned.
//!
//! Renderers fatten an outline by the edge profile's offset (1.43 px at 128 px for the reference profile), so each element then has
//! a stroke of its own color, twice that wide. Under `blend`, the common part of overlapping objects shows a mixture
//! of their colors: it is drawn again, through a mask. Blurred edges are a Gaussian filter over all objects; other softness is left to
//! the viewer's anti-aliasing.
//!
//! Approximations: the outermost pixel of the common part of objects under `blend`; translucent objects that overlap under `blend` on
//! transparent ground are drawn one over the other, and so are common parts of more than 16 objects or beyond the first 4,096, which a
//! comment in the file says; common parts of objects with color ramps mix their mean colors; outlines of descriptors pass the 64 vertices that renderers paint within 0.15 px, but as
//! smooth curves; offsets below 0 are not drawn.
//!
//! `tests/command/svg.rs` compares with pixels drawn by another program (resvg).
//!
//! | file | holds |
//! |---|---|
//! | `document` | the text of the file, [`to_svg`] and [`to_svg_numbered`] |
//! | `drawn` | objects with their colors, opacities and names |
//! | `element` | an object as `<circle>`, `<ellipse>`, `<rect>`, `<polygon>` or `<path>` |
//! | `figure` | closed lines that are circles or rectangles |
//! | `path_data` | lines, arcs and cubics as path data |
//! | `ramp` | color ramps as `<linearGradient>` and `<radialGradient>` |
//! | `curves` | outlines of descriptors as few smooth curves |
//! | `mixture` | the colors of overlaps under `blend` |
//! | `overlap` | which sets of objects share pixels |
//! | `number` | decimal numbers |

mod curves;
mod document;
mod drawn;
mod element;
mod figure;
mod mixture;
mod number;
mod overlap;
mod path_data;
mod ramp;
#[cfg(test)]
mod tests;

pub use document::{to_svg, to_svg_numbered};
