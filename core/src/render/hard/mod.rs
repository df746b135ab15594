//! Hard coverage: 1 where the center of a pixel lies inside of an object, else 0. Masks, not gradients.
//!
//! In: closed rings in pixels. Out: coverage 0 or 1 per pixel under the even-odd rule. A center on an edge counts
//! as inside if the edge is a left or upper side, as outside if it is a right or lower side, so that outlines with an edge
//! in common never share a pixel and leave none out.
//!
//! *Derivative*: coverage is piecewise constant in the vertices, so their gradient is 0 and says nothing; colors,
//! confidences and background keep theirs.
//!
//! | file | holds |
//! |---|---|
//! | `parity.rs` | crossings of edges and rows, counted along the row |
//! | `index.rs` | masks of objects as an index image |
//!
//! Proved by `tests/property/hard.rs` (against a point-in-polygon test, sharing of edges).

mod index;
mod parity;
#[cfg(test)]
mod tests;

pub use index::{BACKGROUND, object_index};
pub use parity::HardRecord;

use self::parity::Cover;
use super::RenderError;
use super::tile::{CoverageModel, Tile, TileRenderer, TileScratch};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::shape::Rings;
use crate::simd::dispatch;

/// Paints objects with hard edges.
pub type HardRenderer = TileRenderer<HardMask>;

/// Memory of a [`HardRenderer`].
pub type HardScratch<T> = TileScratch<T, HardRecord>;

/// Coverage 1 where the pixel center is inside, else 0. The masks of all objects are
/// [`TileRenderer::object_coverage`], the topmost object of each pixel is [`object_index`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HardMask;

impl<T: Real> CoverageModel<T> for HardMask {
    type Record = HardRecord;

    fn check(&self) -> Result<(), RenderError> {
        Ok(())
    }

    fn reach_px(&self, _unit_px: T) -> T {
        T::zero()
    }

    fn smallest_coverage(&self) -> T {
        T::one()
    }

    fn cover(
        &self,
        rings_px: Rings<'_, T>,
        _size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut HardRecord,
        _backward: bool,
    ) -> Result<(), RenderError> {
        dispatch(Cover { rings_px, tile, record });
        Ok(())
    }

    fn cover_vjp(&self, _: Rings<'_, T>, _: ImageSize, _: &mut Tile<T>, _: &mut HardRecord, _: &mut [[T; 2]]) {}
}
