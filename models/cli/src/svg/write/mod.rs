//! Scenes to SVG.
//!
//! | file | holds |
//! |---|---|
//! | `document` | the text of the file, [`to_svg`] and [`to_svg_numbered`] |
//! | `drawn` | objects with their colors, opacities and names |
//! | `element` | an object as `<circle>`, `<ellipse>`, `<rect>`, `<polygon>` or `<path>` |
//! | `figure` | closed lines that are circles or rectangles |
//! | `path_data` | lines, arcs and cubics as path data |
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
#[cfg(test)]
mod tests;

pub use document::{to_svg, to_svg_numbered};
