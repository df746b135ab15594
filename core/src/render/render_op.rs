//! Renderers as differentiable steps of a batch: drawings in, images or their pixel losses out.

use alloc::vec::Vec;
use core::fmt;

use super::tile::check_breaks;
use super::{PixelLoss, RenderError, Renderer};
use crate::diff_op::{DiffOp, OpInput, Signature, add_scaled};
use crate::dims::{Dims, DimsError, ImageSize};
use crate::image::{CHANNELS, Image};
use crate::real::Real;
use crate::scene::{Drawing, DrawingGrad};
use crate::shape::Rings;

/// What both steps take: posed outlines (objects x vertices x 2, scene units), colors (objects x 3), confidences (objects)
/// and the background (3).
fn drawing_inputs(objects: usize, vertices: usize) -> Result<[OpInput; 4], DimsError> {
    Ok([
        OpInput::new("outlines", &[objects, vertices, 2])?,
        OpInput::new("colors", &[objects, CHANNELS])?,
        OpInput::new("confidences", &[objects])?,
        OpInput::new("background", &[CHANNELS])?,
    ])
}

/// Memory of a step between items.
pub struct RenderOpScratch<T, S> {
    drawing: Drawing<T>,
    grad: DrawingGrad<T>,
    renderer: S,
}

impl<T: Real, S: Default> Default for RenderOpScratch<T, S> {
    fn default() -> Self {
        Self { drawing: Drawing::default(), grad: DrawingGrad::default(), renderer: S::default() }
    }
}

impl<T, S> fmt::Debug for RenderOpScratch<T, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("RenderOpScratch")
    }
}

impl<T: Real, S> RenderOpScratch<T, S> {
    /// Takes an item's values as the drawing, outlines of which have rings that begin at `breaks`.
    fn take(&mut self, signature: &Signature, breaks: &[usize], item: &[T]) -> Result<(), RenderError> {
        let [outlines, colors, confidences, background] = signature.split(item);
        let vertices = outlines.len() / 2 / confidences.len().max(1);
        check_breaks(breaks, vertices)?;
        let outlines = outlines.as_chunks().0.chunks_exact(vertices.max(1));
        self.drawing.clear();
        for ((outline, &color), &confidence) in outlines.zip(colors.as_chunks().0).zip(confidences) {
            self.drawing.push_rings(Rings { vertices: outline, breaks, first: 0 }, color, confidence);
        }
        self.drawing.background.copy_from_slice(background);
        Ok(())
    }

    /// Adds the drawing's gradient in the layout of the inputs.
    fn give(&self, signature: &Signature, grad_item: &mut [T]) {
        let [outlines, colors, confidences, background] = signature.split_mut(grad_item);
        let DrawingGrad {
            background: own_background,
            vertices,
            colors: own_colors,
            confidences: own_confidences,
            ramps: _,
            stops: _,
        } = &self.grad;
        let parts: [(&mut [T], &[T]); 4] = [
            (outlines, vertices.as_flattened()),
            (colors, own_colors.as_flattened()),
            (confidences, own_confidences),
            (background, own_background),
        ];
        for (to, from) in parts {
            add_scaled(to, from, T::one());
        }
    }
}

/// Drawings to images, 3 x height x width. Inputs: posed outlines (objects x vertices x 2, scene units), colors
/// (objects x 3), confidences (objects), background (3). An outline is one ring unless [`Self::with_breaks`] says otherwise.
///
/// *Derivative*: [`Renderer::render_vjp`].
#[derive(Clone, Debug)]
pub struct RenderOp<R> {
    renderer: R,
    size: ImageSize,
    breaks: Vec<usize>,
    signature: Signature,
}

impl<R> RenderOp<R> {
    /// Images of `size` of `objects` outlines of `vertices` vertices per item.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(renderer: R, size: ImageSize, objects: usize, vertices: usize) -> Result<Self, DimsError> {
        let image = Dims::new(&[CHANNELS, size.height(), size.width()])?;
        let signature = Signature::new("render", drawing_inputs(objects, vertices)?, image);
        Ok(Self { renderer, size, breaks: Vec::new(), signature })
    }

    /// Every outline of every item has rings that begin at these of its vertices, rising, beside the one that begins at 0:
    /// what it encloses lies inside of an odd number of them. An outline of fewer rings repeats one vertex in the others.
    #[must_use]
    pub fn with_breaks(self, breaks: Vec<usize>) -> Self {
        Self { breaks, ..self }
    }
}

impl<T: Real, R: Renderer<T> + fmt::Debug + Send + Sync> DiffOp<T> for RenderOp<R> {
    type Scratch = RenderOpScratch<T, R::Scratch>;
    type Error = RenderError;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(
        &self,
        _: usize,
        input: &[T],
        output: &mut [T],
        _: &mut [T],
        scratch: &mut Self::Scratch,
    ) -> Result<(), RenderError> {
        scratch.take(&self.signature, &self.breaks, input)?;
        self.renderer.render(&scratch.drawing, self.size, &mut scratch.renderer, output)
    }

    fn vjp(
        &self,
        _: usize,
        input: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        scratch: &mut Self::Scratch,
    ) -> Result<(), RenderError> {
        scratch.take(&self.signature, &self.breaks, input)?;
        let RenderOpScratch { drawing, grad, renderer } = scratch;
        grad.reset(drawing);
        self.renderer.render_vjp(drawing, self.size, renderer, grad_output, grad)?;
        scratch.give(&self.signature, grad_input);
        Ok(())
    }
}

/// Drawings to their pixel loss against a target each: a number per item, without an image in between. Inputs as those of
/// [`RenderOp`].
///
/// *Derivative*: that of [`Renderer::loss_and_grad`], worked out together with the loss and kept.
#[derive(Clone, Debug)]
pub struct RenderLossOp<T, R> {
    renderer: R,
    loss: PixelLoss,
    targets: Vec<Image<T>>,
    breaks: Vec<usize>,
    signature: Signature,
}

impl<T: Real, R> RenderLossOp<T, R> {
    /// Losses against `targets`, one per item, of `objects` outlines of `vertices` vertices each.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(
        renderer: R,
        loss: PixelLoss,
        targets: Vec<Image<T>>,
        objects: usize,
        vertices: usize,
    ) -> Result<Self, DimsError> {
        let signature = Signature::new("render loss", drawing_inputs(objects, vertices)?, Dims::SCALAR);
        let signature = signature.for_batch(targets.len()).keeping_gradient();
        Ok(Self { renderer, loss, targets, breaks: Vec::new(), signature })
    }

    /// As [`RenderOp::with_breaks`].
    #[must_use]
    pub fn with_breaks(self, breaks: Vec<usize>) -> Self {
        Self { breaks, ..self }
    }
}

impl<T: Real, R: Renderer<T> + fmt::Debug + Send + Sync> DiffOp<T> for RenderLossOp<T, R> {
    type Scratch = RenderOpScratch<T, R::Scratch>;
    type Error = RenderError;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(
        &self,
        item: usize,
        input: &[T],
        output: &mut [T],
        saved: &mut [T],
        scratch: &mut Self::Scratch,
    ) -> Result<(), RenderError> {
        scratch.take(&self.signature, &self.breaks, input)?;
        let RenderOpScratch { drawing, grad, renderer } = scratch;
        let target = self.targets[item].view();
        if saved.is_empty() {
            output[0] = self.renderer.loss(drawing, target, self.loss, renderer)?;
            return Ok(());
        }
        grad.reset(drawing);
        output[0] = self.renderer.loss_and_grad(drawing, target, self.loss, renderer, grad)?;
        scratch.give(&self.signature, saved);
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        _: &[T],
        saved: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        _: &mut Self::Scratch,
    ) -> Result<(), RenderError> {
        add_scaled(grad_input, saved, grad_output[0]);
        Ok(())
    }
}
