//! Layers that let queries look at each other and at the image.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use super::NORM_EPSILON;
use super::config::DetrConfig;
use super::encoder::Perceptron;
use crate::error::NetError;
use crate::layers::{LayerNorm, Linear, attend, join_heads};
use crate::weights::Weights;

/// What all layers look at.
#[derive(Debug)]
pub(super) struct Scenery<'a, B: Backend> {
    /// Tokens of the image, batch x n x width.
    pub memory: &'a Tensor<B>,
    /// Their positions, 1 x n x width.
    pub positions: &'a Tensor<B>,
    /// What tells the queries apart, 1 x queries x width.
    pub queries: &'a Tensor<B>,
}

/// Attention among queries, conditional cross attention to the image, a perceptron; a norm after each.
///
/// Conditional: what a query looks for and where it looks are two halves of each head, side by side and not summed.
#[derive(Clone, Debug)]
pub(super) struct DecoderLayer<B: Backend> {
    own: SelfAttention<B>,
    own_norm: LayerNorm<B>,
    cross: CrossAttention<B>,
    cross_norm: LayerNorm<B>,
    perceptron: Perceptron<B>,
}

impl<B: Backend> DecoderLayer<B> {
    pub(super) fn load(weights: &Weights<'_, B>, config: &DetrConfig, first: bool) -> Result<Self, NetError> {
        let width = config.d_model;
        let norm = |name| LayerNorm::load(&weights.under(name), width, NORM_EPSILON);
        Ok(Self {
            own: SelfAttention::load(weights, config)?,
            own_norm: norm("self_attn_layer_norm")?,
            cross: CrossAttention::load(weights, config, first)?,
            cross_norm: norm("encoder_attn_layer_norm")?,
            perceptron: Perceptron::load(weights, width, config.decoder_ffn_dim)?,
        })
    }

    /// `x`: batch x queries x width, or batch 1 as long as it is the same for all images. `place`: where each query
    /// looks, in the same extents.
    pub(super) fn forward(
        &self,
        x: &Tensor<B>,
        place: &Tensor<B>,
        scenery: &Scenery<'_, B>,
    ) -> Result<Tensor<B>, TensorError> {
        let x = self.own_norm.forward(&x.add(&self.own.forward(x, scenery)?)?)?;
        let x = self.cross_norm.forward(&x.add(&self.cross.forward(&x, place, scenery)?)?)?;
        self.perceptron.forward(&x)
    }
}

/// Attention among queries.
#[derive(Clone, Debug)]
struct SelfAttention<B: Backend> {
    /// Maps of content and of position.
    query: [Linear<B>; 2],
    key: [Linear<B>; 2],
    value: Linear<B>,
    output: Linear<B>,
    heads: usize,
}

impl<B: Backend> SelfAttention<B> {
    fn load(weights: &Weights<'_, B>, config: &DetrConfig) -> Result<Self, NetError> {
        let square = |name| Linear::load(&weights.under(name), config.d_model, config.d_model);
        Ok(Self {
            query: [square("sa_qcontent_proj")?, square("sa_qpos_proj")?],
            key: [square("sa_kcontent_proj")?, square("sa_kpos_proj")?],
            value: square("sa_v_proj")?,
            output: square("self_attn.out_proj")?,
            heads: config.decoder_attention_heads,
        })
    }

    fn forward(&self, x: &Tensor<B>, scenery: &Scenery<'_, B>) -> Result<Tensor<B>, TensorError> {
        let placed =
            |[content, position]: &[Linear<B>; 2]| content.forward(x)?.add(&position.forward(scenery.queries)?);
        let mixed = attend(&placed(&self.query)?, &placed(&self.key)?, &self.value.forward(x)?, self.heads)?;
        self.output.forward(&mixed)
    }
}

/// Attention of queries to the image.
#[derive(Clone, Debug)]
struct CrossAttention<B: Backend> {
    query_content: Linear<B>,
    /// In the first layer alone, where the content says nothing yet.
    query_position: Option<Linear<B>>,
    query_sine: Linear<B>,
    key_content: Linear<B>,
    key_position: Linear<B>,
    value: Linear<B>,
    output: Linear<B>,
    heads: usize,
}

impl<B: Backend> CrossAttention<B> {
    fn load(weights: &Weights<'_, B>, config: &DetrConfig, first: bool) -> Result<Self, NetError> {
        let square = |name| Linear::load(&weights.under(name), config.d_model, config.d_model);
        Ok(Self {
            query_content: square("ca_qcontent_proj")?,
            query_position: if first { Some(square("ca_qpos_proj")?) } else { None },
            query_sine: square("ca_qpos_sine_proj")?,
            key_content: square("ca_kcontent_proj")?,
            key_position: square("ca_kpos_proj")?,
            value: square("ca_v_proj")?,
            output: square("encoder_attn.out_proj")?,
            heads: config.decoder_attention_heads,
        })
    }

    fn forward(&self, x: &Tensor<B>, place: &Tensor<B>, scenery: &Scenery<'_, B>) -> Result<Tensor<B>, TensorError> {
        let key_position = self.key_position.forward(scenery.positions)?;
        let mut query = self.query_content.forward(x)?;
        let mut key = self.key_content.forward(scenery.memory)?;
        if let Some(query_position) = &self.query_position {
            query = query.add(&query_position.forward(scenery.queries)?)?;
            key = key.add(&key_position)?;
        }
        let query = join_heads(&query, &self.query_sine.forward(place)?, self.heads)?;
        let key = join_heads(&key, &key_position, self.heads)?;
        let mixed = attend(&query, &key, &self.value.forward(scenery.memory)?, self.heads)?;
        self.output.forward(&mixed)
    }
}
