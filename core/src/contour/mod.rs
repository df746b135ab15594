//! Contours traced from masks: in a grid of pixels, out closed polygons.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `label` | a mask, or what neighbors have in common | connected components, [`label`], [`label_by`] |
//! | `walk` | a yes or no per pixel | the cracks between yes and no, loop by loop; [`Crack`] |
//! | `trace` | a mask, or a field and a level | closed polygons, [`trace_mask`], [`trace_level`] |
//! | `polygon` | a polygon | area, centroid, perimeter, inside or not, points at equal distances |
//!
//! *Units*: pixels; the pixel (row r, column c) covers \[c, c + 1\] x \[r, r + 1\], x right, y down. Divided by
//! [`ImageSize::unit_px`](crate::ImageSize::unit_px) they are scene units. A polygon is a slice of vertices, closed by the edge from
//! its last one to its first. Everything here takes time linear in its input, and no mask makes it fail.

mod label;
mod polygon;
#[cfg(test)]
mod tests;
mod trace;
mod walk;

pub use label::{Components, label, label_by};
pub use polygon::{centroid, contains, perimeter, resample, signed_area};
pub use trace::{trace_level, trace_mask};
pub use walk::{Crack, Heading};

/// Which neighbors of a pixel are in one piece with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Connectivity {
    /// Those that share an edge.
    #[default]
    Four,
    /// Those that share an edge or a corner.
    Eight,
}

/// Why a grid was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContourError {
    /// The slice is not one value per pixel.
    Length {
        /// Width x height.
        expected: usize,
        /// What came.
        len: usize,
    },
}

impl core::fmt::Display for ContourError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Length { expected, len } => write!(f, "the grid has {len} values, needs {expected} (width x height)"),
        }
    }
}

impl core::error::Error for ContourError {}
