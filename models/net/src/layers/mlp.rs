//! Perceptrons.

use dvp_core::dims::Dims;
use dvp_core::tensor::{Backend, Tensor, TensorError};

use super::linear::Linear;
use crate::error::NetError;
use crate::weights::Weights;

/// Linear maps with ReLU between them, none after the last.
#[derive(Clone, Debug)]
pub struct Mlp<B: Backend> {
    layers: Vec<Linear<B>>,
}

impl<B: Backend> Mlp<B> {
    /// Takes `layers.0`, `layers.1`, ...: the first maps `widths[0]` numbers to `widths[1]`, and so on.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub fn load(weights: &Weights<'_, B>, widths: &[usize]) -> Result<Self, NetError> {
        let layer = |(k, pair): (usize, &[usize])| {
            let (inputs, outputs) = (pair[0], pair[1]);
            Linear::load(&weights.under(&format!("layers.{k}")), inputs, outputs)
        };
        Ok(Self { layers: widths.windows(2).enumerate().map(layer).collect::<Result<_, _>>()? })
    }

    /// A constant in the type and on the device of the weights.
    ///
    /// # Errors
    /// As [`Tensor::like`]; [`TensorError::Operand`] without a layer.
    pub(crate) fn like(&self, values: Vec<f64>, extents: &[usize]) -> Result<Tensor<B>, TensorError> {
        let dims = Dims::SCALAR;
        let first = self.layers.first().ok_or(TensorError::Operand { op: "mlp", dims, must: "needs a layer" })?;
        first.bias().like(values, extents)
    }

    /// .. x first width to .. x last width.
    ///
    /// # Errors
    /// As [`Tensor::linear`].
    pub fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let mut x = x.clone();
        for (k, layer) in self.layers.iter().enumerate() {
            x = layer.forward(&if k == 0 { x } else { x.relu()? })?;
        }
        Ok(x)
    }
}
