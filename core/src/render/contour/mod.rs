//! Coverage by the scene's edge profile: the reference's images without the seams of its triangles, blur, exact areas.
//!
//! With d the distance from the center of a pixel to the closest edge of any ring as the profile's law measures it (signed,
//! negative inside, squared or not), coverage is logistic((offset - d) / sigma), and 0 where d > cut. Inside and outside
//! are told apart by the even-odd rule over all rings: a pixel is inside where a ray to the left meets an odd number of
//! edges; rings inside of others and outlines that cross themselves have holes. Area coverage is left to [`exact`](super::exact).
//!
//! Distances are worked out only in a narrow band along the outline: outside up to the cut, inside up to where coverage
//! is within [`ContourDistance::saturation`] of 1, which then counts as 1, without gradient.
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

use super::exact::ExactArea;
use super::tile::{CoverageModel, Tile, TileRenderer};
use super::{Compositing, EdgeLaw, EdgeProfile, RenderError};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::scene::PixelProfile;
use crate::shape::Rings;
use crate::simd::dispatch;

/// Inside, coverage this close to 1 counts as 1 unless said otherwise.
const SATURATION: f64 = 1e-6;

/// Smallest sigma: its reciprocal in pixels stays finite in f32.
const SOFTNESS_FLOOR: f64 = 1e-30;

/// Paints by the edge profile.
pub type ContourRenderer<T> = TileRenderer<ContourDistance<T>>;

impl<T: Real> ContourRenderer<T> {
    /// A renderer with the given profile and mixing.
    #[must_use]
    pub fn new(edge: EdgeProfile<T>, compositing: Compositing) -> Self {
        Self { coverage: ContourDistance::new(edge), compositing }
    }
}

/// Coverage by the distance to the outline, or by area where the profile says so.
///
/// *Derivative*: of coverage with respect to the two vertices of the closest edge. Not differentiable where two edges are
/// equally close, nor at the cut; by distance that is not squared, pixels whose center lies exactly on the outline are
/// left out. By area: that of [`ExactArea`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourDistance<T> {
    /// How coverage falls off.
    pub edge: EdgeProfile<T>,
    /// Inside, coverage this close to 1 counts as 1: there the band ends that distances are worked out in. In (0, 1/2].
    pub saturation: T,
}

impl<T: Real> ContourDistance<T> {
    /// Coverage by a profile; inside, what is within 1e-6 of 1 counts as 1.
    #[must_use]
    pub fn new(edge: EdgeProfile<T>) -> Self {
        Self { edge, saturation: T::of(SATURATION) }
    }
}

impl<T: Real> Default for ContourDistance<T> {
    fn default() -> Self {
        Self::new(EdgeProfile::reference())
    }
}

/// The edge profile in pixels.
#[derive(Clone, Copy, Debug)]
struct Band<T> {
    profile: PixelProfile<T>,
    /// Distance, as the profile measures it, below which coverage is 1.
    full: T,
    /// Distance within which edges are looked at, px.
    reach: T,
}

impl<T: Real> ContourDistance<T> {
    fn band(&self, unit_px: T) -> Band<T> {
        let profile = self.edge.in_pixels(unit_px);
        let full = profile.full(self.saturation.as_f64());
        Band { profile, full, reach: profile.px(profile.cut.abs().max(-full)) }
    }
}

impl<T: Real> CoverageModel<T> for ContourDistance<T> {
    type Record = ContourRecord<T>;

    fn check(&self) -> Result<(), RenderError> {
        let EdgeProfile { offset, sigma, cut, .. } = self.edge;
        let refuse = |what, value: T, must| Err(RenderError::Setting { what, value: value.as_f64(), must });
        if !(sigma >= T::of(SOFTNESS_FLOOR) && sigma.is_finite()) {
            refuse("edge.sigma", sigma, "finite and at least 1e-30")
        } else if !offset.is_finite() {
            refuse("edge.offset", offset, "finite")
        } else if !cut.is_finite() {
            refuse("edge.cut", cut, "finite")
        } else if !(self.saturation > T::zero() && self.saturation <= T::of(0.5)) {
            refuse("saturation", self.saturation, "above 0 and at most 1/2")
        } else {
            Ok(())
        }
    }

    fn reach_px(&self, unit_px: T) -> T {
        if self.edge.law == EdgeLaw::Area {
            return ExactArea.reach_px(unit_px);
        }
        let profile = self.edge.in_pixels(unit_px);
        profile.px(profile.cut.max(T::zero()))
    }

    fn smallest_coverage(&self) -> T {
        if self.edge.law == EdgeLaw::Area {
            return CoverageModel::<T>::smallest_coverage(&ExactArea);
        }
        let EdgeProfile { offset, sigma, cut, .. } = self.edge;
        (((cut - offset) / sigma).exp() + T::one()).recip()
    }

    fn cover(
        &self,
        rings_px: Rings<'_, T>,
        size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut ContourRecord<T>,
        backward: bool,
    ) -> Result<(), RenderError> {
        if self.edge.law == EdgeLaw::Area {
            return ExactArea.cover(rings_px, size, tile, &mut record.exact, backward);
        }
        let band = self.band(T::of_usize(size.unit_px()));
        if backward {
            dispatch(cover::Cover::<T, true> { band, rings_px, size, tile, record });
        } else {
            dispatch(cover::Cover::<T, false> { band, rings_px, size, tile, record });
        }
        Ok(())
    }

    fn cover_vjp(
        &self,
        rings_px: Rings<'_, T>,
        size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut ContourRecord<T>,
        grad_px: &mut [[T; 2]],
    ) {
        if self.edge.law == EdgeLaw::Area {
            return ExactArea.cover_vjp(rings_px, size, tile, &mut record.exact, grad_px);
        }
        let band = self.band(T::of_usize(size.unit_px()));
        dispatch(cover_vjp::CoverVjp { band, tile, record, grad_px });
    }
}
