//! The pixel loss with a graph no larger than one chunk.

use super::{DenseRenderer, Rows, TensorDrawing};
use crate::render::PixelLoss;
use crate::tensor::{Backend, Tensor, TensorError};

impl DenseRenderer {
    /// The mean over pixels and channels of the loss against targets (batch x 3 x height x width): a number per item.
    ///
    /// Each chunk is pulled back as soon as it is painted, and only the sums of its gradients are kept: memory does not
    /// grow with the image. In the graph of the drawing the loss is one linear step with those sums.
    ///
    /// # Errors
    /// [`TensorError`] if the extents do not go together.
    pub fn pixel_loss<B: Backend>(
        &self,
        drawing: &TensorDrawing<B>,
        targets: &Tensor<B>,
        loss: PixelLoss,
    ) -> Result<Tensor<B>, TensorError> {
        let [batch, ..] = drawing.extents()?;
        let (height, width) = (self.size.height(), self.size.width());
        if targets.dims().extents() != [batch, 3, height, width] || targets.dtype() != drawing.dtype() {
            let must = "targets must be batch x 3 x height x width, in the type of the drawing";
            return Err(TensorError::Operand { op: "pixel loss", dims: *targets.dims(), must });
        }
        let targets = targets.reshape(&[batch, 3, height * width])?;
        let inputs = drawing.parts();
        let tracked = inputs.map(Tensor::is_tracked);
        let mut value: Option<Tensor<B>> = None;
        let mut slopes: [Option<Tensor<B>>; 4] = [const { None }; 4];
        for rows in self.chunks(drawing)? {
            let chunk = drawing.leaves(tracked)?;
            let sums = self.chunk_loss(&chunk, &targets, &rows, loss)?;
            if tracked.contains(&true) {
                let gradients = sums.sum_all()?.backward()?;
                for (slope, leaf) in slopes.iter_mut().zip(chunk.parts()) {
                    *slope = sum(slope.take(), gradients.of(leaf))?;
                }
            }
            value = sum(value, Some(sums.detach()?))?;
        }
        let mut value = match value {
            Some(value) => value,
            None => targets.like(alloc::vec![0.0; batch], &[batch])?,
        };
        for (slope, input) in slopes.iter().zip(inputs) {
            let Some(slope) = slope else { continue };
            let len = input.dims().len() / batch.max(1);
            // 0 in value, `slope` in derivative.
            let step = slope.mul(&input.sub(&input.detach()?)?)?;
            value = value.add(&step.reshape(&[batch, len])?.sum(1)?.reshape(&[batch])?)?;
        }
        Ok(value)
    }

    /// The part of some rows in the loss of each item.
    fn chunk_loss<B: Backend>(
        &self,
        drawing: &TensorDrawing<B>,
        targets: &Tensor<B>,
        rows: &Rows,
        loss: PixelLoss,
    ) -> Result<Tensor<B>, TensorError> {
        let [batch, ..] = drawing.extents()?;
        let width = self.size.width();
        let pixels = (rows.end - rows.first) * width;
        let difference = self.paint(drawing, rows)?.sub(&targets.slice(2, rows.first * width, pixels)?)?;
        let terms = match loss {
            PixelLoss::Mae => difference.abs()?,
            PixelLoss::Mse => difference.mul(&difference)?,
        };
        #[expect(clippy::cast_precision_loss, reason = "pixel counts are far below 2^52")]
        let share = 1.0 / (3 * self.size.pixels()) as f64;
        terms.reshape(&[batch, 3 * pixels])?.sum(1)?.affine(share, 0.0)?.reshape(&[batch])
    }
}

/// The sum of what there is.
fn sum<B: Backend>(a: Option<Tensor<B>>, b: Option<Tensor<B>>) -> Result<Option<Tensor<B>>, TensorError> {
    match (a, b) {
        (Some(a), Some(b)) => a.add(&b).map(Some),
        (a, b) => Ok(a.or(b)),
    }
}

impl<B: Backend> TensorDrawing<B> {
    pub(super) fn parts(&self) -> [&Tensor<B>; 4] {
        [&self.outlines, &self.colors, &self.confidences, &self.background]
    }

    /// The same numbers as parameters of a graph of their own, as far as they are tracked.
    fn leaves(&self, tracked: [bool; 4]) -> Result<Self, TensorError> {
        let leaf = |tensor: &Tensor<B>, tracked| if tracked { tensor.parameter() } else { Ok(tensor.clone()) };
        Ok(Self {
            outlines: leaf(&self.outlines, tracked[0])?,
            colors: leaf(&self.colors, tracked[1])?,
            confidences: leaf(&self.confidences, tracked[2])?,
            background: leaf(&self.background, tracked[3])?,
        })
    }
}
