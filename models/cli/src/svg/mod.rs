//! Scenes as SVG, and SVG as scenes: circles, ellipses, rectangles, polygons, paths and strokes that people can edit.
//!
//! The way out is that of `dvp-formats`.

mod read;
#[cfg(test)]
mod tests;

pub use dvp_formats::svg::{to_svg, to_svg_numbered};
pub use read::{Losses, SvgDrawing, SvgError, from_svg};
