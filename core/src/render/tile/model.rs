//! The trait of coverage models.

use super::Tile;
use crate::dims::ImageSize;
use crate::real::Real;
use crate::render::RenderError;
use crate::shape::Rings;

/// How much of each pixel an object covers, and the way back for gradients. With it [`TileRenderer`] makes a renderer.
///
/// An object is what lies inside of an odd number of its rings, closed polygons in pixels: centers of pixels are at
/// integers, x right, y down. There is at least one vertex; all are finite and within 2^29 of 0. A ring may have any number
/// of vertices, none included. The tile holds every pixel within [`Self::reach_px`] of the box of all vertices.
///
/// Hot loops go through [`simd::dispatch`](crate::simd::dispatch), once per call of these methods.
///
/// [`TileRenderer`]: super::TileRenderer
pub trait CoverageModel<T: Real> {
    /// What [`Self::cover`] leaves for [`Self::cover_vjp`], and memory kept between calls; one per object.
    type Record: Default + core::fmt::Debug + Send;

    /// Checks the model's settings.
    ///
    /// # Errors
    /// [`RenderError::Setting`].
    fn check(&self) -> Result<(), RenderError>;

    /// How far outside an object, in pixels, coverage can be above 0, at `unit_px` pixels per scene unit.
    fn reach_px(&self, unit_px: T) -> T;

    /// A lower bound of coverage where it is not 0; 0 if there is none. Lets compositing leave out a guard.
    fn smallest_coverage(&self) -> T;

    /// Writes coverage of the object into `tile`: the state of each chunk (all are empty before) and the coverage of mixed
    /// ones. `record` may come from any earlier object; [`Self::cover_vjp`] may follow only if `backward` is set.
    ///
    /// # Errors
    /// [`RenderError`] if the model cannot cover such an object.
    fn cover(
        &self,
        rings_px: Rings<'_, T>,
        size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut Self::Record,
        backward: bool,
    ) -> Result<(), RenderError>;

    /// Adds to `grad_px`, one entry per vertex, the gradient of sum(`tile.grad` x coverage) over the mixed chunks. Tile and record are as
    /// [`Self::cover`] left them, but for `tile.grad`, which may be changed here.
    fn cover_vjp(
        &self,
        rings_px: Rings<'_, T>,
        size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut Self::Record,
        grad_px: &mut [[T; 2]],
    );
}
