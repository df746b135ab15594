//! A block: attention among tokens, then a perceptron on each.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use super::config::Dinov2Config;
use crate::error::NetError;
use crate::layers::{LayerNorm, Linear, attend};
use crate::weights::Weights;

/// x + scale attention(norm(x)), then x + scale perceptron(norm(x)), each scale one number per channel.
#[derive(Clone, Debug)]
pub(super) struct Block<B: Backend> {
    norms: [LayerNorm<B>; 2],
    scales: [Tensor<B>; 2],
    query: Linear<B>,
    key: Linear<B>,
    value: Linear<B>,
    output: Linear<B>,
    widen: Linear<B>,
    narrow: Linear<B>,
    heads: usize,
}

impl<B: Backend> Block<B> {
    pub(super) fn load(weights: &Weights<'_, B>, config: &Dinov2Config) -> Result<Self, NetError> {
        let width = config.hidden_size;
        let wide = width * config.mlp_ratio;
        let norm = |name| LayerNorm::load(&weights.under(name), width, config.layer_norm_eps);
        let square = |name| Linear::load(&weights.under(name), width, width);
        Ok(Self {
            norms: [norm("norm1")?, norm("norm2")?],
            scales: [weights.get("layer_scale1.lambda1", &[width])?, weights.get("layer_scale2.lambda1", &[width])?],
            query: square("attention.attention.query")?,
            key: square("attention.attention.key")?,
            value: square("attention.attention.value")?,
            output: square("attention.output.dense")?,
            widen: Linear::load(&weights.under("mlp.fc1"), width, wide)?,
            narrow: Linear::load(&weights.under("mlp.fc2"), wide, width)?,
            heads: config.num_attention_heads,
        })
    }

    /// Batch x tokens x width to the same extents.
    pub(super) fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let ([norm_1, norm_2], [scale_1, scale_2]) = (&self.norms, &self.scales);
        let y = norm_1.forward(x)?;
        let mixed = attend(&self.query.forward(&y)?, &self.key.forward(&y)?, &self.value.forward(&y)?, self.heads)?;
        let x = x.add(&self.output.forward(&mixed)?.mul(scale_1)?)?;
        let changed = self.narrow.forward(&self.widen.forward(&norm_2.forward(&x)?)?.gelu()?)?;
        x.add(&changed.mul(scale_2)?)
    }
}
