//! Sizes of the transformer.

use serde::{Deserialize, Serialize};

use crate::error::{NetError, require};

/// Sizes of a [`ConditionalDetr`](super::ConditionalDetr), under the keys of the published `config.json`; its other
/// keys are passed over.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct DetrConfig {
    /// Numbers per token and per query; a multiple of 4, for sines and cosines of two coordinates.
    pub d_model: usize,
    /// Queries: slots for objects.
    pub num_queries: usize,
    /// Layers of the encoder.
    pub encoder_layers: usize,
    /// Heads of its attention.
    pub encoder_attention_heads: usize,
    /// Width of its perceptrons.
    pub encoder_ffn_dim: usize,
    /// Layers of the decoder, at least 1.
    pub decoder_layers: usize,
    /// Heads of its attention.
    pub decoder_attention_heads: usize,
    /// Width of its perceptrons.
    pub decoder_ffn_dim: usize,
    /// The function in the perceptrons; only `relu` is here.
    pub activation_function: String,
    /// How positions become numbers; only `sine` is here.
    pub position_embedding_type: String,
}

impl DetrConfig {
    /// Checks that a model can be made of these sizes.
    ///
    /// # Errors
    /// [`NetError::Config`].
    pub fn validate(&self) -> Result<(), NetError> {
        let width = self.d_model;
        require(width > 0 && width.is_multiple_of(4), "d_model", width, "must be a multiple of 4, at least 4")?;
        for (key, heads) in [
            ("encoder_attention_heads", self.encoder_attention_heads),
            ("decoder_attention_heads", self.decoder_attention_heads),
        ] {
            require(heads > 0 && width.is_multiple_of(heads), key, heads, "must divide d_model")?;
        }
        for (key, count) in [
            ("num_queries", self.num_queries),
            ("decoder_layers", self.decoder_layers),
            ("encoder_ffn_dim", self.encoder_ffn_dim),
            ("decoder_ffn_dim", self.decoder_ffn_dim),
        ] {
            require(count > 0, key, count, "must be at least 1")?;
        }
        let (function, position) = (&self.activation_function, &self.position_embedding_type);
        require(function == "relu", "activation_function", function, "only relu is supported")?;
        require(position == "sine", "position_embedding_type", position, "only sine is supported")
    }
}
