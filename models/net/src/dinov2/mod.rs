//! DINOv2, a vision transformer, with registers: an image as tokens.
//!
//! In: images, batch x channels x height x width, with the mean and deviation that the weights were trained with. Out:
//! batch x tokens x width: the class token, the registers, then the patches row by row.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Dinov2`] |
//! | `config` | [`Dinov2Config`], read from the published `config.json` |
//! | `embedding` | patches, class token and registers with their positions |
//! | `position` | the position table at other extents than its own |
//! | `block` | attention and perceptron |
//!
//! *Source*: Oquab et al.: DINOv2: Learning Robust Visual Features without Supervision (2023); Darcet et al.: Vision
//! Transformers Need Registers (2023). Names of weights and order of tokens are those of the public library
//! transformers (`Dinov2WithRegistersModel`). Different: an image that patches do not tile is refused, not cut; no
//! dropout, no drop path.

mod block;
mod config;
mod embedding;
mod position;
#[cfg(test)]
mod tests;

use dvp_core::tensor::{Backend, Tensor, TensorError};

use block::Block;
pub use config::Dinov2Config;
use embedding::Embedding;

use crate::error::NetError;
use crate::layers::LayerNorm;
use crate::weights::Weights;

/// The encoder of an image.
#[derive(Clone, Debug)]
pub struct Dinov2<B: Backend> {
    embedding: Embedding<B>,
    blocks: Vec<Block<B>>,
    norm: LayerNorm<B>,
    /// Tokens before the patches.
    lead: usize,
}

impl<B: Backend> Dinov2<B> {
    /// Takes the weights by their public names: `embeddings.cls_token`, `encoder.layer.0.norm1.weight`, ...,
    /// `layernorm.bias`. Others are passed over. [`Weights::frozen`] makes an encoder that does not train.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`] if the weights are of another model.
    pub fn load(config: &Dinov2Config, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        config.validate()?;
        let block = |k| Block::load(&weights.under(&format!("encoder.layer.{k}")), config);
        Ok(Self {
            embedding: Embedding::load(&weights.under("embeddings"), config)?,
            blocks: (0..config.num_hidden_layers).map(block).collect::<Result<_, _>>()?,
            norm: LayerNorm::load(&weights.under("layernorm"), config.hidden_size, config.layer_norm_eps)?,
            lead: 1 + config.num_register_tokens,
        })
    }

    /// The tokens of images of whole patches.
    ///
    /// *Dimensions*: batch x channels x height x width to batch x (1 + registers + patches) x width of a token.
    ///
    /// # Errors
    /// [`NetError::ImageSize`]; [`NetError::Input`] if the extents are others or the channels not the model's;
    /// [`NetError::Tensor`] if the images are of another number type or device than the weights.
    pub fn forward(&self, images: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        let mut tokens = self.embedding.forward(images)?;
        for block in &self.blocks {
            tokens = block.forward(&tokens)?;
        }
        Ok(self.norm.forward(&tokens)?)
    }

    /// The tokens before the first block and after each, all without the norm at the end; extents as in
    /// [`Self::forward`].
    ///
    /// # Errors
    /// As [`Self::forward`].
    pub fn hidden_states(&self, images: &Tensor<B>) -> Result<Vec<Tensor<B>>, NetError> {
        let mut tokens = self.embedding.forward(images)?;
        let mut states = vec![tokens.clone()];
        for block in &self.blocks {
            tokens = block.forward(&tokens)?;
            states.push(tokens.clone());
        }
        Ok(states)
    }

    /// The patches among tokens, batch x patches x width: row by row from the top.
    ///
    /// # Errors
    /// [`TensorError::Axis`] or [`TensorError::Range`] if these are no tokens of this model.
    pub fn patches(&self, tokens: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let count = tokens.dims().get(1).unwrap_or(0).saturating_sub(self.lead);
        tokens.slice(1, self.lead, count)
    }
}
