//! Layers that let the tokens of an image look at each other.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use super::NORM_EPSILON;
use super::config::DetrConfig;
use crate::error::NetError;
use crate::layers::{LayerNorm, Linear, attend};
use crate::weights::Weights;

/// norm(x + attention(x)), then norm(x + perceptron(x)).
#[derive(Clone, Debug)]
pub(super) struct EncoderLayer<B: Backend> {
    query: Linear<B>,
    key: Linear<B>,
    value: Linear<B>,
    output: Linear<B>,
    attention_norm: LayerNorm<B>,
    perceptron: Perceptron<B>,
    heads: usize,
}

impl<B: Backend> EncoderLayer<B> {
    pub(super) fn load(weights: &Weights<'_, B>, config: &DetrConfig) -> Result<Self, NetError> {
        let width = config.d_model;
        let square = |name| Linear::load(&weights.under("self_attn").under(name), width, width);
        Ok(Self {
            query: square("q_proj")?,
            key: square("k_proj")?,
            value: square("v_proj")?,
            output: square("out_proj")?,
            attention_norm: LayerNorm::load(&weights.under("self_attn_layer_norm"), width, NORM_EPSILON)?,
            perceptron: Perceptron::load(weights, width, config.encoder_ffn_dim)?,
            heads: config.encoder_attention_heads,
        })
    }

    /// Tokens batch x n x width, with their `positions`, to the same extents. Positions tell where to look, not what is
    /// there.
    pub(super) fn forward(&self, x: &Tensor<B>, positions: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let placed = x.add(positions)?;
        let (query, key) = (self.query.forward(&placed)?, self.key.forward(&placed)?);
        let mixed = attend(&query, &key, &self.value.forward(x)?, self.heads)?;
        let x = self.attention_norm.forward(&x.add(&self.output.forward(&mixed)?)?)?;
        self.perceptron.forward(&x)
    }
}

/// The second half of a layer, of encoder and decoder: norm(x + fc2(relu(fc1(x)))).
#[derive(Clone, Debug)]
pub(super) struct Perceptron<B: Backend> {
    widen: Linear<B>,
    narrow: Linear<B>,
    norm: LayerNorm<B>,
}

impl<B: Backend> Perceptron<B> {
    pub(super) fn load(weights: &Weights<'_, B>, width: usize, wide: usize) -> Result<Self, NetError> {
        Ok(Self {
            widen: Linear::load(&weights.under("fc1"), width, wide)?,
            narrow: Linear::load(&weights.under("fc2"), wide, width)?,
            norm: LayerNorm::load(&weights.under("final_layer_norm"), width, NORM_EPSILON)?,
        })
    }

    pub(super) fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let changed = self.narrow.forward(&self.widen.forward(x)?.relu()?)?;
        self.norm.forward(&x.add(&changed)?)
    }
}
