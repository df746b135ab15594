//! Scenes as SVG: few smooth paths that draw what the renderers show, in a file that people can edit.
//!
//! In: a scene and an image size. Out: one `<path>` per object, in unit coordinates, with the pose as a readable
//! `transform="translate(x y) rotate(degrees) scale(pixels)"`.
//!
//! Renderers fatten an outline by the edge profile's offset (1.43 px at 128 px for the reference profile), so each path has
//! a stroke of its own color, twice that wide. Under `blend`, the common part of overlapping objects shows the mean
//! of their colors: it is drawn again, through a mask.
//!
//! Blurred edges are a Gaussian filter over all objects; other softness is left to the viewer's anti-aliasing.
//!
//! Approximations: fully confident objects mix exactly except for the outermost pixel of the common part; objects with a
//! confidence below 0.99 are drawn with that opacity, one over the other; outlines pass the 64 vertices that renderers paint within 0.2 px, but as smooth curves.
//!
//! | file | holds |
//! |---|---|
//! | `path.rs` | polygons to few lines and cubic Bezier curves |
//! | `overlap.rs` | which sets of objects share pixels |
//! | `write.rs` | the text |
//!
//! `tests/command/svg.rs` compares with pixels drawn by another program (resvg).

mod overlap;
mod path;
mod write;

pub use write::to_svg;

#[cfg(test)]
mod tests;
