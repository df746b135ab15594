//! Instance norm with weights.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use crate::error::NetError;
use crate::weights::Weights;

/// Added to the variance.
const EPSILON: f64 = 1e-5;

/// Each channel of each image with mean 0 and variance 1 over its pixels, times a weight plus a bias.
///
/// *Source*: Ulyanov, Vedaldi, Lempitsky: Instance Normalization (2016).
#[derive(Clone, Debug)]
pub(crate) struct InstanceNorm<B: Backend> {
    /// Channels x 1, as the bias.
    weight: Tensor<B>,
    bias: Tensor<B>,
}

impl<B: Backend> InstanceNorm<B> {
    /// Takes `weight` and `bias`, both of `channels` numbers.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(crate) fn load(weights: &Weights<'_, B>, channels: usize) -> Result<Self, NetError> {
        let of_each = |name: &str| Ok::<_, NetError>(weights.get(name, &[channels])?.reshape(&[channels, 1])?);
        Ok(Self { weight: of_each("weight")?, bias: of_each("bias")? })
    }

    /// batch x channels x h x w to the same extents.
    ///
    /// # Errors
    /// [`TensorError::Operand`] if the rank is not 4; as [`Tensor::layer_norm`] and [`Tensor::mul`].
    pub(crate) fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let &[batch, channels, h, w] = x.dims().extents() else {
            let must = "must be batch x channels x h x w";
            return Err(TensorError::Operand { op: "instance_norm", dims: *x.dims(), must });
        };
        // The layer norm of all pixels of a channel.
        let normed = x.reshape(&[batch, channels, h * w])?.layer_norm(EPSILON)?;
        normed.mul(&self.weight)?.add(&self.bias)?.reshape(&[batch, channels, h, w])
    }
}
