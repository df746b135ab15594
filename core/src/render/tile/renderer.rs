//! The renderer that every coverage model shares.

use alloc::vec::Vec;

use super::check::{check_drawing, check_finite, check_grad, check_image};
use super::{CoverageModel, FARTHEST_PX, Tile, Window};
use crate::dims::ImageSize;
use crate::image::{CHANNELS, ImageView, RGBA_CHANNELS};
use crate::real::Real;
use crate::render::composite::{CompositeScratch, Composition, Forward, Loss, Mae, Mse, Pull};
use crate::render::{Compositing, PixelLoss, RenderError, Renderer};
use crate::scene::{Drawing, DrawingGrad};
use crate::shape::Rings;

/// Paints with any coverage model: a coverage tile per object, then one pass of compositing over the image, fused with
/// the loss and its gradient where one is asked for.
///
/// *Memory*: the scratch grows to the largest windows seen (up to 16 objects in 256 x 256 pixels: to the whole image at once); no call
/// allocates otherwise. Objects outside the view cost nothing and get zero gradient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileRenderer<C> {
    /// How much of each pixel an object covers.
    pub coverage: C,
    /// How objects that share a pixel mix.
    pub compositing: Compositing,
}

/// Memory of a [`TileRenderer`], kept between calls.
#[derive(Debug)]
pub struct TileScratch<T, R> {
    pub(super) vertices_px: Vec<[T; 2]>,
    grad_px: Vec<[T; 2]>,
    pub(super) tiles: Vec<Tile<T>>,
    pub(super) records: Vec<R>,
    composite: CompositeScratch<T>,
}

impl<T: Real, R> Default for TileScratch<T, R> {
    fn default() -> Self {
        Self {
            vertices_px: Vec::new(),
            grad_px: Vec::new(),
            tiles: Vec::new(),
            records: Vec::new(),
            composite: CompositeScratch::default(),
        }
    }
}

impl<C> TileRenderer<C> {
    /// Checks everything, then covers a tile per object; objects outside the view get an empty window. `backward`: whether
    /// [`Self::pull_back`] is to follow.
    fn cover_all<T: Real>(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut TileScratch<T, C::Record>,
        backward: bool,
    ) -> Result<(), RenderError>
    where
        C: CoverageModel<T>,
    {
        self.coverage.check()?;
        check_drawing(drawing)?;
        let objects = drawing.object_count();
        if scratch.tiles.len() < objects {
            scratch.tiles.resize_with(objects, Tile::default);
            scratch.records.resize_with(objects, C::Record::default);
        }
        scratch.vertices_px.clear();
        scratch.vertices_px.extend(drawing.vertices.iter().map(|&v| to_px(v, size)));
        let reach_px = self.coverage.reach_px(T::of_usize(size.unit_px()));
        for (k, (tile, record)) in scratch.tiles[..objects].iter_mut().zip(&mut scratch.records).enumerate() {
            let vertices = &scratch.vertices_px[drawing.starts[k]..drawing.starts[k + 1]];
            match Window::around(vertices, reach_px, size) {
                Some(window) => {
                    tile.reset(window, size, objects, backward);
                    self.coverage.cover(Rings { vertices, ..drawing.rings(k) }, size, tile, record, backward)?;
                }
                None => tile.reset(Window::default(), size, objects, backward),
            }
        }
        Ok(())
    }

    /// Pulls the gradients that a pass over `N` channels left in the tiles back to the vertices, and adds everything to
    /// `grad`.
    fn pull_back<T: Real, const N: usize>(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut TileScratch<T, C::Record>,
        grad: &mut DrawingGrad<T>,
    ) where
        C: CoverageModel<T>,
    {
        let objects = drawing.object_count();
        let unit = T::of_usize(size.unit_px());
        scratch.composite.add_grad::<N>(drawing, unit, grad);
        scratch.grad_px.clear();
        scratch.grad_px.resize(drawing.vertices.len(), [T::zero(); 2]);
        for (k, (tile, record)) in scratch.tiles[..objects].iter_mut().zip(&mut scratch.records).enumerate() {
            if tile.window().rows > 0 {
                let range = drawing.starts[k]..drawing.starts[k + 1];
                let rings_px = Rings { vertices: &scratch.vertices_px[range.clone()], ..drawing.rings(k) };
                self.coverage.cover_vjp(rings_px, size, tile, record, &mut scratch.grad_px[range]);
            }
        }
        for (sum, &g) in grad.vertices.as_flattened_mut().iter_mut().zip(scratch.grad_px.as_flattened()) {
            *sum += g * unit;
        }
    }

    fn composition<'a, T: Real>(
        &self,
        drawing: &'a Drawing<T>,
        size: ImageSize,
        tiles: &'a mut [Tile<T>],
    ) -> Composition<'a, T>
    where
        C: CoverageModel<T>,
    {
        let smallest_coverage = self.coverage.smallest_coverage();
        Composition { drawing, size, compositing: self.compositing, smallest_coverage, tiles }
    }

    /// Paints the tiles against `target`; if `BACKWARD`, [`Self::pull_back`] is to follow.
    fn compare<T: Real, const N: usize, const BACKWARD: bool>(
        &self,
        drawing: &Drawing<T>,
        target: ImageView<'_, T, N>,
        loss: PixelLoss,
        scratch: &mut TileScratch<T, C::Record>,
    ) -> T
    where
        C: CoverageModel<T>,
    {
        let composition = self.composition(drawing, target.size(), &mut scratch.tiles[..drawing.object_count()]);
        let (target, pixels, scratch) = (target.data(), target.size().pixels(), &mut scratch.composite);
        match loss {
            PixelLoss::Mae => composition.run::<_, N>(scratch, Loss::<T, Mae, BACKWARD>::new(target, pixels)),
            PixelLoss::Mse => composition.run::<_, N>(scratch, Loss::<T, Mse, BACKWARD>::new(target, pixels)),
        }
    }

    /// Paints `N` channels.
    fn paint<T: Real, const N: usize>(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut TileScratch<T, C::Record>,
        image: &mut [T],
    ) -> Result<(), RenderError>
    where
        C: CoverageModel<T>,
    {
        check_image::<T, N>("image", image, size)?;
        self.cover_all(drawing, size, scratch, false)?;
        let composition = self.composition(drawing, size, &mut scratch.tiles[..drawing.object_count()]);
        composition.run::<_, N>(&mut scratch.composite, Forward { image, pixels: size.pixels() });
        Ok(())
    }

    /// The way back of [`Self::paint`].
    fn paint_vjp<T: Real, const N: usize>(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut TileScratch<T, C::Record>,
        grad_image: &[T],
        grad: &mut DrawingGrad<T>,
    ) -> Result<(), RenderError>
    where
        C: CoverageModel<T>,
    {
        check_image::<T, N>("grad_image", grad_image, size)?;
        check_finite("grad_image", grad_image)?;
        check_grad(drawing, grad)?;
        self.cover_all(drawing, size, scratch, true)?;
        let composition = self.composition(drawing, size, &mut scratch.tiles[..drawing.object_count()]);
        composition.run::<_, N>(&mut scratch.composite, Pull { grad_image, pixels: size.pixels() });
        self.pull_back::<T, N>(drawing, size, scratch, grad);
        Ok(())
    }
}

impl<T: Real, C: CoverageModel<T>> Renderer<T> for TileRenderer<C> {
    type Scratch = TileScratch<T, C::Record>;

    #[inline(never)]
    fn render(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut Self::Scratch,
        image: &mut [T],
    ) -> Result<(), RenderError> {
        self.paint::<T, CHANNELS>(drawing, size, scratch, image)
    }

    #[inline(never)]
    fn render_rgba(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut Self::Scratch,
        image: &mut [T],
    ) -> Result<(), RenderError> {
        self.paint::<T, RGBA_CHANNELS>(drawing, size, scratch, image)
    }

    #[inline(never)]
    fn render_vjp(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut Self::Scratch,
        grad_image: &[T],
        grad: &mut DrawingGrad<T>,
    ) -> Result<(), RenderError> {
        self.paint_vjp::<T, CHANNELS>(drawing, size, scratch, grad_image, grad)
    }

    #[inline(never)]
    fn render_rgba_vjp(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut Self::Scratch,
        grad_image: &[T],
        grad: &mut DrawingGrad<T>,
    ) -> Result<(), RenderError> {
        self.paint_vjp::<T, RGBA_CHANNELS>(drawing, size, scratch, grad_image, grad)
    }

    #[inline(never)]
    fn loss<const N: usize>(
        &self,
        drawing: &Drawing<T>,
        target: ImageView<'_, T, N>,
        loss: PixelLoss,
        scratch: &mut Self::Scratch,
    ) -> Result<T, RenderError> {
        self.cover_all(drawing, target.size(), scratch, false)?;
        Ok(self.compare::<T, N, false>(drawing, target, loss, scratch))
    }

    #[inline(never)]
    fn loss_and_grad<const N: usize>(
        &self,
        drawing: &Drawing<T>,
        target: ImageView<'_, T, N>,
        loss: PixelLoss,
        scratch: &mut Self::Scratch,
        grad: &mut DrawingGrad<T>,
    ) -> Result<T, RenderError> {
        check_grad(drawing, grad)?;
        let size = target.size();
        self.cover_all(drawing, size, scratch, true)?;
        let value = self.compare::<T, N, true>(drawing, target, loss, scratch);
        self.pull_back::<T, N>(drawing, size, scratch, grad);
        Ok(value)
    }
}

/// Scene units to pixels. The bound keeps far vertices from overflowing: their edges still run in their direction.
pub(super) fn to_px<T: Real>(v: [T; 2], size: ImageSize) -> [T; 2] {
    let unit = T::of_usize(size.unit_px());
    let far = T::of(FARTHEST_PX);
    v.map(|x| (x * unit - T::of(0.5)).max(-far).min(far))
}
