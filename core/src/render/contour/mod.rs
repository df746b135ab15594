//! Coverage by the distance to the outline: the reference's images without the seams of its triangles.
//!
//! With d2 the signed squared distance from the center of a pixel to the outline (doubled frame, negative inside), coverage
//! is logistic((offset - d2) / sigma), and 0 where d2 > cut. Inside and outside are told apart by the even-odd rule: a
//! pixel is inside where a ray to the left meets an odd number of edges; self-intersecting outlines have holes.
//!
//! Distances are worked out only in a narrow band along the outline: outside up to the cut, inside up to where coverage
//! is within 1e-6 of 1, which then counts as 1, without gradient.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the model and its settings in pixels |
//! | `edge.rs` | edges, and the blocks of pixels near them |
//! | `cover.rs` | forward: distance, inside, coverage |
//! | `cover_vjp.rs` | backward: coverage to vertices |
//!
//! `tests.rs` holds it against the definition, pixel by pixel; the golden tests `render_contour` against the reference's
//! images, masks and gradients; the gradient tests `render_contour` against differences.

mod cover;
mod cover_vjp;
mod edge;
#[cfg(test)]
mod tests;

pub use cover::ContourRecord;

use super::tile::{CoverageModel, Tile, TileRenderer};
use super::{Compositing, EdgeProfile, RenderError};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::simd::dispatch;

/// Inside, coverage this close to 1 counts as 1.
const SATURATION: f64 = 1e-6;

/// Smallest sigma: its reciprocal in pixels stays finite in f32.
const SOFTNESS_FLOOR: f64 = 1e-30;

/// Paints by the distance to the outline.
pub type ContourRenderer<T> = TileRenderer<ContourDistance<T>>;

impl<T: Real> ContourRenderer<T> {
    /// A renderer with the given profile and mixing.
    #[must_use]
    pub fn new(edge: EdgeProfile<T>, compositing: Compositing) -> Self {
        Self { coverage: ContourDistance { edge }, compositing }
    }
}

/// Coverage by the distance to the outline.
///
/// *Derivative*: of coverage with respect to the two vertices of the closest edge. Not differentiable where two edges are
/// equally close, nor at the cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourDistance<T> {
    /// How coverage falls off.
    pub edge: EdgeProfile<T>,
}

impl<T: Real> Default for ContourDistance<T> {
    fn default() -> Self {
        Self { edge: EdgeProfile::reference() }
    }
}

/// The edge profile in pixels.
#[derive(Clone, Copy, Debug)]
struct Band<T> {
    /// Signed squared distance of half coverage, px^2.
    offset: T,
    /// 1 / softness, 1 / px^2.
    sharpness: T,
    /// Signed squared distance beyond which coverage is 0, px^2.
    cut: T,
    /// Signed squared distance below which coverage is 1, px^2.
    full: T,
    /// Distance within which edges are looked at, px.
    reach: T,
}

impl<T: Real> ContourDistance<T> {
    fn band(&self, unit_px: T) -> Band<T> {
        // A squared length in the doubled frame, where 2 is the shorter side.
        let square = unit_px * unit_px * T::of(0.25);
        let EdgeProfile { offset, sigma, cut } = self.edge;
        let full = offset - sigma * T::of(-libm::log(SATURATION));
        Band {
            offset: offset * square,
            sharpness: (sigma * square).recip(),
            cut: cut * square,
            full: full * square,
            reach: (cut.abs().max(-full) * square).sqrt(),
        }
    }
}

impl<T: Real> CoverageModel<T> for ContourDistance<T> {
    type Record = ContourRecord<T>;

    fn check(&self) -> Result<(), RenderError> {
        let EdgeProfile { offset, sigma, cut } = self.edge;
        let refuse = |what, value: T, must| Err(RenderError::Setting { what, value: value.as_f64(), must });
        if !(sigma >= T::of(SOFTNESS_FLOOR) && sigma.is_finite()) {
            refuse("edge.sigma", sigma, "finite and at least 1e-30")
        } else if !offset.is_finite() {
            refuse("edge.offset", offset, "finite")
        } else if !cut.is_finite() {
            refuse("edge.cut", cut, "finite")
        } else {
            Ok(())
        }
    }

    fn reach_px(&self, unit_px: T) -> T {
        self.edge.cut.max(T::zero()).sqrt() * unit_px * T::of(0.5)
    }

    fn smallest_coverage(&self) -> T {
        let EdgeProfile { offset, sigma, cut } = self.edge;
        (((cut - offset) / sigma).exp() + T::one()).recip()
    }

    fn cover(
        &self,
        outline_px: &[[T; 2]],
        size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut ContourRecord<T>,
        backward: bool,
    ) -> Result<(), RenderError> {
        let band = self.band(T::of_usize(size.unit_px()));
        if backward {
            dispatch(cover::Cover::<T, true> { band, outline_px, size, tile, record });
        } else {
            dispatch(cover::Cover::<T, false> { band, outline_px, size, tile, record });
        }
        Ok(())
    }

    fn cover_vjp(
        &self,
        _outline_px: &[[T; 2]],
        size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut ContourRecord<T>,
        grad_outline_px: &mut [[T; 2]],
    ) {
        let band = self.band(T::of_usize(size.unit_px()));
        dispatch(cover_vjp::CoverVjp { band, tile, record, grad_outline_px });
    }
}
