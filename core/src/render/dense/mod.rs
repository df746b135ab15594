//! A renderer in tensor operations alone: every pixel against every edge, on any backend and its own gradient.
//!
//! It paints what [`ContourRenderer`](super::ContourRenderer) paints, from the same definitions and none of its code: the
//! independent check of the hand-written one, and the version for devices where a round trip to the host costs more
//! than the waste. Pixels are worked on in chunks, so that arrays of objects x pixels x edges stay bounded.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`DenseRenderer`], [`TensorDrawing`], the chunks |
//! | `cover` | outlines to coverage |
//! | `mix` | coverage and colors to pixels |
//! | `pixel_loss` | the loss whose graph stays as small as one chunk |
//!
//! Shown by `tests/backend`: images and gradients equal to the contour renderer's, on every backend.

mod cover;
mod mix;
mod pixel_loss;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use super::{Compositing, EdgeLaw, EdgeProfile, RenderError};
use crate::dims::ImageSize;
use crate::real::DType;
use crate::tensor::{Backend, Tensor, TensorError};

/// Numbers in the largest array of a chunk: 4 MB of f32, of which about 30 are alive at a time.
const CHUNK_VALUES: usize = 1 << 20;

/// Drawings of a batch as tensors.
#[derive(Clone, Debug)]
pub struct TensorDrawing<B: Backend> {
    /// Posed outlines, batch x objects x vertices x 2, scene units.
    pub outlines: Tensor<B>,
    /// batch x objects x 3.
    pub colors: Tensor<B>,
    /// batch x objects.
    pub confidences: Tensor<B>,
    /// batch x 3.
    pub background: Tensor<B>,
}

/// Paints by the edge profile, in tensor operations.
///
/// *Derivative*: as that of [`ContourDistance`](super::ContourDistance); where edges are equally close, shared evenly.
#[derive(Clone, Debug, PartialEq)]
pub struct DenseRenderer {
    edge: EdgeProfile<f64>,
    compositing: Compositing,
    size: ImageSize,
    chunk_values: usize,
    /// Where rings begin in every outline, beside the first.
    breaks: Vec<usize>,
}

impl DenseRenderer {
    /// A renderer of images of `size`.
    ///
    /// # Errors
    /// [`RenderError::Setting`] for area coverage, which is no function of a distance, and a sigma that is not above 0.
    pub fn new(edge: EdgeProfile<f64>, compositing: Compositing, size: ImageSize) -> Result<Self, RenderError> {
        if edge.law == EdgeLaw::Area {
            let must = "positive: area coverage is painted by the exact renderer";
            return Err(RenderError::Setting { what: "distance law", value: 0.0, must });
        }
        if !(edge.sigma > 0.0 && edge.sigma.is_finite()) {
            return Err(RenderError::Setting { what: "sigma", value: edge.sigma, must: "above 0 and finite" });
        }
        Ok(Self { edge, compositing, size, chunk_values: CHUNK_VALUES, breaks: Vec::new() })
    }

    /// The same renderer with at most about `values` numbers in an array of objects x pixels x edges; a row of pixels at
    /// least.
    #[must_use]
    pub fn with_chunk_values(self, values: usize) -> Self {
        Self { chunk_values: values, ..self }
    }

    /// Outlines of several rings, as [`RenderOp::with_breaks`](super::RenderOp::with_breaks).
    #[must_use]
    pub fn with_breaks(self, breaks: Vec<usize>) -> Self {
        Self { breaks, ..self }
    }

    /// Images, batch x 3 x height x width. If the drawing is tracked, all chunks stay in the graph; where that is too much
    /// memory use [`Self::pixel_loss`].
    ///
    /// # Errors
    /// [`TensorError`] if the extents do not go together.
    pub fn render<B: Backend>(&self, drawing: &TensorDrawing<B>) -> Result<Tensor<B>, TensorError> {
        let [batch, ..] = drawing.extents()?;
        let mut chunks = Vec::new();
        for rows in self.chunks(drawing)? {
            chunks.push(self.paint(drawing, &rows)?);
        }
        let chunks: Vec<&Tensor<B>> = chunks.iter().collect();
        Tensor::concat(&chunks, 2)?.reshape(&[batch, 3, self.size.height(), self.size.width()])
    }

    /// Pixels of some rows, batch x 3 x pixels.
    fn paint<B: Backend>(&self, drawing: &TensorDrawing<B>, rows: &Rows) -> Result<Tensor<B>, TensorError> {
        let coverage = self.cover(&drawing.outlines, rows)?;
        match self.compositing {
            Compositing::Blend => mix::blend(drawing, &coverage),
            Compositing::Over => mix::over(drawing, &coverage),
        }
    }

    /// The rows of each chunk.
    fn chunks<B: Backend>(&self, drawing: &TensorDrawing<B>) -> Result<Vec<Rows>, TensorError> {
        let [batch, objects, vertices] = drawing.extents()?;
        let per_row = (batch * objects * vertices * self.size.width()).max(1);
        let step = (self.chunk_values / per_row).max(1);
        let rows = (0..self.size.height()).step_by(step);
        Ok(rows.map(|first| Rows { first, end: (first + step).min(self.size.height()) }).collect())
    }
}

/// Rows of pixels worked on together.
#[derive(Clone, Copy, Debug)]
struct Rows {
    first: usize,
    end: usize,
}

impl<B: Backend> TensorDrawing<B> {
    /// Items, objects and vertices, checked against one another.
    fn extents(&self) -> Result<[usize; 3], TensorError> {
        let &[batch, objects, vertices, 2] = self.outlines.dims().extents() else {
            let must = "outlines must be batch x objects x vertices x 2";
            return Err(TensorError::Operand { op: "dense render", dims: *self.outlines.dims(), must });
        };
        let parts: [(&Tensor<B>, &[usize]); 3] = [
            (&self.colors, &[batch, objects, 3]),
            (&self.confidences, &[batch, objects]),
            (&self.background, &[batch, 3]),
        ];
        for (tensor, extents) in parts {
            if tensor.dims().extents() != extents {
                let must = "colors must be batch x objects x 3, confidences batch x objects, backgrounds batch x 3";
                return Err(TensorError::Operand { op: "dense render", dims: *tensor.dims(), must });
            }
        }
        Ok([batch, objects, vertices])
    }

    fn dtype(&self) -> DType {
        self.outlines.dtype()
    }
}
