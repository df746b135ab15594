//! Layer norm with weights.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use crate::error::NetError;
use crate::weights::Weights;

/// Numbers of the last axis with mean 0 and variance 1, times a weight plus a bias.
///
/// *Source*: Ba, Kiros, Hinton: Layer Normalization (2016).
#[derive(Clone, Debug)]
pub struct LayerNorm<B: Backend> {
    weight: Tensor<B>,
    bias: Tensor<B>,
    epsilon: f64,
}

impl<B: Backend> LayerNorm<B> {
    /// Takes `weight` and `bias`, both of `width` numbers. `epsilon` is added to the variance.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub fn load(weights: &Weights<'_, B>, width: usize, epsilon: f64) -> Result<Self, NetError> {
        Ok(Self { weight: weights.get("weight", &[width])?, bias: weights.get("bias", &[width])?, epsilon })
    }

    /// .. x width to the same extents.
    ///
    /// # Errors
    /// As [`Tensor::layer_norm`] and [`Tensor::mul`].
    pub fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        x.layer_norm(self.epsilon)?.mul(&self.weight)?.add(&self.bias)
    }
}
