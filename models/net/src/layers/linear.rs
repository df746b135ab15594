//! Linear maps.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use crate::error::NetError;
use crate::weights::Weights;

/// x W^T + b of the last axis.
#[derive(Clone, Debug)]
pub struct Linear<B: Backend> {
    weight: Tensor<B>,
    bias: Tensor<B>,
}

impl<B: Backend> Linear<B> {
    /// Takes `weight`, outputs x inputs, and `bias`, outputs.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub fn load(weights: &Weights<'_, B>, inputs: usize, outputs: usize) -> Result<Self, NetError> {
        Ok(Self { weight: weights.get("weight", &[outputs, inputs])?, bias: weights.get("bias", &[outputs])? })
    }

    /// The bias, outputs.
    #[must_use]
    pub fn bias(&self) -> &Tensor<B> {
        &self.bias
    }

    /// .. x inputs to .. x outputs.
    ///
    /// # Errors
    /// As [`Tensor::linear`].
    pub fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        x.linear(&self.weight.transpose()?, &self.bias)
    }
}
