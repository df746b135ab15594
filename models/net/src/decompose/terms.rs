//! The terms of MONet's loss.

use dvp_core::tensor::{Backend, Tensor, TensorError};

/// What the loss of a batch is made of, before the factors of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Terms {
    /// How badly the parts explain the pixels: minus the logarithm of their likelihood per pixel, 0 or above; for a model without
    /// one the mean squared error.
    pub pixels: f64,
    /// What the latents tell, in nats per pixel; 0 for a model without a prior.
    pub latents: f64,
    /// What the masks tell that is not in the latents, in nats per pixel; 0 for a model that does not ask.
    pub masks: f64,
}

/// Minus the logarithm of the likelihood of images as mixtures, mean over images and pixels: each pixel is of one of the parts,
/// by its mask, and normally distributed around the part's color. Counted from the best that is possible: 0 if every pixel has
/// the color of a part of the least deviation that is its own.
///
/// *Dimensions*: images batch x 3 x h x w, logarithms of masks batch x slots x h x w, colors batch x slots x 3 x h x w,
/// `deviations` slots.
pub(super) fn mixture<B: Backend>(
    images: &Tensor<B>,
    log_masks: &Tensor<B>,
    colors: &Tensor<B>,
    deviations: &[f64],
) -> Result<Tensor<B>, TensorError> {
    let &[batch, slots, _, h, w] = colors.dims().extents() else {
        let must = "must be batch x slots x 3 x h x w";
        return Err(TensorError::Operand { op: "mixture", dims: *colors.dims(), must });
    };
    let difference = images.reshape(&[batch, 1, 3, h, w])?.sub(colors)?;
    let squares = difference.mul(&difference)?.sum(2)?.reshape(&[batch, slots, h, w])?;
    let per_slot = |value: &dyn Fn(f64) -> f64| {
        log_masks.like(deviations.iter().map(|&sigma| value(sigma)).collect(), &[1, slots, 1, 1])
    };
    let factors = per_slot(&|sigma| -0.5 / (sigma * sigma))?;
    let least = deviations.iter().copied().fold(f64::INFINITY, f64::min);
    let offsets = per_slot(&|sigma| -3.0 * (sigma / least).ln())?;
    let logs = squares.mul(&factors)?.add(&offsets)?.add(log_masks)?;
    let largest = logs.max_detached(1)?;
    let sum = logs.sub(&largest)?.exp()?.sum(1)?.log()?.add(&largest)?;
    sum.mean_all()?.affine(-1.0, 0.0)
}

/// The Kullback-Leibler divergence of normal distributions from the standard one, summed over latents and items, over `count`.
pub(super) fn told<B: Backend>(
    mean: &Tensor<B>,
    log_variance: &Tensor<B>,
    count: usize,
) -> Result<Tensor<B>, TensorError> {
    let both = mean.mul(mean)?.add(&log_variance.exp()?)?.sub(log_variance)?.affine(1.0, -1.0)?;
    both.sum_all()?.affine(0.5 / count.max(1) as f64, 0.0)
}

/// The Kullback-Leibler divergence of masks from other masks, mean over images and pixels; both as logarithms, batch x slots x
/// h x w.
pub(super) fn apart<B: Backend>(log_masks: &Tensor<B>, others: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    log_masks.exp()?.mul(&log_masks.sub(others)?)?.sum(1)?.mean_all()
}
