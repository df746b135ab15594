//! Exact coverage: the share of each pixel that lies inside of an object, what drawing programs call analytic
//! anti-aliasing.
//!
//! In: closed rings in pixels. Out: coverage per pixel, and backward the gradient of the vertices. There is no edge
//! profile: rings cover what they enclose, with neither fattening nor softness.
//!
//! Overlap follows the even-odd rule, as in the other renderers of the crate: what is enclosed twice is outside, whichever
//! way round the rings are drawn.
//!
//! | file | holds |
//! |---|---|
//! | `orientation.rs` | which way round each ring is walked |
//! | `pieces.rs` | an edge cut at the pixel grid |
//! | `area.rs` | forward: the winding number integrated over pixels, even-odd coverage |
//! | `area_vjp.rs` | backward: what a moving edge sweeps |
//!
//! Proved by `tests/property/exact.rs` (against supersampling, area sums, whole-pixel shifts) and
//! `tests/gradient/exact.rs`.
//!
//! *Source*: signed-area accumulation as in font rasterizers (R. Levien, font-rs; FreeType's smooth rasterizer); the
//! derivative is Reynolds' transport theorem per pixel.

mod area;
mod area_vjp;
mod orientation;
mod pieces;
#[cfg(test)]
mod tests;

pub use area::ExactRecord;

use self::area::Cover;
use self::area_vjp::CoverVjp;
use super::tile::{CoverageModel, Tile, TileRenderer};
use super::{RenderError, tile::TileScratch};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::shape::Rings;
use crate::simd::dispatch;

/// Paints objects with exact area coverage.
pub type ExactRenderer = TileRenderer<ExactArea>;

/// Memory of an [`ExactRenderer`].
pub type ExactScratch<T> = TileScratch<T, ExactRecord<T>>;

/// Coverage by the area of pixel and object in common.
///
/// *Derivative*: exact, see [`TileRenderer`]'s `render_vjp`; piecewise smooth, with kinks where a vertex or an
/// axis-parallel edge crosses the pixel grid. Where a pixel is wholly inside or outside there is none: an object that
/// meets no difference along its outline gets a zero gradient.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExactArea;

impl<T: Real> CoverageModel<T> for ExactArea {
    type Record = ExactRecord<T>;

    fn check(&self) -> Result<(), RenderError> {
        Ok(())
    }

    fn reach_px(&self, _unit_px: T) -> T {
        // From the center of a pixel to its side.
        T::of(0.5)
    }

    fn smallest_coverage(&self) -> T {
        T::zero()
    }

    fn cover(
        &self,
        rings_px: Rings<'_, T>,
        _size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut ExactRecord<T>,
        _backward: bool,
    ) -> Result<(), RenderError> {
        record.orientation.find(rings_px);
        dispatch(Cover { rings_px, tile, record });
        Ok(())
    }

    fn cover_vjp(
        &self,
        rings_px: Rings<'_, T>,
        _size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut ExactRecord<T>,
        grad_px: &mut [[T; 2]],
    ) {
        dispatch(CoverVjp { rings_px, tile, record, grad_px });
    }
}
