//! Soft triangles: the reference's renderer, with the seams of its triangles.
//!
//! In: closed rings in pixels. Out: coverage per pixel, and backward the gradient of the vertices. What the rings enclose
//! is cut into triangles; with d2 the signed squared distance from a pixel center to a triangle (doubled frame, negative
//! inside), the triangle covers the pixel by logistic((offset - d2) / sigma), 0 where d2 > cut, and the object by the
//! largest of its triangles; profiles in distance are painted as well, area coverage as the nearest of them. Inside an object, on the edges that two triangles share, d2 is 0: coverage dips to 0.993
//! there (reference profile), and to 1/2 where the offset is 0. [`contour`](super::contour) has no such seams and is faster; this one is for comparison
//! with the reference.
//!
//! | file | holds |
//! |---|---|
//! | `triangulate.rs` | from rings to triangles |
//! | `profile.rs` | the edge profile in pixels |
//! | `distance.rs` | forward: nearest triangle, coverage |
//! | `distance_vjp.rs` | backward: coverage to vertices |
//!
//! Proved by `tests/golden/triangles.rs` (the reference's object coverages, images and gradients), `tests/gradient/triangles.rs`
//! and `tests/property/triangles.rs`.
//!
//! *Source*: Liu et al., Soft Rasterizer (ICCV 2019), as PyTorch3D computes it. Differences: triangles come from a
//! constrained Delaunay triangulation instead of cut ears, and no limit on triangles per pixel.

mod distance;
mod distance_vjp;
mod profile;
#[cfg(test)]
mod tests;
mod triangulate;

pub use distance::TriangleRecord;
pub use triangulate::{Delaunay, Face, Triangulate, TriangulationReport};

use self::distance::Cover;
use self::distance_vjp::CoverVjp;
use self::profile::SquaredProfile;
use super::tile::{CoverageModel, Tile, TileRenderer, TileScratch};
use super::{ContourDistance, EdgeProfile, RenderError};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::shape::Rings;
use crate::simd::dispatch;

/// Paints objects as soft triangles.
pub type TriangleRenderer<T> = TileRenderer<SoftTriangles<T>>;

/// Memory of a [`TriangleRenderer`].
pub type TriangleScratch<T> = TileScratch<T, TriangleRecord<T>>;

/// Coverage by the soft distance to the triangles of the interior.
///
/// *Derivative*: to the two ends of the edge that is nearest in the winning triangle; not differentiable where two
/// edges or triangles are equally near, at the cut, and where the triangulation changes (there the seams jump).
///
/// *Memory*: unlike the other renderers, triangulation allocates in every call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftTriangles<T, F = Delaunay> {
    /// How coverage falls off.
    pub edge: EdgeProfile<T>,
    /// Where the triangles come from.
    pub faces: F,
}

impl<T: Real> Default for SoftTriangles<T> {
    fn default() -> Self {
        Self { edge: EdgeProfile::reference(), faces: Delaunay }
    }
}

impl<T: Real, F: Triangulate> CoverageModel<T> for SoftTriangles<T, F> {
    type Record = TriangleRecord<T>;

    fn check(&self) -> Result<(), RenderError> {
        ContourDistance::new(self.edge).check()
    }

    fn reach_px(&self, unit_px: T) -> T {
        ContourDistance::new(self.edge).reach_px(unit_px)
    }

    fn smallest_coverage(&self) -> T {
        ContourDistance::new(self.edge).smallest_coverage()
    }

    fn cover(
        &self,
        rings_px: Rings<'_, T>,
        size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut TriangleRecord<T>,
        _backward: bool,
    ) -> Result<(), RenderError> {
        self.faces.triangulate(rings_px, &mut record.faces);
        if let Some(&vertex) = record.faces.as_flattened().iter().find(|&&vertex| vertex >= rings_px.vertices.len()) {
            return Err(RenderError::Setting {
                what: "face",
                value: T::of_usize(vertex).as_f64(),
                must: "a vertex of its object",
            });
        }
        let profile = SquaredProfile::new(&self.edge, T::of_usize(size.unit_px()));
        dispatch(Cover { profile, vertices_px: rings_px.vertices, tile, record });
        Ok(())
    }

    fn cover_vjp(
        &self,
        _rings_px: Rings<'_, T>,
        size: ImageSize,
        tile: &mut Tile<T>,
        record: &mut TriangleRecord<T>,
        grad_px: &mut [[T; 2]],
    ) {
        let profile = SquaredProfile::new(&self.edge, T::of_usize(size.unit_px()));
        dispatch(CoverVjp { profile, tile, record, grad_px });
    }
}
