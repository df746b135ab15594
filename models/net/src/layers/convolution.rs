//! Convolution.

use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};

use crate::error::NetError;
use crate::weights::Weights;

/// Cross-correlation with square kernels, plus a bias.
#[derive(Clone, Debug)]
pub(crate) struct Convolution<B: Backend> {
    kernels: Tensor<B>,
    bias: Option<Tensor<B>>,
    stride: Stride,
}

impl<B: Backend> Convolution<B> {
    /// Takes `weight`, to x from x side x side, and `bias`, to.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(crate) fn load(
        weights: &Weights<'_, B>,
        [from, to]: [usize; 2],
        side: usize,
        stride: Stride,
    ) -> Result<Self, NetError> {
        let plain = Self::load_plain(weights, [from, to], side, stride)?;
        Ok(Self { bias: Some(weights.get("bias", &[to])?.reshape(&[to, 1, 1])?), ..plain })
    }

    /// The same without a bias: takes `weight` alone.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(crate) fn load_plain(
        weights: &Weights<'_, B>,
        [from, to]: [usize; 2],
        side: usize,
        stride: Stride,
    ) -> Result<Self, NetError> {
        Ok(Self { kernels: weights.get("weight", &[to, from, side, side])?, bias: None, stride })
    }

    /// batch x from x h x w to batch x to x rows x columns.
    ///
    /// # Errors
    /// As [`Tensor::conv2d`].
    pub(crate) fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let x = x.conv2d(&self.kernels, self.stride)?;
        self.bias.as_ref().map_or(Ok(x.clone()), |bias| x.add(bias))
    }
}
