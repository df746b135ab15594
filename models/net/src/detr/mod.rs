//! Conditional DETR: from the tokens of an image to one latent vector per object slot.
//!
//! In: features of an image, batch x width x rows x columns. Out: the tokens after the encoder, and the latents.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`ConditionalDetr`]; its encoder alone is [`DetrEncoder`] |
//! | `config` | [`DetrConfig`], read from the published `config.json` |
//! | `sine` | positions as sines and cosines |
//! | `encoder`, `decoder` | a layer of each |
//!
//! *Source*: Meng et al.: Conditional DETR for Fast Training Convergence (2021). Names of weights are those of the
//! public library transformers (`ConditionalDetrModel`). Different: no dropout, no padded images.

mod config;
mod decoder;
mod encoder;
mod sine;
#[cfg(test)]
mod tests;

use dvp_core::tensor::{Backend, Tensor, TensorError};

pub use config::DetrConfig;
use decoder::{DecoderLayer, Scenery};
use encoder::EncoderLayer;
use sine::{embed_grid, embed_points};

use crate::error::NetError;
use crate::layers::{LayerNorm, Mlp};
use crate::weights::Weights;

/// Added to variances: PyTorch's default, with which the published weights were trained.
const NORM_EPSILON: f64 = 1e-5;

/// The layers that let the tokens of an image look at each other.
#[derive(Clone, Debug)]
pub struct DetrEncoder<B: Backend> {
    layers: Vec<EncoderLayer<B>>,
    width: usize,
}

/// The transformer.
#[derive(Clone, Debug)]
pub struct ConditionalDetr<B: Backend> {
    encoder: DetrEncoder<B>,
    decoder: Vec<DecoderLayer<B>>,
    norm: LayerNorm<B>,
    /// What tells the queries apart, 1 x queries x width.
    queries: Tensor<B>,
    /// From a query to the logits of the point of the image where it looks.
    point: Mlp<B>,
    /// From what a query knows to factors on its position.
    scale: Mlp<B>,
    width: usize,
}

/// What a [`ConditionalDetr`] makes of features.
#[derive(Clone, Debug)]
pub struct DetrOutput<B: Backend> {
    /// The tokens after the encoder: batch x rows * columns x width.
    pub memory: Tensor<B>,
    /// One vector per slot: batch x queries x width.
    pub latents: Tensor<B>,
}

impl<B: Backend> DetrEncoder<B> {
    /// Takes `layers.0`, `layers.1`, ...; of the sizes those of the encoder are looked at.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load(config: &DetrConfig, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        config.validate()?;
        let layer = |k| EncoderLayer::load(&weights.under(&format!("layers.{k}")), config);
        Ok(Self { layers: (0..config.encoder_layers).map(layer).collect::<Result<_, _>>()?, width: config.d_model })
    }

    /// Features, batch x width x rows x columns, none of them 0, to tokens, batch x rows * columns x width, and where
    /// they stand, 1 x rows * columns x width.
    ///
    /// # Errors
    /// [`NetError::Input`] for other extents; [`NetError::Tensor`] if the features are of another number type or device
    /// than the weights.
    pub fn forward(&self, features: &Tensor<B>) -> Result<[Tensor<B>; 2], NetError> {
        let extents = features.dims().extents();
        let &[batch, width, rows, columns] = extents else { return Err(not_features(features)) };
        if width != self.width || extents.contains(&0) {
            return Err(not_features(features));
        }
        let positions = embed_grid(rows, columns, width, features)?;
        let mut memory = features.reshape(&[batch, width, rows * columns])?.transpose()?;
        for layer in &self.layers {
            memory = layer.forward(&memory, &positions)?;
        }
        Ok([memory, positions])
    }
}

impl<B: Backend> ConditionalDetr<B> {
    /// Takes the weights by their public names: `encoder.layers.0.self_attn.q_proj.weight`, ...,
    /// `decoder.layernorm.bias`, `query_position_embeddings.weight` (or `query_position_embedding.weight`). Others are
    /// passed over. In files of a whole detector they stand under `model`; see [`Weights::under`].
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`] if the weights are of another model.
    pub fn load(config: &DetrConfig, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        config.validate()?;
        let (width, count) = (config.d_model, config.num_queries);
        let decoder = weights.under("decoder");
        let decoder_layer = |k| DecoderLayer::load(&decoder.under(&format!("layers.{k}")), config, k == 0);
        let singular = "query_position_embedding.weight";
        let name = if weights.contains(singular) { singular } else { "query_position_embeddings.weight" };
        Ok(Self {
            encoder: DetrEncoder::load(config, &weights.under("encoder"))?,
            decoder: (0..config.decoder_layers).map(decoder_layer).collect::<Result<_, _>>()?,
            norm: LayerNorm::load(&decoder.under("layernorm"), width, NORM_EPSILON)?,
            queries: weights.get(name, &[count, width])?.reshape(&[1, count, width])?,
            point: Mlp::load(&decoder.under("ref_point_head"), &[width, width, 2])?,
            scale: Mlp::load(&decoder.under("query_scale"), &[width, width, width])?,
            width,
        })
    }

    /// Tokens and latents of features.
    ///
    /// *Dimensions*: as [`DetrEncoder::forward`].
    ///
    /// # Errors
    /// As [`DetrEncoder::forward`].
    pub fn forward(&self, features: &Tensor<B>) -> Result<DetrOutput<B>, NetError> {
        let [memory, positions] = self.encoder.forward(features)?;
        let latents = self.decode(&memory, &positions)?;
        Ok(DetrOutput { memory, latents })
    }

    fn decode(&self, memory: &Tensor<B>, positions: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let scenery = Scenery { memory, positions, queries: &self.queries };
        let place = embed_points(&self.point.forward(&self.queries)?.sigmoid()?, self.width)?;
        // The queries know nothing at first, the same of every image.
        let mut x = self.queries.like(vec![0.0; self.queries.dims().len()], self.queries.dims().extents())?;
        for (k, layer) in self.decoder.iter().enumerate() {
            let scaled = if k == 0 { place.clone() } else { place.mul(&self.scale.forward(&x)?)? };
            x = layer.forward(&x, &scaled, &scenery)?;
        }
        self.norm.forward(&x)
    }
}

fn not_features<B: Backend>(features: &Tensor<B>) -> NetError {
    let must = "must be batch x d_model of the model x rows x columns, none of them 0";
    NetError::Input { input: "features", dims: *features.dims(), must }
}
