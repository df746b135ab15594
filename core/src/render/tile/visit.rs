//! Coverage of every object, one object at a time: masks without a plane of pixels per object.

use super::check::check_drawing;
use super::renderer::{TileScratch, to_px};
use super::{ChunkState, CoverageModel, LANES, Tile, TileRenderer, Window};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::render::RenderError;
use crate::scene::Drawing;
use crate::shape::Rings;

impl<C> TileRenderer<C> {
    /// Hands the coverage of every object to `visit`, with no regard to confidence: the object's index, the index of a
    /// pixel (row by row), and the coverage of this and the next pixels of its row. Objects come in the order of the
    /// drawing; coverage is 0 where nothing was handed over. It is above 0 exactly on the pixels that the object's
    /// fattened outline reaches: the reference's mask.
    ///
    /// *Memory*: one tile, whatever the number of objects.
    ///
    /// # Errors
    /// As [`Renderer::render`](crate::render::Renderer::render).
    pub fn visit_coverage<T: Real>(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut TileScratch<T, C::Record>,
        mut visit: impl FnMut(usize, usize, &[T]),
    ) -> Result<(), RenderError>
    where
        C: CoverageModel<T>,
    {
        self.visit_each(drawing, size, scratch, &mut visit)
    }

    /// [`Self::visit_coverage`], compiled once for all that visit ([`crate::instances`]).
    #[inline(never)]
    pub(crate) fn visit_each<T: Real>(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut TileScratch<T, C::Record>,
        visit: &mut dyn FnMut(usize, usize, &[T]),
    ) -> Result<(), RenderError>
    where
        C: CoverageModel<T>,
    {
        self.coverage.check()?;
        check_drawing(drawing)?;
        let TileScratch { vertices_px, tiles, records, .. } = scratch;
        if tiles.is_empty() {
            tiles.push(Tile::default());
            records.push(C::Record::default());
        }
        let ([tile, ..], [record, ..]) = (&mut tiles[..], &mut records[..]) else { return Ok(()) };
        let reach_px = self.coverage.reach_px(T::of_usize(size.unit_px()));
        for k in 0..drawing.object_count() {
            let rings = drawing.rings(k);
            vertices_px.clear();
            vertices_px.extend(rings.vertices.iter().map(|&v| to_px(v, size)));
            let Some(window) = Window::around(vertices_px, reach_px, size) else { continue };
            tile.reset(window, size, 1, false);
            self.coverage.cover(Rings { vertices: vertices_px, ..rings }, size, tile, record, false)?;
            for i in 0..window.rows * window.chunks {
                let left = (window.left_chunk + i % window.chunks) * LANES;
                let start = (window.top + i / window.chunks) * size.width() + left;
                let pixels = LANES.min(size.width() - left);
                match tile.states[i] {
                    ChunkState::Empty => {}
                    ChunkState::Mixed => visit(k, start, &tile.coverage[i][..pixels]),
                    ChunkState::Full => visit(k, start, &[T::one(); LANES][..pixels]),
                }
            }
        }
        Ok(())
    }

    /// Writes the coverage of every object, objects x height x width; see [`Self::visit_coverage`].
    ///
    /// # Errors
    /// As [`Renderer::render`](crate::render::Renderer::render).
    #[inline(never)]
    pub fn object_coverage<T: Real>(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut TileScratch<T, C::Record>,
        coverage: &mut [T],
    ) -> Result<(), RenderError>
    where
        C: CoverageModel<T>,
    {
        let expected = drawing.object_count() * size.pixels();
        if coverage.len() != expected {
            return Err(RenderError::Length { what: "coverage", expected, len: coverage.len() });
        }
        coverage.fill(T::zero());
        self.visit_coverage(drawing, size, scratch, |object, pixel, part| {
            let start = object * size.pixels() + pixel;
            coverage[start..start + part.len()].copy_from_slice(part);
        })
    }
}
