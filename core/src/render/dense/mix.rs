//! Coverage and colors to pixels, in both ways of mixing.

use super::TensorDrawing;
use crate::render::Compositing;
use crate::tensor::{Backend, Tensor, TensorError};

/// The confidence-weighted mean over the background. Coverage batch x objects x pixels; pixels batch x 3 x pixels.
pub(super) fn blend<B: Backend>(drawing: &TensorDrawing<B>, coverage: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    let confidences = column(&drawing.confidences)?;
    let (sharpness, guard) = (Compositing::SHARPNESS, Compositing::SMALLEST_WEIGHT);
    let weights = coverage.mul(&confidences.affine(sharpness, -sharpness)?.exp()?)?;
    let total = weights.sum(1)?.affine(1.0, -guard)?.relu()?.affine(1.0, guard)?;
    // batch x 3 x objects times batch x objects x pixels.
    let mean = drawing.colors.transpose()?.matmul(&weights)?.div(&total)?;
    let opacity = coverage.mul(&confidences)?;
    let background = column(&drawing.background)?;
    let Some(clear) = product(&opacity.affine(-1.0, 1.0)?)? else {
        return background.expand(mean.dims().extents());
    };
    background.sub(&mean)?.mul(&clear)?.add(&mean)
}

/// Painter's order. Dimensions as for [`blend`].
pub(super) fn over<B: Backend>(drawing: &TensorDrawing<B>, coverage: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    let opacity = coverage.mul(&column(&drawing.confidences)?)?;
    let &[batch, objects, pixels] = coverage.dims().extents() else {
        return Err(TensorError::Operand { op: "over", dims: *coverage.dims(), must: "must have three axes" });
    };
    let mut image = column(&drawing.background)?.expand(&[batch, 3, pixels])?;
    for object in 0..objects {
        let color = drawing.colors.slice(1, object, 1)?.transpose()?;
        image = color.sub(&image)?.mul(&opacity.slice(1, object, 1)?)?.add(&image)?;
    }
    Ok(image)
}

/// A last axis of extent 1.
fn column<B: Backend>(tensor: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    let mut extents = tensor.dims().extents().to_vec();
    extents.push(1);
    tensor.reshape(&extents)
}

/// Products over axis 1, which keeps extent 1; none without objects.
fn product<B: Backend>(factors: &Tensor<B>) -> Result<Option<Tensor<B>>, TensorError> {
    let mut product: Option<Tensor<B>> = None;
    for object in 0..factors.dims().get(1).unwrap_or(0) {
        let factor = factors.slice(1, object, 1)?;
        product = Some(match product {
            Some(before) => before.mul(&factor)?,
            None => factor,
        });
    }
    Ok(product)
}
