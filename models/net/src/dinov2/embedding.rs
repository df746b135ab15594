//! An image as tokens: class, registers, patches.

use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};

use super::config::Dinov2Config;
use super::position::resample;
use crate::error::NetError;
use crate::weights::Weights;

/// Cuts images into patches, maps each to a token and adds its position.
#[derive(Clone, Debug)]
pub(super) struct Embedding<B: Backend> {
    class: Tensor<B>,
    registers: Option<Tensor<B>>,
    positions: Tensor<B>,
    kernels: Tensor<B>,
    bias: Tensor<B>,
    channels: usize,
    patch: usize,
    table_side: usize,
    width: usize,
}

impl<B: Backend> Embedding<B> {
    pub(super) fn load(weights: &Weights<'_, B>, config: &Dinov2Config) -> Result<Self, NetError> {
        let (width, patch, channels) = (config.hidden_size, config.patch_size, config.num_channels);
        let table_side = config.table_side();
        let count = config.num_register_tokens;
        let registers = if count > 0 { Some(weights.get("register_tokens", &[1, count, width])?) } else { None };
        let projection = weights.under("patch_embeddings.projection");
        Ok(Self {
            class: weights.get("cls_token", &[1, 1, width])?,
            registers,
            positions: weights.get("position_embeddings", &[1, 1 + table_side * table_side, width])?,
            kernels: projection.get("weight", &[width, channels, patch, patch])?,
            bias: projection.get("bias", &[width])?,
            channels,
            patch,
            table_side,
            width,
        })
    }

    /// Batch x channels x height x width to batch x tokens x numbers per token.
    pub(super) fn forward(&self, images: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        let &[batch, channels, height, width] = images.dims().extents() else {
            let must = "must be batch x channels x height x width";
            return Err(NetError::Input { input: "images", dims: *images.dims(), must });
        };
        if channels != self.channels {
            let must = "the second extent must be the num_channels of the model";
            return Err(NetError::Input { input: "images", dims: *images.dims(), must });
        }
        let patch = self.patch;
        let tiled = |side: usize| side > 0 && side.is_multiple_of(patch);
        if !tiled(height) || !tiled(width) {
            return Err(NetError::ImageSize { width, height, patch });
        }
        Ok(self.tokens(images, batch, height / patch, width / patch)?)
    }

    fn tokens(&self, images: &Tensor<B>, batch: usize, rows: usize, columns: usize) -> Result<Tensor<B>, TensorError> {
        let (side, width) = (self.table_side, self.width);
        let patches = images.conv2d(&self.kernels, Stride { step: self.patch, padding: 0 })?;
        let patches = patches.reshape(&[batch, width, rows * columns])?.transpose()?.add(&self.bias)?;
        let table = self.positions.slice(1, 1, side * side)?;
        let patches = patches.add(&resample(&table, side, rows, columns, width)?)?;
        let class = self.class.add(&self.positions.slice(1, 0, 1)?)?.expand(&[batch, 1, width])?;
        match &self.registers {
            Some(registers) => {
                let count = registers.dims().get(1).unwrap_or(0);
                Tensor::concat(&[&class, &registers.expand(&[batch, count, width])?, &patches], 1)
            }
            None => Tensor::concat(&[&class, &patches], 1),
        }
    }
}
